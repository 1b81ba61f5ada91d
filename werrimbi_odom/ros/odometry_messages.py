# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Estimates as nav_msgs/Odometry, and poses from geometry_msgs.

docs/node.md explains each entry of the covariances.
"""

from __future__ import annotations

import math

from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import PoseWithCovarianceStamped, TransformStamped
from nav_msgs.msg import Odometry

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.odometer import Estimate
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.slip import NOTHING, Missed
from werrimbi_odom.ros import planar

PLANAR_VARIANCE = 1e-6
"""Variance of z, roll and pitch and of their rates, zero on a flat floor: (1 mm)², (1 mrad)², per
second."""

_OFF_UNIT = 1e-3  # tolerance of a quaternion's norm

# Indices in a 6 x 6 matrix, row by row, over (x, y, z, roll, pitch, yaw).
_XX, _XY, _XYAW = 0, 1, 5
_YX, _YY, _YYAW = 6, 7, 11
_YAWX, _YAWY, _YAWYAW = 30, 31, 35
_OUT_OF_PLANE = (14, 21, 28)


class OdometryMessage:
    """A message that is filled again for each estimate; publishing copies it.

    Pose and twist have the frames `odom_frame` and `base_frame` (REP-105).
    """

    def __init__(self, odom_frame: str, base_frame: str) -> None:
        self._message = Odometry()
        self._message.header.frame_id = odom_frame
        self._message.child_frame_id = base_frame
        # Cached, because every access to a field of a message is a call.
        self._header = self._message.header
        self._position = self._message.pose.pose.position
        self._orientation = self._message.pose.pose.orientation
        self._linear = self._message.twist.twist.linear
        self._angular = self._message.twist.twist.angular
        self._pose = self._message.pose.covariance
        self._twist = self._message.twist.covariance
        for place in _OUT_OF_PLANE:
            self._pose[place] = self._twist[place] = PLANAR_VARIANCE
        self._transform = TransformStamped(header=self._header, child_frame_id=base_frame)
        self._transform.transform.rotation = self._orientation
        self._translation = self._transform.transform.translation

    def filled(self, stamp: Stamp, estimate: Estimate, missed: Missed = NOTHING) -> Odometry:
        """Fill the message with an estimate; it is valid until the next call.

        Detected wheel slip also increases the covariance of the twist, for filters that fuse it.
        Integrated over the interval, the increase is the variance that the pose gains.
        """
        self._header.stamp = stamp
        self._position.x, self._position.y, yaw = estimate.pose
        self._orientation.z, self._orientation.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)
        self._linear.x, self._linear.y, self._angular.z = estimate.twist
        self._fill_covariances(estimate)
        if missed.heading:
            per_second = 1.0 / estimate.late.duration**2
            self._twist[_XX] += missed.along * per_second
            self._twist[_YAWYAW] += missed.heading * per_second
        return self._message

    def transform(self) -> TransformStamped:
        """The pose that was filled in last, as a transform for /tf."""
        self._translation.x, self._translation.y = self._position.x, self._position.y
        return self._transform

    def _fill_covariances(self, estimate: Estimate) -> None:
        xx, xy, xyaw, yy, yyaw, yawyaw = planar.rounded_up(estimate.covariance)
        pose, twist = self._pose, self._twist
        pose[_XX] = xx
        pose[_YY] = yy
        pose[_YAWYAW] = yawyaw
        pose[_XY] = pose[_YX] = xy
        pose[_XYAW] = pose[_YAWX] = xyaw
        pose[_YYAW] = pose[_YAWY] = yyaw
        speed, cross, yaw_rate = estimate.twist_covariance
        speed, yaw_rate = speed * planar.UP, yaw_rate * planar.UP
        twist[_XX] = speed
        # Lateral and longitudinal slip are equally unlikely: the same contact patch resists both.
        twist[_YY] = speed
        twist[_YAWYAW] = yaw_rate
        twist[_XYAW] = twist[_YAWX] = cross


def pose_from(
    message: PoseWithCovarianceStamped, odom_frame: str
) -> tuple[Pose, PoseCovariance[float]]:
    """Planar pose of a message.

    InputError if the frame is not the odometry frame, a number is not finite, the orientation is
    not a rotation about the vertical, or the covariance is invalid. The first argument is the
    cause, the second the detail.
    """
    frame = message.header.frame_id
    if frame != odom_frame:
        raise InputError("wrong frame", f"frame_id is {frame!r}, not {odom_frame!r}")
    x, y = planar.place_of(message.pose.pose.position)
    turn = message.pose.pose.orientation
    yaw = planar.yaw_of(turn, slack=_OFF_UNIT)
    if turn.x * turn.x + turn.y * turn.y > 1e-3:
        raise InputError("orientation not planar", "it rolls or pitches")
    return Pose(x, y, yaw), planar.covariance_of(message.pose.covariance)
