# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Quantities that effects may read, for all steps of a recorded run at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields
from functools import cache, partial
from itertools import pairwise
from typing import Any, Literal, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.castor import castor_swings
from werrimbi_odom.model.drive import ROLLBACK, SMOOTHING, Drive, Span
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.step_speeds import EarlySteps, early_steps, mean_speeds

QUANTITIES = tuple(item.name for item in fields(Drive))
"""Names of all quantities that effects may read."""


Some = TypeVar("Some", bound="DriveOfRun")


class DriveOfRun(Drive[Floats]):
    """A `Drive` over all steps of runs that computes each quantity at first use.

    An effect reads two or three of the thirty quantities.
    """

    __slots__ = ("_works",)
    _works: Mapping[str, Callable[[], Any]]

    @classmethod
    def by(cls: type[Some], works: Mapping[str, Callable[[], Any]]) -> Some:
        """Create a drive from functions that compute its quantities, by name."""
        drive = object.__new__(cls)
        object.__setattr__(drive, "_works", works)
        return drive

    def found(self, name: str) -> Any:
        """Compute a quantity without caching it."""
        return self._works[name]()

    def __getattr__(self, name: str) -> Any:
        """Compute and cache a quantity at its first use."""
        if name not in QUANTITIES:
            raise AttributeError(name)
        value = self.found(name)
        object.__setattr__(self, name, value)
        return value

    def but(self, **quantities: Any) -> DriveOfRun:
        """Return a copy with these quantities replaced."""
        works: dict[str, Callable[[], Any]]
        works = {name: partial(getattr, self, name) for name in QUANTITIES}
        for name, value in quantities.items():
            works[name] = partial(_itself, value)
        return self.by(works)


def _itself(value: Any) -> Any:
    return value


_TURNED = ("yaw_rate", "castor_angle", "heading", "y")
"""Quantities of the body that have the other sign in a mirror."""


def mirrored(drive: Drive[Floats]) -> DriveOfRun:
    """The drive of the same robot seen in a mirror: left is right, and it turns the other way."""
    other_side = {"left": "right", "right": "left"}

    def work(name: str) -> Any:
        side, _, what = name.partition("_")
        if side in other_side:
            return getattr(drive, f"{other_side[side]}_{what}")
        value = getattr(drive, name)
        return Span(-value.start, -value.end) if name in _TURNED else value

    return DriveOfRun.by({name: partial(work, name) for name in QUANTITIES})


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
    track: float,
    first_angles: tuple[float, float] = (0.0, 0.0),
    channels: Mapping[str, Span[Floats]] | None = None,
    message: NDArray[np.intp] | None = None,
    rims: WheelTravel[Floats] | None = None,
) -> DriveOfRun:
    """Compute all steps of a run at once; the same as passing them to a `drive_memory.DriveMemory`.

    Arrays have shape (n,), as in `RawStep`. The pose is that of the counters alone, starting at
    zero (see `Drive.with_heading`, `Drive.with_place`).

    A message may be split into steps at a reference stamp. The mean speed over one part contains
    the error of that stamp: a stamp that is off would make the robot both faster and farther ahead,
    which looks like wheel slip. So both parts get the wheel speeds of the message. The speeds of
    the body stay those of the steps, unless the message is much too early: they sum exactly to the
    robot's path and turn.

    Parameters
    ----------
    message : ndarray, shape (n,), optional
        Index of the message in which each step ends, from 0 on, without gaps; by default, each step
        is a message.
    rims
        Speeds of the wheels' rims over each message [m/s], where something better than the counts
        tells them.
    """
    least = max(flicker, ROLLBACK)
    since = cache(partial(_shuttled, along, least))
    since_left, since_right = (cache(partial(_shuttled, side, least)) for side in (left, right))
    whole, of_step = _by_message(message)
    lasted = cache(partial(whole, duration))

    @cache
    def early() -> EarlySteps:
        rolled = whole(np.abs(left) + np.abs(right))
        return early_steps(lasted(), rolled, cut=message is not None)

    @cache
    def rim(side: Literal["left", "right"]) -> Floats:
        if rims is not None:
            return rims.left if side == "left" else rims.right
        return mean_speeds(whole(left if side == "left" else right), lasted(), early())

    @cache
    def smooth(side: Literal["left", "right"]) -> Span[Floats]:
        return _smooth(rim(side), lasted())

    def smooth_speed(side: Literal["left", "right"]) -> Span[Floats]:
        return Span(*map(of_step, smooth(side)))

    def of_body(travel: Floats) -> Span[Floats]:
        if message is None:
            return _lagged(mean_speeds(travel, duration, early()))
        speeds, too_early = travel / duration, np.isin(message, early().rows)
        if too_early.any():
            means = mean_speeds(whole(travel), lasted(), early())
            speeds[too_early] = means[message[too_early]]
        return _lagged(speeds)

    heading = cache(partial(_grown, 0.0, turn))

    @cache
    def places() -> list[Span[Floats]]:
        moved = displacement(BodyMotion(along, np.zeros_like(along), turn), heading().start)
        return [_grown(0.0, steps) for steps in moved]

    return DriveOfRun.by(
        {
            "duration": lambda: duration,
            "time": lambda: _grown(0.0, duration),
            "speed": lambda: of_body(along),
            "yaw_rate": lambda: of_body(turn),
            "left_speed": lambda: _lagged(of_step(rim("left"))),
            "right_speed": lambda: _lagged(of_step(rim("right"))),
            "left_smooth_speed": lambda: smooth_speed("left"),
            "right_smooth_speed": lambda: smooth_speed("right"),
            "left_acceleration": lambda: of_step(smooth("left").change / lasted()),
            "right_acceleration": lambda: of_step(smooth("right").change / lasted()),
            "left_angle": lambda: _grown(first_angles[0], left_angle),
            "right_angle": lambda: _grown(first_angles[1], right_angle),
            "distance": lambda: _grown(0.0, np.abs(along)),
            "left_since_reversal": lambda: since_left().since,
            "right_since_reversal": lambda: since_right().since,
            "since_reversal": lambda: since().since,
            "left_direction": lambda: since_left().direction,
            "right_direction": lambda: since_right().direction,
            "direction": lambda: since().direction,
            "reversals": lambda: since().reversals,
            "left_reversals": lambda: since_left().reversals,
            "right_reversals": lambda: since_right().reversals,
            "castor_angle": lambda: _grown(0.0, castor_swings(along, turn, track)),
            "heading": heading,
            "x": lambda: places()[0],
            "y": lambda: places()[1],
            "channels": lambda: channels or {},
        }
    )


