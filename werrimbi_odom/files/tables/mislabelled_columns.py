# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Columns that hold something else than their names say; the message says how to convert them.

Such mistakes are made where a log is written as a run folder. No effect corrects them, and each
makes wheels and reference look as if they had nothing in common. Degrees and millimetres are
recognised in the set-up search too, which knows how well each fits (`inference.set_up.search`).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.files.tables.compared_ways import (
    CHORD,
    ends_of_chords,
    words_about_globe,
    words_about_metres,
)
from werrimbi_odom.files.tables.counter_columns import (
    FEWEST,
    HARDLY,
    TAKES,
    turns_by_wheels,
    what_counters_hold,
    wraps_words,
)
from werrimbi_odom.files.tables.standing_reference import no_turn, stands_still
from werrimbi_odom.files.tables.units_of_time import other_unit_of_time, rounded_times
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

FOLLOWS, CONTRADICTS = 0.8, 0.7
"""Mean resultant length of the angle between path and yaw, above which they belong together and
below which they do not. A path along the yaw has 1 less its scatter (0.8 at 0.67 rad). On a path
that hardly turns, both senses of turning have much."""
TURNED = 0.9
"""Mean resultant length of the path's direction above which it hardly turned (0.46 rad)."""
FAR_LESS = 3.0
"""Factor by which a path that turned scatters less about the yaw turned over (1 less the length
above). About its own yaw a path scatters less, as the other sense adds twice its turning."""

MORE_THAN_A_TURN = 2.1 * np.pi
"""Range of yaw from which it may be in degrees: wrapped, in radians, it is 2 pi at most."""
YAW_IN_DEGREES = (
    "the reference's yaw is in degrees, and must be in radians: convert that column (times "
    "pi/180; of a gyro, its rates)"
)

FAR, FAR_STEPS = 0.05, 20.0
"""Distance [m], and in typical steps of the reference, beyond which a pose of zeros is none."""


def refuse_wrong_columns(run: Run, robot: Robot) -> None:
    """Check the meaning of a run's columns by its data.

    InputError if the times are not in seconds or are rounded, the reference stands still while the
    wheels drive, the counters are no running, signed totals, the yaw is in degrees or no heading,
    or it turns the other way round than the path.
    """
    assert run.reference is not None
    ticks, reference = run.ticks.unwrapped(robot.encoder_bits), run.reference
    if words := stands_still(ticks, reference, robot) or no_turn(ticks, reference, robot):
        raise InputError(f"{run.path}: {words}")
    words = "; and ".join(filter(None, _wrong(ticks, reference, robot)))
    if words and run.of_bag and "robot file" not in words:
        words += (
            "; a bag has no such columns: mend what its driver sends, or write the converted "
            "values as a run folder (wo.write_run, docs/python.md)"
        )
    if words:
        raise InputError(f"{run.path}: {words}")


def _wrong(ticks: Ticks, reference: Reference, robot: Robot) -> tuple[str, str, str]:
    """What is wrong with the times, with counters or places, and with the yaw; "" for each not."""
    counts = (
        words_about_metres(ticks, reference, robot)
        # The leap of a 32-bit counter is as many counts as degrees would make.
        or ("" if wraps_words(ticks) else words_about_globe(ticks, reference, robot))
        or what_counters_hold(ticks, reference)
    )
    headings = (
        # Of speeds the sums turn as the reference does.
        _degrees(ticks, reference)
        or (_degrees(_summed(ticks), reference) if counts else "")
        or _no_heading(ticks, reference)
    )
    times = other_unit_of_time(ticks, reference, robot) or rounded_times(ticks, reference)
    return times, counts, headings


def _summed(ticks: Ticks) -> Ticks:
    duration = np.diff(ticks.time, prepend=ticks.time[:1])
    left, right = (np.cumsum(np.nan_to_num(side) * duration) for side in (ticks.left, ticks.right))
    return Ticks(ticks.time, left, right)


