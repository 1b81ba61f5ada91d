# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Lays a gyro's heading upon the direction of a path: its angle, steady drift and scale.

The middle of an axle goes along its heading, ahead or backwards, and nothing to the side. So
between positions it goes to the side of a heading that is off by an angle, by that angle times the
way ahead (negative backwards). Over parts of the path that are long against the positions' noise
this is a linear regression. A point ahead of the axle goes to the side by its distance times the
turn, and a heading that is late by the delay times the turn rate and the way; both are fitted too,
and dropped. A point beside the axle goes along the heading.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

ANGLES = {"reference_yaw_offset": 1.0, "sideways_drift": -1.0}
"""Effects that are an angle between heading and path, which a path does not tell, with its sign."""
LONG, LEAST = 10.0, 0.1
"""Length of a part of the path, in the noise of a position and at least [m]: its direction is then
known to 8 degrees, and that of a hundred to one."""
FEWEST = 10
"""Least number of such parts."""
BENT = 0.5
"""Curvature of a part [1/m] of which it weighs half at first: there a point half a metre off the
axle goes 14 degrees past the heading."""
COHERENT, BY_CHANCE = 0.5, 10.0
"""Least resultant of the parts' directions in axes that turn with the gyro (1 if all are one), and
least log of the odds against its being chance."""
DRIFT_MOST = 0.2
"""Largest drift that is looked for [rad/s]: 11 degrees a second, a gyro without calibration."""
UNSURE = 0.2
"""Largest standard deviation of the heading anywhere in the drive [rad]: the fits of a model, which
find it anew by all that they know, are linear so far."""
DISTINCT, APART = 2.0, 0.3
"""Least way of a part (rms) that a point off the axle would not go by the turning alone: in the
scatter to the side, and as a share of the whole way. On the spot it is that scatter, and a sixth
where turns begin and end a tenth of a second beside the gyro's."""
TURNED_MOST = 1.0
"""Largest turn between positions [rad]; where a robot went meanwhile is not known beyond."""
MEDIAN_TO_SIGMA = 1.4826
"""Of a normal distribution."""
_HUBER = 1.345
_ROUNDS = 20

Complex = NDArray[np.complex128]


class CourseFit(NamedTuple):
    """Alignment of a gyro's heading with a path; for stamps from the first position on."""

    angle: float
    """[rad]"""
    drift: float
    """[rad/s]"""
    scale: float
    """Turn of the path over that of the gyro, but for what a steady drift explains."""
    scale_std: float
    unsure: float
    """Standard deviation of the heading at that end of the drive where it is larger [rad]."""


def course_fit(
    time: Floats, place: Complex, gyro: tuple[Floats, Floats], turned: Floats
) -> CourseFit | str:
    """Align a gyro with a path that it was recorded on, or say why the path does not tell how.

    `time`, `place` (n,): stamps, rising [s], and positions x + i y [m]. `gyro`: its stamps and
    unwrapped headings. `turned` (n,): its turn without offset and steady drift, at the positions.
    """
    since = time - time[0]
    middle, turned = _middles(since), _middles(turned)
    facing = _mean_direction(gyro, time)
    lasted = np.diff(time)
    turn = np.diff(np.interp(time, *gyro))
    known = np.abs(turn) < TURNED_MOST
    steps = np.where(known, np.diff(place) * np.conj(facing), 0.0)
    noise = _scatter(np.diff(steps)) / np.sqrt(6.0)
    begins, last = _parts(steps, max(LONG * noise, LEAST))
    if begins.size < FEWEST:
        return (
            f"its positions scatter by {1e3 * noise:.2g} mm, and the robot drove no {FEWEST} times "
            f"{max(LONG * noise, LEAST):.2g} m, whose directions would tell the heading"
        )

    def of_parts(values: Floats) -> Floats:
        return np.asarray(np.add.reduceat(values[:last], begins))

    at = of_parts(middle * lasted) / of_parts(lasted)
    ways = of_parts(steps.real) + 1j * of_parts(steps.imag)
    found = _roughly(ways, of_parts(np.abs(turn)), at, float(since[-1]))
    if found is None:
        return "the path does not turn as it does (is it upside down, dead, or in degrees?)"
    told = np.array([*found, 0.0])
    along, columns, aside = np.zeros(0), np.zeros((0, 5)), np.zeros(0)
    for _ in range(_ROUNDS):
        seen = steps * np.exp(-1j * (told[0] + told[1] * middle + told[2] * turned))
        along = seen.real
        swung = np.where(known, turn + told[1] * lasted, 0.0)
        late = along * swung / lasted
        columns = np.stack(
            [of_parts(each) for each in (along, along * middle, along * turned, swung, late)],
            axis=1,
        )
        aside = of_parts(seen.imag)
        change = _robustly(columns, aside)
        told += change[:3]
        if np.abs(change[0]) + np.abs(change[1]) * since[-1] < 1e-6:
            break
    left = aside - columns @ _robustly(columns, aside)
    scatter = max(MEDIAN_TO_SIGMA * float(np.median(np.abs(left))), 1e-6)
    heading = scatter**2 * _precision_inverse(columns, [0, 1])
    ends_of_drive = np.array([[1.0, 0.0], [1.0, since[-1]]])
    unsure = float(np.sqrt(np.max(np.sum((ends_of_drive @ heading) * ends_of_drive, axis=1))))
    way, free = columns[:, :1], _free_of(columns[:, 3:], columns[:, :1])
    usual, apart = (float(np.sqrt(np.mean(each**2))) for each in (way, free))
    if apart < max(DISTINCT * scatter, APART * usual):
        unsure = np.pi
    if not unsure < UNSURE:
        return (
            f"the direction of the path tells its heading to ±{np.degrees(min(unsure, np.pi)):.2g}°"
            " at best (standard deviation), as where a robot turns on the spot, drives one curve "
            "or goes less far than its positions scatter: drive straight lines too"
        )
    angle = told[0] if along.sum() > 0.0 else told[0] + np.pi
    scale_std = scatter * float(np.sqrt(_precision_inverse(columns, [2])[0, 0]))
    return CourseFit(float(angle), float(told[1]), 1.0 + float(told[2]), scale_std, unsure)


