# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Streaming odometry: ticks in, pose with covariance out; constant cost and memory."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from werrimbi_odom.model.compiled import of_floats
from werrimbi_odom.model.covariance import (
    CERTAIN,
    PoseCovariance,
    TwistCovariance,
    after_stretch,
    noise_of_wheel_variances,
    path_noise_of,
    twist_noise,
)
from werrimbi_odom.model.driven_motion import Channels, DrivenStep, Driving
from werrimbi_odom.model.effect import wiring_of
from werrimbi_odom.model.encoder_online import Encoder, EncoderLimits, EncoderTally, WheelStep
from werrimbi_odom.model.end_of_piece import PieceRule, PieceSums, PieceTolerance
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, mean_twist
from werrimbi_odom.model.pieces import OpenPiece, Piece
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.twist_interval import MovedStep, TwistInterval
from werrimbi_odom.model.uncertainty import Uncertainty, after_piece, known, with_lost_travel

_displacement = of_floats(displacement)
_path_noise = of_floats(path_noise_of)
_after_stretch = of_floats(after_stretch)


class _Estimate(NamedTuple):
    """The data from which an `Estimate` is computed."""

    time: float
    """Stamp of the message [s]."""
    late: WheelStep
    """Raw travel of the wheels over the interval of the twist, before any effect."""
    late_motion: BodyMotion[float]
    """Motion in that interval."""
    pose: Pose
    """In the odometry frame; yaw is unwrapped."""
    distance: float
    """Path length of the axle's midpoint since the start, both directions counted positive [m]."""
    closed: Piece | None
    """The piece that ended with this message, if any."""
    robot: Robot
    start: Pose
    """Pose at the start of the open piece."""
    errors_start: Uncertainty[float]
    """Errors of that pose."""
    stretch: PieceSums
    """The open piece so far."""


class Estimate(_Estimate):
    """Everything the odometer knows after one message.

    Errors and twist are computed at first use, and cached.
    """

    @cached_property
    def errors(self) -> Uncertainty[float]:
        """Errors of the pose, in the odometry frame."""
        return errors_along(self.robot, self.start, self.errors_start, self.stretch, self.pose)

    @property
    def covariance(self) -> PoseCovariance[float]:
        """Covariance of the pose, in the odometry frame."""
        return self.errors.covariance

    @property
    def mean_shift(self) -> tuple[float, float] | None:
        """Mean of the true position minus the pose (x, y) [m]; None without exact moments."""
        return self.errors.mean_shift

    @cached_property
    def twist(self) -> BodyMotion[float]:
        """Mean speed forward and to the left [m/s] and yaw rate [rad/s] over the last interval.

        A message that arrives much too early (a driver that blocked, then sent several at once) is
        combined with those before it: travel divided by a few microseconds is no speed.
        """
        return mean_twist(self.late_motion, self.late.duration)

    @cached_property
    def twist_covariance(self) -> TwistCovariance:
        """Covariance of the twist: wheel noise over its interval and quantisation."""
        robot = self.robot
        ticks = robot.left_tick, robot.right_tick
        return twist_noise(robot.wheel_noise, *ticks, *self.late[1:])


class Odometer:
    """Wheel odometry with the closed-form covariance of Chong and Kleeman.

    The pose is integrated exactly at every message. Its covariance is that of the finished pieces,
    propagated to the present pose, plus that of the open piece in closed form.

    Parameters
    ----------
    tolerance : PieceTolerance
        When a piece ends.
    limits : EncoderLimits
        When counter readings are rejected.
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
        self._interval = TwistInterval()

    @property
    def tally(self) -> EncoderTally:
        """Counts of accepted and rejected messages."""
        return self._encoder.tally

    @property
    def piece(self) -> Piece:
        """The open piece so far."""
        return self._piece.finished(self._now, self.robot.track)

    @property
    def _now(self) -> float:
        return 0.0 if self._time is None else self._time

    @property
    def driven_step(self) -> DrivenStep | None:
        """The latest step as effects see it; None for a robot without effects."""
        return self._driving.last

    def update(
        self, time: float, left: float, right: float, channels: Channels | None = None
    ) -> Estimate | None:
        """Process the counters of one message.

        Parameters
        ----------
        time : float
            Stamp [s].
        left, right : float or int
            Cumulative signed counts.
        channels : mapping, optional
            Extra measured channels, for effects that read them.

        Returns
        -------
        Estimate or None
            None for the first message (no interval yet) and for one that was rejected; `tally`
            counts the reason.

        Raises
        ------
        InputError
            If an effect reads a channel that was never measured. The message is as if it never
            came: the next one contains its travel.
        """
        if self._time is not None:
            self._driving.check(channels)
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
        late = self._interval.add(MovedStep(step, motion), self._encoder.usual)
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
        """Continue from another pose with this covariance; return the piece that ends here."""
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
        """Change parameter values; pose, errors, counts and the state of the effects are kept.

        The open piece continues if noise and piece rule are unchanged. Otherwise it ends here and
        is returned, so that past travel keeps the noise assumed at the time.

        Raises
        ------
        ValueError
            If the meaning of the counts would change.
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
        """Errors of the present pose, in the odometry frame."""
        piece = self._piece
        return errors_along(self.robot, piece.start, piece.errors_start, piece.stretch, self._pose)

    def covariance(self) -> PoseCovariance[float]:
        """Covariance of the present pose, in the odometry frame."""
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
        """Extend the open piece by the step; or end it, start another, and return the ended one."""
        lost = step.left_lost > 0.0 or step.right_lost > 0.0
        if not lost and self._piece.extend(self._rule, travel, motion, pose):
            return None
        finished = self.piece
        errors = self.errors()
        if lost:
            unseen = noise_of_wheel_variances(step.left_lost, step.right_lost, self.robot.track)
            errors = with_lost_travel(errors, unseen, self._pose.yaw)
        travelled = self._piece.travelled_after
        self._piece = OpenPiece(self._now, self._pose, errors, travelled)
        self._piece.extend(self._rule, travel, motion, pose)
        return finished


def _reading_of(robot: Robot) -> tuple[object, ...]:
    """Parameters that turn counts into travel, except the wheel sizes."""
    per_turn = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
    return *per_turn, robot.encoder_bits, wiring_of(robot.effects)


def _noise_of(robot: Robot) -> tuple[object, ...]:
    """Parameters that determine the covariance of a travel."""
    noise = robot.left_wheel_noise, robot.right_wheel_noise
    return *noise, robot.track, robot.covariance_order


def errors_along(
    robot: Robot, start: Pose, errors: Uncertainty[float], stretch: PieceSums, pose: Pose
) -> Uncertainty[float]:
    """Errors of a pose at the end of a stretch, given those at its start."""
    noise = _path_noise(robot.wheel_noise, stretch.left, stretch.right)
    dx, dy = pose.x - start.x, pose.y - start.y
    if errors.moments is not None:
        return after_piece(errors, stretch.motion, noise, start.yaw, dx, dy)
    return Uncertainty(
        _after_stretch(errors.covariance, stretch.motion, noise, stretch.chord, dx, dy)
    )