def without_zeros(run: Run) -> Run:
    """Remove poses of zeros far from their neighbours: so trackers write that they see nothing."""
    reference = run.reference
    if reference is None or reference.time.size < FEWEST:
        return run
    places = reference.x + 1j * reference.y
    none = (places == 0.0) & ((reference.yaw == 0.0) | np.isnan(reference.yaw))
    seen = np.flatnonzero(~none & reference.has_position)
    rows = np.flatnonzero(none)
    if rows.size == 0 or seen.size < FEWEST:
        return run
    far = max(FAR, FAR_STEPS * float(np.median(np.abs(np.diff(places[seen])))))
    after = np.searchsorted(seen, rows)
    beside = np.stack([np.maximum(after - 1, 0), np.minimum(after, seen.size - 1)])
    none[rows] = (np.abs(places[seen[beside]]) > far).all(axis=0)
    count = int(none.sum())
    if count == 0:
        return run
    words = (
        f"{count} of {none.size} reference poses are zeros, far from those beside them: the "
        "tracker saw nothing there; they are left out"
    )
    return replace(run, reference=reference.chosen(~none), damage=(*run.damage, words))


def _degrees(ticks: Ticks, reference: Reference) -> str:
    known = reference.yaw[reference.has_yaw]
    if known.size < FEWEST or np.ptp(known) < MORE_THAN_A_TURN:
        return ""
    if turns_by_wheels(ticks, reference) > HARDLY:
        return ""
    in_radians = replace(reference, yaw=np.radians(reference.yaw))
    return YAW_IN_DEGREES if turns_by_wheels(ticks, in_radians) > TAKES else ""


def _no_heading(ticks: Ticks, reference: Reference) -> str:
    """By scans a heading and a path are of one measurement; where they differ, it was carried."""
    chords = None if reference.own_axes and reference.gyro is None else _chords(reference)
    if chords is None:
        return ""
    course, yaw, when = chords
    if _together(course) < TURNED and not np.ptp(reference.yaw[reference.has_yaw]):
        return (
            f"yaw_rad is {reference.yaw[reference.has_yaw][0]:g} in all rows, while the path "
            "turns: no heading was measured; leave that column empty"
        )
    ahead = np.interp(when, ticks.time, 0.5 * (ticks.left + ticks.right))
    backwards = np.where(np.diff(ahead, axis=0)[0] < 0.0, np.pi, 0.0)

    def follows(sign: float, yaw: Floats) -> float:
        return max(_together(course + sign * yaw), _together(course + sign * yaw + backwards))

    along, against = follows(-1.0, yaw), follows(1.0, yaw)
    if along < CONTRADICTS and np.nanmax(np.abs(reference.yaw)) <= 1.0:
        halves = _chords(replace(reference, yaw=2.0 * np.arcsin(reference.yaw)))
        if halves is not None and follows(-1.0, halves[1]) > FOLLOWS:
            return (
                "yaw_rad stays within 1 while the path turns all round, and twice its arcsine "
                "follows the path: it is the z of a quaternion: write the angle, 2 atan2(z, w)"
            )
    far_less = along < TURNED and FAR_LESS * (1.0 - against) < 1.0 - along
    if against < FOLLOWS or (along > CONTRADICTS and not far_less):
        return ""
    return (
        "the reference's yaw turns to the right where its path bends to the left: yaw_rad counts "
        "clockwise, and must count anticlockwise from the x axis (minus that column; of a compass, "
        "pi/2 minus it), or x_m and y_m are not of one right-handed frame (exchanged: east is x, "
        "north is y; or one with the wrong sign: y points down)"
    )


def _chords(reference: Reference) -> tuple[Floats, Floats, Floats] | None:
    """Direction of the path's chords, mean yaw on each, and times of both ends; k chords."""
    rows = np.flatnonzero(reference.has_position & reference.has_yaw)
    if rows.size < FEWEST:
        return None
    place = reference.x[rows] + 1j * reference.y[rows]
    extent = float(np.hypot(np.ptp(place.real), np.ptp(place.imag)))
    ends = ends_of_chords(place, CHORD * extent)
    if ends.size <= FEWEST:
        return None
    begin, end = ends[:-1], ends[1:]
    yaw = reference.yaw[rows]
    middle = yaw[begin] + 0.5 * wrap_all(yaw[end] - yaw[begin])
    when = reference.time[rows]
    return np.angle(place[end] - place[begin]), middle, np.stack([when[begin], when[end]])


def _together(angles: Floats) -> float:
    """Mean resultant length of angles: 1 if all are equal."""
    return float(np.abs(np.exp(1j * angles).mean()))
