# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Monotone cubic interpolation, of counts between messages."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats


def between_messages(time: Floats, known: Floats, *columns: Floats) -> Floats:
    """Interpolate columns known at the instants `known` (k,) at times (n,); shape (n, columns).

    Between messages the counts follow a monotone cubic. Linear interpolation would cut the corners
    of every start and stop, by a millimetre for a robot that brakes at 1 m/s² and is read at 10 Hz;
    a smoother curve would overshoot the counts. Before the first message and after the last the
    robot stands. Slopes at the messages are those of Fritsch and Butland (SIAM J. Sci. Stat.
    Comput. 5, 1984), computed only where needed.
    """
    before, width, share = interval_of(time, known)
    rest = 1.0 - share
    found = []
    for values in columns:
        start, end = _slope(known, values, before), _slope(known, values, before + 1)
        first, last = values[before], values[before + 1]
        found.append(
            first * rest * rest * (1.0 + 2.0 * share)
            + last * share * share * (3.0 - 2.0 * share)
            + width * share * rest * (start * rest - end * share)
        )
    return np.stack(found, axis=-1)


def missed_at(known: Floats, values: Floats) -> Floats:
    """How far each value (k,) is from what is interpolated between the others; the ends are 0."""
    missed = np.zeros(known.size)
    odd = np.arange(known.size) % 2 == 1
    for out in (odd, ~odd):
        out = out & (known > known[0]) & (known < known[-1])
        between = between_messages(known[out], known[~out], values[~out])[:, 0]
        missed[out] = np.abs(values[out] - between)
    return missed


def interval_of(time: Floats, known: Floats) -> tuple[NDArray[np.intp], Floats, Floats]:
    """Interval of each time (n,): index and width, and what share of it has gone by."""
    within = np.clip(time, known[0], known[-1])
    before = np.clip(np.searchsorted(known, within, side="right") - 1, 0, known.size - 2)
    width = known[before + 1] - known[before]
    return before, width, (within - known[before]) / width


def _slope(time: Floats, values: Floats, at: NDArray[np.intp]) -> Floats:
    """Slopes of the monotone cubic at some of its knots."""
    last = time.size - 1

    def step(index: NDArray[np.intp]) -> tuple[Floats, Floats]:
        """Width and slope of the intervals that begin at some knots."""
        here = np.clip(index, 0, last - 1)
        width = time[here + 1] - time[here]
        return width, (values[here + 1] - values[here]) / width

    if last == 1:
        return step(at)[1]
    (behind, slope_behind), (ahead, slope_ahead) = step(at - 1), step(at)
    one, other = 2.0 * ahead + behind, ahead + 2.0 * behind
    alike = slope_behind * slope_ahead > 0.0
    slope_behind, slope_ahead = (np.where(alike, part, 1.0) for part in (slope_behind, slope_ahead))
    slope = np.where(alike, (one + other) / (one / slope_behind + other / slope_ahead), 0.0)
    begins, ends = at == 0, at == last
    for edge, near, next_one in ((begins, 0, 1), (ends, last - 1, last - 2)):
        if edge.any():
            slope[edge] = _at_edge(*step(np.array([near])), *step(np.array([next_one])))
    return slope


def _at_edge(near: Floats, slope: Floats, other: Floats, other_slope: Floats) -> Floats:
    """Slope at the first or last knot: that of a parabola, limited to stay monotone."""
    found = ((2.0 * near + other) * slope - near * other_slope) / (near + other)
    found = np.where(np.sign(found) != np.sign(slope), 0.0, found)
    steep = (np.sign(slope) != np.sign(other_slope)) & (np.abs(found) > 3.0 * np.abs(slope))
    return np.where(steep, 3.0 * slope, found)
