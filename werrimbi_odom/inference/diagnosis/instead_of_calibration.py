# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects that would do in place of the calibration that a model needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.forward_selection import (
    as_given,
    best_of_each,
    worth_fitting,
)
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.fit import fit_model
from werrimbi_odom.inference.fitting.free_parameters import NUISANCES, own_of
from werrimbi_odom.inference.fitting.score_tests import candidates, parameters_with, scores
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Instead:
    """An effect in place of a calibration."""

    effect: str
    total: float
    """Cost and penalty, comparable with the calibrated model's."""


def instead_of_calibration(
    runs: Concatenated, calibrated: Fitted, effects: Sequence[Effect], given: Robot
) -> tuple[Instead, ...]:
    """Effects that would do in place of the calibration that a model needs, cheapest first.

    The multipliers are fixed at the given robot's.
    """
    model = calibrated.point.model
    point = as_given(calibrated.point, given)
    nuisances = model.nuisance_parameters
    held = {applied.name for applied in model.robot.effects}
    # In a map made by a lidar, whose metric scale is its own.
    wanders = point.options.reference_kind == "local_map"
    looked_at = candidates(effects, held, runs.channels, len(runs.runs), own_scale=wanders)
    found = scores(runs, point, (*calibrated.numbers, *nuisances), looked_at)
    results = []
    penalty = calibrated.penalty_of_one
    best = sorted(best_of_each(found), key=lambda score: penalty * score.degrees - score.gain)
    for score in worth_fitting(best, most=rules.INSTEAD_FITTED):
        start = started_with(runs, point, score)
        numbers = (*parameters_with(calibrated.numbers, score.candidate), *nuisances)
        fit = fit_model(runs, start, numbers, find_jumps=False, rounds=8)
        if not fit.at_bound:
            own = [each.name for each in own_of(numbers) if each.name not in NUISANCES]
            owned = sum(name in values for values in fit.point.model.own for name in own)
            paid = penalty * len(fit.free) + calibrated.penalty_of_own * owned
            total = fit.minus_two_log_likelihood + paid * calibrated.scatter
            results.append(Instead(score.candidate.name, total))
    return tuple(sorted(results, key=lambda item: item.total))
