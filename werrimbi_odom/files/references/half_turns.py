# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings that turn round by 180° from one pose to the next: an axis whose sense is not known.

So errs the heading of a marker that is seen from its other side, of a body that looks alike turned
round, and of a line through two markers that cannot be told apart.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.pose import Floats, wrap_all

NEAR = 0.2
"""Greatest difference of such a step from 180° [rad]. Chosen: seven standard deviations of a step
between headings that are known to a degree."""
SOON = 0.5
"""Longest interval of such a step [s]: a robot that is not seen for longer may turn round."""
SLOW = 0.5
"""Greatest usual step about it [rad], as of a robot that hardly turns from pose to pose."""
REACH = 3
"""Steps before and after that tell the usual one."""
STAYS, AT_ONCE = 0.03, 4.0
"""Way [m], and multiple of the usual step, that the place may go meanwhile: a track that was taken
for another is wrong in both."""
FEWEST = 20
"""Headings of a reference that may do so: fewer were taken by hand."""
CLEARLY = 0.5
"""Correlation of the way along the headings with that of the wheels that tells ahead from behind: 1
if the robot only drives and everything is set up right, 0 if one counter has the wrong sign."""
SURELY = 5.0
"""Standard deviations of such a correlation by chance beyond which it tells the sense of headings
that were laid upon the path of positions, whose noise hides most of the way from one to the next.
"""


def without_half_turns(run: Run, bits: int) -> Run:
    """With all headings of one sense: ahead where the wheels roll ahead, else that of most of them.

    Unchanged if none turns round at once; headings that were laid upon a path are as a whole.
    `bits`: of the counters, if they begin anew.
    """
    reference = run.reference
    if reference is None or reference.own_axes:
        return run
    if reference.by_course:
        return _as_it_rolls(run, reference, bits)
    rows = np.flatnonzero(reference.has_yaw)
    if rows.size < FEWEST:
        return run
    seen = reference.chosen(rows)
    turned = _turned_round(seen)
    times = int(np.count_nonzero(np.diff(turned)))
    if not times:
        return run
    yaw = seen.yaw + np.pi * turned
    ahead = _ahead(run.ticks.unwrapped(bits), seen, yaw)
    if ahead < -CLEARLY or (ahead < CLEARLY and turned.mean() > 0.5):
        turned, yaw = ~turned, yaw + np.pi
    headings = reference.yaw.copy()
    headings[rows] = np.where(turned, wrap_all(yaw), seen.yaw)
    words = (
        f"the reference's heading turned round by 180° from one pose to the next {times} times, as "
        f"of a marker seen from its other side: {np.count_nonzero(turned)} of {rows.size} headings "
        "are turned back"
    )
    return replace(run, reference=replace(reference, yaw=headings), damage=(*run.damage, words))


def _as_it_rolls(run: Run, reference: Reference, bits: int) -> Run:
    """With headings that were laid upon a path turned round, if the wheels roll back along them.

    Wheels that also turn the other way are wired wrongly; then the headings stay.
    """
    seen = reference.chosen(reference.has_yaw & reference.has_position)
    ticks = run.ticks.unwrapped(bits)
    back = _ahead(ticks, seen, seen.yaw) * np.sqrt(max(seen.time.size, 1)) < -SURELY
    if not back or _turns_alike(ticks, seen) < CLEARLY:
        return run
    words = "by its wheels it drove mostly backwards, and so the headings are turned by 180°"
    turned = replace(reference, yaw=reference.yaw + np.pi)
    return replace(run, reference=turned, notes=(*run.notes, words))


def _turned_round(seen: Reference) -> NDArray[np.bool_]:
    """Which headings look the other way than the first, (m,)."""
    turns = wrap_all(np.diff(seen.yaw))
    size = 2 * REACH + 1
    round_about = np.abs(wrap_all(turns - np.pi)) < NEAR
    usual = median_filter(np.abs(turns), size, mode="nearest")
    at_once = round_about & (usual < SLOW) & (np.diff(seen.time) < SOON)
    way = np.hypot(np.diff(seen.x), np.diff(seen.y))
    known = np.nan_to_num(way)
    leaps = known > np.maximum(STAYS, AT_ONCE * median_filter(known, size, mode="nearest"))
    return np.asarray(np.concatenate([[0], np.cumsum(at_once & ~leaps)]) % 2 == 1)


def _ahead(ticks: Ticks, seen: Reference, yaw: Floats) -> float:
    """Correlation of the ways along the headings with those of the wheels; 0 without positions."""
    steps = (np.diff(seen.x) + 1j * np.diff(seen.y)) * np.exp(-1j * yaw[:-1])
    counted = ticks.left.astype(np.float64) + ticks.right.astype(np.float64)
    return _correlation(steps.real, counted, ticks, seen)


def _turns_alike(ticks: Ticks, seen: Reference) -> float:
    """Correlation of the turns with those of the wheels."""
    counted = ticks.right.astype(np.float64) - ticks.left.astype(np.float64)
    return _correlation(wrap_all(np.diff(seen.yaw)), counted, ticks, seen)


def _correlation(steps: Floats, counted: Floats, ticks: Ticks, seen: Reference) -> float:
    """Correlation of steps from pose to pose with those of some counts; 0 if none is known."""
    read = np.isfinite(counted)
    if not read.any():
        return 0.0
    stamps = np.maximum.accumulate(ticks.time[read])
    rolled = np.diff(np.interp(seen.time, stamps, counted[read]))
    known = np.isfinite(steps)
    steps, rolled = steps[known], rolled[known]
    sizes = float(np.linalg.norm(steps) * np.linalg.norm(rolled))
    return float(steps @ rolled) / max(sizes, 1e-12)
