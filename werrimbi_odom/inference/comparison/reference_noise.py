# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Kind of measurement of a reference, and its own noise.

Both are taken from the reference's own intervals, before legs are cut. Errors of a wrong model are
smooth or grow with travel; noise of a reference does neither. So the noise is the dispersion of
third differences of measured minus predicted path over a few poses. The part that grows with the
span (wheel noise) is removed by a line through several spans. Differences are taken in motion where
possible, as a robot at rest shows a tracker at its best. The noise is never less than the
quantisation of the written values.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.inference.chances import MEDIAN_TO_SIGMA
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import START_YAW, Model
from werrimbi_odom.inference.fitting.likelihood import quantisation_variance
from werrimbi_odom.inference.fitting.prediction import predicted_legs, right_handed
from werrimbi_odom.inference.rules import (
    DIFFERENCE_REACH,
    DIFFERENCES,
    FACING_POSES,
    NOISE_LEFT,
    POSE_ROWS,
    TURNS_ENOUGH,
    VARIANCE_GROWS,
)
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

Measure = Literal["pose", "position", "heading"]
"""Quantity that the reference measures at both ends of a leg."""

_THIRD = np.array([-1.0, 3.0, -3.0, 1.0])


@dataclass(frozen=True, slots=True)
class Residual:
    """Measured and predicted path of one run, at every reference pose; arrays of shape (n,)."""

    time: Floats
    """Stamps of the reference [s]."""
    measured: NDArray[np.complex128]
    """x + iy in a right-handed frame; NaN where not measured [m]."""
    measured_yaw: Floats
    predicted: NDArray[np.complex128]
    """Dead reckoning of the reference's point from the first pose, with fitted start heading
    [m]."""
    predicted_yaw: Floats
    """In the reference's frame [rad]."""
    intervals: Floats
    """Measured minus predicted relative pose of each interval, shape (n - 1, 3)."""
    relative: Floats
    """Predicted relative pose of each interval, shape (n - 1, 3)."""


def measured_alike(run: Run) -> tuple[Run, Measure]:
    """Quantity that most rows of the reference measure, and the run restricted to these rows.

    If all rows do, the run itself is returned. Positions without headings keep the heading of the
    first row if it was measured.
    """
    reference = run.reference
    if reference is None:
        return run, "pose"  # matching raises the error
    position, yaw = reference.has_position, reference.has_yaw
    both = position & yaw
    if both.sum() >= max(2, POSE_ROWS * max(position.sum(), yaw.sum())):
        whole = bool(both.all())
        return run if whole else replace(run, reference=reference.chosen(both)), "pose"
    if position.sum() >= max(2, yaw.sum()):
        kept = reference.chosen(position)
        start = np.where(np.arange(kept.yaw.size) == 0, kept.yaw, np.nan)
        return replace(run, reference=replace(kept, yaw=start)), "position"
    return replace(run, reference=reference.chosen(yaw)), "heading"


def residuals_of(
    model: Model, every: Concatenated, measure: Measure
) -> tuple[tuple[Residual, ...], Model]:
    """Dead reckoning along every reference pose and its difference to the measurement, run by run.

    Parameters
    ----------
    model : Model
        The model.
    every : Concatenated
        Runs from `legs.cutting.every_pose`.
    measure : Measure
        Quantity that the reference measures.

    Returns
    -------
    residuals : tuple of Residual
        One for each run.
    model : Model
        The model with the start heading of each run. Where only positions are measured and the
        model has none, it is the one that best aligns the whole path with them.
    """
    view = view_of(model.robot.effects)
    relative = predicted_legs(model, every)
    if measure == "position":
        model = _with_headings(model, every, relative)
        relative = predicted_legs(model, every)
    found = []
    for index, run in enumerate(every.runs):
        own = slice(every.legs[index], every.legs[index + 1])
        poses = np.stack([run.measured.x, run.measured.y, run.measured.yaw], axis=-1)
        poses = right_handed(poses, view)
        given = model.start_yaw(index)
        heading = float(poses[0, 2]) if given is None else given
        found.append(_residual(run.measured.time, poses, relative[own], heading, measure))
    return tuple(found), model


def _with_headings(model: Model, every: Concatenated, relative: Floats) -> Model:
    mirror = -1.0 if view_of(model.robot.effects).mirrored else 1.0
    own: list[dict[str, float]] = []
    for index, run in enumerate(every.runs):
        known = model.start_yaw(index) is not None or np.isfinite(run.measured.yaw[0])
        legs = slice(every.legs[index], every.legs[index + 1])
        measured = run.measured.x + 1j * mirror * run.measured.y
        shape = chained(relative[legs])[0]
        own.append({} if known else {START_YAW: fitted_heading(shape, measured)})
    return model.turned({}, own)


