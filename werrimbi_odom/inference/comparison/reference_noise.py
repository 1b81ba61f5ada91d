# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Noise of a reference, estimated from its own intervals before legs are cut.

Errors of a wrong model are
smooth or grow with travel; noise of a reference does neither. So the noise is the dispersion of
third differences of measured minus predicted path over a few poses. The part that grows with the
span (wheel noise) is removed by a line through several spans. Differences are taken in motion where
possible, as a robot at rest shows a tracker at its best. The noise is never less than the
quantisation of the written values. Coarse counters hide it. Then the same differences of the
measured path alone tell it: those hold how unevenly the robot moved, and no counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.residuals import Residual
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.quantisation import quantisation_variance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_THIRD = np.array([-1.0, 3.0, -3.0, 1.0])
_SPANS = (1, 2, 4)


def reference_noise(
    robot: Robot, residuals: Sequence[Residual], kind: ReferenceKind
) -> tuple[float | None, float | None]:
    """Standard deviations (position [m], heading [rad]) of the reference.

    Of each pose (absolute) or of each interval (incremental). None if poses are too few, or if the
    quantity is not measured.
    """
    reading = quantisation_variance(robot)
    positions = [item.measured.real for item in residuals]
    headings = [np.unwrap(item.measured_yaw) for item in residuals]
    roundings = _rounding(positions), _rounding(headings)
    if kind == "incremental":
        errors = np.concatenate([_steps(item) for item in residuals])
        sigmas = [_growing(errors[:, part]) for part in ((0, 1), (2,))]
        reading, least = 2.0 * reading, [0.0, 0.0]
    else:
        places = [_position_differences(item) for item in residuals]
        turns = [_heading_differences(item) for item in residuals]
        sigmas = [_level(places), _level(turns)]
        gone = [item.predicted for item in residuals]
        turned = [item.predicted_yaw for item in residuals]
        least = [
            _least(float(reading[0]), places, [item.measured for item in residuals], gone),
            _least(float(reading[2]), turns, headings, turned),
        ]
    return (
        _less(sigmas[0], float(reading[0]), max(least[0], roundings[0])),
        _less(sigmas[1], float(reading[2]), max(least[1], roundings[1])),
    )


def independent_for(residuals: Sequence[Residual], span: int) -> bool:
    """Whether the errors of poses so many intervals apart are no larger than those of neighbours.

    Then the noise is that of each pose, and neither model nor wheels err more over such a span.
    False where poses are too few to tell.
    """
    spans = (1, span)
    for differences in (_position_differences, _heading_differences):
        runs = [differences(item, spans) for item in residuals]
        sides = [[run[each][0] for run in runs if each in run] for each in spans]
        near, far = (np.concatenate(side) if side else np.zeros(0) for side in sides)
        if not near.size and not far.size:  # not measured
            continue
        if far.size < rules.DIFFERENCES * (_THIRD.size - 1) * span:  # so many do not overlap
            return False
        if _variance(far) > rules.VARIANCE_GROWS * _variance(near):
            return False
    return True


def stamp_noise(robot: Robot, every: Concatenated, residuals: Sequence[Residual]) -> float:
    """Standard deviation of the stamps of gyros, and of scans [s]; zero for others.

    Heading errors in turns have a larger dispersion than on straight lines, by turn rate times
    this. Spans are longer than two messages of the ticks, since the interpolation between two
    messages causes the same error in all headings. On straight lines both counters may step
    together, so that their rounding cancels in the heading, while in turns all of it remains, and
    even more at some paces. The measured headings hold none, and scatter by stamps and motion.
    """
    if not every.has_stamp_noise:
        return 0.0
    pairs = zip(every.runs, residuals, strict=True)
    found = [_scatter_and_rate(item, run.counters.time) for run, item in pairs]
    scatter, seen, rate = (np.concatenate(part) for part in zip(*found, strict=True))
    turning = rate > rules.TURNS_ENOUGH
    if min(turning.sum(), (~turning).sum()) < rules.DIFFERENCES:
        return 0.0
    fast, slow = (_variance(scatter[rows]) for rows in (turning, ~turning))
    reading = float(quantisation_variance(robot)[2])
    stamps = min(fast - max(slow, reading), _variance(seen[turning]))
    more = float(np.median(rate[turning] ** 2) - np.median(rate[~turning] ** 2))
    return float(np.sqrt(max(stamps, 0.0) / more))


