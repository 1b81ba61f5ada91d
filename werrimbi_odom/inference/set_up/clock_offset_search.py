# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Clock offset of seconds between wheels and reference, by cross-correlation.

A fit cannot find it: if a turn ends before the reference starts it, the derivative is zero. The
turn rate is regressed on both wheels' speeds, the squared speed on their products, so neither
wiring nor scale of the robot file matter. Both are taken over half a second. Where one driver reads
wheels and sensor in one loop, their stamps jitter together, and at shorter times the correlation
would be that of the jitter and not of the motion.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import maximum_filter1d

from werrimbi_odom.files.instants import instants
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.gaps import touched
from werrimbi_odom.inference.legs.windows import standing_below
from werrimbi_odom.inference.set_up.records import SetUpRecord
from werrimbi_odom.model.pose import Floats, wrap_all

Wheels = Callable[[int], tuple[Floats, Floats]]
"""Ways of both wheels over each window, (n,) each, by lag in steps of the grid."""

_Numbers = TypeVar("_Numbers", np.float64, np.complex128)

_PERIOD = 0.1
_STEPS = round(rules.DELAY_WINDOW / _PERIOD)


def lag_of(records: Sequence[SetUpRecord]) -> tuple[float, float]:
    """Estimate the delay of the reference [s], and the gain in unexplained variance over no delay.

    Result: delay [s], 0 where none is clearly better; and the ratio of the unexplained variance
    without delay to that with it; 1 for no delay.
    """
    most = round(rules.DELAY_LONGEST / _PERIOD)
    sums = [_Sums(width, most) for width in (2, 3)]  # of turns, and of squared steps
    for record in records:
        if record.seen.size < rules.FEWEST_CUTS:
            continue
        reach = (most + _STEPS) * _PERIOD + _silence(record.seen)
        grid = instants(record.time[0], record.time[-1], _PERIOD, record.seen, reach)
        if grid.size < rules.DELAY_SPANS * most:
            continue
        wheels = _wheels(record, grid)
        unseen = [*record.not_driven, *record.taken_out, *_silences(record.seen)]
        near = _near_driving(wheels(0), most)
        both = _turns(record, grid, near), _squares(record, grid, near)
        for total, measured in zip(sums, both, strict=True):
            if measured is not None:
                measured[_in_any(touched(grid, unseen))] = np.nan
                total.add(wheels, measured, _interval(record))
    used = [total for total in sums if total.rows > 0]
    if not used:
        return 0.0, 1.0
    misfit = np.sum([total.rows * np.log(total.residual_innovations()) for total in used], axis=0)
    misfit = misfit / sum(total.rows for total in used)
    best = int(np.argmin(misfit))
    lag = (best - most) * _PERIOD
    if 0 < best < 2 * most:
        before, here, after = misfit[best - 1 : best + 2]
        bend = before - 2.0 * here + after
        if bend > 0.0:
            lag += 0.5 * _PERIOD * float(before - after) / float(bend)
    gain = float(np.exp(misfit[most] - misfit[best]))
    seconds = used[0].seconds
    if (
        abs(lag) < rules.DELAY_SHORTEST
        or gain < rules.DELAY_BETTER
        or seconds * np.log(gain) < rules.DELAY_EVIDENCE
    ):
        return 0.0, 1.0
    return float(lag), gain


class _Sums:
    """Normal equations of the regression at every lag, accumulated over all runs.

    At each lag exactly the windows count that were measured and have wheels: sums over more of
    either would compare one part of a drive with another.
    """

    def __init__(self, width: int, most: int) -> None:
        self.width = width
        self.most = most
        self.rows = 0
        self.seconds = 0.0  # that are independent
        lags = 2 * most + 1
        self.square = np.zeros(lags)
        self.gram = np.zeros((lags, width, width))
        self.cross = np.zeros((lags, width))

    def add(self, wheels: Wheels, measured: Floats, interval: float) -> None:
        """Add a run: (n,) measured on the grid, NaN where unmeasured, and the wheels at any lag."""
        known = np.isfinite(measured)
        if known.sum() < rules.DELAY_SPANS * self.most:
            return
        scale = np.std(measured[known])
        if scale == 0.0:
            return
        output = (measured - measured[known].mean()) / scale
        together = self._inputs(wheels(0))[:, known]
        together = together[:, np.isfinite(together[0])]
        if together.size == 0:
            return
        self.rows += int(known.sum())
        self.seconds += float(known.sum()) * _PERIOD / max(1.0, interval)
        middle = together.mean(axis=1, keepdims=True)
        for number, lag in enumerate(range(-self.most, self.most + 1)):
            inputs = self._inputs(wheels(lag))
            both = known & np.isfinite(inputs[0])
            seen, driven = output[both], inputs[:, both] - middle
            self.square[number] += seen @ seen
            self.gram[number] += driven @ driven.T
            self.cross[number] += driven @ seen

    def _inputs(self, both: tuple[Floats, Floats]) -> Floats:
        """Regressors: of turns the ways of both wheels, of squared steps their products."""
        left, right = both
        return np.stack([left, right] if self.width == 2 else [left**2, left * right, right**2])

    def residual_innovations(self) -> Floats:
        """Unexplained share of the variance at each lag."""
        inverse = np.linalg.pinv(self.gram, rcond=1e-9, hermitian=True)
        explained = np.einsum("ki,kij,kj->k", self.cross, inverse, self.cross)
        explained = explained / np.maximum(self.square, np.finfo(np.float64).tiny)
        return np.asarray(np.clip(1.0 - explained, rules.DELAY_UNEXPLAINED, 1.0))


