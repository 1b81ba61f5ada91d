# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the model predicts for every leg: relative pose, its noise, and its derivatives."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.model.covariance import (
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    piece_covariance,
)
from werrimbi_odom.model.motion import (
    BodyMotion,
    WheelTravel,
    displacement,
    sinc,
    wheels_to_body,
)
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Prediction:
    """Legs as the model sees them; each in the frame of the robot at its own start.

    Arrays have shape (m, 3) for (x, y, yaw) [m, m, rad] or (m, 3, 3).
    """

    relative: Floats
    """Relative pose of each leg's end."""
    per_left: Floats
    """Covariance of the relative pose for a left wheel noise k_L² of 1 m."""
    per_right: Floats
    """The same for k_R²."""
    length: Floats
    """Path driven in each leg, shape (m,), [m]."""
    along: Floats
    """Signed travel in each leg, shape (m,), [m]."""
    turn: Floats
    """Change of heading in each leg, shape (m,), [rad]."""


@dataclass(frozen=True, slots=True)
class _Path:
    """Poses of the nodes, heading zero at the first."""

    motion: BodyMotion[Floats]
    travel: WheelTravel[Floats]
    x: Floats
    y: Floats
    yaw: Floats


def _drive(robot: Robot, run: MatchedRun) -> _Path:
    travel = WheelTravel(run.left * robot.left_tick, run.right * robot.right_tick)
    motion = wheels_to_body(travel, robot.track)
    yaw = np.concatenate([[0.0], np.cumsum(motion.turn)])
    dx, dy = displacement(motion, yaw[:-1])
    x, y = np.concatenate([[0.0], np.cumsum(dx)]), np.concatenate([[0.0], np.cumsum(dy)])
    return _Path(motion, travel, x, y, yaw)


def predict(robot: Robot, run: MatchedRun) -> Prediction:
    """Relative pose of every leg and the noise that it has for unit noise of each wheel."""
    path = _drive(robot, run)
    begin, end = run.ends[:-1], run.ends[1:]
    cos, sin = np.cos(path.yaw[begin]), np.sin(path.yaw[begin])
    dx, dy = path.x[end] - path.x[begin], path.y[end] - path.y[begin]
    turn = path.yaw[end] - path.yaw[begin]
    relative = np.stack([cos * dx + sin * dy, cos * dy - sin * dx, turn], axis=-1)
    first, last = run.ends[0], run.ends[-1]
    starts = run.ends[:-1] - first
    along = path.motion.along[first:last]
    return Prediction(
        relative,
        _noise_of_legs(path, run, robot.track, left=1.0, right=0.0),
        _noise_of_legs(path, run, robot.track, left=0.0, right=1.0),
        np.add.reduceat(np.abs(along), starts),
        np.add.reduceat(along, starts),
        turn,
    )


def _noise_of_legs(
    path: _Path, run: MatchedRun, track: float, *, left: float, right: float
) -> Floats:
    """Sum of the steps' closed forms, each carried to its leg's end, in its leg's own frame."""
    first, last = int(run.ends[0]), int(run.ends[-1])
    leg = np.repeat(np.arange(run.legs), np.diff(run.ends))
    begin, end = run.ends[leg], run.ends[leg + 1]
    steps = slice(first, last)
    motion = BodyMotion(*(part[steps] for part in path.motion))
    noise = noise_of_wheel_variances(
        left * np.abs(path.travel.left[steps]), right * np.abs(path.travel.right[steps]), track
    )
    facing = path.yaw[begin]
    own = piece_covariance(motion, noise, path.yaw[steps] - facing)
    after = slice(first + 1, last + 1)
    dx, dy = path.x[end] - path.x[after], path.y[end] - path.y[after]
    cos, sin = np.cos(facing), np.sin(facing)
    moved = carried(own, cos * dx + sin * dy, cos * dy - sin * dx)
    starts = run.ends[:-1] - first
    return PoseCovariance(*(np.add.reduceat(entry, starts) for entry in moved)).matrix()


def sensitivity(robot: Robot, run: MatchedRun, changes: list[BodyMotion[Floats]]) -> Floats:
    """Derivative of every leg's relative pose, when the steps' motion has given derivatives.

    Parameters
    ----------
    changes : list of BodyMotion
        For each of p parameters, the derivative of every step's along, sideways [m] and turn
        [rad]; arrays of shape (n,).

    Returns
    -------
    ndarray, shape (m, 3, p)
    """
    path = _drive(robot, run)
    begin, end = run.ends[:-1], run.ends[1:]
    half = 0.5 * path.motion.turn
    facing = np.exp(1j * (path.yaw[:-1] + half))
    chord = path.motion.along + 1j * path.motion.sideways
    shrink = sinc(half)
    position = path.x + 1j * path.y
    move = np.diff(position)
    back = np.exp(-1j * path.yaw[begin])
    result = np.empty((run.legs, 3, len(changes)))
    for column, change in enumerate(changes):
        swung = np.concatenate([[0.0], np.cumsum(change.turn)])
        turned = 0.5 * change.turn
        # d(sinc h) = -h V dh, with h V = (sinc h - cos h) / h.
        own = facing * (
            shrink * (change.along + 1j * change.sideways)
            + chord * turned * (1j * shrink - _bend(half))
        )
        shifted = np.concatenate([[0.0], np.cumsum(own + 1j * swung[:-1] * move)])
        relative = back * (
            shifted[end] - shifted[begin] - 1j * swung[begin] * (position[end] - position[begin])
        )
        result[:, 0, column], result[:, 1, column] = relative.real, relative.imag
        result[:, 2, column] = swung[end] - swung[begin]
    return result


def _bend(h: Floats) -> Floats:
    """(sinc h - cos h) / h: minus the derivative of sinc."""
    small = np.abs(h) < 1e-2
    safe = np.where(small, 1.0, h)
    t = h * h
    near = h * (1.0 / 3.0 - t * (1.0 / 30.0 - t / 840.0))
    return np.where(small, near, (np.sin(safe) / safe - np.cos(safe)) / safe)


def calibration_changes(robot: Robot, run: MatchedRun) -> dict[str, BodyMotion[Floats]]:
    """Derivatives of every step's motion in the three multipliers that calibration may change."""
    path = _drive(robot, run)
    none = np.zeros_like(path.travel.left)
    left = path.travel.left / robot.left_wheel_radius_multiplier
    right = path.travel.right / robot.right_wheel_radius_multiplier
    return {
        "wheel_separation_multiplier": BodyMotion(
            none, none, -path.motion.turn / robot.wheel_separation_multiplier
        ),
        "left_wheel_radius_multiplier": BodyMotion(0.5 * left, none, -left / robot.track),
        "right_wheel_radius_multiplier": BodyMotion(0.5 * right, none, right / robot.track),
    }
