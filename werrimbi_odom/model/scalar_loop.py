# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run, step by step in single numbers: the lines that `compiled` makes machine code of.

It is what `Odometer` does at each message, by the same functions and so to the last bit. In plain
Python it would take as long as the odometer; for that case `pieces_recorded` and `trajectory` have
arrays.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.covariance import (
    PoseCovariance,
    after_stretch,
    path_noise_of,
)
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pieces_online import NOTHING, PieceRule, PieceSums, extended
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import WheelNoise


class Marching(NamedTuple):
    """Where the robot is, and the open piece."""

    pose: Pose
    covariance: PoseCovariance[float]
    """Of the pose."""
    start: Pose
    """Of the piece."""
    covariance_start: PoseCovariance[float]
    """Of the pose there."""
    earlier: float
    """Travel u of the pieces before [m]."""
    stretch: PieceSums


def march(
    rule: PieceRule,
    wheels: WheelNoise,
    at: Marching,
    steps: Floats,
    poses: Floats,
    covariances: Floats,
    starts: NDArray[np.intp],
    sums: Floats,
    pieces: int,
    done: int,
) -> tuple[Marching, int]:
    """Go on from `at` over some steps; a piece ends where it must.

    Parameters
    ----------
    steps : ndarray, shape (5, n)
        Travel of the wheels, and motion along, sideways and in turn.
    poses, covariances : ndarray, shape (3, n) and (6, n)
        Written: x, y, yaw and the covariance after each step.
    starts, sums : ndarray, shape (m,) and (5, m)
        Written from `pieces` on: the first step of each piece that these steps begin, counted from
        the run's beginning; and the sums of `steps` over each piece that they end.
    pieces, done : int
        How many pieces have been begun, and how many steps gone.

    Returns
    -------
    Marching, int
        Where that leads, and how many pieces have been begun then.
    """
    pose, covariance, start, covariance_start, earlier, stretch = at
    for step in range(steps.shape[1]):
        travel = WheelTravel(steps[0, step], steps[1, step])
        motion = BodyMotion(steps[2, step], steps[3, step], steps[4, step])
        dx, dy = displacement(motion, pose.yaw)
        after = Pose(pose.x + dx, pose.y + dy, pose.yaw + motion.turn)
        goes_on, longer = extended(rule, start, earlier, stretch, travel, motion, after)
        begins = stretch.empty or not goes_on
        if not goes_on:
            last = pieces - 1
            whole = sums_of(stretch)
            sums[0, last], sums[1, last], sums[2, last], sums[3, last], sums[4, last] = whole
            start, covariance_start = pose, covariance
            earlier += abs(stretch.left) + abs(stretch.right)
            longer = extended(rule, start, earlier, NOTHING, travel, motion, after)[1]
        if begins:
            starts[pieces] = done + step
            pieces += 1
        stretch, pose = longer, after
        noise = path_noise_of(wheels, stretch.left, stretch.right)
        dx, dy = pose.x - start.x, pose.y - start.y
        covariance = after_stretch(covariance_start, stretch.motion, noise, stretch.chord, dx, dy)
        poses[0, step], poses[1, step], poses[2, step] = pose
        xx, xy, xyaw, yy, yyaw, yawyaw = covariance
        covariances[0, step], covariances[1, step], covariances[2, step] = xx, xy, xyaw
        covariances[3, step], covariances[4, step], covariances[5, step] = yy, yyaw, yawyaw
    return Marching(pose, covariance, start, covariance_start, earlier, stretch), pieces


def follow(motion: BodyMotion[Floats], position: Floats, yaw: Floats) -> None:
    """Follow the steps of a run; `course.followed` has what is taken and filled.

    Parameters
    ----------
    position : ndarray, shape (n + 1, 2)
        The first row is given; the others are filled, as those of `yaw`, shape (n + 1,).
    """
    along, sideways, turn = motion
    for step in range(turn.size):
        moved = BodyMotion(along[step], sideways[step], turn[step])
        dx, dy = displacement(moved, yaw[step])
        position[step + 1, 0] = position[step, 0] + dx
        position[step + 1, 1] = position[step, 1] + dy
        yaw[step + 1] = yaw[step] + turn[step]


March = Callable[..., tuple[Marching, int]]
"""`march`, or machine code of it."""


def sums_of(stretch: PieceSums) -> tuple[float, float, float, float, float]:
    """What a piece has come to: travel of the wheels, and motion along, sideways and in turn."""
    along, sideways, turn = stretch.motion
    return stretch.left, stretch.right, along, sideways, turn
