# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ranking of all effects: how significant each is, and how far it lowers the errors."""

from __future__ import annotations

from dataclasses import dataclass

from werrimbi_odom.inference.calibration_parametrisation import base_name, name_of_base
from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.holdout import Errors, Judge
from werrimbi_odom.inference.diagnosis.p_values import (
    chance,
    chance_of_score,
    p_value_by_parts,
    p_value_of_size,
)
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import bonferroni
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, Model
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Ranked:
    """An effect with its p-value and its effect on the errors."""

    effect: str
    p_value: float | None
    """Corrected for the number of effects tried. None where nothing was tested: a set-up mistake is
    found by a search of all set-ups, whose statistic has no known distribution."""
    train: Sides | None
    """Position error before and after adding it [m], or heading error where only headings were
    measured [rad]; None where it was not fitted.

    An effect is held against the same model without it: where base and radii are fitted with it, so
    are they before it, as in `add`."""
    holdout: Sides | None


def ranking_of(
    found: tuple[str, ...],
    set_up: SetUp,
    rounds: tuple[Round, ...],
    final: Fitted,
    judge: Judge,
    start: Errors,
    laid: Concatenated,
    given: Robot,
    told: Fitted,
) -> list[Ranked]:
    """All effects, those found first, with the figures of the round that accepted them.

    The figures of the others are of their first trial. `told`: the reported fit.
    """
    ranked: dict[str, Ranked] = {}
    mended = judge.of(Model(set_up.robot, judge.nothing_of_own)) if set_up.findings else start
    for finding in set_up.findings:
        ranked[finding.effect] = _worth(finding.effect, None, start, mended)
    calibrated = judge.of(rounds[0].before.point.model)
    before = calibrated if _sizes_differ(told, set_up.robot) else mended
    for number, this in enumerate(rounds):
        if number > 0:
            before = judge.of(this.before.point.model)
        for fit in this.tried:
            name = fit.names[-1]
            # An accepted effect is reported as of its acceptance, not of an earlier trial.
            taken = final.names[number : number + 1] == (name,)
            if name not in ranked or taken:
                p_value = chance(fit, this.before, this.number)
                if taken:
                    p_value = max(p_value, p_value_by_parts(laid, final, name, this.number))
                without = mended if base_name(fit.newest) is not None else before
                ranked[name] = _worth(name, p_value, without, judge.of(fit.point.model))
    for name in CALIBRATED:
        importance = final.importance.get(name, 0.0)
        p_value = bonferroni(rounds[0].number, p_value_of_size(final, name, given, set_up.robot))
        untried = Ranked(name, p_value, None, None)
        worth = _worth(name, p_value, mended, calibrated) if importance else untried
        base = name_of_base(final.point.model.robot)
        ranked.setdefault(base if name == "track_width" else name, worth)
    for score in rounds[0].scores:
        p_value = chance_of_score(score, rounds[0].before, rounds[0].number)
        ranked.setdefault(score.candidate.name, Ranked(score.candidate.name, p_value, None, None))
    first = [ranked.pop(name) for name in found if name in ranked]
    return [*first, *sorted(ranked.values(), key=_certainty)]


def _sizes_differ(told: Fitted, given: Robot) -> bool:
    """Whether base or radii of the reported fit differ from those that it began with."""
    robot = told.point.model.robot
    return any(getattr(robot, name) != getattr(given, name) for name in MULTIPLIERS)


def _certainty(item: Ranked) -> float:
    return 0.0 if item.p_value is None else item.p_value


def _worth(effect: str, p_value: float | None, before: Errors, after: Errors) -> Ranked:
    return Ranked(effect, p_value, Sides(before.train, after.train, after.unit), before.to(after))
