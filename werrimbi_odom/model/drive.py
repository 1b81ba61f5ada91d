# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a physical effect may look at in a step, and all the memory it may use.

Every quantity is known when the step's message arrives (causal), and is given at the step's start
and end, so that an effect can integrate between them and does not depend on the logging rate. The
same class holds floats (the node, step by step) and arrays (a whole run).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Generic, NamedTuple

import numpy as np

from werrimbi_odom.model.motion import Number
from werrimbi_odom.model.pose import Floats

ROLLBACK = 1.5e-3
"""A wheel that goes back by no more than this [m] has not reversed: whatever the counters resolve,
a stopped wheel is still settled by its controller, by some tenths of a millimetre to and fro."""


class Span(NamedTuple, Generic[Number]):
    """A quantity at the start and at the end of a step."""

    start: Number
    end: Number

    @property
    def mean(self) -> Number:
        """Half way between."""
        return 0.5 * (self.start + self.end)

    @property
    def change(self) -> Number:
        """End minus start."""
        return self.end - self.start


@dataclass(frozen=True, slots=True)
class Drive(Generic[Number]):
    """One step, or all steps of a run (arrays of shape (n,)), before any effect."""

    duration: Number
    """[s]"""
    time: Span[Number]
    """Since the first message [s]."""
    speed: Span[Number]
    """Forward speed [m/s]: mean of the last step, mean of this one.

    In the first step both are its own mean: a record may begin in full motion, and nothing is known
    of what was before."""
    yaw_rate: Span[Number]
    """[rad/s], likewise."""
    left_speed: Span[Number]
    """Of the left wheel's rim [m/s], likewise."""
    right_speed: Span[Number]
    """Of the right wheel's rim [m/s], likewise."""
    left_angle: Span[Number]
    """Of the left wheel, from its counter's zero [rad]."""
    right_angle: Span[Number]
    """Of the right wheel, from its counter's zero [rad]."""
    distance: Span[Number]
    """Path of the axle's midpoint, both directions counted [m]."""
    left_since_reversal: Span[Number]
    """Travel of the left wheel since it last reversed [m]."""
    right_since_reversal: Span[Number]
    """Travel of the right wheel since it last reversed [m]."""
    since_reversal: Span[Number]
    """Travel of the axle's midpoint since it last reversed [m]."""
    left_direction: Number
    """+1 when the left wheel last rolled forwards, -1 backwards, 0 before it has moved."""
    right_direction: Number
    """The same for the right wheel."""
    direction: Number
    """The same for the axle's midpoint."""
    reversals: Number
    """How often the axle's midpoint has reversed so far."""
    left_reversals: Number
    """The same for the left wheel."""
    right_reversals: Number
    """The same for the right wheel."""
    heading: Span[Number]
    """Of the robot in the odometry frame [rad]."""
    x: Span[Number]
    """Where the axle's midpoint is, in the odometry frame [m]; NaN but for effects with `pose`."""
    y: Span[Number]
    """Likewise, across [m]."""
    channels: Mapping[str, Span[Number]] = field(default_factory=dict)
    """Extra measured channels of the record, by name, in their own units."""

    def with_heading(self, start: Number, turn: Number) -> Drive[Number]:
        """The same with the heading that the odometry has at the start of the step."""
        return replace(self, heading=Span(start, start + turn))

    def with_place(self, x: Number, y: Number, moved: tuple[Number, Number]) -> Drive[Number]:
        """The same with the place that the odometry has at the start of the step."""
        return replace(self, x=Span(x, x + moved[0]), y=Span(y, y + moved[1]))


class RawStep(NamedTuple):
    """What the encoders say of one step, before any effect."""

    duration: float
    left: float
    """Travel of the left wheel [m]."""
    right: float
    """Travel of the right wheel [m]."""
    along: float
    """Travel of the axle's midpoint [m]."""
    turn: float
    """[rad]"""
    left_angle: float
    """Change of the left wheel's angle [rad]."""
    right_angle: float
    """Change of the right wheel's angle [rad]."""


class _Means(NamedTuple):
    """Speeds over a step [m/s, rad/s, m/s, m/s]."""

    speed: float
    yaw_rate: float
    left: float
    right: float


@dataclass(slots=True)
class _Shuttle:
    """Travel since the last reversal of something that goes to and fro."""

    flicker: float
    direction: float = 0.0
    reversals: int = 0
    _position: float = 0.0
    _turned_at: float = 0.0
    _farthest: float = 0.0

    @property
    def since(self) -> float:
        """Travel since the last reversal [m]."""
        return abs(self._farthest - self._turned_at)

    def step(self, travel: float) -> Span[float]:
        """Take one step; travel since reversal at its start and end."""
        self._position += travel
        start = self.since
        ahead = (self._position - self._farthest) * (self.direction or 1.0)
        if self.direction == 0.0:
            if abs(self._position) > self.flicker:
                self.direction = 1.0 if self._position > 0.0 else -1.0
                self._farthest = self._position
        elif ahead > 0.0:
            self._farthest = self._position
        elif -ahead > self.flicker:
            self._turned_at, self._farthest = self._farthest, self._position
            self.direction = -self.direction
            self.reversals += 1
            start = 0.0
        return Span(start, self.since)


