# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A drive in time windows: wheel travel and reference motion in each."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d, median_filter

from werrimbi_odom.files.instants import instants
from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.legs.count_interpolation import Counters
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

_GRID = 0.1  # grid step, where messages come as often [s]
_WINDOWS = 1500  # windows used for fitting, from a long drive
_STILL = 0.1  # share of the standing limit within which not even the motors stir


@dataclass(frozen=True, slots=True)
class Windows:
    """Overlapping time windows, each one grid step after the one before; k of them."""

    step: float
    """Grid step [s]."""
    steps: int
    """Grid steps in a window."""
    time: Floats
    """Midpoints of the windows, (k,) [s]."""
    left: Floats
    """Travel of the left wheel according to the robot file, (k,) [m]."""
    right: Floats
    rolled: Floats
    """Mean absolute travel of both wheels, (k,) [m]."""
    measured: Floats
    """Turn [rad] or displacement [m]; NaN where the reference is silent; (k,)."""
    chord: Floats
    """Ratio of chord to arc length in each, (k,)."""
    without_leaps: bool = False
    """Whether jumps between successive reference poses are removed from the measurement, so that
    what is left takes several steps."""
    noise: float = 0.0
    """Median of what the noise of two poses does to one coordinate of a window, as told by poses
    while the wheels stand; 0 where too few do [rad or m]."""

    @property
    def still(self) -> float:
        """Wheel travel per window below which the wheels stand [m]."""
        return standing_below(self.rolled)

    def later(self, lag: float) -> Windows:
        """Shift the reference, which is later than the wheels by `lag` [s]."""
        shift = round(lag / self.step)
        if shift == 0:
            return self
        moved = np.full_like(self.measured, np.nan)
        if shift > 0:
            moved[:-shift] = self.measured[shift:]
        else:
            moved[-shift:] = self.measured[:shift]
        return replace(self, measured=moved)

    def some(self, rows: NDArray[np.intp]) -> Windows:
        """Select windows."""
        names = ("time", "left", "right", "rolled", "measured", "chord")
        return replace(self, **{name: getattr(self, name)[rows] for name in names})

    def rolling(self) -> Windows:
        """Windows with turning wheels and a reference; a subset of them for a long drive."""
        rows = np.flatnonzero((self.rolled > self.still) & np.isfinite(self.measured))
        return self.some(rows[:: max(1, rows.size // _WINDOWS)])

    def at_rest(self) -> Floats:
        """Measurements while the wheels stand."""
        return self.measured[(self.rolled <= _STILL * self.still) & np.isfinite(self.measured)]


def standing_below(rolled: Floats) -> float:
    """Wheel travel in equal times below which the wheels stand [m].

    It is a share of the usual travel of rolling wheels, not of trembling ones: computed wheel
    angles jitter in their last digits while a robot waits.
    """
    ordered = np.sort(rolled[rolled > 0.0])
    if not ordered.size:
        return 0.0
    gone = np.cumsum(ordered)
    half_of_all = float(ordered[int(np.searchsorted(gone, 0.5 * gone[-1]))])
    return rules.STANDS * float(np.median(ordered[ordered >= rules.TREMBLES * half_of_all]))


def later_than_all_before(time: Floats) -> NDArray[np.bool_]:
    """Rows whose stamps go on, (n,): no message that came twice, and none of a clock set back."""
    return np.append(True, time[1:] > np.maximum.accumulate(time)[:-1])[: time.size]


def windows_of(
    counters: Counters, reference: Reference, robot: Robot, *, ways: bool
) -> Windows | None:
    """Turns or displacements in time windows; None where the record is too sparse."""
    known = reference.has_position if ways else reference.has_yaw
    time = reference.time[known]
    if time.size < rules.NO_DRIVING_POSES:
        return None
    new = later_than_all_before(time)
    time = time[new]
    first, last = max(time[0], counters.time[0]), min(time[-1], counters.time[-1])
    usual = [float(np.median(np.diff(each))) for each in (time, counters.time)]
    step = max(_GRID, *usual)
    steps = max(2, round(rules.NO_DRIVING_WINDOW / step))
    if 0.5 * step > rules.NO_DRIVING_WINDOW or last - first < rules.NO_DRIVING_SPANS * steps * step:
        return None
    silence = max(rules.NO_DRIVING_SILENCE * usual[1], 2.0 * step)
    reach = rules.AGREE_LATEST + steps * step + silence
    grid = instants(first, last, step, counters.time, reach)
    left = np.interp(grid, counters.time, counters.left) * robot.left_tick
    right = np.interp(grid, counters.time, counters.right) * robot.right_tick
    way = 0.5 * (np.abs(np.diff(left)) + np.abs(np.diff(right)))
    way[np.diff(grid) > 2 * step] = 0.0  # all that was gone in a silence is no way of a window
    rolled = np.concatenate([[0.0], np.cumsum(way)])
    by_wheels = rolled if ways else (right - left) / robot.track
    often = usual[0] < rules.NO_DRIVING_LEAP_WITHIN
    if ways:
        places = reference.x[known][new] + 1j * reference.y[known][new]
        told = np.diff(places)
        steps_seen = np.diff(_without_outliers(places)) if often else told
    else:
        steps_seen = told = wrap_all(np.diff(reference.yaw[known][new])) + 0j
    if often:
        steps_seen = _without_leaps(steps_seen, np.abs(np.diff(np.interp(time, grid, by_wheels))))
    gone = np.concatenate([[0j], np.cumsum(steps_seen)])
    over = _over(np.interp(grid, time, gone.real), steps)
    measured = np.hypot(over, _over(np.interp(grid, time, gone.imag), steps)) if ways else over
    begin, end = grid[:-steps], grid[steps:]
    for stamps, each in zip((time, counters.time), usual, strict=True):
        gaps = np.flatnonzero(np.diff(stamps) > max(rules.NO_DRIVING_SILENCE * each, 2.0 * step))
        firsts = np.searchsorted(end, stamps[gaps], side="right").tolist()
        for first, last in zip(firsts, np.searchsorted(begin, stamps[gaps + 1]), strict=True):
            measured[first:last] = np.nan
    middle, gone_by = 0.5 * (begin + end), _over(rolled, steps)
    stands = np.interp(time, middle, gone_by) <= standing_below(gone_by)
    return Windows(
        step,
        steps,
        middle,
        _over(left, steps),
        _over(right, steps),
        gone_by,
        measured,
        np.ones_like(measured),
        often,
        _noise(told, stands, ways=ways),
    )


def _noise(seen: NDArray[np.complex128], stands: NDArray[np.bool_], *, ways: bool) -> float:
    """Noise of a window's measurement, by third differences of poses while the wheels stand.

    A hand moves a robot smoothly from one pose to the next, so it hardly adds to them.
    """
    third = np.diff(seen, 2)[stands[:-3] & stands[1:-2] & stands[2:-1] & stands[3:]]
    if third.size < rules.AGREE_FEWEST:
        return 0.0
    each = np.concatenate([third.real, third.imag]) if ways else third.real
    # Of poses with unit noise a third difference has the variance 20, a difference of two 2.
    return float(np.median(np.abs(each)) * np.sqrt(2.0 / 20.0))


def _without_outliers(places: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Positions without single ones far from both neighbours, as radio ranging has them.

    They are too small for jumps, and several in a second would be a stretch. A motion of its own
    goes on for more than two poses: it passes the median of three.
    """
    return np.asarray(median_filter(places.real, 3) + 1j * median_filter(places.imag, 3))


def leaps_of(
    seen: NDArray[np.complex128], by_wheels: Floats
) -> tuple[NDArray[np.bool_], NDArray[np.complex128]]:
    """Jumps (a localiser that relocalised) among the steps between reference poses, (n,) each.

    A jump is a single step that exceeds the noise, its neighbours and the wheels' motion. Moving a
    robot by hand takes longer than one to three steps. Second result: what each step would usually
    be, by its neighbours.
    """
    reach = 2 * rules.JUMP_NEIGHBOURS + 1
    usual = median_filter(seen.real, reach) + 1j * median_filter(seen.imag, reach)
    left = np.abs(seen - usual)
    moved = maximum_filter1d(np.maximum(np.abs(usual), by_wheels), reach)
    scatter = rules.JUMP_SCATTER * MEDIAN_TO_SIGMA * float(np.median(left))
    if scatter == 0.0 and seen.any():
        # Of a reading in whole degrees, say, most steps are as usual, and the others off by one.
        steps = np.abs(seen)
        scatter = rules.NO_DRIVING_LEAP_OF_DIGITS * float(np.median(steps[steps > 0.0]))
    return left > np.maximum(scatter, rules.NO_DRIVING_LEAP * moved), usual


def _without_leaps(seen: NDArray[np.complex128], by_wheels: Floats) -> NDArray[np.complex128]:
    """Steps between reference poses without jumps (`leaps_of`)."""
    leaps, usual = leaps_of(seen, by_wheels)
    return np.where(leaps, usual, seen)


def _over(values: Floats, steps: int) -> Floats:
    return np.asarray(values[steps:] - values[:-steps])
