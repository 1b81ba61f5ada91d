# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ways by the counters and by the reference, chord by chord: columns that are of other units."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.files.tables.counter_columns import FEWEST
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

MILLIMETRES = 1000.0
METRES, OTHERWISE = 1.25, 3.0
"""Factor within which counters go as many units as the reference goes metres, and that by which the
robot file says otherwise."""
METRES_OF_A_DEGREE = 1.1e5
"""On the Earth, of latitude [m]; of longitude that times the cosine of the latitude."""
ONE_SCALE = 1.5
"""Factor within which most chords have the drive's own ratio of both ways."""
FAR_APART = 20.0
"""Factor between the ways by wheels and reference above which a robot file is of another unit."""

CHORD = 0.05
"""Chords of the path, as a share of its extent: long against noise, short against a lap."""
LEAST_CHORD, FEWEST_CHORDS, ROLLED = 0.01, 10, 0.8
"""Length of such chords [m], their number (a line makes at most 20), and share of them with counts,
from which ways are compared."""
_STRETCH = 64
"""Rows that are looked at first for the end of a chord, then twice as many, and so on."""


def words_about_ways(run: Run, robot: Robot) -> str:
    """Ways by wheels and reference that are of different units; "" if they are not.

    Of a robot that rolled most of the time while it moved: one that is carried does not.
    """
    ways = _ways_of(run, robot)
    if ways is None:
        return ""
    counted, seen = (float(each.sum()) for each in ways)
    rolled = 0.5 * counted * (robot.left_tick + robot.right_tick)
    if seen / FAR_APART < rolled < FAR_APART * seen:
        return ""
    told = (
        f"by its wheels, with this robot file, it went {rolled:.2g} m, and by the reference "
        f"{seen:.2g} m, {seen / counted:.2g} m for each count"
    )
    if MILLIMETRES / METRES < seen / rolled < MILLIMETRES * METRES:
        return (
            f"{told}: x_m and y_m are in millimetres, and mean metres (divide by 1000), or "
            "wheel_radius or the counts of a turn are wrong by as much"
        )
    return (
        f"{told}: look at wheel_radius and at the counts of a turn; counters in radians have "
        "left_ticks_per_revolution: 6.283185, in degrees 360"
    )


def ways_of_one_scale(run: Run, robot: Robot) -> tuple[float, float] | None:
    """Ways [m] by the wheels and by the reference, if chord by chord they differ by one factor.

    A robot file that is wrong by it hides all that both have in common, unless the turns show it.
    """
    ways = _ways_of(run, robot)
    if ways is None:
        return None
    counted, seen = ways
    ratio = (seen / np.maximum(counted, 1e-9)) / (seen.sum() / counted.sum())
    if np.mean((ratio < ONE_SCALE) & (ratio > 1.0 / ONE_SCALE)) < ROLLED:
        return None
    rolled = 0.5 * float(counted.sum()) * (robot.left_tick + robot.right_tick)
    return rolled, float(seen.sum())


def words_about_metres(ticks: Ticks, reference: Reference, robot: Robot) -> str:
    """Counters that are metres already; "" if they are not."""
    ways = _ways(ticks, reference)
    if ways is None or all((part == np.rint(part)).all() for part in (ticks.left, ticks.right)):
        return ""
    counted, seen = (float(each.sum()) for each in ways)
    size = 0.5 * (robot.left_tick + robot.right_tick)
    if not 1.0 / METRES < seen / counted < METRES or 1.0 / OTHERWISE < size < OTHERWISE:
        return ""
    return (
        f"left_ticks and right_ticks go {counted:.4g} where the robot goes {seen:.4g} m: they are "
        "metres, and no counts: write how many steps of 0.01 mm they are, as whole numbers, and "
        "into the robot file how many of these its wheel goes in a turn (left_ticks_per_revolution "
        "= 2 pi wheel_radius / 0.00001)"
    )


def words_about_globe(ticks: Ticks, reference: Reference, robot: Robot) -> str:
    """Positions that are longitude and latitude; "" if they are not."""
    ways = _ways(ticks, reference, 0.0)
    if ways is None or not reference.has_position.all():
        return ""
    rolled = 0.5 * float(ways[0].sum()) * (robot.left_tick + robot.right_tick)
    degrees = float(ways[1].sum())
    most, least = (METRES_OF_A_DEGREE * factor for factor in (OTHERWISE, 1.0 / OTHERWISE))
    if not least * degrees < rolled < most * degrees:
        return ""
    return (
        f"x_m and y_m go {degrees:.2g} where the wheels go {rolled:.3g} m, as degrees of longitude "
        "and latitude do: write metres east and north of the first fix (a degree of latitude is "
        "111 km, one of longitude that times the cosine of the latitude)"
    )


def _ways_of(run: Run, robot: Robot) -> tuple[Floats, Floats] | None:
    if run.reference is None:
        return None
    return _ways(run.ticks.unwrapped(robot.encoder_bits), run.reference)


def _ways(
    ticks: Ticks, reference: Reference, least: float = LEAST_CHORD
) -> tuple[Floats, Floats] | None:
    """Counts of a wheel and metres by the reference, of each chord; None if hardly any."""
    rows = np.flatnonzero(reference.has_position)
    if min(ticks.rows, rows.size) < FEWEST:
        return None
    place = reference.x[rows] + 1j * reference.y[rows]
    chord = CHORD * float(np.hypot(np.ptp(place.real), np.ptp(place.imag)))
    ends = ends_of_chords(place, chord)
    when = reference.time[rows[ends]]
    inside = (when >= ticks.time.min()) & (when <= ticks.time.max())
    if np.count_nonzero(inside) <= FEWEST_CHORDS or chord < least:
        return None
    stamps = np.maximum.accumulate(ticks.time)
    counts = [np.interp(when[inside], stamps, part) for part in (ticks.left, ticks.right)]
    moved = np.abs(np.diff(counts, axis=1)).mean(axis=0)
    if not np.isfinite(moved).all() or np.count_nonzero(moved) < ROLLED * moved.size:
        return None
    return moved, np.abs(np.diff(place[ends][inside]))


def ends_of_chords(place: NDArray[np.complex128], least: float) -> NDArray[np.intp]:
    """Rows at which a path is `least` away from the row chosen before."""
    chosen, at, size = [0], 0, _STRETCH
    while least > 0.0 and at < place.size:
        far = np.abs(place[at : at + size] - place[chosen[-1]]) >= least
        if far.any():
            at += int(far.argmax())
            size = _STRETCH
            chosen.append(at)
        else:
            at, size = at + size, 2 * size
    return np.asarray(chosen, dtype=np.intp)
