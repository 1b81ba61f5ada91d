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

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.gaps import touched
from werrimbi_odom.inference.set_up.records import SetUpRecord
from werrimbi_odom.model.pose import Floats, wrap_all

_Numbers = TypeVar("_Numbers", np.float64, np.complex128)

_PERIOD = 0.1
_STEPS = round(rules.DELAY_WINDOW / _PERIOD)


def lag_of(records: Sequence[SetUpRecord]) -> tuple[float, float]:
    """Estimate the delay of the reference [s], and the gain in unexplained variance over no delay.

    Returns
    -------
    lag : float
        Delay [s]; 0 where none is clearly better.
    gain : float
        Ratio of the unexplained variance without delay to that with it; 1 for no delay.
    """
    most = round(rules.DELAY_LONGEST / _PERIOD)
    sums = [_Sums(width, most) for width in (2, 3)]
    for record in records:
        grid = np.arange(record.time[0], record.time[-1], _PERIOD)
        if grid.size < rules.DELAY_SPANS * most or record.seen.size < rules.FEWEST_CUTS:
            continue
        left = _over(np.interp(grid, record.time, record.left))
        right = _over(np.interp(grid, record.time, record.right))
        products = np.stack([left**2, left * right, right**2])
        unseen = [*record.not_driven, *record.taken_out, *_silences(record.seen)]
        for total, wheels, measured in (
            (sums[0], np.stack([left, right]), _turns(record, grid)),
            (sums[1], products, _squared_steps(record, grid)),
        ):
            if measured is not None:
                measured[_in_any(touched(grid, unseen))] = np.nan
                total.add(wheels, measured)
    used = [total for total in sums if total.rows > rules.DELAY_ROWS]
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
    seconds = used[0].rows * _PERIOD
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
        self.most = most
        self.rows = 0
        lags = 2 * most + 1
        self.square = np.zeros(lags)
        self.gram = np.zeros((lags, width, width))
        self.cross = np.zeros((lags, width))

    def add(self, wheels: Floats, measured: Floats) -> None:
        """Add a run: (p, n) of the wheels, (n,) measured on the same grid, NaN where unmeasured."""
        known = np.isfinite(measured)
        if known.sum() < rules.DELAY_SPANS * self.most:
            return
        scale = np.std(measured[known])
        if scale == 0.0:
            return
        inputs = wheels - wheels[:, known].mean(axis=1, keepdims=True)
        output = (measured - measured[known].mean()) / scale
        self.rows += int(known.sum())
        for number, lag in enumerate(range(-self.most, self.most + 1)):
            first, last = max(lag, 0), min(output.size, output.size + lag)
            both = known[first:last]
            seen, driven = output[first:last][both], inputs[:, first - lag : last - lag][:, both]
            self.square[number] += seen @ seen
            self.gram[number] += driven @ driven.T
            self.cross[number] += driven @ seen

    def residual_innovations(self) -> Floats:
        """Unexplained share of the variance at each lag."""
        inverse = np.linalg.pinv(self.gram, rcond=1e-9, hermitian=True)
        explained = np.einsum("ki,kij,kj->k", self.cross, inverse, self.cross) / self.square
        return np.asarray(np.clip(1.0 - explained, rules.DELAY_UNEXPLAINED, 1.0))


def _silences(seen: Floats) -> list[tuple[float, float]]:
    """Stretches in which the reference is silent and its motion unknown."""
    duration = np.diff(seen)
    usual = max(rules.DELAY_WINDOW, rules.GAP_INTERVALS * float(np.median(duration)))
    return [(seen[row], seen[row + 1]) for row in np.flatnonzero(duration > usual)]


def _turns(record: SetUpRecord, grid: Floats) -> Floats | None:
    known = np.isfinite(record.yaw)
    if known.sum() < rules.FEWEST_CUTS:
        return None
    yaw = np.concatenate([[0.0], np.cumsum(wrap_all(np.diff(record.yaw[known])))])
    return _winsorised(_over(np.interp(grid, record.seen[known], yaw, left=np.nan, right=np.nan)))


def _squared_steps(record: SetUpRecord, grid: Floats) -> Floats | None:
    known = np.isfinite(record.place)
    if known.sum() < rules.FEWEST_CUTS:
        return None
    place = np.interp(grid, record.seen[known], record.place[known].real, np.nan, np.nan) + (
        1j * np.interp(grid, record.seen[known], record.place[known].imag)
    )
    return _winsorised(np.abs(_over(place))) ** 2


def _over(values: NDArray[_Numbers]) -> NDArray[_Numbers]:
    """Change over each window; windows start one grid step apart."""
    return np.asarray(values[_STEPS:] - values[:-_STEPS])


def _in_any(steps: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Windows that contain any of the given grid steps."""
    held = np.convolve(steps, np.ones(_STEPS), "valid")
    return np.asarray(held > 0.5)


def _winsorised(values: Floats) -> Floats:
    """Winsorise outliers (failed matches)."""
    size = np.abs(values[np.isfinite(values)])
    if size.size == 0:
        return values
    limit = rules.DELAY_TAMED * float(np.quantile(size, 0.9))
    return np.clip(values, -limit, limit)