def _middles(values: Floats) -> Floats:
    return np.asarray(0.5 * (values[1:] + values[:-1]))


def _scatter(changes: Complex) -> float:
    """Standard deviation of the changes of steps to the side; ahead a robot speeds up."""
    ahead = 0.5 * np.angle(np.sum(changes**2 / np.maximum(np.abs(changes), 1e-12)))
    return MEDIAN_TO_SIGMA * float(np.median(np.abs((changes * np.exp(-1j * ahead)).imag)))


def _mean_direction(gyro: tuple[Floats, Floats], time: Floats) -> Complex:
    """Direction of the way between stamps by a gyro's headings, if the speed is even, (n - 1,)."""
    stamps, yaw = gyro
    facing = np.exp(1j * yaw)
    sums = np.cumsum(0.5 * (facing[1:] + facing[:-1]) * np.diff(stamps))
    way = np.diff(np.interp(time, stamps, np.concatenate([[0j], sums])))
    return np.asarray(np.exp(1j * np.angle(way)))


def _parts(steps: Complex, least: float) -> tuple[NDArray[np.intp], int]:
    """First steps of the parts of a path that each go as far as `least` [m]; the end of the last.

    To and fro alike: each part goes so far from where it began.
    """
    bounds, gone = [0], 0j
    for number, step in enumerate(steps.tolist()):
        gone += step
        if abs(gone) >= least:
            bounds.append(number + 1)
            gone = 0j
    return np.array(bounds[:-1], dtype=np.intp), bounds[-1]


def _roughly(ways: Complex, turns: Floats, at: Floats, lasted: float) -> tuple[float, float] | None:
    """Angle and drift for which most ways go ahead or backwards; None if none is convincing.

    By doubled angles, which are those of ways ahead and backwards alike.
    """
    length = np.abs(ways)
    weight = np.minimum(length, 2.0 * np.median(length))
    weight = weight / (1.0 + (turns / length / BENT) ** 2)
    doubled = weight * (ways / length) ** 2
    few = slice(None, None, -(-ways.size // 500))
    drifts = np.linspace(-DRIFT_MOST, DRIFT_MOST, 2 * int(DRIFT_MOST * lasted / 0.5) + 3)
    sums = np.array([np.exp(-2j * drift * at[few]) @ doubled[few] for drift in drifts])
    best = int(np.argmax(np.abs(sums)))
    share = float(np.abs(sums[best]) / weight[few].sum())
    count = float(weight[few].sum() ** 2 / np.sum(weight[few] ** 2))
    chance = (count - 1.0) * np.log(max(1.0 - share**2, 1e-12))
    if share < COHERENT or -chance < np.log(drifts.size) + BY_CHANCE:
        return None
    return 0.5 * float(np.angle(sums[best])), float(drifts[best])


def _robustly(columns: Floats, values: Floats) -> Floats:
    """Coefficients of the columns that explain values, robust to outliers (Huber)."""
    size = np.maximum(np.linalg.norm(columns, axis=0), 1e-12)
    weight, found = np.ones(values.size), np.zeros(columns.shape[1])
    for _ in range(_ROUNDS):
        root = np.sqrt(weight)
        found = np.linalg.lstsq(root[:, None] * columns / size, root * values, rcond=1e-9)[0]
        left = np.abs(values - columns / size @ found)
        spread = max(_HUBER * MEDIAN_TO_SIGMA * float(np.median(left)), 1e-9)
        weight = np.minimum(1.0, spread / np.maximum(left, 1e-12))
    return np.asarray(found / size)


def _precision_inverse(columns: Floats, wanted: list[int]) -> Floats:
    """Covariance of some coefficients for values of unit noise, with all others free."""
    own, others = columns[:, wanted], np.delete(columns, wanted, axis=1)
    size = np.maximum(np.linalg.norm(own, axis=0), 1e-12)
    free = _free_of(others, own / size)
    inverse = np.linalg.inv(free.T @ free + 1e-12 * np.eye(len(wanted)))
    return np.asarray(inverse / np.outer(size, size))


def _free_of(others: Floats, columns: Floats) -> Floats:
    """What other columns do not explain of some."""
    return np.asarray(columns - others @ np.linalg.lstsq(others, columns, rcond=1e-9)[0])
