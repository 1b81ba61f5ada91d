# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a reference measures of a robot on a path, and the inverse.

A reference observes the robot through a `View`: it measures a point off the axle, along an axis of
its own, late, or in a left-handed frame. Frames: `robot` is the right-handed frame in which the
robot drives; `shown` is the reference's own, which is the same unless it is mirrored.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.covariance import PoseCovariance, carried
from werrimbi_odom.model.motion import sinc
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.reference_view import View
from werrimbi_odom.model.trajectory import Trajectory


class Path(NamedTuple):
    """Poses by time; arrays of shape (n,)."""

    time: Floats
    """[s]"""
    x: Floats
    y: Floats
    yaw: Floats
    """Unwrapped [rad]."""
    covariance: PoseCovariance[Floats]


def shown(driven: Trajectory, view: View) -> Path:
    """Poses that the reference measures at the times of a path, in its own frame.

    Before the first row and after the last the robot is assumed to stand still. The covariance is
    that of the odometry at the measured point; it does not include the reference's noise.
    """
    axle = Path(driven.time, driven.x, driven.y, driven.yaw, driven.covariance)
    if view == View():
        return axle
    since = axle.time - axle.time[:1]
    seen = delayed(axle, view.late(since))
    yaw = delayed(axle, view.late(since) + view.heading_delay).yaw + view.yaw
    yaw = yaw + view.drifted(since)
    dx, dy = _turned(view.ahead, view.left, seen.yaw)
    point = Path(driven.time, seen.x + dx, seen.y + dy, yaw, carried(seen.covariance, dx, dy))
    point = _scaled(point, view.scale)
    return mirrored(point) if view.mirrored else point


def axle_of(measured: Pose, view: View) -> Pose:
    """Pose of the axle's midpoint in the robot's frame, given a pose measured by the reference.

    Delays are ignored, since earlier poses are unknown. So is a drifting bias, since the drive
    begins here.
    """
    x, y, yaw = measured
    if view.mirrored:
        y, yaw = -y, -yaw
    yaw -= view.yaw
    x, y = x / view.scale, y / view.scale
    cos, sin = math.cos(yaw), math.sin(yaw)
    return Pose(
        x - (cos * view.ahead - sin * view.left), y - (sin * view.ahead + cos * view.left), yaw
    )


def _scaled(path: Path, scale: float) -> Path:
    """Lengths as measured by a reference with a scale error."""
    p, squared = path.covariance, scale * scale
    larger = PoseCovariance(
        squared * p.xx, squared * p.xy, scale * p.xyaw, squared * p.yy, scale * p.yyaw, p.yawyaw
    )
    return Path(path.time, scale * path.x, scale * path.y, path.yaw, larger)


def mirrored(path: Path) -> Path:
    """Mirror a path: y and yaw change sign."""
    p = path.covariance
    flipped = PoseCovariance(p.xx, -p.xy, -p.xyaw, p.yy, p.yyaw, p.yawyaw)
    return Path(path.time, path.x, -path.y, -path.yaw, flipped)


def delayed(path: Path, delay: float | Floats) -> Path:
    """Pose of the robot `delay` [s] earlier, at every time; one for all, or of shape (n,).

    Between two rows the robot moves along the arc of a constant twist. The covariance is that of
    the previous row.
    """
    if not np.any(delay) or path.time.size < 2:
        return path
    time = np.maximum.accumulate(path.time)
    at = np.clip(path.time - delay, time[0], time[-1])
    begin = np.clip(np.searchsorted(time, at, side="right") - 1, 0, time.size - 2)
    step = time[begin + 1] - time[begin]
    share = np.divide(at - time[begin], step, out=np.ones_like(at), where=step > 0.0)
    turn = path.yaw[begin + 1] - path.yaw[begin]
    chord = (path.x[begin + 1] - path.x[begin]) + 1j * (path.y[begin + 1] - path.y[begin])
    shrunk = sinc(0.5 * turn)
    whole = np.where(np.abs(shrunk) > 1e-3, shrunk, 1.0)  # a full turn in one step has no chord
    part = share * np.exp(0.5j * (share - 1.0) * turn) * sinc(0.5 * share * turn) / whole
    there = path.x[begin] + 1j * path.y[begin] + chord * part
    at_end = share >= 1.0
    before = begin + at_end
    return Path(
        path.time,
        np.where(at_end, path.x[begin + 1], there.real),
        np.where(at_end, path.y[begin + 1], there.imag),
        path.yaw[begin] + share * turn,
        PoseCovariance(*(entry[before] for entry in path.covariance)),
    )


def _turned(ahead: float, left: float, yaw: Floats) -> tuple[Floats, Floats]:
    cos, sin = np.cos(yaw), np.sin(yaw)
    return cos * ahead - sin * left, sin * ahead + cos * left