def _residual(
    time: Floats, poses: Floats, relative: Floats, heading: float, measure: Measure
) -> Residual:
    predicted, yaw = chained(relative)
    measured = poses[:, 0] + 1j * poses[:, 1]
    begin = 0j if measure == "heading" else measured[0]
    facing = poses[:, 2]
    if measure == "position":
        facing = _facing(predicted, yaw, measured, heading)
    moved = np.exp(-1j * facing[:-1]) * np.diff(measured)
    turned = np.full(yaw.size - 1, np.nan)
    if measure != "position":
        turned = wrap_all(np.diff(poses[:, 2]) - relative[:, 2])
    return Residual(
        time,
        measured,
        poses[:, 2],
        begin + np.exp(1j * heading) * predicted,
        heading + yaw,
        np.stack([moved.real - relative[:, 0], moved.imag - relative[:, 1], turned], axis=-1),
        relative,
    )


def chained(relative: Floats) -> tuple[NDArray[np.complex128], Floats]:
    """Compose relative poses (m, 3) to positions and headings from the origin; (m + 1,)."""
    yaw = np.concatenate([[0.0], np.cumsum(relative[:, 2])])
    steps = np.exp(1j * yaw[:-1]) * (relative[:, 0] + 1j * relative[:, 1])
    return np.concatenate([[0j], np.cumsum(steps)]), yaw


def fitted_heading(predicted: NDArray[np.complex128], measured: NDArray[np.complex128]) -> float:
    """Start heading that best aligns the predicted path with the measured one."""
    known = np.isfinite(measured)
    shape = predicted[known] - predicted[known][0]
    return float(np.angle(np.sum(np.conj(shape) * (measured[known] - measured[known][0]))))


def _facing(
    predicted: NDArray[np.complex128],
    yaw: Floats,
    measured: NDArray[np.complex128],
    heading: float,
) -> Floats:
    """Heading at each pose, by aligning the predicted path with the positions around it."""
    count = measured.size
    index = np.arange(count)
    low, high = np.maximum(index - FACING_POSES, 0), np.minimum(index + FACING_POSES, count - 1)
    chord, seen_chord = predicted[high] - predicted[low], measured[high] - measured[low]
    off = np.angle(seen_chord * np.conj(chord))
    usable = (np.abs(chord) > 0.0) & (np.abs(seen_chord) > 0.0)
    return yaw + np.where(usable, off, heading)


def reference_noise(
    robot: Robot, residuals: Sequence[Residual], kind: ReferenceKind
) -> tuple[float | None, float | None]:
    """Standard deviations (position [m], heading [rad]) of the reference.

    Of each pose (absolute) or of each interval (incremental). None if poses are too few, or if the
    quantity is not measured.
    """
    reading = quantisation_variance(robot)
    if kind == "incremental":
        errors = np.concatenate([_steps(item) for item in residuals])
        sigmas = [_growing(errors[:, part]) for part in ((0, 1), (2,))]
        reading = 2.0 * reading
    else:
        sigmas = [
            _level([_position_differences(item) for item in residuals]),
            _level([_heading_differences(item) for item in residuals]),
        ]
    positions = [item.measured.real for item in residuals]
    headings = [item.measured_yaw for item in residuals]
    return (
        _less(sigmas[0], float(reading[0]), _rounding(positions)),
        _less(sigmas[1], float(reading[2]), _rounding(headings)),
    )


def stamp_noise(every: Concatenated, residuals: Sequence[Residual]) -> float:
    """Standard deviation of the stamps of gyros, and of scans [s]; zero for others.

    Heading errors in turns have a larger dispersion than on straight lines, by turn rate times
    this. Spans are longer than two messages of the ticks, since the interpolation between two
    messages causes the same error in all headings.
    """
    if not every.has_stamp_noise:
        return 0.0
    pairs = zip(every.runs, residuals, strict=True)
    found = [_scatter_and_rate(item, run.counters.time) for run, item in pairs]
    scatter, rate = (np.concatenate(part) for part in zip(*found, strict=True))
    turning = rate > TURNS_ENOUGH
    if min(turning.sum(), (~turning).sum()) < DIFFERENCES:
        return 0.0
    fast, slow = (
        (MEDIAN_TO_SIGMA * float(np.median(scatter[rows]))) ** 2 / 20.0
        for rows in (turning, ~turning)
    )
    more = float(np.median(rate[turning] ** 2) - np.median(rate[~turning] ** 2))
    return float(np.sqrt(max(fast - slow, 0.0) / more))


def _scatter_and_rate(item: Residual, ticks: Floats) -> tuple[Floats, Floats]:
    """Absolute third differences of the heading error, and turn rates there [rad, rad/s]."""
    apart, messages = (float(np.median(np.diff(time))) for time in (item.time, ticks))
    span = max(1, round(2.0 * messages / max(apart, 1e-9)))
    first = np.arange(max(item.time.size - 3 * span, 0))
    last = first + 3 * span
    off, turned = (
        np.concatenate([[0.0], np.cumsum(part[:, 2])]) for part in (item.intervals, item.relative)
    )
    left = sum(factor * off[first + number * span] for number, factor in enumerate(_THIRD))
    rate = np.abs(turned[last] - turned[first]) / (item.time[last] - item.time[first])
    moved = np.concatenate([[0.0], np.cumsum(np.abs(item.relative).sum(axis=1))])
    moving = moved[last] > moved[first]
    return np.abs(left)[moving], rate[moving]


