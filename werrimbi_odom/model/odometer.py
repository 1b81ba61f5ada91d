# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Streaming odometry: ticks in, a pose that knows its covariance out; constant cost and memory."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from werrimbi_odom.model.covariance import (
    CERTAIN,
    PoseCovariance,
    TwistCovariance,
    after_stretch,
    noise_of_wheel_variances,
    path_noise_of,
    twist_noise,
)
from werrimbi_odom.model.driving import Channels, DrivenStep, Driving
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.encoder import Encoder, EncoderLimits, EncoderTally, WheelStep
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, mean_twist
from werrimbi_odom.model.of_floats import of_floats
from werrimbi_odom.model.pieces import OpenPiece, Piece
from werrimbi_odom.model.pieces_online import PieceRule, PieceSums, PieceTolerance
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.uncertainty import Uncertainty, after_piece, known

_displacement = of_floats(displacement)
_path_noise = of_floats(path_noise_of)
_after_stretch = of_floats(after_stretch)


class _Estimate(NamedTuple):
    """What an `Estimate` is worked out of."""

    time: float
    """Stamp of the message [s]."""
    late: WheelStep
    """Travel of the wheels, before any effect, over the time of which the twist is the mean."""
    late_motion: BodyMotion[float]
    """In that time."""
    pose: Pose
    """In the odometry frame; yaw goes on counting past a whole turn."""
    distance: float
    """Travel of the axle's midpoint since the start, both directions counted [m]."""
    closed: Piece | None
    """The piece that this message brought to its end, if it did."""
    robot: Robot
    start: Pose
    """Of the open piece."""
    errors_start: Uncertainty[float]
    """Of the pose there."""
    stretch: PieceSums
    """The open piece as far as it has been driven."""


class Estimate(_Estimate):
    """Everything the odometer knows after one message.

    Of errors and twist it holds what they are worked out of; that is done when they are asked for,
    and once.
    """

    @cached_property
    def errors(self) -> Uncertainty[float]:
        """Of the pose, in the odometry frame."""
        return errors_along(self.robot, self.start, self.errors_start, self.stretch, self.pose)

    @property
    def covariance(self) -> PoseCovariance[float]:
        """Of the pose, in the odometry frame."""
        return self.errors.covariance

    @property
    def mean_shift(self) -> tuple[float, float] | None:
        """Where exact moments are carried: mean of the true position less the pose (x, y) [m]."""
        return self.errors.mean_shift

    @cached_property
    def twist(self) -> BodyMotion[float]:
        """Speed forward and to the left [m/s] and yaw rate [rad/s], mean over the last interval.

        A message that came much too soon (a driver that hung, then sent several at once) is taken
        together with those before it: a few microseconds divide no travel.
        """
        return mean_twist(self.late_motion, self.late.duration)

    @cached_property
    def twist_covariance(self) -> TwistCovariance:
        """Of the twist: wheel noise over its interval, quantisation of the two readings."""
        robot = self.robot
        ticks = robot.left_tick, robot.right_tick
        return twist_noise(robot.wheel_noise, *ticks, *self.late[1:])


