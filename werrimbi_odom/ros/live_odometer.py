# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The model's odometer with ROS stamps, and with parameters that may change at run time.

`rehearse` tests parameter values on an imaginary drive, before real counters are used.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from builtin_interfaces.msg import Time as Stamp

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import CERTAIN, PoseCovariance
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.slip import Missed

_TURNS = ((0.0, 0.0), (1.0, 1.0), (1.0, -1.0), (0.5, 2.0), (-1.0, -1.0), (100.0, 100.0))
"""Turns of the left and right wheel in one second: rest, line, spin, arc, reversal, a fast line."""


def rehearse(robot: Robot, tolerance: PieceTolerance) -> None:
    """Simulate a robot on every kind of piece.

    InputError if pose, twist or a covariance is not finite.
    """
    odometer = Odometer(robot, tolerance)
    left = right = time = 0.0
    for turns_left, turns_right in (_TURNS[0], *_TURNS):
        left += turns_left * robot.left_ticks_per_revolution
        right += turns_right * robot.right_ticks_per_revolution
        time += 1.0
        try:
            estimate = odometer.update(time, left, right)
        except (ArithmeticError, ValueError):  # ValueError: the logarithm of a negative number
            estimate = None
            lost = True
        else:
            lost = estimate is not None and not is_finite(estimate)
        if lost:
            raise InputError(
                "with these values odometry is beyond all numbers (tried on a line, a spin, an arc "
                f"and a reversal of a wheel's turn or two; track {robot.track:g} m, "
                f"{robot.left_tick:g} and {robot.right_tick:g} m for a count)"
            )


def is_finite(estimate: Estimate) -> bool:
    """Whether all numbers of an estimate are finite."""
    return math.isfinite(
        sum((*estimate.pose, *estimate.covariance, *estimate.twist, *estimate.twist_covariance))
    )


class Finished(NamedTuple):
    """A finished piece, and the covariance of the pose at its end."""

    piece: Piece
    covariance: PoseCovariance[float]


class LiveOdometer:
    """Pose of the robot, reading by reading."""

    def __init__(self, robot: Robot, tolerance: PieceTolerance, limits: EncoderLimits) -> None:
        self.pose = Pose()
        self.heading = 0.0
        """Cumulative turn [rad], not affected by `set_pose`."""
        self._known = CERTAIN
        self.stamp = Stamp()
        """Stamp of the last accepted reading."""
        self.odometer = Odometer(robot, tolerance, limits)
        """The model's: to be read; what changes it goes through here."""
        self._origin: int | None = None
        self.started = False
        """Whether any reading was accepted."""

    def take(self, stamp: Stamp, left: float, right: float) -> Estimate | None:
        """Process a reading; return None for the first, and for one that is rejected.

        InputError if the result is not finite, for example from a user's effect at an impossible
        speed. The pose is then unchanged.
        """
        if self._origin is None:
            self._origin = stamp.sec
        time = self.seconds(stamp)
        accepted, distance = self.odometer.tally.accepted, self.odometer.distance
        try:
            estimate = self.odometer.update(time, left, right)
            lost = estimate is not None and not is_finite(estimate)
        except (ArithmeticError, ValueError):  # ValueError: the logarithm of a negative number
            lost = True
        if lost:
            self.odometer.set_pose(self.pose, self._known)
            self.odometer.distance = distance
            raise InputError("beyond all numbers", f"what counts {left} and {right} make")
        if self.odometer.tally.accepted > accepted:
            self.started, self.stamp = True, stamp
        if estimate is not None:
            self.heading += estimate.pose.yaw - self.pose.yaw
            self.pose, self._known = estimate.pose, estimate.covariance
        return estimate

    def seconds(self, stamp: Stamp) -> float:
        """Convert a stamp to the odometer's time [s]; NaN before the first reading.

        Time starts at the first stamp: since 1970, a float resolves only 0.2 µs.
        """
        if self._origin is None:
            return math.nan
        return float(stamp.sec - self._origin) + 1e-9 * float(stamp.nanosec)

    def finished_by(self, estimate: Estimate) -> Finished | None:
        """The piece that ended with this estimate, which must be the last one."""
        if estimate.closed is None:
            return None
        return Finished(estimate.closed, self.odometer.piece.covariance_start)

    def set_pose(self, pose: Pose, covariance: PoseCovariance[float] = CERTAIN) -> Finished | None:
        """Continue from another pose; return the piece that ends here, if it is not empty."""
        end = self.odometer.covariance()
        piece = self.odometer.set_pose(pose, covariance)
        self.pose, self._known = pose, covariance
        return Finished(piece, end) if any(piece.travel) else None

    def grow(self, missed: Missed) -> Finished | None:
        """Increase the covariance; return the piece that ends here, if it is not empty."""
        known, yaw = self.odometer.covariance(), self.pose.yaw
        cos, sin = math.cos(yaw), math.sin(yaw)
        more = known._replace(
            xx=known.xx + missed.along * cos * cos,
            xy=known.xy + missed.along * cos * sin,
            yy=known.yy + missed.along * sin * sin,
            yawyaw=known.yawyaw + missed.heading,
        )
        return self.set_pose(self.pose, more)

    def reset(self) -> None:
        """Continue from the origin, with zero distance."""
        self.set_pose(Pose())
        self.odometer.distance = 0.0

    def retune(
        self, robot: Robot, tolerance: PieceTolerance, limits: EncoderLimits
    ) -> Finished | None:
        """Change parameter values; pose, covariance, counts and state are kept.

        Returns the piece that ends here, if any and not empty. The resolution of the encoders
        cannot be changed.
        """
        covariance = self.odometer.covariance()
        piece = self.odometer.retune(robot, tolerance, limits)
        return Finished(piece, covariance) if piece is not None and any(piece.travel) else None
