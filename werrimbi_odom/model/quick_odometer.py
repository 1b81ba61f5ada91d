# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The odometer with compiled code for messages that pass all checks: nearly all of them.

For streams of many messages, if numba is installed. Its import takes a third of a second and 70 MB,
and the first compilation on a machine some seconds.
"""

from __future__ import annotations

import math

import numpy as np

from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.covariance import CERTAIN, PoseCovariance, TwistCovariance
from werrimbi_odom.model.driven_motion import Channels, acts
from werrimbi_odom.model.encoder_online import EncoderLimits, EncoderTally, WheelStep
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.message_loop import IN_DOUBT, marching_of, take, write_marching
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.pace import REMEMBERED
from werrimbi_odom.model.pieces import OpenPiece, Piece, kind_of
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.reading_checks import Reading
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.scalar_loop import Marching
from werrimbi_odom.model.twist_interval import MovedStep
from werrimbi_odom.model.uncertainty import Uncertainty
from werrimbi_odom.model.wiring import Wiring

EXACT = 2.0**53
"""Counts from which floats skip integers."""
PATIENCE = 64
"""Messages processed in Python after a doubtful one, as more may follow."""


class QuickEstimate(Estimate):
    """An `Estimate` that is already computed; its tuples are constructed at first use."""

    _numbers: list[float]

    @classmethod
    def of_numbers(
        cls, numbers: list[float], distance: float, closed: Piece | None, robot: Robot
    ) -> QuickEstimate:
        """Create it from the output of `message_loop.take`."""
        found = tuple.__new__(cls, (numbers[0], None, None, None, distance, closed, robot))
        found._numbers = numbers
        return found

    @property
    def late(self) -> WheelStep:
        """As in `Estimate`, like all that follow."""
        return WheelStep(*self._numbers[:4])

    @property
    def late_motion(self) -> BodyMotion[float]:  # noqa: D102
        return BodyMotion(*self._numbers[4:7])

    @property
    def pose(self) -> Pose:  # noqa: D102
        return Pose(*self._numbers[7:10])

    @property
    def errors(self) -> Uncertainty[float]:  # noqa: D102
        return Uncertainty(self.covariance)

    @property
    def covariance(self) -> PoseCovariance[float]:  # noqa: D102
        return PoseCovariance(*self._numbers[10:16])

    @property
    def twist_covariance(self) -> TwistCovariance:  # noqa: D102
        return TwistCovariance(*self._numbers[16:19])

    @property
    def twist(self) -> BodyMotion[float]:  # noqa: D102
        return BodyMotion(*self._numbers[19:22])


class QuickOdometer(Odometer):
    """`Odometer`, identical to the last bit, in a fraction of the time if numba is installed.

    Doubtful messages and other rare cases are left to the Python code. For that, the state moves
    from the arrays to the objects, and back some messages later. Robots with effects or exact
    moments always use the Python code.
    """

    def __init__(
        self,
        robot: Robot,
        tolerance: PieceTolerance | None = None,
        limits: EncoderLimits | None = None,
    ) -> None:
        super().__init__(robot, tolerance, limits)
        self._machine = compiled(take)
        self._rules, self._heard, self._stamps = np.zeros(17), np.zeros(9), np.zeros(REMEMBERED + 1)
        self._at, self._said, self._ended = np.zeros(34), np.zeros(22), np.zeros(15)
        self._all = self._rules, self._heard, self._stamps, self._at, self._said, self._ended
        self._arrays: tuple[Floats, ...] = ()
        """All of these while the compiled code runs; empty while the Python code does."""
        if self._machine is not None:
            self._machine(*self._all, math.nan, 0.0, 0.0)  # load or compile now, not while driving
        self._waits = 0
        self._untold = 0  # messages not yet counted in the tally
        self._gone = 0  # messages in the arrays but not in the objects

    def update(
        self, time: float, left: float, right: float, channels: Channels | None = None
    ) -> Estimate | None:
        """Process the counters of one message, as `Odometer.update` does."""
        if self._arrays and -EXACT < left < EXACT and -EXACT < right < EXACT:
            assert self._machine is not None
            became = self._machine(*self._arrays, float(time), float(left), float(right))
            if became != IN_DOUBT:
                self._gone += 1
                self._untold += 1
                numbers = self._said.tolist()
                self.distance += abs(numbers[4])
                closed = self._closed() if became else None
                return QuickEstimate.of_numbers(numbers, self.distance, closed, self.robot)
        self._put_down(PATIENCE)
        estimate = super().update(time, left, right, channels)
        self._waits -= 1
        if self._waits <= 0:
            self._take_up()
        return estimate

    @property
    def tally(self) -> EncoderTally:
        """Counts of accepted and rejected messages."""
        self._tell()
        return self._encoder.tally

    @property
    def piece(self) -> Piece:
        """The open piece so far."""
        if not self._gone:
            return super().piece
        return self._objects().finished(float(self._heard[0]), self.robot.track)

    def errors(self) -> Uncertainty[float]:
        """Errors of the present pose, in the odometry frame."""
        if not self._gone:
            return super().errors()
        return Uncertainty(PoseCovariance(*self._at[3:9].tolist()))

    def set_pose(self, pose: Pose, covariance: PoseCovariance[float] = CERTAIN) -> Piece:
        """Continue from another pose, as `Odometer.set_pose` does."""
        self._put_down()
        return super().set_pose(pose, covariance)

    def retune(
        self,
        robot: Robot,
        tolerance: PieceTolerance | None = None,
        limits: EncoderLimits | None = None,
    ) -> Piece | None:
        """Change parameter values, as `Odometer.retune` does."""
        self._put_down()
        return super().retune(robot, tolerance, limits)

    def _closed(self) -> Piece:
        """The piece that has just ended."""
        end, x, y, yaw, *rest = self._ended.tolist()
        motion = BodyMotion(*rest[8:])
        begun, self._piece.time_start = self._piece.time_start, end
        return Piece(
            kind_of(motion, self.robot.track),
            begun,
            end,
            Pose(x, y, yaw),
            WheelTravel(*rest[6:8]),
            motion,
            PoseCovariance(*rest[:6]),
        )

    def _tell(self) -> None:
        """Bring the tally up to date."""
        self._encoder.tally.messages += self._untold
        self._encoder.tally.accepted += self._untold
        self._untold = 0

    def _objects(self) -> OpenPiece:
        """The open piece as an object, from the arrays."""
        at = marching_of(self._at.tolist())
        known = Uncertainty(at.covariance_start)
        return OpenPiece(self._piece.time_start, at.start, known, at.earlier, at.stretch)

    def _take_up(self) -> None:
        """Move the state to the arrays, if the compiled code can handle it."""
        encoder, piece, pace = self._encoder, self._piece, self._encoder.pace
        last = encoder.last
        if self._machine is None or last is None or acts(self.robot):
            return
        if self.robot.covariance_order != "first" or self._wiring != Wiring():
            return
        if not abs(last.left) < EXACT > abs(last.right):
            return
        gap = encoder.limits.gap_duration
        self._rules[:] = *encoder.rule, *self._rule, *self.robot.wheel_noise, gap
        known = pace.stamps()
        self._stamps[: known.size] = known
        place = known.size % self._stamps.size
        self._heard[:] = *last, pace.usual, *pace.speeds(), known.size, place
        covariance, start = super().errors().covariance, piece.errors_start.covariance
        write_marching(
            self._at,
            Marching(self._pose, covariance, piece.start, start, piece.travelled, piece.stretch),
        )
        self._arrays = self._all

    def _put_down(self, waits: int = 0) -> None:
        """Move the state from the arrays to the objects, for the Python code."""
        if not self._arrays:
            return
        self._arrays, self._waits = (), waits
        if not self._gone:
            return
        self._tell()
        said, heard = self._said.tolist(), self._heard.tolist()
        self._piece = self._objects()
        self._time, self._counts, self._pose = heard[0], (heard[1], heard[2]), Pose(*said[7:10])
        step = WheelStep(*said[:4])
        self._interval.begin(MovedStep(step, BodyMotion(*said[4:7])))
        new = min(self._gone, int(heard[7]))
        stamps = np.roll(self._stamps, -int(heard[8]))[-new:]
        self._encoder.have_stepped(step, Reading(*heard[:3]))
        self._encoder.pace.have_seen(stamps, heard[3], heard[4], heard[5], int(heard[6]))
        self._gone = 0
