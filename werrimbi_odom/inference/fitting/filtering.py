# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Kalman filter from one reference pose to the next, vectorised over stretches of legs.

A long run is cut into stretches. Where the reference gives a full pose, the filter may restart from
it, which loses what the poses before tell of where the robot is: that of about one leg of 0.25 m,
but of thirty that end at every pose (of 2 cm, with poses to 1 mm and 2 mrad). So an hour of driving
takes as many iterations of the loop as a minute.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.leg_loop import Loop, both_of, run_loop
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.pose import Floats

STRETCH = 300
"""Least number of legs after which the filter may restart. With 100, effects that are seen sideways
or in heading (a mount askew, a slip in curves, a gyro's drift) showed two thirds of what a filter
shows that never restarts, with 300 all but a thirtieth."""

SIDE_BY_SIDE = 50
"""Approximate number of stretches of a long record."""


class FilterInput(NamedTuple):
    """Inputs of the filter for m legs and g sets of variances."""

    relative: Floats
    """Predicted relative pose, (m, 3), each in the frame of its own start."""
    noise: Floats
    """Process noise: covariance of the relative pose, (g, m, 3, 3)."""
    start: Floats
    """Measured pose at the start of each leg, (m, 3), NaN where not measured."""
    finish: Floats
    """Measured pose at the end of each leg."""
    reading: Floats
    """Measurement covariance of the pose at each leg's end, (g, m, 3, 3); (g, 1, 3, 3) if constant.

    It also stands for that at the leg's start."""
    begins: NDArray[np.bool_]
    """Legs at which the filter must restart: the first of each run, (m,)."""
    skip: NDArray[np.bool_]
    """Gaps, and legs on which the reference jumped, (m,)."""
    heading: Floats
    """Start heading of a run where it was not measured, at its first leg, (m,)."""
    stretch: int = STRETCH


class Ways(NamedTuple):
    """Linear map from perturbations of the legs to innovations, for the first set of variances.

    Rows are in the order of the filter's loop: the first legs of all stretches, then the second
    legs, and so on. The filter has s states, the first three of which are the pose.
    """

    leg: NDArray[np.intp]
    """Index of the leg of each row, (m,)."""
    enter: Floats
    """Map from a perturbation of the leg to the states, (m, s, 3)."""
    carry: Floats
    """State transition from the end of the previous leg to the end of this one, (m, s, s)."""
    leave: Floats
    """Map from the state perturbation at the leg's end to the innovation, (m, 3, s)."""
    free: NDArray[np.bool_]
    """Stretches that start with a heading that was not measured."""
    bounds: NDArray[np.intp]
    """First row of each iteration of the loop, and the end of the last, (r + 1,)."""

    def innovations(self, slopes: Floats) -> Floats:
        """Jacobian of the innovations (m, 3, w + 1) from that of the relative poses (m, 3, w).

        The last column is for the start heading of the run.
        """
        count, _, width = slopes.shape
        states = self.carry.shape[-1]
        found = np.empty((count, 3, width + 1))
        for begin in range(0, width + 1, _COLUMNS):
            columns = slice(begin, min(begin + _COLUMNS, width))
            change = self.enter @ slopes[self.leg, :, columns]
            if columns.stop < begin + _COLUMNS:
                first = slice(0, self.bounds[1])
                heading = np.zeros((count, states, 1))
                heading[first, :, 0] = self.carry[first, :, 2] * self.free[:, None]
                change = np.concatenate([change, heading], axis=-1)
            found[self.leg, :, begin : begin + _COLUMNS] = self._left_by(change)
        return found

    def _left_by(self, change: Floats) -> Floats:
        """Jacobian of the innovations (m, 3, p) from that of the states (m, s, p), loop order."""
        carry_on(self.carry, self.bounds, change)
        return np.asarray(self.leave @ change)

    def of_states(self, change: Floats) -> Floats:
        """Jacobian of the innovations (m, 3, p) for perturbations added to the states (m, s, p).

        Perturbations are in the axes of the states.
        """
        found = np.empty((change.shape[0], 3, change.shape[-1]))
        found[self.leg] = self._left_by(change[self.leg])
        return found

    def shocks(self, weighed: Floats, precision: Floats) -> Shocks:
        """Score and information of a shock to the states in a single leg, for every leg.

        This is the adjoint of the filter loop (de Jong and Penzer, "Diagnosing shocks in time
        series", J. Am. Stat. Assoc. 93, 1998), so all legs are tested in one backward pass.
        `weighed` (m, 3): `precision` times the innovations. `precision` (m, 3, 3): inverse of their
        covariance; zero for coordinates that were not measured.
        """
        seen = self.leave.swapaxes(-1, -2)
        score = -(seen @ weighed[self.leg, :, None])[..., 0]
        known = seen @ precision[self.leg] @ self.leave
        both = np.zeros_like(known)
        for last, now in reversed(list(rows_before(self.bounds))):
            back = self.carry[now].swapaxes(-1, -2)
            score[last] += (back @ score[now][..., None])[..., 0]
            both[last] = back @ known[now]
            known[last] += both[last] @ self.carry[now]
        found = Shocks(*(np.empty_like(part) for part in (score, known, both, self.enter)))
        for part, ordered in zip(found, (score, known, both, self.enter), strict=True):
            part[self.leg] = ordered
        return found


