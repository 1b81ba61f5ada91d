# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Feedback control along a plan: commands from poses of the odometry."""

from __future__ import annotations

import math

from werrimbi_odom.driving.limits import STILL, Command, Limits
from werrimbi_odom.driving.plan import ManoeuvrePlan, Profile, seen_from
from werrimbi_odom.model.motion import sinc
from werrimbi_odom.model.pose import Pose

ALONG = 1.5
"""Gain of the error along the path [1/s]."""
ACROSS, TURN = 6.0, 4.0
"""Gains from the cross-track error [1/m^2] and the heading error [1/m] to curvature: errors decay
within half a metre, with a damping ratio of 0.8."""
SPIN = 2.5
"""Gain of the heading error in turns on the spot [1/s]."""
CLOSE, CLOSE_TURN = 0.003, 0.005
"""A move has ended this near to its end [m, rad] ..."""
PATIENCE = 1.5
"""... or this long after its planned end [s]: motors do not move for very small commands."""


class PathFollower:
    """Follows a plan, move by move.

    Moves are laid out from the start of the plan, so an error of one move is corrected in the next.
    At its end a move creeps on but never back: a reversal would excite effects of its own.
    """

    def __init__(self, plan: ManoeuvrePlan, limits: Limits) -> None:
        self.index = 0
        """Index of the present move; the number of moves when all are driven."""
        self.deviation = 0.0
        """Distance of the robot from its desired position [m]."""
        self.turned_off = 0.0
        """Desired minus actual heading [rad]."""
        self._moves, self._starts, self._limits = plan.moves, plan.starts(), limits
        self._time = 0.0
        self._rested = -1.0  # not yet at rest
        self._profile = self._of_present()

    @property
    def done(self) -> bool:
        """Whether all moves are driven."""
        return self.index == len(self._moves)

    def follow(self, pose: Pose, duration: float) -> Command:
        """Command before limits, at a pose in the frame of the plan's start.

        `duration` is the time since the last call [s].
        """
        if self.done:
            return STILL
        move = self._moves[self.index]
        self._time += duration
        if self._rested >= 0.0:
            self._rested += duration
            if self._rested >= move.rest:
                self._next()
            return STILL
        share, rate = self._profile.at(self._time)
        wanted = move.end(self._starts[self.index], share)
        along, across, turn = seen_from(pose, wanted)
        self.deviation, self.turned_off = math.hypot(along, across), turn
        late = self._time - self._profile.duration
        speed, yaw_rate = move.length * rate, move.turn * rate
        if not move.length:
            near = abs(turn) < CLOSE_TURN
            command = Command(0.0, yaw_rate + SPIN * turn)
        else:
            near = abs(along) < CLOSE
            steer = speed * ACROSS * across * sinc(turn) + abs(speed) * TURN * turn
            command = Command(speed * math.cos(turn) + ALONG * along, yaw_rate + steer)
        if late < 0.0:
            return command
        onwards = Command(
            _onwards(command.speed, move.length), _onwards(command.yaw_rate, move.turn)
        )
        beyond = not (onwards.speed if move.length else onwards.yaw_rate)
        if near or beyond or late > PATIENCE:
            self._rested = 0.0
            return STILL
        return onwards

    def _next(self) -> None:
        self.index += 1
        self._time, self._rested = 0.0, -1.0
        if not self.done:
            self._profile = self._of_present()

    def _of_present(self) -> Profile:
        return Profile.of(self._moves[self.index], self._limits)


def _onwards(value: float, direction: float) -> float:
    """The value if it has the sign of `direction`, else zero."""
    return value if value * direction > 0.0 else 0.0
