# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Rivals of an effect that the robot file holds: effects that explain the drives as well.

A user who was told several rivals adds one of them, and then nothing is missing. That does not
prove it: the same drives still cannot tell it from the others, and the report must keep saying so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from werrimbi_odom.inference.calibration_parametrisation import base_name
from werrimbi_odom.inference.diagnosis.forward_selection import best_of_each
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.score_tests import (
    CALIBRATED,
    candidates,
    parameters_of_candidate,
    scores,
)
from werrimbi_odom.inference.rules import INSTEAD_FITTED, RIVAL, WORTH_A_FIT
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot


def rivals_of_held(
    runs: Concatenated, fit: Fitted, effects: Sequence[Effect], given: Robot
) -> dict[str, tuple[str, ...]]:
    """Effects that explain the drives as well as an effect that the file holds, by its name."""
    found = {}
    for applied in fit.point.model.robot.effects:
        if applied.effect.is_mistake or applied.name in CALIBRATED or base_name(applied.effect):
            continue  # sizes are in every fit
        rivals = _rivals(runs, fit, effects, given, applied.effect)
        if rivals:
            found[applied.name] = rivals
    return found


def _rivals(
    runs: Concatenated, fit: Fitted, effects: Sequence[Effect], given: Robot, held: Effect
) -> tuple[str, ...]:
    """Score all effects without the held one; fit the best few in its place."""
    mine, bare = f"{held.name}.", fit.point.model.without_effect(held.name)
    point, others = replace(fit.point, model=bare), bare.robot.effects
    numbers = tuple(number for number in fit.numbers if not number.name.startswith(mine))
    library = [held, *(effect for effect in effects if effect.name != held.name)]
    tried = candidates(library, {item.name for item in others}, runs.channels, len(runs.runs))
    ordered = best_of_each(scores(runs, point, (*CALIBRATION, *numbers), tried))
    gains = {score.candidate.name: score.gain for score in ordered}
    least = WORTH_A_FIT * gains.get(held.name, max(gains.values(), default=0.0))
    near = [each for each in ordered if each.candidate.name != held.name and each.gain > least]
    found = {}
    for score in near[:INSTEAD_FITTED]:
        start = started_with(runs, point, score)
        free = (*numbers, *parameters_of_candidate(score.candidate))
        other = fitted(runs, start, (score.candidate.name,), free, given)
        if other.told and not other.at_bound and other.total < fit.total + RIVAL * fit.scatter:
            found[score.candidate.name] = other.total
    return tuple(sorted(found, key=lambda name: found[name]))
