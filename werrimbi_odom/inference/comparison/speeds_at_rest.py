# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels that go on, always at the same speed, wherever the reference stands still.

Speeds that a driver or a log states with an offset do so, and counts that were summed up from them.
A robot that is held does so once, or at one speed and another; one that creeps moves, and poses
that repeat the last one are not measured anew.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference, Run, by_hand
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark, Stretch
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.inference.legs.measured_motion import runs_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def speeds_at_rest(
    runs: Sequence[Run], counters: Sequence[Counters], robot: Robot
) -> ReferenceRemark | None:
    """Speeds of both wheels while poses stand still; None if they stand, or differ each time."""
    seen = [_windows(run, own, robot) for run, own in zip(runs, counters, strict=True)]
    speeds, moved = (np.concatenate([each[of] for each in seen], axis=-1) for of in (0, 1))
    size = np.abs(speeds).max(axis=0, initial=0.0)
    if not size.size:
        return None
    usual = float(np.quantile(size, rules.AT_REST_USUAL))
    low, high = (share * usual for share in rules.AT_REST_SPEEDS)
    goes_on = (size > low) & (size < high) & (moved < rules.AT_REST_MOVED * size)
    if not goes_on.any():
        return None
    offset = np.median(speeds[:, goes_on], axis=1)
    least = float(np.abs(offset).max())
    rests, at_rest, alike = [], 0, 0
    for run, own, (speed, way) in zip(runs, counters, seen, strict=True):
        same = np.abs(speed - offset[:, None]).max(axis=0) < rules.AT_REST_ALIKE * least
        for first, last in runs_of(way < rules.AT_REST_MOVED * least):
            inner = slice(first + 1, last)  # by its stamps a reference may be late, or early
            count, kept = same[inner].size, int(np.count_nonzero(same[inner]))
            at_rest, alike = at_rest + count, alike + kept
            if kept > 0:
                begin = float(own.time[0]) + first
                end = float(own.time[0]) + last + rules.AT_REST_WINDOW
                rests.append(Stretch(run.path, begin, end, least, float(own.time[0])))
    if len(rests) < rules.AT_REST_RESTS or alike < rules.AT_REST_MOST * at_rest:
        return None
    return ReferenceRemark("at_rest", float(offset[0]), float(offset[1]), tuple(rests))


def _windows(run: Run, counters: Counters, robot: Robot) -> tuple[Floats, Floats]:
    """Speeds of the wheels in each window of some seconds, (2, k), and how fast poses moved, (k,).

    The latter is infinite where that is not known, or where the robot was held or carried.
    """
    first, length = float(counters.time[0]), rules.AT_REST_WINDOW
    edges = np.arange(first, float(counters.time[-1]), 1.0)
    if run.reference is None or edges.size <= length:
        return np.zeros((2, 0)), np.zeros(0)
    poses = _by_second(run.reference, edges, 0.5 * robot.track)
    for part in by_hand(run.no_driving):
        poses[:, (edges[1:] > part.begin) & (edges[:-1] < part.end)] = np.nan
    seconds = sliding_window_view(poses, length, axis=1)
    moved = np.abs(seconds - seconds[:, :, :1]).sum(axis=0).max(axis=1) / length
    travel = sliding_window_view(counters.travel(robot, edges), length, axis=1)
    return travel.mean(axis=2), np.where(np.isfinite(moved), moved, np.inf)


def _by_second(reference: Reference, edges: Floats, arm: float) -> Floats:
    """Mean x, y and yaw times an arm of each second, (3, n); NaN for none that are new [m]."""
    known: NDArray[np.bool_] = reference.has_position & reference.has_yaw
    time, x, y = reference.time[known], reference.x[known], reference.y[known]
    yaw = arm * np.unwrap(reference.yaw[known])
    new = (np.diff(x, prepend=np.nan) != 0.0) | (np.diff(y, prepend=np.nan) != 0.0)
    second = np.searchsorted(edges, time, side="right") - 1
    new &= (second >= 0) & (second < edges.size - 1)
    count = np.bincount(second[new], minlength=edges.size - 1)
    sums = [np.bincount(second[new], each[new], edges.size - 1) for each in (x, y, yaw)]
    return np.where(count > 0, sums, np.nan) / np.maximum(count, 1)
