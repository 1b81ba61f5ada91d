# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A Kalman filter from reference pose to reference pose, over many stretches of legs side by side.

A long run is cut into stretches: where the reference gives a full pose, the filter may start anew
from it at the price of one leg's worth of knowledge in many. So an hour of driving takes as many
rounds of the loop as a minute.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.leg_loop import Loop, both_of, go_along
from werrimbi_odom.model.pose import Floats

STRETCH = 100
"""Legs, at the least, after which the filter starts anew where it can."""

SIDE_BY_SIDE = 50
"""Stretches into which a long record is cut, about."""


class Legs(NamedTuple):
    """What the filter is to be told of m legs, for g sets of variances."""

    relative: Floats
    """Predicted relative pose, (m, 3), each in the frame of its own start."""
    noise: Floats
    """Covariance of it, (g, m, 3, 3)."""
    start: Floats
    """Measured pose at the legs' starts, (m, 3), NaN where not measured."""
    finish: Floats
    """Measured pose at their ends."""
    reading: Floats
    """Covariance of the measured pose at each leg's end, (g, m, 3, 3); (g, 1, 3, 3) if all alike.

    It stands for that at its start too."""
    begins: NDArray[np.bool_]
    """Where the filter must start anew: first legs of runs, (m,)."""
    skip: NDArray[np.bool_]
    """Legs on which the reference jumped, and gaps, (m,)."""
    heading: Floats
    """Heading at the start of a run where it was not measured, at the run's first leg, (m,)."""
    stretch: int = STRETCH


class Ways(NamedTuple):
    """How a change of a leg's relative pose comes to the innovations, for the first set.

    All in the order of the filter's loop: the first legs of all stretches, the second legs ... The
    filter has s states, the first three of which are the pose.
    """

    leg: NDArray[np.intp]
    """Which leg it is, (m,)."""
    enter: Floats
    """Turns its change into one of the states, (m, s, 3)."""
    carry: Floats
    """Takes the change at the end of the leg before to the end of this one, (m, s, s)."""
    leave: Floats
    """Makes the change of the innovation of the change at the leg's end, (m, 3, s)."""
    free: NDArray[np.bool_]
    """Stretches that begin with a heading that was not measured."""
    rounds: list[slice]
    """Of the loop."""

    def innovations(self, slopes: Floats) -> Floats:
        """Derivatives (m, 3, w + 1) for those of the legs' relative poses (m, 3, w).

        The last one is in the run's start heading.
        """
        count, _, width = slopes.shape
        states = self.carry.shape[-1]
        found = np.empty((count, 3, width + 1))
        for begin in range(0, width + 1, _COLUMNS):
            columns = slice(begin, min(begin + _COLUMNS, width))
            change = self.enter @ slopes[self.leg, :, columns]
            if columns.stop < begin + _COLUMNS:
                first = self.rounds[0]
                heading = np.zeros((count, states, 1))
                heading[first, :, 0] = self.carry[first, :, 2] * self.free[:, None]
                change = np.concatenate([change, heading], axis=-1)
            found[self.leg, :, begin : begin + _COLUMNS] = self._left_by(change)
        return found

    def _left_by(self, change: Floats) -> Floats:
        """Derivatives of the innovations (m, 3, p) for those of the states (m, s, p); in order."""
        for before, now in itertools.pairwise(self.rounds):
            last = slice(before.start, before.start + now.stop - now.start)
            change[now] += self.carry[now] @ change[last]
        return np.asarray(self.leave @ change)

    def of_states(self, change: Floats) -> Floats:
        """Derivatives of the innovations (m, 3, p) for what comes to the states in legs, (m, s, p).

        That is in the axes of the states themselves.
        """
        found = np.empty((change.shape[0], 3, change.shape[-1]))
        found[self.leg] = self._left_by(change[self.leg])
        return found

    def shocks(self, weighed: Floats, precision: Floats) -> Shocks:
        """What the innovations say of a change of the states in one leg alone, for every leg.

        The same loop backwards (its adjoint): de Jong and Penzer, "Diagnosing shocks in time
        series", J. Am. Stat. Assoc. 93, 1998. So all legs are asked at the cost of one pass.

        Parameters
        ----------
        weighed : ndarray, shape (m, 3)
            Innovations times `precision`.
        precision : ndarray, shape (m, 3, 3)
            Inverse of their covariance; zero in what was not measured.
        """
        seen = self.leave.swapaxes(-1, -2)
        score = -(seen @ weighed[self.leg, :, None])[..., 0]
        known = seen @ precision[self.leg] @ self.leave
        both = np.zeros_like(known)
        for before, now in reversed(list(itertools.pairwise(self.rounds))):
            last = slice(before.start, before.start + now.stop - now.start)
            back = self.carry[now].swapaxes(-1, -2)
            score[last] += (back @ score[now][..., None])[..., 0]
            both[last] = back @ known[now]
            known[last] += both[last] @ self.carry[now]
        found = Shocks(*(np.empty_like(part) for part in (score, known, both, self.enter)))
        for part, ordered in zip(found, (score, known, both, self.enter), strict=True):
            part[self.leg] = ordered
        return found


