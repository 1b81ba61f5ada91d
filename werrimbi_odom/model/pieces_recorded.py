# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Segmentation of a recorded run into pieces: `OpenPiece.extend` in array operations.

Every comparison is that of `extend`, on the same sums added in the same order, so both cut at the
same step. Only the order of work differs, which cannot change the result: wheels are checked for
reversals only once they have turned back, and the arcs of several pieces are checked together,
after the wheels' travel alone has cut them. Where a pose is off its arc, the rest is cut again.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.compiled import of_floats
from werrimbi_odom.model.end_of_piece import NOTHING, PieceRule, allowed_lead, extended, off_arc
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pose import Floats, Pose

# Steps processed together; affects only the speed.
_FEW, _MANY = 64, 4096
_SOON = 32  # steps after which a wheel that turns back has usually exceeded the flicker
_SHORT = 8  # usual steps per piece below which following step by step is faster
_extended = of_floats(extended)
_WHEELS, _BODY = slice(0, 2), slice(2, 5)  # rows of the sums


@dataclass(frozen=True, slots=True)
class Cut:
    """A whole run cut into pieces.

    `start` is the first step of every piece, shape (m,). `travel` and `motion` are the sums from
    the start of each step's piece to the step's end, shape (n,).
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
    """Cut a run where `OpenPiece` does.

    `travel`, `motion` (n,): the steps. `x`, `y`, `yaw` (n + 1,): pose before the first step and
    after each step. `broken` (n,): steps that must start a piece (travel was lost before them).
    """
    cutter = _Cutter(rule, travel, motion, x, y, yaw)
    begin = 0
    with np.errstate(divide="ignore", invalid="ignore"):  # no slope before the first motion
        for end in [*np.flatnonzero(broken).tolist(), x.size - 1]:
            if begin < end:
                cutter.cut(begin, end)
                begin = end
    left, right, along, sideways, turn = cutter.sums
    return Cut(
        np.array(cutter.starts, dtype=np.intp),
        WheelTravel(left, right),
        BodyMotion(along, sideways, turn),
    )


class _Cutter:
    """The pieces so far, and the state of the last one."""

    def __init__(
        self,
        rule: PieceRule,
        travel: WheelTravel[Floats],
        motion: BodyMotion[Floats],
        x: Floats,
        y: Floats,
        yaw: Floats,
    ) -> None:
        self.rule = rule
        self.x, self.y, self.yaw = x, y, yaw
        self.steps = np.stack([*travel, *motion])
        self.sums = np.empty_like(self.steps)
        """Sums from the piece's start to the end of each step; overwritten where pieces are
        recut."""
        self.starts: list[int] = []
        self._travelled: list[float] = []  # travel u before each piece
        self._wheels = [_Wheel(steps, rule.flicker) for steps in travel]
        self._usual = _FEW
        self._bounds = -math.inf, math.inf

    def cut(self, begin: int, end: int) -> None:
        """Cut the steps from `begin` to before `end`; the first of them starts a piece."""
        self._open(begin)
        ahead = _FEW
        while begin < end:
            last = self.starts[-1]
            if self._usual < _SHORT and begin < last + _FEW:
                begin, ahead = self._follow_one_by_one(last, min(last + _MANY, end)), _FEW
            stop = begin
            while stop < min(begin + ahead, end):
                stop = self._follow_wheels(stop, end)
            off = self._first_off_arc(begin, stop)
            if off < stop:
                self._forget_after(off)
                begin, ahead = off, max(ahead // 4, _FEW)
            else:
                begin, ahead = stop, min(2 * ahead, _MANY)

    def _open(self, start: int) -> None:
        """Start a piece."""
        before = 0.0
        if self.starts:
            left, right = self.sums[_WHEELS, start - 1].tolist()
            before = self._travelled[-1] + (abs(left) + abs(right))
            self._usual = (self._usual + start - self.starts[-1]) // 2
        self.starts.append(start)
        self._travelled.append(before)
        self._bounds = -math.inf, math.inf
        for wheel in self._wheels:
            wheel.begin(start)

    def _forget_after(self, start: int) -> None:
        """Start a piece at an earlier step than the last piece's."""
        while self.starts[-1] > start:
            self.starts.pop()
            self._travelled.pop()
        self._open(start)

    def _follow_one_by_one(self, begin: int, end: int) -> int:
        """Follow the piece that starts at `begin`, and short ones after it, step by step.

        Returns the first step of the last piece, which must be followed again because it was cut
        off.
        """
        sums = []
        stretch, earlier, before = NOTHING, self._travelled[-1], len(self.starts)
        poses = [part[begin : end + 1].tolist() for part in (self.x, self.y, self.yaw)]
        start, *ends = map(Pose, *poses)
        last = start
        steps = zip(ends, *self.steps[:, begin:end].tolist(), strict=True)
        for step, (pose, left, right, *body) in enumerate(steps, begin):
            travel, motion = WheelTravel(left, right), BodyMotion(*body)
            goes_on, longer = _extended(self.rule, start, earlier, stretch, travel, motion, pose)
            if not goes_on:
                earlier, start = earlier + stretch.travelled, last
                self.starts.append(step)
                self._travelled.append(earlier)
                longer = _extended(self.rule, start, earlier, NOTHING, travel, motion, pose)[1]
            stretch, last = longer, pose
            sums.append((stretch.left, stretch.right, *stretch.motion))
        self.sums[:, begin:end] = np.array(sums).T
        usual = (end - begin) // (len(self.starts) - before + 1)
        begin = self.starts.pop()
        self._travelled.pop()
        self._open(begin)
        self._usual = usual
        return begin

    def _follow_wheels(self, begin: int, limit: int) -> int:
        """Follow the open piece from the step `begin` as long as its wheels stay on one line.

        Where they leave it, the next piece starts. Returns the step to continue with.
        """
        start = self.starts[-1]
        likely_end = min(wheel.next_reversal(begin) for wheel in self._wheels) + _SOON
        block = min(max(4 * self._usual, begin - start), likely_end - begin, _MANY)
        end = min(begin + max(block, _FEW), limit)
        travel = self._summed(_WHEELS, begin, end)
        left, right = np.abs(travel)
        u, v = left + right, right - left
        lead = self._allowed_lead(u)
        low, high = (v - lead) / u, (v + lead) / u
        low[0], high[0] = max(low[0], self._bounds[0]), min(high[0], self._bounds[1])
        low, high = np.maximum.accumulate(low), np.minimum.accumulate(high)
        slope = v / u  # NaN before the first motion, so every comparison is false
        bad = (slope < low) | (slope > high)
        for wheel, travelled in zip(self._wheels, travel, strict=True):
            wheel.mark_reversed(bad, travelled, begin)
        if begin == start:
            bad[0] = False
        good = _until(bad)
        if good:
            self._summed(_BODY, begin, begin + good)
        if good < bad.size:
            self._open(begin + good)
        else:
            self._bounds = float(low[-1]), float(high[-1])
        return begin + good

    def _summed(self, rows: slice, begin: int, end: int) -> Floats:
        """Sums of the open piece to the end of each step from `begin` to before `end`."""
        steps = self.steps[rows, begin:end]
        if begin > self.starts[-1]:
            steps = steps.copy()
            steps[:, 0] += self.sums[rows, begin - 1]
        return np.add.accumulate(steps, axis=1, out=self.sums[rows, begin:end])

    def _allowed_lead(self, u: Floats) -> Floats | float:
        if self._travelled[-1] >= self.rule.settled:
            return allowed_lead(self.rule, 1.0)
        return allowed_lead(self.rule, self._share(self._travelled[-1] + u))

    def _share(self, travelled: Floats) -> Floats:
        """Share of the full tolerance after travel u since the start of the run."""
        return np.minimum(1.0, travelled / self.rule.settled)

    def _first_off_arc(self, begin: int, end: int) -> int:
        """First step after which the pose is off its piece's arc; `end` if there is none."""
        first = bisect_right(self.starts, begin) - 1
        starts = np.array(self.starts[first:])
        lengths = np.diff([begin, *self.starts[first + 1 :], end])
        start = np.repeat(starts, lengths)
        travelled = np.repeat(self._travelled[first:], lengths)
        left, right, *motion = self.sums[:, begin:end]
        u = np.abs(left) + np.abs(right)
        dx, dy = displacement(BodyMotion(*motion), self.yaw[start])
        miss_x = self.x[begin + 1 : end + 1] - self.x[start] - dx
        miss_y = self.y[begin + 1 : end + 1] - self.y[start] - dy
        off = off_arc(self.rule, u, self._share(travelled + u), miss_x, miss_y) > 0.0
        off[starts[(starts >= begin) & (starts < end)] - begin] = False
        return begin + _until(off)


