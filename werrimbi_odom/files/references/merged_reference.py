# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Merges two references of one drive: positions of one, headings of the other.

A gyro measures turns far more precisely than a localiser, but drifts. A localiser measures position
and, roughly, heading without drift. So the gyro's heading is aligned with the localiser's (an
offset and a constant drift, fitted over the drive) and replaces it. Its scale is estimated from all
drives together. Positions and headings keep separate noise and delay; the wheels are not used. With
scans, heading and position are simultaneous, so the gyro is moved to the scans' clock: otherwise a
delay of the positions alone would look like a lever arm during steady driving.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.references.course_alignment import ANGLES, MEDIAN_TO_SIGMA, course_fit
from werrimbi_odom.files.run import GyroTurn, Reference
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

FEWEST = 10
"""Least number of common headings: fewer do not separate offset and drift from noise."""
LASTING = 10.0
"""Correlation time of a localiser's errors [s]; AMCL and SLAM correct themselves in 5 to 30."""
SCALE_TOLD, SCALE_MOST = 4.0, 0.1
"""Significance of a gyro's scale in standard deviations, and its largest plausible error."""
LATE_MOST = 0.5
"""Largest plausible delay between the gyro and the lidar of a robot [s]."""
_ROUNDS = 6


def merged(
    place: str, first: Reference, second: Reference, cuts: Sequence[tuple[float, float]] = ()
) -> tuple[Reference, str]:
    """Combine positions of one reference with the headings of the other.

    `place`: location of the data, for error messages. `cuts`: from the last pose of a segment to
    the first of the next [s], if the positions are in segments. The heading is aligned with each
    segment separately, with a common drift. Result: at the stamps of the positions; headings only
    within the gyro's time span. Then a description of the alignment. InputError unless one
    reference has positions and headings and the other only headings.
    """
    alone = [each for each in (first, second) if not each.has_position.any()]
    whole = [each for each in (first, second) if each.has_position.any()]
    if len(alone) != 1:
        what = "both hold positions" if not alone else "neither holds positions"
        raise InputError(
            f"{place}: {what}. Two references are judged together where the one holds poses and "
            "the other headings alone (a localiser and a gyro); judge others one after the other"
        )
    (headings,), (poses,) = alone, whole
    time, yaw = _ascending(headings)
    by_course = int(poses.has_yaw.sum()) < FEWEST
    inside = (poses.time >= time[0]) & (poses.time <= time[-1]) if time.size else poses.time < 0.0
    both = inside & (poses.has_position if by_course else poses.has_yaw)
    if int(both.sum()) < FEWEST:
        raise InputError(
            f"{place}: they were not recorded at the same time: {_span(poses.time)} and "
            f"{_span(headings.time)}"
        )
    since = poses.time - poses.time[both][0]
    if by_course:
        return _upon_course(place, poses, (time, yaw), inside, since)
    piece = np.searchsorted([end for _, end in cuts], poses.time, side="right")
    pieces = (piece[:, None] == np.arange(len(cuts) + 1)).astype(np.float64)
    columns = np.column_stack([pieces, since])
    late = _later(poses, (time, yaw), pieces, columns, both) if poses.own_axes else 0.0
    at = np.interp(poses.time - late, time, yaw)
    apart = poses.yaw - at
    read = time + late, yaw
    told, gyro, drift = _gyro_turn(read, pieces[both], columns, at, apart, both)
    laid = np.where(inside, at + columns @ told, np.nan)
    each = f", in each of its {len(cuts) + 1} pieces by itself," if cuts else ""
    words = _words(f"turned onto the other's{each}", drift)
    if late:
        when = "before" if late > 0.0 else "after"
        words += (
            f"; by them the robot turns {1e3 * abs(late):.0f} ms {when} it does by the other, on "
            "whose clock they are put"
        )
    return replace(poses, yaw=laid, sigma_yaw=None, covariance=None, gyro=gyro), words