Values = Callable[[Floats], Floats]


def _by_message(message: NDArray[np.intp] | None) -> tuple[Values, Values]:
    """Sums over messages of values of steps, and values of steps from those of their messages."""
    if message is None:
        return _itself, _itself
    return partial(_summed, message), lambda values: values[message]


def _summed(message: NDArray[np.intp], values: Floats) -> Floats:
    return np.asarray(np.bincount(message, values), dtype=np.float64)


class _Shuttled(NamedTuple):
    since: Span[Floats]
    direction: Floats
    reversals: Floats


def _grown(first: float, steps: Floats) -> Span[Floats]:
    """Cumulative sum before and after each step."""
    sums = np.concatenate([[first], steps])
    np.cumsum(sums, out=sums)
    return Span(sums[:-1], sums[1:])


def _lagged(means: Floats) -> Span[Floats]:
    """Mean of the previous step, and of this one; the first step uses its own for both."""
    both = np.concatenate([means[:1], means])
    return Span(both[:-1], both[1:])


def _smooth(means: Floats, duration: Floats) -> Span[Floats]:
    """Low-pass filter of the speeds; the same as `drive_memory.smoothed` message by message.

    Each message is an affine map of the previous value, `kept * before + rest`. Composing these
    maps gives those of two messages, four, eight, until `kept` vanishes.
    """
    kept = np.exp(-duration / SMOOTHING)
    rest = (1.0 - kept) * means
    steps = 1
    while steps < means.size and np.any(kept[steps:] > 0.0):
        rest[steps:] += kept[steps:] * rest[:-steps]
        kept[steps:] = kept[steps:] * kept[:-steps]
        steps *= 2
    after = rest + kept * means[:1]
    return Span(np.concatenate([means[:1], after[:-1]]), after)


def _shuttled(travel: Floats, flicker: float) -> _Shuttled:
    """Travel since reversal over a whole run; the same as `drive_memory` step by step.

    Between reversals the farthest point is a running extreme.
    """
    position = np.cumsum(travel)
    size = position.size
    moved = np.flatnonzero(np.abs(position) > flicker)
    begins = [] if moved.size == 0 else [int(moved[0])]
    signs, turned_at = [0.0], [0.0]
    if begins:
        signs.append(1.0 if position[begins[0]] > 0.0 else -1.0)
        turned_at.append(0.0)
        for begin, at in _reversals(position, travel, begins[0], signs[1], flicker):
            begins.append(begin)
            signs.append(-signs[-1])
            turned_at.append(at)
    bounds = [0, *begins, size]
    counts = np.diff(bounds)
    direction = np.repeat(signs, counts)
    reversals = np.repeat(np.maximum(np.arange(-1.0, counts.size - 1), 0.0), counts)
    since = direction * (position - np.repeat(turned_at, counts))
    for first, last in pairwise(bounds):
        np.maximum.accumulate(since[first:last], out=since[first:last])
    before = np.concatenate([[0.0], since])[:-1]
    before[begins] = 0.0
    return _Shuttled(Span(before, since), direction, reversals)


def _reversals(
    position: Floats, travel: Floats, begin: int, sign: float, flicker: float
) -> Iterator[tuple[int, float]]:
    """Yield the first step of each reversal after `begin`, and the farthest point before it.

    Only where the travel changes its sign can a farthest point be, so the loop runs over these.
    """
    rolled = begin + np.flatnonzero(travel[begin:])
    ends = rolled[:-1][travel[rolled[:-1]] * travel[rolled[1:]] < 0.0]
    ends = np.append(ends, position.size - 1)
    first, farthest = begin, float(position[begin])
    for end, place in zip(ends.tolist(), position[ends].tolist(), strict=True):
        if sign * (place - farthest) > 0.0:
            farthest = place
        elif sign * (farthest - place) > flicker:
            beyond = sign * (farthest - position[first : end + 1]) > flicker
            yield first + int(beyond.argmax()), farthest
            sign, farthest = -sign, place
        first = end
