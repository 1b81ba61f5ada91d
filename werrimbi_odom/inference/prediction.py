# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the model predicts for every leg: the relative pose that the reference shows, its noise."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference.matching import MatchedRun, delayed
from werrimbi_odom.model.covariance import (
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    piece_covariance,
)
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.driving import acts, driven, features
from werrimbi_odom.model.effect import View, view_of, wiring_of
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Prediction:
    """Legs as the model sees them; each in the frame of the reference at its own start.

    Arrays have shape (m, 3) for (x, y, yaw) [m, m, rad] or (m, 3, 3).
    """

    relative: Floats
    """Relative pose of each leg's end, of the point and axis that the reference measures."""
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


def raw_drive(robot: Robot, run: MatchedRun) -> tuple[WheelTravel[Floats], Drive[Floats]]:
    """Travel of the wheels before any effect, and what effects may look at."""
    wheels = wiring_of(robot.effects).wheels
    left, right = wheels(run.left, run.right)
    first_counts = wheels(run.counters.first_left, run.counters.first_right)
    raw = WheelTravel(left * robot.left_tick, right * robot.right_tick)
    return raw, features(robot, np.diff(run.time), raw, first_counts, run.channels)


def _driven(robot: Robot, run: MatchedRun, first_heading: float) -> _Path:
    raw, drive = raw_drive(robot, run)
    travel, motion = driven(robot, raw, drive, 0.0)
    yaw = np.concatenate([[0.0], np.cumsum(motion.turn)])
    if acts(robot):
        # The heading at the first leg is known in the reference's frame; effects may look at it.
        travel, motion = driven(robot, raw, drive, first_heading - float(yaw[run.ends[0]]))
    dx, dy = displacement(motion, yaw[:-1])
    x, y = np.concatenate([[0.0], np.cumsum(dx)]), np.concatenate([[0.0], np.cumsum(dy)])
    return _Path(motion, travel, x, y, yaw)


def relative_poses(robot: Robot, run: MatchedRun, start_yaw: float | None = None) -> Floats:
    """Relative pose of every leg as the reference shows it, shape (m, 3) [m, m, rad].

    Parameters
    ----------
    start_yaw : float, optional
        Heading at the first reference pose where that was not measured [rad].
    """
    view = view_of(robot.effects)
    run = delayed(run, view.delay)
    return _shown(_driven(robot, run, _first_heading(run, view, start_yaw)), run, view)


def predict(robot: Robot, run: MatchedRun, start_yaw: float | None = None) -> Prediction:
    """Relative pose of every leg, and the noise that it has for unit noise of each wheel."""
    view = view_of(robot.effects)
    run = delayed(run, view.delay)
    path = _driven(robot, run, _first_heading(run, view, start_yaw))
    first, last = run.ends[0], run.ends[-1]
    along = path.motion.along[first:last]
    return Prediction(
        _shown(path, run, view),
        _noise_of_legs(path, run, robot.track, view, left=1.0, right=0.0),
        _noise_of_legs(path, run, robot.track, view, left=0.0, right=1.0),
        _per_leg(np.abs(along), run),
        _per_leg(along, run),
        np.diff(path.yaw[run.ends]),
    )


def seen(run: MatchedRun, view: View) -> MatchedRun:
    """The run with the reference's frame made right-handed."""
    if not view.mirrored:
        return run
    measured = run.measured
    return replace(run, measured=replace(measured, y=-measured.y, yaw=-measured.yaw))


def _first_heading(run: MatchedRun, view: View, start_yaw: float | None) -> float:
    """Heading of the robot at the first reference pose, in the reference's frame [rad]."""
    measured = seen(run, view).measured.yaw[0] if start_yaw is None else start_yaw
    return float(measured - view.yaw) if np.isfinite(measured) else 0.0


def _shown(path: _Path, run: MatchedRun, view: View) -> Floats:
    """The legs' relative poses, seen at the reference's point, axis and times."""
    begin, end = run.ends[:-1], run.ends[1:]
    position = path.x + 1j * path.y
    turn = path.yaw[end] - path.yaw[begin]
    moved = np.exp(-1j * path.yaw[begin]) * (position[end] - position[begin])
    point = complex(view.ahead, view.left)
    axis = np.full(run.ends.size, view.yaw)
    if view.heading_delay != 0.0:
        late = np.interp(run.time[run.ends] - view.heading_delay, run.time, path.yaw)
        axis = axis + late - path.yaw[run.ends]
    shown = np.exp(-1j * axis[:-1]) * (moved + (np.exp(1j * turn) - 1.0) * point)
    return np.stack([shown.real, shown.imag, turn + np.diff(axis)], axis=-1)


def _noise_of_legs(
    path: _Path, run: MatchedRun, track: float, view: View, *, left: float, right: float
) -> Floats:
    """Sum of the steps' closed forms, each carried to its leg's end, as the reference sees it."""
    first, last = int(run.ends[0]), int(run.ends[-1])
    leg = np.repeat(np.arange(run.legs), np.diff(run.ends))
    begin = run.ends[leg]
    steps = slice(first, last)
    motion = BodyMotion(*(part[steps] for part in path.motion))
    noise = noise_of_wheel_variances(
        left * np.abs(path.travel.left[steps]), right * np.abs(path.travel.right[steps]), track
    )
    facing = path.yaw[begin] + view.yaw
    own = piece_covariance(motion, noise, path.yaw[steps] - facing)
    point = complex(view.ahead, view.left) * np.exp(1j * path.yaw[run.ends[1:]])
    marker_x = path.x[run.ends[1:]] + point.real
    marker_y = path.y[run.ends[1:]] + point.imag
    after = slice(first + 1, last + 1)
    dx, dy = marker_x[leg] - path.x[after], marker_y[leg] - path.y[after]
    cos, sin = np.cos(facing), np.sin(facing)
    moved = carried(own, cos * dx + sin * dy, cos * dy - sin * dx)
    return PoseCovariance(*(_per_leg(entry, run) for entry in moved)).matrix()


def _per_leg(values: Floats, run: MatchedRun) -> Floats:
    """Sums over the steps of each leg, of values for the steps from the first leg to the last."""
    sums = np.concatenate([[0.0], np.cumsum(values)])
    return np.diff(sums[run.ends - run.ends[0]])
