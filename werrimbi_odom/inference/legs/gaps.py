# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stretches of a recording that no leg may span: where reference or ticks fell silent on the way.

A tracker that lost the robot, a bag that lost messages: over such a stretch a leg would be longer
than it is said to be, and its error no jump of the reference, but that of a longer way.
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
    """A stretch of a run that is no part of any comparison or fit."""

    run: Path
    """As it was given."""
    begin: float
    """In the run's own clock [s]."""
    end: float
    why: Why
    words: str
    """What happened then, as the end of a sentence: the reference is silent ..."""
    started: float = 0.0
    """First tick of the run [s]: what is told of one that is stamped by the time of day is told
    from there."""


def are_gaps(
    duration: Floats, way: Floats, usual_duration: float, usual_way: float
) -> NDArray[np.bool_]:
    """Which of some intervals are gaps.

    Parameters
    ----------
    duration, usual_duration
        Of the intervals, and of most in which there is travel [s].
    way, usual_way
        What was gone in them, and in most of those, in legs.
    """
    long = (duration > GAP_INTERVALS * usual_duration) & (way > GAP_WAYS * usual_way)
    return np.asarray(long & (way >= GAP_LEG))


def gaps_in(time: Floats, way: Floats) -> NDArray[np.bool_]:
    """Which intervals are gaps, shape (n - 1,).

    Parameters
    ----------
    time : ndarray, shape (n,)
        Stamps [s].
    way : ndarray, shape (n,)
        What was gone up to each, in legs.
    """
    duration, gone = np.diff(time), np.diff(way)
    moving = gone > 0.0
    if not (gone >= GAP_LEG).any() or np.count_nonzero(moving) < GAP_FEWEST:
        return np.zeros(duration.shape, dtype=np.bool_)
    usual = float(np.median(duration[moving])), float(np.median(gone[moving]))
    return are_gaps(duration, gone, *usual)


def touched(time: Floats, stretches: Sequence[tuple[float, float]]) -> NDArray[np.bool_]:
    """Which intervals between stamps (n,) share more than an instant with a stretch, (n - 1,)."""
    found = np.zeros(max(time.size - 1, 0), dtype=np.bool_)
    for begin, end in stretches:
        first = max(int(np.searchsorted(time, begin, side="right")) - 1, 0)
        found[first : int(np.searchsorted(time, end, side="left"))] = True
    return found