class Shocks(NamedTuple):
    """Of a change of the filter's s states in each of m legs."""

    score: Floats
    """Derivative of the log-likelihood in the change, (m, s)."""
    known: Floats
    """Its information (minus the second derivative), (m, s, s)."""
    both: Floats
    """That between a change in this leg and one in the next, (m, s, s); zero where none follows."""
    enter: Floats
    """Turns the axes of the robot at a leg's start into those of the states, (m, s, 3)."""


_COLUMNS = 32
"""Of derivatives, at a time: what they take fits in the processor's cache."""


class Unexpected(NamedTuple):
    """Innovations in the frame of the robot at each leg's start."""

    value: Floats
    """(g, m, 3), zero where nothing was measured."""
    covariance: Floats
    """(g, m, 3, 3)."""
    ways: Ways
    """What changes of the legs do to them."""


def stretches(legs: Legs) -> NDArray[np.intp]:
    """First legs of the stretches."""
    length = max(legs.stretch, legs.begins.size // SIDE_BY_SIDE)
    full = np.all(np.isfinite(legs.start), axis=-1).tolist()
    starts = []
    bounds = np.append(np.flatnonzero(legs.begins), legs.begins.size)
    for begin, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        starts.append(begin)
        for wanted in range(begin + length, end - length // 2, length):
            if full[wanted]:
                starts.append(wanted)
    return np.array(starts, dtype=np.intp)


def in_rounds(legs: Legs) -> tuple[NDArray[np.intp], NDArray[np.intp], list[slice]]:
    """First legs of the stretches, longest stretch first; legs in the loop's order; its rounds.

    That is the first legs of all stretches, then the second of all that have one ...
    """
    first = stretches(legs)
    length = np.diff(np.append(first, legs.relative.shape[0]))
    order = np.argsort(-length, kind="stable")
    first, length = first[order], length[order]
    active = np.searchsorted(-length, -np.arange(length[0]))
    bounds = np.concatenate([[0], np.cumsum(active)]).tolist()
    leg = np.concatenate([first[:still] + step for step, still in enumerate(active)])
    return first, leg, [slice(begin, end) for begin, end in itertools.pairwise(bounds)]


def filtered(legs: Legs) -> Unexpected:
    """Filter all stretches at once.

    States and covariances go through the loop for all sets. What they do to the derivatives is a
    matrix for each leg, so these follow by a loop of one product.
    """
    sets, count = legs.noise.shape[0], legs.relative.shape[0]
    first, leg, rounds = in_rounds(legs)
    finite = np.isfinite(legs.start[first])
    free = ~finite[:, 2]
    state = np.where(finite, legs.start[first], 0.0)
    state[:, 2] = np.where(free, np.nan_to_num(legs.heading[first]), state[:, 2])
    alike = legs.reading.shape[1] == 1
    spread = (legs.reading if alike else legs.reading[:, first]) * both_of(finite)
    known = np.isfinite(legs.finish)
    of = Loop(
        leg,
        rounds,
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
    go_along(of)
    counted = (known & ~legs.skip[:, None])[leg]
    leave = -of.turns.swapaxes(-1, -2) * counted[:, None]
    return Unexpected(of.values, of.covariances, Ways(leg, of.turns, of.carry, leave, free, rounds))