class Shocks(NamedTuple):
    """Score and information of a shock to the s states in each of m legs."""

    score: Floats
    """Derivative of the log-likelihood in the shock, (m, s)."""
    known: Floats
    """Fisher information of the shock, (m, s, s)."""
    both: Floats
    """Cross information of shocks in this leg and the next, (m, s, s); zero where none follows."""
    enter: Floats
    """Rotation from the robot's axes at the leg's start to those of the states, (m, s, 3)."""


_COLUMNS = 32
"""Columns of derivatives per block, which fits the processor's cache."""


class FilterResult(NamedTuple):
    """Innovations in the frame of the robot at each leg's start."""

    value: Floats
    """Shape (g, m, 3), zero where nothing was measured."""
    covariance: Floats
    """Shape (g, m, 3, 3)."""
    ways: Ways
    """Linear map from perturbations of the legs to the innovations."""


def stretches(legs: FilterInput) -> NDArray[np.intp]:
    """First leg of each stretch."""
    length = max(legs.stretch, legs.begins.size // SIDE_BY_SIDE)
    starts = []
    bounds = np.append(np.flatnonzero(legs.begins), legs.begins.size)
    for begin, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        starts.append(begin)
        for wanted in range(begin + length, end - length // 2, length):
            if np.isfinite(legs.start[wanted]).all():
                starts.append(wanted)
    return np.array(starts, dtype=np.intp)


def in_rounds(legs: FilterInput) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """First legs of the stretches, longest first; legs in loop order; `Ways.bounds`.

    Loop order is the first legs of all stretches, then the second legs of those that have one, ...
    """
    first = stretches(legs)
    length = np.diff(np.append(first, legs.relative.shape[0]))
    order = np.argsort(-length, kind="stable")
    first, length = first[order], length[order]
    active = np.searchsorted(-length, -np.arange(length[0]))
    bounds = np.concatenate([[0], np.cumsum(active)])
    step = np.repeat(np.arange(active.size), active)
    leg = first[np.arange(step.size) - bounds[step]] + step
    return first, leg, bounds


def filtered(legs: FilterInput) -> FilterResult:
    """Run the filter over all stretches at once.

    States and covariances go through the loop for all sets of variances. Their effect on
    derivatives is one matrix per leg, so a second loop with one product propagates these.
    """
    sets, count = legs.noise.shape[0], legs.relative.shape[0]
    first, leg, bounds = in_rounds(legs)
    finite = np.isfinite(legs.start[first])
    free = ~finite[:, 2]
    state = np.where(finite, legs.start[first], 0.0)
    state[:, 2] = np.where(free, np.nan_to_num(legs.heading[first]), state[:, 2])
    alike = legs.reading.shape[1] == 1
    spread = (legs.reading if alike else legs.reading[:, first]) * both_of(finite)
    known = np.isfinite(legs.finish)
    of = Loop(
        leg,
        bounds,
        state,
        spread,
        legs.relative,
        legs.noise,
        np.where(known, legs.finish, 0.0),
        known,
        legs.skip,
        legs.reading,
        values=np.empty((sets, count, 3)),
        covariances=np.empty((sets, count, 3, 3)),
        turns=np.empty((count, 3, 3)),
        carry=np.empty((count, 3, 3)),
    )
    run_loop(of)
    counted = (known & ~legs.skip[:, None])[leg]
    leave = -of.turns.swapaxes(-1, -2) * counted[:, None]
    return FilterResult(
        of.values, of.covariances, Ways(leg, of.turns, of.carry, leave, free, bounds)
    )


def rows_before(bounds: NDArray[np.intp]) -> Iterator[tuple[slice, slice]]:
    """Of each round but the first: the rows of the legs before its own, and its own."""
    for before, begin, end in zip(bounds[:-2], bounds[1:-1], bounds[2:], strict=True):
        yield slice(before, before + end - begin), slice(begin, end)


def carry_on(carry: Floats, bounds: NDArray[np.intp], change: Floats) -> None:
    """Add to changes of the states (m, s, p), in the order of the rounds, those of the legs before.

    The faster way: `carried_in_scalars`, or array by array.
    """
    machine = compiled(carried_in_scalars)
    if machine is not None:
        machine(carry, bounds, change)
        return
    for last, now in rows_before(bounds):
        change[now] += carry[now] @ change[last]


def carried_in_scalars(carry: Floats, bounds: NDArray[np.intp], change: Floats) -> None:
    """`carry_on`, number by number."""
    states, columns = change.shape[1], change.shape[2]
    for step in range(1, bounds.size - 1):
        back = bounds[step] - bounds[step - 1]
        for row in range(bounds[step], bounds[step + 1]):
            for to in range(states):
                for by in range(states):
                    share = carry[row, to, by]
                    if share != 0.0:
                        for column in range(columns):
                            change[row, to, column] += share * change[row - back, by, column]
