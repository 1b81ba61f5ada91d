# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning of arrays."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from werrimbi_odom.model.pose import Floats, Pose

if TYPE_CHECKING:
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.model.robot import Robot


class Odometry(NamedTuple):
    """A pose and its covariance for each row of ticks, in the frame of the start."""

    x: Floats
    """[m], shape (n,)"""
    y: Floats
    """[m], shape (n,)"""
    yaw: Floats
    """Not wrapped [rad], shape (n,)."""
    covariance: Floats
    """Of (x, y, yaw) [m², m·rad, rad²], shape (n, 3, 3)."""


def odometry(
    robot: RobotFile | Robot,
    t: ArrayLike,
    left: ArrayLike,
    right: ArrayLike,
    *,
    start: tuple[float, float, float] = (0.0, 0.0, 0.0),
    channels: Mapping[str, ArrayLike] | None = None,
) -> Odometry:
    """Wheel odometry of recorded ticks, with the closed-form covariance of Chong and Kleeman.

    Parameters
    ----------
    robot
        From `read_robot`, or a `werrimbi_odom.model.robot.Robot`.
    t
        Stamps [s], shape (n,).
    left, right
        Cumulative signed counts of the encoders, shape (n,).
    start
        Pose at the first row: x [m], y [m], yaw [rad].
    channels
        Further measured columns that an effect looks at, by name, shape (n,) each.

    Returns
    -------
    Odometry
        A row for each row of ticks; one that could not be used repeats the latest estimate.

    Raises
    ------
    ValueError
        When the arrays differ in length, or no row can be used.
    """
    from werrimbi_odom.files.robot_file import RobotFile
    from werrimbi_odom.model.encoder import EncoderLimits
    from werrimbi_odom.model.pieces_online import PieceTolerance
    from werrimbi_odom.model.trajectory import trajectory

    time, of_left, of_right = (np.atleast_1d(np.asarray(part)) for part in (t, left, right))
    if not time.shape == of_left.shape == of_right.shape or time.ndim != 1:
        raise ValueError(
            f"t, left and right must be as long as each other, and are {time.shape}, "
            f"{of_left.shape} and {of_right.shape}"
        )
    if isinstance(robot, RobotFile):
        plain, tolerance, limits = robot.robot, robot.tolerance, robot.limits
    else:
        plain, tolerance, limits = robot, PieceTolerance(), EncoderLimits()
    driven = trajectory(
        plain,
        time.astype(np.float64),
        of_left,
        of_right,
        start=Pose(*start),
        tolerance=tolerance,
        limits=limits,
        channels={name: np.asarray(values) for name, values in (channels or {}).items()},
    )
    rows = driven.expanded(time.size)
    covariance = driven.covariance.matrix()[rows]
    return Odometry(driven.x[rows], driven.y[rows], driven.yaw[rows], covariance)
