# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Gaps: stretches in which reference or ticks are silent while the robot moves. No leg spans one.

A reference that repeats one pose to the last digit is silent too: no robot that is held does so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import NoDriving, Reference, Why
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.measured_motion import runs_of
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

    `duration`, `usual_duration`: durations of the intervals, and the usual duration of those with
    travel [s]. `way`, `usual_way`: travel in the intervals, and the usual travel of those with any,
    in legs.
    """
    long = (duration > rules.GAP_INTERVALS * usual_duration) & (way > rules.GAP_WAYS * usual_way)
    return np.asarray(long & (way >= rules.GAP_LEG))


def gaps_in(time: Floats, way: Floats) -> NDArray[np.bool_]:
    """Find which intervals are gaps, shape (n - 1,).

    `time` (n,): stamps [s]. `way` (n,): cumulative travel at each stamp, in legs.
    """
    duration, gone = np.diff(time), np.diff(way)
    moving = gone > 0.0
    if not (gone >= rules.GAP_LEG).any() or np.count_nonzero(moving) < rules.GAP_FEWEST:
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


STUCK = "the reference repeated one pose to the last digit, and the wheels turned: it stood still"


def as_stuck(part: NoDriving, reference: Reference) -> NoDriving:
    """Put a stretch down to the reference if that repeated one pose.

    Measurements of a robot that is held differ by their noise. A gyro that reads zero is none.
    """
    time, poses = reference.time, np.stack([reference.x, reference.y, reference.yaw])
    rows = np.flatnonzero((time >= part.begin) & (time <= part.end))
    if rows.size < rules.NO_DRIVING_FEWEST or not np.isfinite(poses[0, rows]).any():
        return part
    repeats = np.zeros(time.size, dtype=np.bool_)
    repeats[1:] = ((poses[:, 1:] == poses[:, :-1]) | np.isnan(poses[:, 1:])).all(axis=0)
    if np.mean(repeats[rows[1:]]) < rules.NO_DRIVING_STUCK:
        return part
    stuck = [each for each in runs_of(repeats) if each[1] >= rows[0] and each[0] <= rows[-1]]
    first, last = stuck[0][0] - 1, min(stuck[-1][1] + 1, time.size - 1)
    begin, end = min(part.begin, float(time[first])), max(part.end, float(time[last]))
    return NoDriving(begin, end, "gap", STUCK)
