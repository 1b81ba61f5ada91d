# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Planar readings from messages: of odometry, and of a reference of four types."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.ros.compare_track import TimedPose
from werrimbi_odom.ros.planar import covariance_of, place_of, yaw_of

REFERENCE_TYPES: dict[str, type] = {
    "pose_stamped": PoseStamped,
    "pose_with_covariance_stamped": PoseWithCovarianceStamped,
    "odometry": Odometry,
    "transform_stamped": TransformStamped,
}

_VARIANCES = (0, 7, 35)  # of x, y and yaw among the 36 entries


class Clockwork:
    """Stamps as seconds since the first: since 1970, a float resolves only 0.2 µs."""

    def __init__(self) -> None:
        self._origin: int | None = None

    def seconds(self, stamp: Any) -> float:
        """Convert a stamp to seconds since the first one.

        InputError if the stamp is invalid; arguments are the cause and the detail.
        """
        if self._origin is None:
            self._origin = stamp.sec
        if stamp.nanosec >= 10**9:
            raise InputError("stamp not valid", f"{stamp.nanosec} nanoseconds past a second")
        return float(stamp.sec - self._origin) + 1e-9 * float(stamp.nanosec)

    def stamp(self, seconds: float) -> Stamp:
        """Convert such a time to a stamp."""
        whole, part = divmod(round(1e9 * seconds), 10**9)
        second = min(whole + (self._origin or 0), 2**31 - 1)  # rounding may exceed the range
        return Stamp(sec=second, nanosec=part)


def odometry_of(message: Any, clockwork: Clockwork) -> tuple[TimedPose, BodyMotion[float]]:
    """Pose and twist of a nav_msgs/Odometry.

    InputError if a number is invalid; arguments are the cause and the detail.
    """
    covariance = covariance_of(message.pose.covariance)
    pose = _pose(message.pose.pose.position, message.pose.pose.orientation)
    linear, angular = message.twist.twist.linear, message.twist.twist.angular
    time = clockwork.seconds(message.header.stamp)
    return TimedPose(time, pose, covariance), BodyMotion(linear.x, linear.y, angular.z)


def reference_reader(
    kind: str, usual: PoseCovariance[float]
) -> Callable[[Any, Clockwork], TimedPose]:
    """Create a function that reads one of `REFERENCE_TYPES`.

    It raises InputError if a number is invalid. `usual` is the covariance for messages without one
    of their own (a variance is not positive).
    """

    def read(message: Any, clockwork: Clockwork) -> TimedPose:
        stated = usual
        if kind == "pose_stamped":
            place, turn = message.pose.position, message.pose.orientation
        elif kind == "transform_stamped":
            place, turn = message.transform.translation, message.transform.rotation
        else:
            place, turn = message.pose.pose.position, message.pose.pose.orientation
            entries = message.pose.covariance
            if all(entries[place] > 0.0 for place in _VARIANCES):  # zero, -1 or NaN state none
                stated = covariance_of(entries)
        return TimedPose(clockwork.seconds(message.header.stamp), _pose(place, turn), stated)

    return read


def _pose(place: Any, turn: Any) -> Pose:
    return Pose(*place_of(place), yaw_of(turn, slack=1.0))
