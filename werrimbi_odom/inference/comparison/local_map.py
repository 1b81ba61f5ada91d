# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Legs of a reference that tells its place on a map: how it wanders, and what is left beside that.

A localiser that has lost itself by 5 degrees shows every leg 90 mm a metre to the side until it has
found back. So a leg is not judged by its two poses alone: the error of the reference at its start
is what all poses before it tell, as in a fit, and the error of a leg is what nobody expected of the
pose at its end.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.knobs import CALIBRATION, Model
from werrimbi_odom.inference.fitting.likelihood import Variances, errors_between, innovations
from werrimbi_odom.inference.fitting.own_values import with_own_values
from werrimbi_odom.inference.fitting.prediction import Prediction, right_handed
from werrimbi_odom.inference.fitting.together import Together, together
from werrimbi_odom.inference.legs.cutting import Record, cut_finely
from werrimbi_odom.inference.rules import NOISE_NUMBERS, UNKNOWN_HEADING
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Wandering:
    """Noise of a reference on a local map."""

    variances: Variances
    """With those of the wheels as the fit has them, which nobody is to judge by."""
    estimated: bool
    """Else there were too few poses, and it is what such references usually have."""


def wandering_of(
    records: Sequence[Record],
    robot: Robot,
    leg: float,
    sigma_xy: float | None,
    sigma_yaw: float | None,
) -> Wandering:
    """How a reference errs: likeliest beside a robot whose calibration is free.

    So a wrong base or radius does not pass for a walk of the reference.
    """
    laid = together([cut_finely(record, robot, leg) for record in records])
    point = start_point(laid, robot, sigma_xy, sigma_yaw)
    if laid.data < NOISE_NUMBERS:
        return Wandering(point.variances, False)
    point, knobs = with_own_values(laid, point, "local_map")
    knobs = (*CALIBRATION, *knobs, *point.model.nuisance_knobs)
    fit = fit_model(laid, point, "local_map", knobs, sigma_xy=sigma_xy, sigma_yaw=sigma_yaw)
    return Wandering(fit.point.variances, True)


def errors_on_map(
    model: Model,
    runs: Together,
    prediction: Prediction,
    variances: Variances,
    jumped: NDArray[np.bool_],
) -> tuple[Floats, Floats]:
    """Errors of legs, (m, 3), NaN where not measured, and their covariances, (m, 3, 3).

    Legs on which the reference jumped have what they have by their two poses.
    """
    robot = model.robot
    wheels = np.square([robot.left_wheel_noise, robot.right_wheel_noise])
    found = innovations(
        robot,
        runs,
        prediction,
        replace(variances, left=wheels[:1], right=wheels[1:]),
        "local_map",
        excluded=jumped,
        start_yaws=model.start_yaws,
        heading=UNKNOWN_HEADING,
    )
    view = view_of(robot.effects)
    start, finish = right_handed(runs.start, view), right_handed(runs.finish, view)
    plain = errors_between(start, finish, prediction)
    error = np.where(found.known, found.value[0], np.where(jumped[:, None], plain, np.nan))
    return error, found.covariance[0]
