# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two references of one drive as one: the positions of the one, the headings of the other.

A gyro tells turning far better than a localiser does, and drifts; a localiser tells where the robot
is and roughly how it faces, and does not drift. So the gyro's heading is laid upon the localiser's
(an angle and a steady drift, fitted to all of the drive) and stands in its place. Positions and
headings keep a noise and a delay of their own; the wheels take no part in this.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats

FEWEST = 10
"""Headings that both must have told: fewer do not tell an angle and a drift from noise."""


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
    angle, drift = _laid(since[both], poses.yaw[both], at[both])
    laid = np.where(inside, at + angle + drift * since, np.nan)
    degrees = np.degrees(60.0 * drift)
    told = (
        "headings are those of the one without positions, turned onto the other's and freed of a "
        f"steady drift of {degrees:+.2g}° a minute"
    )
    return replace(poses, yaw=laid, sigma_yaw=None), told


def _laid(since: Floats, yaw: Floats, at: Floats) -> tuple[float, float]:
    """Angle and drift that lay headings `at` upon `yaw`; jumps of either do not count (Huber)."""
    from scipy.optimize import least_squares

    apart = yaw - at
    apart = np.unwrap(apart)
    scale = max(float(np.median(np.abs(apart - np.median(apart)))), 1e-6)
    found = least_squares(
        lambda values: values[0] + values[1] * since - apart,
        [float(np.median(apart)), 0.0],
        loss="huber",
        f_scale=scale,
        x_scale=[1.0, 1.0 / max(float(since[-1]), 1.0)],
    )
    return float(found.x[0]), float(found.x[1])


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