Differences = dict[int, tuple[Floats, float]]
"""By span in intervals: third differences, and the motion over one of them."""

_SPANS = (1, 2, 4)


def _position_differences(item: Residual) -> Differences:
    """Third differences of the position error, for several spans."""
    found: Differences = {}
    path = np.abs(item.relative[:, :2]).sum(axis=1)
    for span in _SPANS:
        ahead = item.measured.size - 3 * span
        if ahead < 1:
            break
        rows = np.arange(ahead)
        moved = sum(
            factor * item.predicted[rows + number * span] for number, factor in enumerate(_THIRD)
        )
        seen_moved = sum(
            factor * item.measured[rows + number * span] for number, factor in enumerate(_THIRD)
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


def _heading_differences(item: Residual) -> Differences:
    """Third differences of the heading error, for several spans."""
    found: Differences = {}
    off = np.concatenate([[0.0], np.cumsum(item.intervals[:, 2])])
    turned = np.abs(item.relative[:, 2])
    for span in _SPANS:
        ahead = off.size - 3 * span
        if ahead < 1:
            break
        rows = np.arange(ahead)
        left = sum(factor * off[rows + number * span] for number, factor in enumerate(_THIRD))
        reach = float(np.mean(turned)) * 3 * span
        found[span] = (np.asarray(left)[_moving(turned, span) & np.isfinite(left)], reach)
    return found


def _moving(driven: Floats, span: int) -> NDArray[np.bool_]:
    """Differences over a span that were taken in motion; all, if few were."""
    sums = np.concatenate([[0.0], np.cumsum(driven)])
    moved = sums[3 * span :] - sums[: -3 * span] > 0.0
    return moved if moved.sum() >= DIFFERENCES else np.ones(moved.size, dtype=np.bool_)


def _level(runs: list[Differences]) -> float | None:
    """Variance extrapolated to zero span; None if there are too few differences."""
    spans, variances, counts = [], [], []
    for span in _SPANS:
        here = [run[span] for run in runs if span in run]
        left = np.concatenate([item[0] for item in here]) if here else np.zeros(0)
        reach = max((item[1] for item in here), default=0.0)
        if left.size < DIFFERENCES or (span > 1 and reach > DIFFERENCE_REACH):
            break
        spans.append(float(span))
        variances.append((MEDIAN_TO_SIGMA * float(np.median(np.abs(left)))) ** 2 / 20.0)
        counts.append(float(left.size))
    return _intercept(np.array(spans), np.array(variances), np.array(counts)) if spans else None


def _intercept(at: Floats, variances: Floats, counts: Floats) -> float:
    """Intercept at zero of a weighted line through the variances."""
    weight = counts / np.maximum(variances, 1e-300) ** 2
    weight = weight / weight.sum()
    middle, mean = float(weight @ at), float(weight @ variances)
    if variances.max() < VARIANCE_GROWS * variances[0]:
        return mean  # not significant; a line would extrapolate chance to zero
    spread = float(weight @ (at - middle) ** 2)
    slope = float(weight @ ((at - middle) * variances)) / spread if spread > 0.0 else 0.0
    # Where growth dominates the noise, do not trust the line down to zero.
    return max(mean - max(slope, 0.0) * middle, NOISE_LEFT * float(variances[0]))


def _steps(item: Residual) -> Floats:
    """Differences of errors of neighbouring intervals, scaled to one, without the systematic part.

    Shape (n - 2, 4): x, y, yaw, and the path of the two intervals.
    """
    path = np.hypot(item.relative[:, 0], item.relative[:, 1])
    left = np.diff(item.intervals, axis=0) / np.sqrt(2.0)
    return np.concatenate([left, 0.5 * (path[1:] + path[:-1])[:, None]], axis=1)


def _growing(columns: Floats) -> float | None:
    """Variance of the errors of single intervals; None if there are too few."""
    known = columns[np.isfinite(columns).all(axis=1)]
    if known.shape[0] < DIFFERENCES:
        return None
    return (MEDIAN_TO_SIGMA * float(np.median(np.abs(known)))) ** 2


def _less(variance: float | None, reading: float, rounding: float) -> float | None:
    """Standard deviation without encoder quantisation, which the legs account for themselves."""
    return None if variance is None else float(np.sqrt(max(variance - reading, rounding)))


def _rounding(values: Sequence[Floats]) -> float:
    """Quantisation variance: uniform over the smallest difference between written values."""
    steps = [np.diff(np.unique(part[np.isfinite(part)])) for part in values]
    every = np.concatenate(steps) if steps else np.zeros(0)
    every = every[every > 1e-9]
    return float(every.min(initial=np.inf)) ** 2 / 12.0 if every.size else 0.0