def as_mounted(reference: Reference, robot: Robot) -> Reference:
    """Turn headings that were laid upon a path to the angle that a robot file has between both.

    It was found with another reference, and the path tells nothing of it.
    """
    gyro = reference.gyro
    if gyro is None or not gyro.by_course:
        return reference
    applied = [each for each in robot.effects if each.name in ANGLES]
    mount = sum(ANGLES[each.name] * each.values["angle"] for each in applied)
    yaw = reference.yaw + mount - gyro.mount
    return replace(reference, yaw=yaw, gyro=gyro._replace(mount=mount))


def _upon_course(
    place: str,
    poses: Reference,
    gyro: tuple[Floats, Floats],
    inside: NDArray[np.bool_],
    since: Floats,
) -> tuple[Reference, str]:
    """Combine positions without headings with a gyro's, laid upon the direction of their path."""
    at = np.interp(poses.time, *gyro)
    rows = np.flatnonzero(inside & poses.has_position)
    rows = rows[_later_than_all_before(poses.time[rows])]
    columns = np.column_stack([np.ones_like(since), since])
    clear = np.linalg.lstsq(columns[rows], at[rows], rcond=None)[0]
    turned = at - columns @ clear
    path = poses.x[rows] + 1j * poses.y[rows]
    found = course_fit(poses.time[rows], path, gyro, turned[rows])
    if isinstance(found, str):
        raise InputError(
            f"{place}: the one with positions holds no headings, and {found}; else judge them one "
            "after the other"
        )
    laid = np.where(inside, at + found.angle + found.drift * since, np.nan)
    sure = SCALE_TOLD * found.scale_std < abs(found.scale - 1.0) < SCALE_MOST
    drift = found.drift - (float(clear[1]) * (found.scale - 1.0) if sure else 0.0)
    turn = GyroTurn(*gyro, turned, found.scale, found.scale_std, by_course=True)
    words = (
        f"{_words('laid upon the direction of the path', drift)} (which tells them to "
        f"±{np.degrees(found.unsure):.1g}°, ahead being where most of the way goes); so neither "
        "an angle at which the robot drives nor one at which the gyro sits is told by them"
    )
    seen = replace(poses, yaw=laid, sigma_yaw=None, covariance=None, gyro=turn, kind="local_map")
    return seen, words


def _words(how: str, drift: float) -> str:
    degrees = np.degrees(60.0 * drift)
    return (
        f"headings are those of the one without positions, {how} and freed of a steady drift of "
        f"{degrees:+.2g}° a minute"
    )


def with_one_scale(references: Sequence[Reference], of: Sequence[Reference]) -> list[Reference]:
    """Apply a common scale to the gyros' headings, if some drives together determine it.

    The gyro is the same in all drives. From a single drive, its scale is only as good as the other
    reference's drift allows. `of`: drives that determine the scale; the others are not used for it.
    """
    told = [each.gyro for each in of if each.gyro is not None]
    weights = np.array([each.std**-2 for each in told])
    if not told:
        return list(references)
    scales = np.array([each.scale for each in told])
    scale = float(weights @ scales / weights.sum())
    apart = float(weights @ (scales - scale) ** 2) / max(len(told) - 1, 1)
    std = float(np.sqrt(max(apart, 1.0) / weights.sum()))
    if not SCALE_TOLD * std < abs(scale - 1.0) < SCALE_MOST:
        return list(references)
    return [
        each
        if each.gyro is None
        else replace(each, yaw=each.yaw + (scale - 1.0) * each.gyro.turned)
        for each in references
    ]


