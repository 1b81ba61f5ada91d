# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that may have either sign: which fit is told, and what the other leaves unsure."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed, with_sizes
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, shared_of, value_of
from werrimbi_odom.model.effect import applied_of
from werrimbi_odom.model.robot import Robot


def cheapest_of(fits: Sequence[Fitted]) -> Fitted:
    """The cheapest of the fits of one effect, with the cheapest of the other sign as `or_else`.

    A bump, and a flat across from it beside a larger radius, do the same once a turn. Where either
    may be true, a standard deviation about one of them says nothing of the other.
    """
    best, *others = sorted(fits, key=lambda fit: fit.total)
    effect = best.newest
    signs = [name for name in effect.parameters if effect.has_null(name)]

    def side(fit: Fitted, name: str) -> float:
        value = applied_of(fit.point.model.robot.effects, effect.name).values[name]
        return (
            math.copysign(1.0, value - effect.nulls[name]) if value != effect.nulls[name] else 0.0
        )

    other = next(
        (
            fit
            for fit in others
            if fit.total - best.total < rules.RIVAL * best.scatter
            and any(side(fit, name) * side(best, name) < 0.0 for name in signs)
        ),
        None,
    )
    return replace(best, or_else=other)


def variances_by_sign(
    runs: Concatenated, either: Iterable[Fitted], given: Robot, wanted: Collection[str]
) -> dict[str, float]:
    """Variances of shared parameters, by name, for the signs that effects may have (`or_else`).

    A flat instead of a bump goes with another base and another radius. Each sign has a probability
    by its cost and penalty, as all choices do (`model_averaged_covariance`). The effect's own size
    has none here: that of the other sign is told beside it. `either`: fits with an effect as their
    newest, to these runs.
    """
    found: dict[str, float] = {}
    for fit in either:
        other = fit.or_else
        if other is None:
            continue
        share = 1.0 / (1.0 + math.exp(0.5 * (other.total - fit.total) / fit.scatter))
        robots = []
        for each in (fit, other):
            sizes = sizes_needed(each, given, wanted)
            robots.append(with_sizes(runs, each, given, sizes).point.model.robot)
        own = f"{fit.newest.name}."
        for name in (*MULTIPLIERS, *(number.name for number in shared_of(fit.numbers))):
            if not name.startswith(own):
                here, there = (value_of(robot, name) for robot in robots)
                found[name] = found.get(name, 0.0) + share * (there - here) ** 2
    return found
