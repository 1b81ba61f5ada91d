# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Planar readings out of what publishes poses: of odometry, and of a reference of four types."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.ros.compare_track import Reading

REFERENCE_TYPES: dict[str, type] = {
    "pose_stamped": PoseStamped,
    "pose_with_covariance_stamped": PoseWithCovarianceStamped,
    "odometry": Odometry,
    "transform_stamped": TransformStamped,
}

_PLANE = (0, 1, 5)  # x, y and yaw among x, y, z, roll, pitch, yaw


class Clockwork:
    """Stamps as seconds since the first one: of those since 1970 a float resolves but 0.2 µs."""

    def __init__(self) -> None:
        self._origin: int | None = None

    def seconds(self, stamp: Any) -> float:
        """A stamp in seconds since the first that was seen."""
        if self._origin is None:
            self._origin = stamp.sec
        return float(stamp.sec - self._origin) + 1e-9 * float(stamp.nanosec)

    def stamp(self, seconds: float) -> Stamp:
        """The stamp of such a time."""
        whole, part = divmod(round(1e9 * seconds), 10**9)
        return Stamp(sec=whole + (self._origin or 0), nanosec=part)


def odometry_of(message: Any, clockwork: Clockwork) -> tuple[Reading, BodyMotion[float]]:
    """Pose and twist in a nav_msgs/Odometry.

    Raises
    ------
    InputError
        When a number cannot be used; arguments are the cause and the detail.
    """
    covariance = _covariance(message.pose.covariance)
    if covariance is None:
        raise InputError("no covariance", "that of the odometry's pose is empty or not finite")
    pose = _pose(message.pose.pose.position, message.pose.pose.orientation)
    linear, angular = message.twist.twist.linear, message.twist.twist.angular
    time = clockwork.seconds(message.header.stamp)
    return Reading(time, pose, covariance), BodyMotion(linear.x, linear.y, angular.z)


def reference_reader(
    kind: str, usual: PoseCovariance[float]
) -> Callable[[Any, Clockwork], Reading]:
    """What makes a reading of a message of one of `REFERENCE_TYPES`.

    Parameters
    ----------
    kind : str
    usual : PoseCovariance
        Taken where a message states no covariance of its own, or one that is zero.

    Returns
    -------
    callable
        It raises an InputError when a number cannot be used.
    """

    def read(message: Any, clockwork: Clockwork) -> Reading:
        stated = None
        if kind == "pose_stamped":
            place, turn = message.pose.position, message.pose.orientation
        elif kind == "transform_stamped":
            place, turn = message.transform.translation, message.transform.rotation
        else:
            place, turn = message.pose.pose.position, message.pose.pose.orientation
            stated = _covariance(message.pose.covariance)
        if stated is None or not min(stated.xx, stated.yy, stated.yawyaw) > 0.0:
            stated = usual
        return Reading(clockwork.seconds(message.header.stamp), _pose(place, turn), stated)

    return read


def _pose(place: Any, turn: Any) -> Pose:
    x, y, z, w = turn.x, turn.y, turn.z, turn.w
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not (math.isfinite(place.x) and math.isfinite(place.y) and math.isfinite(norm)):
        raise InputError("pose not finite", "NaN or infinite")
    if not 0.5 < norm < 2.0:
        raise InputError("no orientation", f"the quaternion's norm is {norm:g}, not 1")
    return Pose(place.x, place.y, math.atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z))


def _covariance(entries: Any) -> PoseCovariance[float] | None:
    """The planar part; None where it is none: negative or not finite."""
    block = np.asarray(entries, dtype=np.float64).reshape(6, 6)[np.ix_(_PLANE, _PLANE)]
    if not np.isfinite(block).all() or (block.diagonal() < 0.0).any():
        return None
    symmetric = (0.5 * (block + block.T))[np.triu_indices(3)]
    return PoseCovariance(*symmetric.tolist())