def _later(
    poses: Reference,
    gyro: tuple[Floats, Floats],
    pieces: Floats,
    columns: Floats,
    both: NDArray[np.bool_],
) -> float:
    """Delay of the headings of poses relative to a gyro's [s]; 0 if not significant.

    By Gauss-Newton: with a delay d, a heading lags by d times the turn rate.
    """
    late, pieces, time = 0.0, pieces[both], poses.time[both]
    step = float(np.median(np.diff(time)))
    for _ in range(_ROUNDS):
        ahead, at, back = (np.interp(time - late + side, *gyro) for side in (step, 0.0, -step))
        rate = (ahead - back) / (2.0 * step)
        free = np.column_stack([columns[both], rate])
        told = _laid(pieces, free, poses.yaw[both] - at)
        late -= float(told[-1])
        if not abs(late) < LATE_MOST:
            return 0.0
    left = np.unwrap(poses.yaw[both] - at) - free @ told
    noise = MEDIAN_TO_SIGMA * float(np.median(np.abs(left - np.median(left))))
    std = max(noise, 1e-6) * float(np.sqrt(np.linalg.pinv(free.T @ free)[-1, -1]))
    return late if abs(late) > SCALE_TOLD * std > 0.0 else 0.0


def _gyro_turn(
    read: tuple[Floats, Floats],
    pieces: Floats,
    columns: Floats,
    gyro: Floats,
    apart: Floats,
    both: NDArray[np.bool_],
) -> tuple[Floats, GyroTurn, float]:
    """Coefficients of the columns; the gyro's turn, with its scale error; the drift [rad/s].

    Columns and scale are fitted together. Otherwise the columns would absorb the part of a scale
    error that follows the drive's mean turn direction, and more than is corrected later. The drift
    excludes the part due to a scale that this drive determines.
    """
    clear = np.linalg.lstsq(columns[both], gyro[both], rcond=None)[0]
    turned = gyro - columns @ clear
    free = np.column_stack([columns[both], turned[both]])
    told = _laid(pieces, free, apart[both])
    left = np.unwrap(apart[both]) - free @ told
    noise = MEDIAN_TO_SIGMA * float(np.median(np.abs(left - np.median(left))))
    # A localiser's errors are correlated, so the number of independent headings is that of such
    # intervals.
    count = max(float(np.ptp(columns[both, -1])) / LASTING, 1.0)
    spread = max(float(np.std(turned[both])), 1e-9)
    std = max(noise, 1e-6) / spread / np.sqrt(count)
    more = float(told[-1]) if SCALE_TOLD * std < abs(told[-1]) < SCALE_MOST else 0.0
    drift = float(told[-2] - more * clear[-1])
    return np.asarray(told[:-1]), GyroTurn(*read, turned, 1.0 + told[-1], std), drift


def _laid(pieces: Floats, columns: Floats, apart: Floats) -> Floats:
    """Coefficients of the columns that explain angles, robust to jumps (Huber).

    The first columns are `pieces`: 1 within a segment, else 0.
    """
    from scipy.optimize import least_squares

    apart = np.unwrap(apart)
    begin = np.zeros(columns.shape[1])
    for number, here in enumerate(pieces.T > 0.0):
        begin[number] = float(np.median(apart[here])) if here.any() else 0.0
    spread = max(float(np.median(np.abs(apart - columns @ begin))), 1e-6)
    found = least_squares(
        lambda values: columns @ values - apart,
        begin,
        loss="huber",
        f_scale=spread,
        x_scale=1.0 / np.maximum(np.ptp(columns, axis=0), 1.0),
    )
    return np.asarray(found.x)


def _ascending(reference: Reference) -> tuple[Floats, Floats]:
    """Stamps and unwrapped headings, without those that are not later than earlier ones."""
    known = reference.has_yaw
    time, yaw = reference.time[known], reference.yaw[known]
    if time.size == 0:
        return time, yaw
    later = _later_than_all_before(time)
    return time[later], np.unwrap(yaw[later])


def _later_than_all_before(time: Floats) -> NDArray[np.bool_]:
    return np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0.0])


def _span(time: Floats) -> str:
    return f"t_s {time.min():.14g} to {time.max():.14g}"