class Odometer:
    """Wheel odometry with the closed-form covariance of Chong and Kleeman.

    The pose is integrated exactly at every message; the covariance is that of the pieces finished
    so far, carried to the present pose, and of the open piece in closed form up to now.

    Parameters
    ----------
    robot : Robot
    tolerance : PieceTolerance
        When a piece ends.
    limits : EncoderLimits
        When counters are doubted.
    """

    def __init__(
        self,
        robot: Robot,
        tolerance: PieceTolerance | None = None,
        limits: EncoderLimits | None = None,
    ) -> None:
        self.robot = robot
        self.distance = 0.0
        self._rule = PieceRule.of(robot, tolerance or PieceTolerance())
        self._encoder = Encoder(robot, limits or EncoderLimits())
        self._driving = Driving(robot)
        self._wiring = wiring_of(robot.effects)
        self._time: float | None = None
        self._counts = (0.0, 0.0)
        self._pose = Pose()
        self._piece = OpenPiece(0.0, Pose(), known(robot.covariance_order))
        self._late: tuple[WheelStep, BodyMotion[float]] | None = None

    @property
    def tally(self) -> EncoderTally:
        """What became of the messages."""
        return self._encoder.tally

    @property
    def piece(self) -> Piece:
        """The open piece as it stands."""
        return self._piece.finished(self._now, self.robot.track)

    @property
    def _now(self) -> float:
        return 0.0 if self._time is None else self._time

    @property
    def driven_step(self) -> DrivenStep | None:
        """The latest step as effects see it; None where the robot has none."""
        return self._driving.last

    def update(
        self, time: float, left: float, right: float, channels: Channels | None = None
    ) -> Estimate | None:
        """Take the counters of one message.

        Parameters
        ----------
        time : float
            Stamp [s].
        left, right : float or int
            Cumulative signed counts.
        channels : mapping, optional
            Extra measured channels, for effects that look at them.

        Returns
        -------
        Estimate or None
            None for the first message (there is no interval yet) and for one that was refused;
            `tally` says why.
        """
        left, right = self._wiring.wheels(left, right)
        step = self._encoder.step(time, left, right)
        if step is None:
            if self._time is None and self._encoder.tally.accepted:
                self._begin(time, left, right, channels)
            return None
        raw = WheelTravel(step.left, step.right)
        travel, motion = self._driving.step(step.duration, raw, self._pose, channels)
        pose = self._moved(motion)
        closed = self._cut(step, travel, motion, pose)
        self._time, self._counts, self._pose = time, (left, right), pose
        self.distance += abs(motion.along)
        late = step, motion
        if step.duration < self._encoder.lasted and self._late is not None:
            late = joined(*self._late, *late)
        self._late = late
        piece = self._piece
        return Estimate(
            step.time,
            *late,
            pose,
            self.distance,
            closed,
            self.robot,
            piece.start,
            piece.errors_start,
            piece.stretch,
        )

    def set_pose(self, pose: Pose, covariance: PoseCovariance[float] = CERTAIN) -> Piece:
        """Go on from another pose, known with a covariance; returns the piece that this ends."""
        finished = self.piece
        self._pose = pose
        self._piece = OpenPiece(self._now, pose, known(self.robot.covariance_order, covariance))
        return finished

    def retune(
        self,
        robot: Robot,
        tolerance: PieceTolerance | None = None,
        limits: EncoderLimits | None = None,
    ) -> Piece | None:
        """Go on with other values; pose, errors, counts, and all that effects remember stay.

        The open piece goes on where noise and its rule stay as they are; else it ends here, and is
        returned: what was driven keeps the noise that was believed of it.

        Raises
        ------
        ValueError
            When counts would mean something else than before.
        """
        if _reading_of(robot) != _reading_of(self.robot):
            raise ValueError("resolution and wiring of the encoders cannot change in a drive")
        rule = PieceRule.of(robot, tolerance or PieceTolerance())
        finished = None
        if rule != self._rule or _noise_of(robot) != _noise_of(self.robot):
            finished, errors = self.piece, self.errors()
            if robot.covariance_order != self.robot.covariance_order:
                errors = known(robot.covariance_order, errors.covariance)
            travelled = self._piece.travelled_after
            self._piece = OpenPiece(self._now, self._pose, errors, travelled)
        self.robot, self._rule = robot, rule
        self._encoder.retune(robot, limits or EncoderLimits())
        self._driving.retune(robot, *self._counts)
        return finished

    def errors(self) -> Uncertainty[float]:
        """Of the present pose, in the odometry frame."""
        piece = self._piece
        return errors_along(self.robot, piece.start, piece.errors_start, piece.stretch, self._pose)

    def covariance(self) -> PoseCovariance[float]:
        """Of the present pose, in the odometry frame."""
        return self.errors().covariance

    def _begin(self, time: float, left: float, right: float, channels: Channels | None) -> None:
        self._time, self._counts = time, (left, right)
        self._piece.time_start = time
        self._driving.begin(left, right, channels)

    def _moved(self, motion: BodyMotion[float]) -> Pose:
        x, y, yaw = self._pose
        dx, dy = _displacement(motion, yaw)
        return Pose(x + dx, y + dy, yaw + motion.turn)

    def _cut(
        self, step: WheelStep, travel: WheelTravel[float], motion: BodyMotion[float], pose: Pose
    ) -> Piece | None:
        """Let the step go on with the open piece, or end that and begin another with it."""
        lost = step.left_lost > 0.0 or step.right_lost > 0.0
        if not lost and self._piece.extend(self._rule, travel, motion, pose):
            return None
        finished = self.piece
        errors = self.errors()
        if lost:
            errors = with_lost_travel(errors, self.robot, step, self._pose.yaw)
        travelled = self._piece.travelled_after
        self._piece = OpenPiece(self._now, self._pose, errors, travelled)
        self._piece.extend(self._rule, travel, motion, pose)
        return finished


def _reading_of(robot: Robot) -> tuple[object, ...]:
    """What makes travel of counts, but for the size of wheels."""
    per_turn = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    return *per_turn, robot.encoder_bits, wiring_of(robot.effects)


def _noise_of(robot: Robot) -> tuple[object, ...]:
    """What makes covariance of travel."""
    noise = robot.left_wheel_noise, robot.right_wheel_noise
    return *noise, robot.track, robot.covariance_order


def errors_along(
    robot: Robot, start: Pose, errors: Uncertainty[float], stretch: PieceSums, pose: Pose
) -> Uncertainty[float]:
    """Errors of a pose to which a stretch has led, from those of the pose at its start."""
    noise = _path_noise(robot.wheel_noise, stretch.left, stretch.right)
    dx, dy = pose.x - start.x, pose.y - start.y
    if errors.moments is not None:
        return after_piece(errors, stretch.motion, noise, start.yaw, dx, dy)
    return Uncertainty(
        _after_stretch(errors.covariance, stretch.motion, noise, stretch.chord, dx, dy)
    )


def with_lost_travel(
    errors: Uncertainty[float], robot: Robot, step: WheelStep, yaw: float
) -> Uncertainty[float]:
    """Errors of a pose with heading `yaw`, with the travel added that a counter reset hid."""
    noise = noise_of_wheel_variances(step.left_lost, step.right_lost, robot.track)
    return after_piece(errors, BodyMotion(0.0, 0.0, 0.0), noise, yaw, 0.0, 0.0)


def joined(
    before: WheelStep, moved: BodyMotion[float], step: WheelStep, motion: BodyMotion[float]
) -> tuple[WheelStep, BodyMotion[float]]:
    """Two steps as one, and the motion in them."""
    _, *earlier = before
    time, *later = step
    sums = [a + b for a, b in zip(earlier, later, strict=True)]
    return WheelStep(time, *sums), BodyMotion(*(a + b for a, b in zip(moved, motion, strict=True)))
