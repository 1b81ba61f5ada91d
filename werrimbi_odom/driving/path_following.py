# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Following a plan by what the odometry says: commands out of poses."""

from __future__ import annotations

import math

from werrimbi_odom.driving.limits import STILL, Command, Limits
from werrimbi_odom.driving.plan import ManoeuvrePlan, Profile, seen_from
from werrimbi_odom.model.motion import sinc
from werrimbi_odom.model.pose import Pose

ALONG = 1.5
"""Share of the error along the path that is made up for in a second [1/s]."""
ACROSS, TURN = 6.0, 4.0
"""Curvature for an error across [1/m^2] and of the heading [1/m]: errors die out within half a
metre, hardly swinging (a damping of 0.8)."""
SPIN = 2.5
"""Share of the heading's error that is made up for in a second on the spot [1/s]."""
CLOSE, CLOSE_TURN = 0.003, 0.005
"""A move has ended when this near to its end [m, rad] ..."""
PATIENCE = 1.5
"""... or this long after it should have [s]: motors that do not move for so little."""


class PathFollower:
    """A plan that is being driven.

    The moves are those of the plan, laid out from its start: what one move misses, the next makes
    up for. At its end a move creeps on, and never back: a reversal would be a manoeuvre of its own.

    Parameters
    ----------
    plan : ManoeuvrePlan
    limits : Limits
    """

    def __init__(self, plan: ManoeuvrePlan, limits: Limits) -> None:
        self.index = 0
        """Of the present move; the count of moves when all are driven."""
        self.deviation = 0.0
        """Of the robot from where it should be now [m]."""
        self.turned_off = 0.0
        """Of its heading from what it should be now [rad]."""
        self._moves, self._starts, self._limits = plan.moves, plan.starts(), limits
        self._time = 0.0
        self._rested = -1.0  # not yet at rest
        self._profile = self._of_present()

    @property
    def done(self) -> bool:
        """Whether all is driven."""
        return self.index == len(self._moves)

    def follow(self, pose: Pose, duration: float) -> Command:
        """What to command, before limits, at a pose seen from the plan's start.

        Parameters
        ----------
        duration : float
            Since the last call [s].
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
    """The value where it has the sign of the direction, else zero."""
    return value if value * direction > 0.0 else 0.0
