# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Times in another unit than seconds, or rounded, told by the rows' intervals and the speeds."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.files.run import Reference, Ticks
from werrimbi_odom.files.tables.counter_columns import FEWEST
from werrimbi_odom.model.pose import wrap_all
from werrimbi_odom.model.robot import Robot

LONG_INTERVAL = 0.9
"""Interval of rows from which their times may be in another unit [s]: 1 kHz in milliseconds."""
SLOWEST, SLOWEST_TURN = 0.005, 0.005
"""Mean speed [m/s] and turn rate [rad/s] while the wheels roll, below which the times are in
another unit. Chosen: ten times below a robot that creeps; in milliseconds 1 m/s is 0.001."""
UNITS = ((2e6, "nanoseconds", 9), (2e3, "microseconds", 6), (0.0, "milliseconds", 3))
"""Units of time by the median interval of the rows: messages come at 0.5 Hz to 1 kHz."""

SPANS_ALIKE = 2.0
"""Factor within which the spans of both files are alike once one's times are divided."""

SHORT_INTERVAL, FASTEST = 0.001, 50.0
"""Interval of rows below which their times may be in a larger unit [s], and speed above which they
are [m/s]: nothing on wheels that is judged here goes at 180 km/h. A file that was divided once too
often has rows of 50 Hz at 0.02 ms."""

SHARED, WHOLE = 0.5, 0.001
"""Share of rows at the time of the row before above which times are rounded, if they come in whole
multiples of their smallest step, to within this share of it. Bursts of messages do not, or skip
most of these multiples."""
PACKETS = 1.5
"""Smallest steps that times are apart, in the median, from which on messages were sent together: of
rounded times every next one is there."""


def other_unit_of_time(ticks: Ticks, reference: Reference, robot: Robot) -> str:
    """In which unit the times of both files are; "" if they are in seconds."""
    if min(ticks.rows, reference.time.size) < FEWEST:
        return ""
    interval = float(np.median(np.diff(ticks.time)))
    rolls = np.diff(ticks.left, prepend=ticks.left[0]) != 0
    rolls |= np.diff(ticks.right, prepend=ticks.right[0]) != 0
    rolling = float(np.diff(ticks.time, prepend=ticks.time[0])[rolls].sum())
    if rolling <= 0.0:
        return ""
    if interval < SHORT_INTERVAL:
        return _too_fast(ticks, reference, robot, interval, rolling)
    if interval < LONG_INTERVAL:
        return ""
    places = reference.has_position
    if places.any():
        way = _way(reference)
        slow, told = way / rolling < SLOWEST, f"{1e3 * way / rolling:.2g} mm/s"
    else:
        turn = float(np.abs(wrap_all(np.diff(reference.yaw[reference.has_yaw]))).sum())
        slow, told = turn / rolling < SLOWEST_TURN, f"{np.degrees(turn / rolling):.2g}°/s"
    if not slow:
        return ""
    if all((np.diff(each.time) == 1.0).all() for each in (ticks, reference)):
        return f"t_s counts the rows, and the robot goes at {told}: write the time of each [s]"
    name, power = next((name, power) for above, name, power in UNITS if interval >= above)
    return (
        f"rows of ticks are {interval:.6g} s apart and the robot goes at {told}: the times are in "
        f"{name}, and t_s means seconds: divide that column by 10^{power}, in both files"
    )


def _too_fast(
    ticks: Ticks, reference: Reference, robot: Robot, interval: float, rolling: float
) -> str:
    """Of rows that come too often, at a speed that the wheels and the reference both show."""
    sides = (ticks.left, robot.left_tick), (ticks.right, robot.right_tick)
    rolled = max(float(np.nansum(np.abs(np.diff(counts)))) * tick for counts, tick in sides)
    speed = min(rolled, _way(reference)) / rolling
    if speed < FASTEST:
        return ""
    return (
        f"rows of ticks are {interval:.3g} s apart and the robot goes at {speed:.3g} m/s: the "
        f"times are not in seconds: multiply that column by 10^{_power(interval)}, in both files"
    )


def _way(reference: Reference) -> float:
    """Way from pose to pose [m]; 0 where no positions were measured."""
    places = reference.has_position
    return float(np.hypot(np.diff(reference.x[places]), np.diff(reference.y[places])).sum())


def _power(interval: float) -> int:
    """By which power of ten times were divided too often, for rows at 1 Hz to 1 kHz."""
    return 3 if interval >= SHORT_INTERVAL / 1e3 else 6


def words_about_one_clock_unit(ticks: Ticks, reference: Reference) -> str:
    """Which file has its times in another unit than the other; "" if none does."""
    if min(ticks.rows, reference.time.size) < FEWEST:
        return ""
    spans = [float(np.ptp(each.time)) for each in (ticks, reference)]
    if not min(spans) > 0.0:
        return ""
    names, steps = ("ticks", "reference"), [np.diff(each.time) for each in (ticks, reference)]
    short, long = (0, 1) if spans[0] <= spans[1] else (1, 0)
    often, seldom = (float(np.median(np.abs(steps[at]))) for at in (short, long))
    told = f"the ticks last {spans[0]:.6g} s and the reference {spans[1]:.6g} s: the times of the"
    for _, name, power in UNITS:
        if not 1.0 / SPANS_ALIKE < max(spans) / min(spans) / 10.0**power < SPANS_ALIKE:
            continue
        if seldom >= LONG_INTERVAL:
            return (
                f"{told} {names[long]} are in {name}, and t_s means seconds: divide that column "
                f"there by 10^{power}"
            )
        if often < SHORT_INTERVAL:
            return (
                f"{told} {names[short]}, whose rows are {often:.3g} s apart, are not in seconds: "
                f"multiply that column there by 10^{power}"
            )
    return ""


def rounded_times(ticks: Ticks, reference: Reference) -> str:
    """Which file has its times rounded so that rows share them; "" if none does."""
    for name, time in (("ticks", ticks.time), ("the reference", reference.time)):
        steps = np.diff(time)
        new = steps[steps > 0.0]
        shared = int((steps == 0.0).sum())
        if new.size < FEWEST or shared <= SHARED * steps.size:
            continue
        unit = float(new.min())
        if float(np.median(new)) > PACKETS * unit:  # several messages at one time, sent together
            continue
        if (np.abs(new / unit - np.rint(new / unit)) < WHOLE).all():
            return (
                f"{shared} of {time.size} rows of {name} share their time with the row before: "
                f"t_s is rounded to {unit:.6g} s; write all its digits, or keep the first row of "
                "each time"
            )
    return ""
