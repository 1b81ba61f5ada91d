# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What effects may look at in all steps of a recorded run at once."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.drive import ROLLBACK, Drive, Span
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Floats


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
    """All steps of a run at once; the same as feeding them to a `drive_memory.DriveMemory`.

    Arrays have shape (n,), as in `RawStep`. The pose is that of the counters alone, from zero on
    (`Drive.with_heading`, `Drive.with_place`).
    """
    least = max(flicker, ROLLBACK)
    middle = _shuttled(along, least)
    left_side, right_side = _shuttled(left, least), _shuttled(right, least)
    heading = _grown(0.0, turn)
    dx, dy = displacement(BodyMotion(along, np.zeros_like(along), turn), heading.start)
    return Drive(
        duration=duration,
        time=_grown(0.0, duration),
        speed=_lagged(along / duration),
        yaw_rate=_lagged(turn / duration),
        left_speed=_lagged(left / duration),
        right_speed=_lagged(right / duration),
        left_angle=_grown(first_angles[0], left_angle),
        right_angle=_grown(first_angles[1], right_angle),
        distance=_grown(0.0, np.abs(along)),
        left_since_reversal=left_side.since,
        right_since_reversal=right_side.since,
        since_reversal=middle.since,
        left_direction=left_side.direction,
        right_direction=right_side.direction,
        direction=middle.direction,
        reversals=middle.reversals,
        left_reversals=left_side.reversals,
        right_reversals=right_side.reversals,
        heading=heading,
        x=_grown(0.0, dx),
        y=_grown(0.0, dy),
        channels=channels or {},
    )


def with_wheels_of_messages(drive: Drive[Floats], message: NDArray[np.intp]) -> Drive[Floats]:
    """The same with each step's speeds of the wheels those of the message that it is a part of.

    Where a message is cut in two, at an instant that somebody else measured, the counters say no
    more of either part: a mean over a part has the error of where it was cut in it, so that a stamp
    which is off would make the robot fast and far ahead at once, as wheels that slip do. Those of
    the body stay the step's: what they add up to is the robot's path and turn, to the last digit.

    Parameters
    ----------
    message : ndarray, shape (n,)
        Number of the message in which each step ends, counted from any.
    """
    message = message - message[0]
    lasted = np.bincount(message, drive.duration)

    def of_messages(span: Span[Floats]) -> Span[Floats]:
        gone = np.bincount(message, span.end * drive.duration)
        return _lagged((gone / np.where(lasted > 0.0, lasted, 1.0))[message])

    return replace(
        drive,
        left_speed=of_messages(drive.left_speed),
        right_speed=of_messages(drive.right_speed),
    )


class _Shuttled(NamedTuple):
    since: Span[Floats]
    direction: Floats
    reversals: Floats


def _grown(first: float, steps: Floats) -> Span[Floats]:
    """Running sum before and after each step."""
    sums = np.cumsum(np.concatenate([[first], steps]))
    return Span(sums[:-1], sums[1:])


def _lagged(means: Floats) -> Span[Floats]:
    """Mean of the step before, and of the step; the first step has none before it."""
    return Span(np.concatenate([means[:1], means[:-1]]), means)


def _shuttled(travel: Floats, flicker: float) -> _Shuttled:
    """Travel since reversal over a whole run, as `drive_memory` has it step by step.

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