def _scatter_and_rate(item: Residual, ticks: Floats) -> tuple[Floats, Floats, Floats]:
    """Third differences of heading error and of measured heading, and turn rates there [rad/s]."""
    apart, messages = (float(np.median(np.diff(time))) for time in (item.time, ticks))
    span = max(1, round(2.0 * messages / max(apart, 1e-9)))
    first = np.arange(max(item.time.size - 3 * span, 0))
    last = first + 3 * span
    off, turned = (
        np.concatenate([[0.0], np.cumsum(part[:, 2])]) for part in (item.intervals, item.relative)
    )
    left, seen = (_third_at(each, first, span) for each in (off, off + turned))
    rate = np.abs(turned[last] - turned[first]) / (item.time[last] - item.time[first])
    moved = np.concatenate([[0.0], np.cumsum(np.abs(item.relative).sum(axis=1))])
    moving = moved[last] > moved[first]
    return left[moving], seen[moving], rate[moving]


Differences = dict[int, tuple[Floats, float]]
"""By span in intervals: third differences, and the motion over one of them."""


def _position_differences(item: Residual, spans: Sequence[int] = _SPANS) -> Differences:
    """Third differences of the position error, for several spans."""
    found: Differences = {}
    path = np.abs(item.relative[:, :2]).sum(axis=1)
    for span in spans:
        ahead = item.measured.size - 3 * span
        if ahead < 1:
            break
        rows = np.arange(ahead)
        moved, seen_moved = (
            _third_at(each, rows, span) for each in (item.predicted, item.measured)
        )
        off = item.measured_yaw[rows] - item.predicted_yaw[rows]
        if not np.isfinite(off).all():
            chord = item.predicted[rows + 3 * span] - item.predicted[rows]
            off = np.angle((item.measured[rows + 3 * span] - item.measured[rows]) * np.conj(chord))
        left = seen_moved - np.exp(1j * off) * moved
        left = left[_moving(path, span) & np.isfinite(left)]
        reach = float(np.median(path[path > 0.0]) if (path > 0.0).any() else 0.0) * 3 * span
        found[span] = (np.concatenate([left.real, left.imag]), reach)
    return found


def _heading_differences(item: Residual, spans: Sequence[int] = _SPANS) -> Differences:
    """Third differences of the heading error, for several spans."""
    found: Differences = {}
    off = np.concatenate([[0.0], np.cumsum(item.intervals[:, 2])])
    turned = np.abs(item.relative[:, 2])
    for span in spans:
        ahead = off.size - 3 * span
        if ahead < 1:
            break
        left = _third_at(off, np.arange(ahead), span)
        reach = float(np.mean(turned)) * 3 * span
        found[span] = (left[_moving(turned, span) & np.isfinite(left)], reach)
    return found


def _third_at(values: NDArray[Any], rows: NDArray[np.intp], span: int) -> NDArray[Any]:
    """Third differences of a series over a span, from each of some rows."""
    return np.asarray(sum(k * values[rows + n * span] for n, k in enumerate(_THIRD)))


def _moving(driven: Floats, span: int) -> NDArray[np.bool_]:
    """Differences over a span that were taken in motion; all, if few were."""
    sums = np.concatenate([[0.0], np.cumsum(driven)])
    moved = sums[3 * span :] - sums[: -3 * span] > 0.0
    return moved if moved.sum() >= rules.DIFFERENCES else np.ones(moved.size, dtype=np.bool_)


def _level(runs: list[Differences]) -> float | None:
    """Variance extrapolated to zero span; None if there are too few differences."""
    spans, variances, counts = [], [], []
    for span in _SPANS:
        here = [run[span] for run in runs if span in run]
        left = np.concatenate([item[0] for item in here]) if here else np.zeros(0)
        reach = max((item[1] for item in here), default=0.0)
        if left.size < rules.DIFFERENCES or (span > 1 and reach > rules.DIFFERENCE_REACH):
            break
        spans.append(float(span))
        variances.append(_variance(left))
        counts.append(float(left.size))
    return _intercept(np.array(spans), np.array(variances), np.array(counts)) if spans else None


