# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A recorded run cut into pieces: what `OpenPiece.extend` does step by step, in array operations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pieces import PieceRule
from werrimbi_odom.model.pose import Floats

_FIRST_BLOCK, _LARGEST_BLOCK = 64, 4096  # steps looked at together: few where pieces are short


@dataclass(frozen=True, slots=True)
class Cut:
    """A whole run cut into pieces.

    `start` has the first step of every piece, shape (m,); `travel` and `motion` have, for every
    step, the sums from the start of its piece to its end, shape (n,).
    """

    start: NDArray[np.intp]
    travel: WheelTravel[Floats]
    motion: BodyMotion[Floats]


def cut(
    rule: PieceRule,
    travel: WheelTravel[Floats],
    motion: BodyMotion[Floats],
    x: Floats,
    y: Floats,
    yaw: Floats,
    broken: NDArray[np.bool_],
) -> Cut:
    """Cut a run where `OpenPiece` would.

    Parameters
    ----------
    travel, motion : arrays of shape (n,)
        The steps.
    x, y, yaw : ndarray, shape (n + 1,)
        Pose before the first step and after each step.
    broken : ndarray of bool, shape (n,)
        Steps that must begin a piece (travel was lost before them).
    """
    run = _Run(rule, np.stack([*travel, *motion]), x, y, yaw)
    ends = np.append(np.flatnonzero(broken), x.size - 1).tolist()
    sums = np.empty_like(run.steps)
    starts: list[int] = []
    start, travelled = 0, 0.0
    for limit in ends:
        while start < limit:
            starts.append(start)
            start = _end_of_piece(run, sums, start, limit, travelled)
            travelled += float(abs(sums[0, start - 1]) + abs(sums[1, start - 1]))
    left, right, along, sideways, turn = sums
    return Cut(
        np.array(starts, dtype=np.intp),
        WheelTravel(left, right),
        BodyMotion(along, sideways, turn),
    )


@dataclass(frozen=True, slots=True)
class _Run:
    rule: PieceRule
    steps: Floats
    """Left, right, along, sideways, turn of each step, shape (5, n)."""
    x: Floats
    y: Floats
    yaw: Floats


def _end_of_piece(run: _Run, sums: Floats, start: int, limit: int, travelled: float) -> int:
    """First step after the piece that begins at `start`; fills its columns of `sums`."""
    rule = run.rule
    begin, block = start, _FIRST_BLOCK
    carry: Floats | None = None
    left_span = right_span = (0.0, 0.0)
    lowest, highest = -np.inf, np.inf
    while begin < limit:
        end = min(begin + block, limit)
        steps = run.steps[:, begin:end]
        if carry is not None:
            steps = steps.copy()
            steps[:, 0] += carry
        here = np.cumsum(steps, axis=1, out=sums[:, begin:end])
        left, right = here[0], here[1]
        size_left, size_right = np.abs(left), np.abs(right)
        u, v = size_left + size_right, size_right - size_left
        share = np.minimum(1.0, (travelled + u) / rule.settled)
        bad = _off_arc(run, here, start, begin, end, u, share)
        turned_left, left_span = _reversed(left, left_span, rule.flicker)
        turned_right, right_span = _reversed(right, right_span, rule.flicker)
        bad |= turned_left
        bad |= turned_right
        lead = rule.allowed_lead(share)
        with np.errstate(divide="ignore", invalid="ignore"):
            low = np.fmax.accumulate((v - lead) / u)
            high = np.fmin.accumulate((v + lead) / u)
            slope = v / u  # not a number before the first motion: every comparison is false
        bad |= slope < np.fmax(low, lowest)
        bad |= slope > np.fmin(high, highest)
        if begin == start:
            bad[0] = False
        first = int(bad.argmax())
        if bad[first]:
            return begin + first
        carry, begin = here[:, -1].copy(), end
        lowest, highest = np.fmax(low[-1], lowest), np.fmin(high[-1], highest)
        block = min(2 * block, _LARGEST_BLOCK)
    return limit


def _off_arc(
    run: _Run, sums: Floats, start: int, begin: int, end: int, u: Floats, share: Floats
) -> NDArray[np.bool_]:
    """Where the pose has left the arc that the sums describe."""
    dx, dy = displacement(BodyMotion(*sums[2:]), np.full(end - begin, run.yaw[start]))
    miss_x = run.x[begin + 1 : end + 1] - run.x[start] - dx
    miss_y = run.y[begin + 1 : end + 1] - run.y[start] - dy
    return run.rule.off_arc(u, share, miss_x, miss_y) > 0.0


def _reversed(
    travel: Floats, span: tuple[float, float], flicker: float
) -> tuple[NDArray[np.bool_], tuple[float, float]]:
    """Where a wheel has reversed, given its span so far; and the span at the end."""
    lowest = np.minimum(np.minimum.accumulate(travel), span[0])
    highest = np.maximum(np.maximum.accumulate(travel), span[1])
    forwards = (lowest >= -flicker) & (travel >= highest - flicker)
    backwards = (highest <= flicker) & (travel <= lowest + flicker)
    return ~(forwards | backwards), (float(lowest[-1]), float(highest[-1]))
