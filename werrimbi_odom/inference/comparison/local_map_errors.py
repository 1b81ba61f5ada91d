# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of legs for a reference that localises on a map, whose own error varies slowly.

A localiser that is off by 5 degrees shifts every leg by 90 mm per metre to the side until it
recovers. So a leg is not judged by its two poses alone. As in a fit, the reference's error at the
leg's start is filtered from all poses before it, and the error of a leg is the innovation of the
pose at its end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, Model
from werrimbi_odom.inference.fitting.likelihood import Variances, errors_between, innovations
from werrimbi_odom.inference.fitting.prediction import Prediction, right_handed
from werrimbi_odom.inference.fitting.run_phases import with_own_values
from werrimbi_odom.inference.legs.cutting import cut_for_fit
from werrimbi_odom.inference.legs.matched_run import AlignedRun
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_MEDIAN_OF_A_SHARE = 2.366 / 3.0
_ROUNDS = 6


@dataclass(frozen=True, slots=True)
class Wandering:
    """Noise of a reference on a local map."""

    variances: Variances
    """Noise variances. Those of the wheels are by-products of the fit and not for judging."""
    estimated: bool
    """False if there were too few poses, so that typical values are used."""


def wandering_of(
    records: Sequence[AlignedRun], robot: Robot, options: EvaluationOptions
) -> Wandering:
    """Maximum-likelihood noise of a reference, with the robot's calibration free.

    So a wrong base or radius is not taken for a random walk of the reference.
    """
    laid = concatenated([cut_for_fit(record, robot, options.leg) for record in records])
    point = start_point(laid, robot, options)
    if not laid.tells_noise:
        return Wandering(point.variances, False)
    point, numbers = with_own_values(laid, point)
    numbers = (*CALIBRATION, *numbers, *point.model.nuisance_parameters)
    fit = fit_model(laid, point, numbers)
    return Wandering(fit.point.variances, True)


def errors_on_map(
    model: Model,
    runs: Concatenated,
    prediction: Prediction,
    variances: Variances,
    jumped: NDArray[np.bool_],
) -> tuple[Floats, Floats]:
    """Errors of legs, (m, 3), NaN where not measured, and their covariances, (m, 3, 3).

    A wrong model would attribute its own errors to the reference and carry them into all later
    legs. So errors are the innovations of a filter whose wheel noise is inflated until they are
    consistent; the covariance is that of the stated noise. Legs on which the reference jumped are
    judged by their two poses.
    """
    robot = model.robot
    wheels = np.square([robot.left_wheel_noise, robot.right_wheel_noise])
    doubt, honest = 1.0, None
    for _ in range(_ROUNDS):
        found = innovations(
            robot,
            runs,
            prediction,
            replace(variances, left=doubt * wheels[:1], right=doubt * wheels[1:]),
            "local_map",
            excluded=jumped,
            start_yaws=model.start_yaws,
            heading=rules.UNKNOWN_HEADING,
        )
        honest = found.covariance[0] if honest is None else honest
        counted = found.known.any(axis=1)
        if not counted.any():
            break
        share = np.sum(found.whitened()[counted] ** 2, axis=1) / found.known[counted].sum(axis=1)
        usual = float(np.median(share)) / _MEDIAN_OF_A_SHARE
        if usual <= rules.HONEST_WITHIN:
            break
        doubt *= usual
    assert honest is not None
    view = view_of(robot.effects)
    start, finish = right_handed(runs.start, view), right_handed(runs.finish, view)
    plain = errors_between(start, finish, prediction)
    error = np.where(found.known, found.value[0], np.where(jumped[:, None], plain, np.nan))
    return error, honest