def _variance(differences: Floats) -> float:
    """Variance of one pose, by third differences of independent ones."""
    return (MEDIAN_TO_SIGMA * float(np.median(np.abs(differences)))) ** 2 / 20.0


def _intercept(at: Floats, variances: Floats, counts: Floats) -> float:
    """Intercept at zero of a weighted line through the variances."""
    if variances.min() < 1e-18:  # (1 nm, 1 nrad): nothing scatters; the likelihood needs some noise
        return 1e-18
    weight = counts / np.maximum(variances, 1e-300) ** 2
    weight = weight / weight.sum()
    middle, mean = float(weight @ at), float(weight @ variances)
    if variances.max() < rules.VARIANCE_GROWS * variances[0]:
        return mean  # not significant; a line would extrapolate chance to zero
    spread = float(weight @ (at - middle) ** 2)
    slope = float(weight @ ((at - middle) * variances)) / spread if spread > 0.0 else 0.0
    # Where growth dominates the noise, do not trust the line down to zero.
    return max(mean - max(slope, 0.0) * middle, rules.NOISE_LEFT * float(variances[0]))


def _steps(item: Residual) -> Floats:
    """Differences of errors of neighbouring intervals, scaled to one, without the systematic part.

    Shape (n - 2, 3): x, y, yaw.
    """
    return np.asarray(np.diff(item.intervals, axis=0) / np.sqrt(2.0))


def _growing(columns: Floats) -> float | None:
    """Variance of the errors of single intervals; None if there are too few."""
    known = columns[np.isfinite(columns).all(axis=1)]
    if known.shape[0] < rules.DIFFERENCES:
        return None
    return (MEDIAN_TO_SIGMA * float(np.median(np.abs(known)))) ** 2


def _third(measured: NDArray[np.complex128] | Floats) -> Floats:
    """Third differences of a measured path between neighbours, of each coordinate."""
    found = np.diff(measured, n=3)
    return found[np.isfinite(found)].view(np.float64)


def _least(
    reading: float,
    left: Sequence[Differences],
    measured: Sequence[NDArray[Any]],
    counted: Sequence[NDArray[Any]],
) -> float:
    """Least variance of a pose by third differences between neighbours, whatever the counts err.

    The measured path alone has the noise and the motion (`measured`), and that by the counts has
    their rounding and the motion (`counted`). Where that rounding (`reading`) may be all that the
    differences of both have (`left`), the three tell the noise as three clocks do (Gray and Allan,
    "A method for estimating the frequency stability of an individual oscillator", 1974). It is no
    more than the measured path has.
    """
    sides = (
        [item[1][0] for item in left if 1 in item],
        *([_third(path) for path in paths] for paths in (measured, counted)),
    )
    if min(sum(map(len, each)) for each in sides) < rules.DIFFERENCES:
        return 0.0
    both, seen, told = (_variance(np.concatenate(each)) for each in sides)
    some = rules.NOISE_LEFT * both
    between = 0.5 * (both + seen - told) if reading > some else some
    return min(seen, max(between, some), both)


def _less(variance: float | None, reading: float, least: float) -> float | None:
    """Standard deviation without encoder quantisation, which the legs account for themselves.

    Counts that the driving interpolates err by less than that: taken off whole, nothing would be
    left, whatever the noise.
    """
    return None if variance is None else float(np.sqrt(max(variance - reading, least, 1e-18)))


def _rounding(values: Sequence[Floats]) -> float:
    """Quantisation variance: uniform over the smallest difference between written values.

    Or between such differences, as a robot that goes steadily comes nowhere near where it was.
    """
    steps = np.concatenate([np.diff(np.unique(part[np.isfinite(part)])) for part in values])
    every = np.concatenate([steps, np.diff(np.unique(steps))])
    every = every[every > 1e-9]
    return float(every.min()) ** 2 / 12.0 if every.size else 0.0
