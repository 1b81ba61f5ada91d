# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two references of one drive as one: the positions of the one, the headings of the other.

A gyro tells turning far better than a localiser does, and drifts; a localiser tells where the robot
is and roughly how it faces, and does not drift. So the gyro's heading is laid upon the localiser's
(an angle, a steady drift, and its scale where the drive turns enough to tell it; fitted to all of
the drive) and stands in its place. Positions and headings keep a noise and a delay of their own;
the wheels take no part in this.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats

FEWEST = 10
"""Headings that both must have told: fewer do not tell an angle and a drift from noise."""
LASTING = 10.0
"""For how long a localiser errs alike [s]; AMCL and SLAM correct themselves in 5 to 30."""
_MEDIAN_TO_SIGMA = 1.4826  # of a normal scatter
SCALE_TOLD, SCALE_MOST = 4.0, 0.1
"""Standard deviations beyond which a gyro's scale is told, and the most that a gyro's is off."""


def merged(place: str, first: Reference, second: Reference) -> tuple[Reference, str]:
    """Positions of what has them, with the headings of what has nothing else.

    Parameters
    ----------
    place
        Where they are, for errors.

    Returns
    -------
    reference
        At the stamps of the positions; headings only while the gyro was heard.
    told : str
        What was laid upon what, in words.

    Raises
    ------
    InputError
        When they are not one with positions and headings and one with headings alone.
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
    if int(poses.has_yaw.sum()) < FEWEST:
        raise InputError(
            f"{place}: the one with positions holds no headings, by which the other's could be "
            "laid upon its map; judge them one after the other"
        )
    time, yaw = _ascending(headings)
    inside = (poses.time >= time[0]) & (poses.time <= time[-1]) if time.size else poses.time < 0.0
    both = inside & poses.has_yaw
    if int(both.sum()) < FEWEST:
        raise InputError(
            f"{place}: they were not recorded at the same time: {_span(poses.time)} and "
            f"{_span(headings.time)}"
        )
    at = np.interp(poses.time, time, yaw)
    since = poses.time - poses.time[both][0]
    middle = float(np.mean(at[both]))
    angle, drift, scale = _laid(since[both], poses.yaw[both], at[both], middle)
    laid = np.where(inside, middle + scale * (at - middle) + angle + drift * since, np.nan)
    degrees = np.degrees(60.0 * drift)
    told = (
        "headings are those of the one without positions, turned onto the other's and freed of a "
        f"steady drift of {degrees:+.2g}° a minute"
    )
    if scale != 1.0:
        told += f"; what it shows of a turn is {100.0 / scale:.2f} % of the other's, and mended"
    return replace(poses, yaw=laid, sigma_yaw=None), told


def _laid(since: Floats, yaw: Floats, at: Floats, middle: float) -> tuple[float, float, float]:
    """Angle, drift and scale that lay headings `at` upon `yaw`; jumps do not count (Huber)."""
    from scipy.optimize import least_squares

    apart = np.unwrap(yaw - at)
    spread = max(float(np.median(np.abs(apart - np.median(apart)))), 1e-6)
    columns = np.stack([np.ones(at.size), since, at - middle], axis=-1)
    begin = np.array([float(np.median(apart)), 0.0, 0.0])
    sizes = np.array([1.0, 1.0 / max(float(since[-1]), 1.0), 1.0 / max(float(np.ptp(at)), 1.0)])

    def fitted(free: int) -> Floats:
        found = least_squares(
            lambda values: columns[:, :free] @ values - apart,
            begin[:free],
            loss="huber",
            f_scale=spread,
            x_scale=sizes[:free],
        )
        return np.asarray(found.x)

    without, whole = fitted(2), fitted(3)
    left = apart - columns @ whole
    # A localiser errs alike for seconds: as many headings tell as there are times of LASTING.
    count = max(float(since[-1] - since[0]) / LASTING, 1.0)
    noise = _MEDIAN_TO_SIGMA * float(np.median(np.abs(left - np.median(left))))
    clear = np.linalg.lstsq(columns[:, :2], columns[:, 2], rcond=None)[0]
    free = columns[:, 2] - columns[:, :2] @ clear
    told = abs(whole[2]) * float(np.std(free)) * np.sqrt(count)
    if told > SCALE_TOLD * max(noise, 1e-12) and abs(whole[2]) < SCALE_MOST:
        return float(whole[0]), float(whole[1]), 1.0 + float(whole[2])
    return float(without[0]), float(without[1]), 1.0


def _ascending(reference: Reference) -> tuple[Floats, Floats]:
    """Stamps and unwrapped headings, those that are not later than the ones before left out."""
    known = reference.has_yaw
    time, yaw = reference.time[known], reference.yaw[known]
    if time.size == 0:
        return time, yaw
    later = np.concatenate([[True], np.diff(np.maximum.accumulate(time)) > 0.0])
    return time[later], np.unwrap(yaw[later])


def _span(time: Floats) -> str:
    return f"t_s {time.min():.14g} to {time.max():.14g}"