@dataclass(slots=True)
class DriveMemory:
    """The causal memory behind `Drive`: constant in size, a step at a time.

    Parameters
    ----------
    flicker : float
        A wheel that goes back by less (or by less than `ROLLBACK`) has not reversed [m].
    left_angle, right_angle : float
        Of the wheels at the first message, from the counters' zeros [rad].
    """

    flicker: float
    left_angle: float = 0.0
    right_angle: float = 0.0
    _time: float = 0.0
    _distance: float = 0.0
    _means: _Means | None = None
    _left: _Shuttle = field(init=False)
    _right: _Shuttle = field(init=False)
    _middle: _Shuttle = field(init=False)

    def __post_init__(self) -> None:
        least = max(self.flicker, ROLLBACK)
        self._left, self._right, self._middle = _Shuttle(least), _Shuttle(least), _Shuttle(least)

    def step(
        self,
        raw: RawStep,
        heading: float,
        channels: Mapping[str, Span[float]] | None = None,
    ) -> Drive[float]:
        """Take one step and tell an effect all that it may know of it."""
        time = Span(self._time, self._time + raw.duration)
        distance = Span(self._distance, self._distance + abs(raw.along))
        means = _Means(
            raw.along / raw.duration,
            raw.turn / raw.duration,
            raw.left / raw.duration,
            raw.right / raw.duration,
        )
        speed, yaw_rate, left_speed, right_speed = map(Span, self._means or means, means)
        left_angle = Span(self.left_angle, self.left_angle + raw.left_angle)
        right_angle = Span(self.right_angle, self.right_angle + raw.right_angle)
        left, right = self._left.step(raw.left), self._right.step(raw.right)
        middle = self._middle.step(raw.along)
        self._time, self._distance = time.end, distance.end
        self._means = means
        self.left_angle, self.right_angle = left_angle.end, right_angle.end
        return Drive(
            raw.duration,
            time,
            speed,
            yaw_rate,
            left_speed,
            right_speed,
            left_angle,
            right_angle,
            distance,
            left,
            right,
            middle,
            self._left.direction,
            self._right.direction,
            self._middle.direction,
            float(self._middle.reversals),
            float(self._left.reversals),
            float(self._right.reversals),
            Span(heading, heading + raw.turn),
            Span(math.nan, math.nan),
            Span(math.nan, math.nan),
            channels or {},
        )


def drive_of_run(
    duration: Floats,
    left: Floats,
    right: Floats,
    along: Floats,
    turn: Floats,
    left_angle: Floats,
    right_angle: Floats,
    *,
    flicker: float,
    first_angles: tuple[float, float] = (0.0, 0.0),
    channels: Mapping[str, Span[Floats]] | None = None,
) -> Drive[Floats]:
    """All steps of a run at once; the same as feeding them to a `DriveMemory`.

    Arrays have shape (n,), as in `RawStep`; the heading starts at zero (`Drive.with_heading`).
    """
    least = max(flicker, ROLLBACK)
    middle = _shuttled(along, least)
    left_side, right_side = _shuttled(left, least), _shuttled(right, least)
    return Drive(
        duration,
        _grown(0.0, duration),
        _lagged(along / duration),
        _lagged(turn / duration),
        _lagged(left / duration),
        _lagged(right / duration),
        _grown(first_angles[0], left_angle),
        _grown(first_angles[1], right_angle),
        _grown(0.0, np.abs(along)),
        left_side.since,
        right_side.since,
        middle.since,
        left_side.direction,
        right_side.direction,
        middle.direction,
        middle.reversals,
        left_side.reversals,
        right_side.reversals,
        _grown(0.0, turn),
        _nowhere(turn),
        _nowhere(turn),
        channels or {},
    )


class _Shuttled(NamedTuple):
    since: Span[Floats]
    direction: Floats
    reversals: Floats


def _grown(first: float, steps: Floats) -> Span[Floats]:
    """Running sum before and after each step."""
    sums = np.cumsum(np.concatenate([[first], steps]))
    return Span(sums[:-1], sums[1:])


def _nowhere(steps: Floats) -> Span[Floats]:
    """A place that nobody has told yet."""
    return Span(np.full_like(steps, np.nan), np.full_like(steps, np.nan))


def _lagged(means: Floats) -> Span[Floats]:
    """Mean of the step before, and of the step; the first step has none before it."""
    return Span(np.concatenate([means[:1], means[:-1]]), means)


def _shuttled(travel: Floats, flicker: float) -> _Shuttled:
    """`_Shuttle` over a whole run.

    Only steps that set a new extreme or turn back matter; between reversals the farthest point is
    a running extreme, so the loop is over reversals, not over steps.
    """
    position = np.cumsum(travel)
    count = position.size
    since_start, since_end = np.zeros(count), np.zeros(count)
    direction, reversals = np.zeros(count), np.zeros(count)
    moved = np.flatnonzero(np.abs(position) > flicker)
    if moved.size == 0:
        return _Shuttled(Span(since_start, since_end), direction, reversals)
    begin, turned_at = int(moved[0]), 0.0
    sign, number = (1.0 if position[begin] > 0.0 else -1.0), 0
    while begin < count:
        end, farthest = _until_reversal(position, begin, sign, flicker)
        leg = slice(begin, end)
        since_end[leg] = np.abs(farthest - turned_at)
        since_start[leg] = np.concatenate([[0.0], since_end[begin : end - 1]])
        direction[leg], reversals[leg] = sign, number
        if end < count:
            turned_at, sign, number = float(farthest[-1]), -sign, number + 1
        begin = end
    return _Shuttled(Span(since_start, since_end), direction, reversals)


def _until_reversal(
    position: Floats, begin: int, sign: float, flicker: float
) -> tuple[int, Floats]:
    """First step after `begin` that has turned back, and the farthest point until then."""
    window = 256
    while True:
        end = min(begin + window, position.size)
        ahead = sign * position[begin:end]
        farthest = np.maximum.accumulate(ahead)
        back = farthest - ahead > flicker
        first = int(back.argmax())
        if back[first]:
            return begin + first, sign * farthest[:first]
        if end == position.size:
            return end, sign * farthest
        window *= 4
