# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of poses and legs from the whole counts that encoders give."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference.fitting.leg_loop import lever_of
from werrimbi_odom.model.effect import view_of, wiring_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def quantisation_variance(robot: Robot) -> Floats:
    """Diagonal of `quantisation`, in the axes of a reference in which the robot heads anywhere."""
    return np.asarray(np.diagonal(quantisation(robot, np.array([np.nan]))[0]))


def quantisation(robot: Robot, heading: Floats, unseen: Floats | None = None) -> Floats:
    """Quantisation covariance of a pose from one reading of both counters (uniform), (m, 3, 3).

    Counts err along the path and in heading, never sideways. So they do at a message. Between two
    they err less (`Counters.rounding_at`), which fits leave out: how much depends on the speed, and
    a delay for which it seems to be least would be preferred. `heading` (m,): of the robot, in the
    axes of the covariance [rad]; where it is NaN, the mean over all headings. `unseen` (m, 2): what
    the counters did between messages (`Counters.unseen_at`) [counts].
    """
    between = np.zeros((heading.size, 2)) if unseen is None else unseen
    left, right = wiring_of(robot.effects).wheels(*between.T)
    left = robot.left_tick**2 / 12.0 + np.square(robot.left_tick * left)
    right = robot.right_tick**2 / 12.0 + np.square(robot.right_tick * right)
    along, yaw = 0.25 * (left + right), (left + right) / robot.track**2
    both = 0.5 * (right - left) / robot.track
    cos, sin = np.nan_to_num(np.cos(heading)), np.nan_to_num(np.sin(heading))
    twice = np.nan_to_num(np.exp(2j * heading))
    found = np.empty((heading.size, 3, 3))
    found[:, 0, 0] = 0.5 * along * (1.0 + twice.real)
    found[:, 1, 1] = 0.5 * along * (1.0 - twice.real)
    found[:, 0, 1] = found[:, 1, 0] = 0.5 * along * twice.imag
    found[:, 0, 2] = found[:, 2, 0] = both * cos
    found[:, 1, 2] = found[:, 2, 1] = both * sin
    found[:, 2, 2] = yaw
    return found


def quantisation_of_legs(
    robot: Robot,
    relative: Floats,
    unseen: Floats,
    rounding: Sequence[float] | Floats = (1.0, 1.0),
) -> Floats:
    """Quantisation covariance of the legs' errors, from the readings at both ends, (m, 3, 3).

    `relative` (m, 3): predicted, in the frame of the reference at each leg's start. `unseen`,
    `rounding`: `Concatenated.unseen`, and shares of all at the starts and ends
    (`Concatenated.rounding`).
    """
    axis = view_of(robot.effects).yaw
    lever = lever_of(relative)
    begun = quantisation(robot, np.full(relative.shape[0], -axis), unseen[0])
    ended = quantisation(robot, relative[:, 2] - axis, unseen[1])
    first, last = (np.reshape(share, (-1, 1, 1)) for share in rounding)
    return np.asarray(last * ended + first * (lever @ begun @ lever.swapaxes(-1, -2)))
