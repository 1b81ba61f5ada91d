# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What one drive tells about the robot's parameters, fitted by itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.changes.change_evidence import evidence_of, held_or_equivalent
from werrimbi_odom.inference.changes.logarithmic_sizes import in_logarithms
from werrimbi_odom.inference.changes.parameter_groups import DELAY, MOUNT, numbers_of, value_at
from werrimbi_odom.inference.diagnosis.forward_selection import (
    best_of_each,
    fit_calibration,
    fitted_beside,
    may_pay,
)
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.candidate_starts import started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.score_tests import candidates, scores
from werrimbi_odom.inference.legs.cutting import match_for_fit, with_stated_noise
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.set_up.search import require_sizes_to_mean_something
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

NULLS: Mapping[str, float] = {
    f"{name}.{key}": null for name in MOUNT for key, null in find(name).nulls.items()
}
"""Null values of the mount, by the names of its parameters."""


@dataclass(frozen=True, slots=True)
class DriveEstimate:
    """Information of one drive."""

    names: tuple[str, ...]
    """Names of its s parameters."""
    information: Floats
    """Information matrix, (s, s)."""
    weighted: Floats
    """Information times estimate, (s,)."""
    begin: float
    """First stamp of the ticks [s]."""
    data: int
    """Number of measured coordinates in use."""
    way: float
    """Travel [m]."""


def estimate_of_drive(run: Run, robot: Robot, options: EvaluationOptions) -> DriveEstimate:
    """Fit one drive by itself.

    InputError when it has no usable reference or no ticks, or when what is set up wrongly (a unit,
    exchanged counters) leaves its sizes without a meaning.
    """
    run = with_no_driving(run, robot, options.limits)
    require_sizes_to_mean_something(run, robot, options)
    laid = concatenated(match_for_fit([run], robot, options.leg, options.limits))
    fit = fit_calibration(laid, robot, with_stated_noise(options, laid.runs))
    fit = _with_its_reference(laid, fit, robot)
    evidence = evidence_of(laid, fit)
    drive = in_logarithms(evidence.drives(np.zeros(1)), evidence.values, robot)
    # Fitted, and told for no drive: a length of a law, a phase, a delay that the file lacks.
    every = (*evidence.numbers, *(number for number, run in fit.design.columns if run < 0))
    told = {number.name for number in numbers_of(robot, [find(name) for name in MOUNT])}
    drive = drive.without(
        {
            number.name: (value_at(robot, number.name, NULLS), number.undetermined)
            for number in every
            if number.name not in told
        }
    )
    way = float(np.sum(predict_all(fit.point.model, laid).length[~laid.gap]))
    begin = float(laid.runs[0].counters.time[0])
    return DriveEstimate(
        drive.names, drive.information[0], drive.weighted[0], begin, laid.data, way
    )


def _with_its_reference(runs: Concatenated, fit: Fitted, robot: Robot) -> Fitted:
    """The fit with the mount and the clock of the reference, as far as the drive needs them.

    What the robot file lacks of them would else pass for noise of the wheels, by which nothing
    would be known.
    """
    effects = [find(name) for name in (*MOUNT, DELAY)]
    while True:
        held = held_or_equivalent(fit.point.model.robot)
        looked_at = candidates(effects, held, set(), len(runs.runs))
        found = scores(runs, fit.point, (*CALIBRATION, *fit.numbers), looked_at)
        best = next((each for each in best_of_each(found) if may_pay(each, fit, runs.data)), None)
        if best is None:
            return fit
        start = started_with(runs, fit.point, best)
        wider = fitted_beside(runs, fit, start, best, robot)
        if not wider.total < fit.total:
            return fit
        fit = wider