def _interval(record: SetUpRecord) -> float:
    """Usual time between two poses [s]."""
    return float(np.median(np.diff(record.seen)))


def _wheels(record: SetUpRecord, grid: Floats) -> Wheels:
    """Ways of both wheels over each window, at any lag in steps of the grid; NaN outside.

    Between rare poses a measured path is a straight line, at an even speed. So is that of the
    wheels then: where only one of the two knows a turn's begin, a wrong lag may fit better.
    """
    sides = record.left, record.right
    if _interval(record) > rules.DELAY_WINDOW:

        def at_poses(lag: int) -> tuple[Floats, Floats]:
            then = record.seen - lag * _PERIOD
            left, right = (np.interp(then, record.time, side, np.nan, np.nan) for side in sides)
            return _over(np.interp(grid, record.seen, left)), _over(
                np.interp(grid, record.seen, right)
            )

        return at_poses
    left, right = (_over(np.interp(grid, record.time, side)) for side in sides)
    return lambda lag: (_shifted(left, lag), _shifted(right, lag))


def _shifted(values: Floats, lag: int) -> Floats:
    """Values so many rows later, NaN where there are none."""
    found = np.full(values.size, np.nan)
    first, last = max(lag, 0), min(values.size, values.size + lag)
    found[first:last] = values[first - lag : last - lag]
    return found


def _silences(seen: Floats) -> list[tuple[float, float]]:
    """Stretches in which the reference is silent and its motion unknown."""
    return [(seen[row], seen[row + 1]) for row in np.flatnonzero(np.diff(seen) > _silence(seen))]


def _silence(seen: Floats) -> float:
    """Time without a pose above which the reference is silent [s]."""
    return max(rules.DELAY_WINDOW, rules.GAP_INTERVALS * float(np.median(np.diff(seen))))


def _near_driving(wheels: tuple[Floats, Floats], most: int) -> NDArray[np.bool_]:
    """Windows from which one with rolling wheels is no farther than the longest lag, (n,)."""
    rolled = np.nan_to_num(np.abs(wheels[0]) + np.abs(wheels[1]))
    return np.asarray(maximum_filter1d(rolled > standing_below(rolled), 2 * most + 1))


def _turns(record: SetUpRecord, grid: Floats, near: NDArray[np.bool_]) -> Floats | None:
    known = np.isfinite(record.yaw)
    if known.sum() < rules.FEWEST_CUTS:
        return None
    yaw = np.concatenate([[0.0], np.cumsum(wrap_all(np.diff(record.yaw[known])))])
    turns = _over(np.interp(grid, record.seen[known], yaw, left=np.nan, right=np.nan))
    return _winsorised(turns, near)


def _squares(record: SetUpRecord, grid: Floats, near: NDArray[np.bool_]) -> Floats | None:
    known = np.isfinite(record.place)
    if known.sum() < rules.FEWEST_CUTS:
        return None
    place = np.interp(grid, record.seen[known], record.place[known].real, np.nan, np.nan) + (
        1j * np.interp(grid, record.seen[known], record.place[known].imag)
    )
    return _winsorised(np.abs(_over(place)), near) ** 2


def _over(values: NDArray[_Numbers]) -> NDArray[_Numbers]:
    """Change over each window; windows start one grid step apart."""
    return np.asarray(values[_STEPS:] - values[:-_STEPS])


def _in_any(steps: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Windows that contain any of the given grid steps."""
    held = np.convolve(steps, np.ones(_STEPS), "valid")
    return np.asarray(held > 0.5)


def _winsorised(values: Floats, near: NDArray[np.bool_]) -> Floats:
    """Winsorise outliers (failed matches), by what is usual near driving.

    After a minute of driving and an hour at rest every turn would be an outlier.
    """
    size = np.abs(values[np.isfinite(values) & near])
    if size.size == 0:
        return values
    limit = rules.DELAY_TAMED * float(np.quantile(size, 0.9))
    return np.clip(values, -limit, limit)
