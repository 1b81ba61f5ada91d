# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Gaps: stretches in which reference or ticks are silent while the robot moves. No leg spans one.

Causes are a tracker that lost the robot, or a bag that lost messages. A leg over such a stretch
would be longer than it is said to be, and its error would look like a jump of the reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Why
from werrimbi_odom.inference.rules import GAP_FEWEST, GAP_INTERVALS, GAP_LEG, GAP_WAYS
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True, slots=True)
class LeftOut:
    """A stretch of a run that is excluded from comparisons and fits."""

    run: Path
    """Path as given by the user."""
    begin: float
    """Time in the run's own clock [s]."""
    end: float
    why: Why
    words: str
    """What happened, as a sentence without its end mark: the reference is silent ..."""
    started: float = 0.0
    """First tick of the run [s]; reported times are relative to it where stamps are times of
    day."""


def are_gaps(
    duration: Floats, way: Floats, usual_duration: float, usual_way: float
) -> NDArray[np.bool_]:
    """Classify intervals as gaps.

    Parameters
    ----------
    duration, usual_duration
        Durations of the intervals, and the usual duration of those with travel [s].
    way, usual_way
        Travel in the intervals, and the usual travel of those with any, in legs.
    """
    long = (duration > GAP_INTERVALS * usual_duration) & (way > GAP_WAYS * usual_way)
    return np.asarray(long & (way >= GAP_LEG))


def gaps_in(time: Floats, way: Floats) -> NDArray[np.bool_]:
    """Find which intervals are gaps, shape (n - 1,).

    Parameters
    ----------
    time : ndarray, shape (n,)
        Stamps [s].
    way : ndarray, shape (n,)
        Cumulative travel at each stamp, in legs.
    """
    duration, gone = np.diff(time), np.diff(way)
    moving = gone > 0.0
    if not (gone >= GAP_LEG).any() or np.count_nonzero(moving) < GAP_FEWEST:
        return np.zeros(duration.shape, dtype=np.bool_)
    usual = float(np.median(duration[moving])), float(np.median(gone[moving]))
    return are_gaps(duration, gone, *usual)


def touched(time: Floats, stretches: Sequence[tuple[float, float]]) -> NDArray[np.bool_]:
    """Intervals between stamps (n,) that overlap a stretch by more than an instant, (n - 1,)."""
    found = np.zeros(max(time.size - 1, 0), dtype=np.bool_)
    for begin, end in stretches:
        first = max(int(np.searchsorted(time, begin, side="right")) - 1, 0)
        found[first : int(np.searchsorted(time, end, side="left"))] = True
    return found