class _Wheel:
    """Turning points of one wheel, computed in advance; and its range over the open piece."""

    def __init__(self, travel: Floats, flicker: float) -> None:
        self._flicker = flicker
        moving = np.flatnonzero(travel)
        backwards = np.signbit(travel[moving])
        turns = moving[1:][backwards[1:] != backwards[:-1]]
        position = np.cumsum(travel)
        soon = np.minimum(turns + _SOON, travel.size) - 1
        lasting = np.abs(position[soon] - position[turns - 1]) > flicker
        self._turns: list[int] = [*turns.tolist(), travel.size]
        """Steps against the previous direction, flicker or reversal; the last entry lies behind the
        run."""
        self._reversals: list[int] = [*turns[lasting].tolist(), travel.size]
        """Those that are probably not flicker, as far as the next steps show."""
        self._next_turn = 0
        self._span = 0.0, 0.0

    def next_reversal(self, step: int) -> int:
        """Next step after this one at which the wheel probably reverses."""
        return self._reversals[bisect_right(self._reversals, step)]

    def begin(self, start: int) -> None:
        """Start a piece."""
        self._next_turn = self._turns[bisect_right(self._turns, start)]
        self._span = 0.0, 0.0

    def mark_reversed(self, bad: NDArray[np.bool_], travel: Floats, begin: int) -> None:
        """Mark in `bad` where the wheel has reversed, given its travel from the step `begin` on."""
        one_way = min(max(self._next_turn - begin, 0), travel.size)
        if one_way:
            last = float(travel[one_way - 1])
            self._span = min(self._span[0], last), max(self._span[1], last)
        if one_way == travel.size:
            return
        rest, flicker = travel[one_way:], self._flicker
        lowest, highest = self._span
        if highest > flicker:  # moving forwards so far; a fall back is a reversal
            highs = np.maximum.accumulate(np.maximum(rest, highest))
            bad[one_way:] |= rest < highs - flicker
            self._span = lowest, float(highs[-1])
        elif lowest < -flicker:
            lows = np.minimum.accumulate(np.minimum(rest, lowest))
            bad[one_way:] |= rest > lows + flicker
            self._span = float(lows[-1]), highest
        else:
            highs = np.maximum.accumulate(np.maximum(rest, highest))
            lows = np.minimum.accumulate(np.minimum(rest, lowest))
            forwards = (lows >= -flicker) & (rest >= highs - flicker)
            backwards = (highs <= flicker) & (rest <= lows + flicker)
            bad[one_way:] |= ~(forwards | backwards)
            self._span = float(lows[-1]), float(highs[-1])


def _until(bad: NDArray[np.bool_]) -> int:
    """Number of entries before the first bad one."""
    first = int(bad.argmax())
    return first if bad[first] else bad.size
