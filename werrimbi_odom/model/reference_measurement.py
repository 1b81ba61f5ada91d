# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a reference shows of a robot that drives along a path, and the other way round.

A reference looks at the robot in its own way (`View`): it measures a point off the axle, along an
axis of its own, late, or in a left-handed frame. Frames: `robot` is the right-handed frame in which
the robot drives; `shown` is the reference's own, which is the same unless it is mirrored.
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
    """Goes on counting past a whole turn [rad]."""
    covariance: PoseCovariance[Floats]


def shown(driven: Trajectory, view: View) -> Path:
    """What the reference shows at the times of a driven path, in its own frame.

    Before the first row and after the last the robot is taken to stand. The covariance is the
    odometry's own, of the point that is shown; the reference's noise is no part of it.
    """
    axle = Path(driven.time, driven.x, driven.y, driven.yaw, driven.covariance)
    if view == View():
        return axle
    seen = delayed(axle, view.delay)
    yaw = delayed(axle, view.delay + view.heading_delay).yaw + view.yaw
    yaw = yaw + view.drifted(axle.time - axle.time[:1])
    dx, dy = _turned(view.ahead, view.left, seen.yaw)
    point = Path(driven.time, seen.x + dx, seen.y + dy, yaw, carried(seen.covariance, dx, dy))
    point = _scaled(point, view.scale)
    return mirrored(point) if view.mirrored else point


def axle_of(measured: Pose, view: View) -> Pose:
    """Where the axle's midpoint is, in the robot's frame, when the reference shows a pose.

    Delays are left out: nothing is known of what was before. So is a bias that wanders, for the
    drive begins here.
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
    """Lengths as a reference shows them whose own metre is off."""
    p, squared = path.covariance, scale * scale
    larger = PoseCovariance(
        squared * p.xx, squared * p.xy, scale * p.xyaw, squared * p.yy, scale * p.yyaw, p.yawyaw
    )
    return Path(path.time, scale * path.x, scale * path.y, path.yaw, larger)


def mirrored(path: Path) -> Path:
    """The same in a frame of the other hand: y and yaw change sign."""
    p = path.covariance
    flipped = PoseCovariance(p.xx, -p.xy, -p.xyaw, p.yy, p.yyaw, p.yawyaw)
    return Path(path.time, path.x, -path.y, -path.yaw, flipped)


def delayed(path: Path, delay: float) -> Path:
    """At every time, where the robot was by `delay` [s] earlier.

    Between two rows it goes along the arc of one constant twist. The covariance is that of the row
    before.
    """
    if delay == 0.0 or path.time.size < 2:
        return path
    time = np.maximum.accumulate(path.time)
    at = np.clip(path.time - delay, time[0], time[-1])
    begin = np.clip(np.searchsorted(time, at, side="right") - 1, 0, time.size - 2)
    step = time[begin + 1] - time[begin]
    share = np.divide(at - time[begin], step, out=np.ones_like(at), where=step > 0.0)
    turn = path.yaw[begin + 1] - path.yaw[begin]
    chord = (path.x[begin + 1] - path.x[begin]) + 1j * (path.y[begin + 1] - path.y[begin])
    shrunk = sinc(0.5 * turn)
    whole = np.where(np.abs(shrunk) > 1e-3, shrunk, 1.0)  # a whole turn in one step has no chord
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
