# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A history in words: its drives, what changed and when, what to do now."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timezone

from werrimbi_odom.inference.changes.between_drives import ParameterChange
from werrimbi_odom.inference.changes.dated_drives import Dated, History
from werrimbi_odom.inference.changes.history import BASE_OVER_RADIUS, Number
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, value_of
from werrimbi_odom.report.changes import changes_words, in_small_unit
from werrimbi_odom.report.document import Paragraph, Table, paragraphs
from werrimbi_odom.report.number_format import counted, length, listed, with_std

TITLES = {
    "wheel_separation_multiplier": "wheel base",
    "left_wheel_radius_multiplier": "left radius",
    "right_wheel_radius_multiplier": "right radius",
    "unequal_wheel_radii": "right over left radius",
    "wheel_radius_scale": "mean radius",
    BASE_OVER_RADIUS: "base over mean radius",
    "reference_yaw_offset.angle": "mount: angle to the left",
    "reference_lever_arm.x": "mount: ahead of the axle",
    "reference_lever_arm.y": "mount: left of the middle",
}
"""Names of the parameters."""

_LOOK = {
    "left_wheel": "look at the left wheel: tread, pressure, and whether it sits firmly",
    "right_wheel": "look at the right wheel: tread, pressure, and whether it sits firmly",
    "both_wheels": "look at both tyres: tread, pressure, load",
    "wheel_base": "look at what the wheels stand on: axle, bearings, a tyre's width, the floor",
    "wheels_over_base": "look at both tyres, at axle and bearings, and at the gyro: headings alone "
    "do not tell which",
    "mount": "look at how the reference is mounted, and enter its place anew",
}
_DATE_WORDS = {
    "stamp": "stamps of their first messages",
    "file": "when their files were written, for their stamps are no dates",
    "order": "none: they are taken in the order given",
}
_SIGMAS = 3.0  # threshold of a difference from the other robot file, in standard deviations


@dataclass(frozen=True)
class Alarm:
    """A recommended action."""

    what: str
    """A group of parameters, or calibration."""
    since: str
    """Name of a drive; "" if it is not since a drive."""
    words: str


@dataclass(frozen=True)
class Against:
    """A parameter compared with another robot file."""

    what: str
    now: float
    std: float
    there: float
    differs: bool


def words_of(history: History) -> tuple[Paragraph, ...]:
    """All sentences."""
    robot = history.robot
    told = changes_words(told_as(history, dated_names(history)), robot)
    lines = [_headline(history)]
    lines += [f"- {words}" for words in told]
    for alarm in alarms(history):
        lines.append(f"Next: {alarm.words}.")
    differing = [each for each in against(history) if each.differs]
    if history.like is not None:
        lines.append(_against_words(history, differing))
    lines.append(f"{_drives(history)}.")
    lines += [f"Not used: {each.run}: {each.why.rstrip('.')}." for each in history.unusable[:_MOST]]
    if (more := len(history.unusable) - _MOST) > 0:
        lines.append(f"So {'is' if more == 1 else 'are'} {counted(more, 'more drive')}.")
    return paragraphs(lines, hanging=["Next", "Not used"])


_MOST = 5  # unusable drives that are reported one by one


def alarms(history: History) -> list[Alarm]:
    """Actions for the latest change of each group, and for an outdated robot file."""
    names = dated_names(history)
    latest = {move.group: move for move in history.course.changes if move.kind != "alone"}
    found = []
    for group, move in latest.items():
        look = _LOOK.get(group, f"look at what makes {group}: its size is another one")
        since = names[int(move.from_run)]
        how = "changes steadily" if move.kind == "trend" else "is otherwise"
        found.append(Alarm(group, since, f"{look}; it {how} since {since}"))
    if history.course.off:
        sizes = listed(
            [
                f"{TITLES[off.name]} {_share(off.value / off.given - 1.0, off.std / off.given)}"
                for off in history.course.off
            ]
        )
        found.append(
            Alarm(
                "calibration",
                "",
                f"calibrate again (werrimbi calibrate fit, with the latest drives): the robot "
                f"file is off by this: {sizes}",
            )
        )
    return found


def against(history: History) -> list[Against]:
    """Current values compared with those of the other robot file; empty without one."""
    if history.like is None:
        return []
    found = []
    for number in history.course.numbers:
        other = there(history, number)
        now, std = float(number.level[-1]), float(number.level_std[-1])
        wide = math.hypot(std, number.scatter)
        differs = abs(now - other) > _SIGMAS * wide
        found.append(Against(number.name, now, std, other, differs))
    return found


def told_as(history: History, names: Sequence[str]) -> list[ParameterChange]:
    """The changes, with names of the drives instead of indices."""
    return [
        replace(
            move,
            last_before=names[int(move.last_before)],
            from_run=names[int(move.from_run)],
            surely_from=names[int(move.surely_from)],
        )
        for move in history.course.changes
    ]


def dated_names(history: History) -> list[str]:
    """Name and day of each drive."""
    return [
        f"{name} ({day_of(drive)})" if drive.date_from != "order" else name
        for name, drive in zip(history.names, history.drives, strict=True)
    ]


def day_of(drive: Dated) -> str:
    """Date of a drive in UTC."""
    return datetime.fromtimestamp(drive.date, timezone.utc).strftime("%Y-%m-%d")


def _headline(history: History) -> str:
    if not history.course.numbers:
        return "These drives tell no number of this robot, so no change of one either."
    count = len({(move.group, move.from_run) for move in history.course.changes})
    if not count:
        return "Nothing changed on this robot that these drives could show."
    return f"{counted(count, 'change')} on this robot."


def _drives(history: History) -> str:
    drives = history.drives
    way = length(sum(drive.estimate.way for drive in drives))
    kinds = list(dict.fromkeys(drive.date_from for drive in drives))
    days = ""
    if "order" not in kinds:
        days = f" from {day_of(drives[0])} to {day_of(drives[-1])}"
    known = sum(drive.kept for drive in drives)
    kept = f"; {known} of them known from before" if known else ""
    dates = listed([_DATE_WORDS[kind] for kind in kinds])
    return f"Seen: {counted(len(drives), 'drive')}{days}, {way}{kept}. Dates: {dates}"


def _against_words(history: History, differing: Sequence[Against]) -> str:
    missing = not_compared(history)
    more = (
        f" It holds {listed(missing)}, which this file does not: not compared." if missing else ""
    )
    if not differing:
        return f"Against the other robot file nothing is new.{more}"
    parts = []
    for each in differing:
        title = TITLES.get(each.what, each.what)
        if "." not in each.what and each.there:
            parts.append(f"{title} {_share(each.now / each.there - 1.0, each.std / each.there)}")
        else:
            number = next(item for item in history.course.numbers if item.name == each.what)
            value, unit = in_small_unit(each.now, each.std, number.unit)
            other, unit_there = in_small_unit(each.there, 0.0, number.unit)
            parts.append(f"{title} {value} {unit}, there {other} {unit_there}")
    return f"New against the other robot file: {listed(parts)}.{more}"


def not_compared(history: History) -> list[str]:
    """Effects of the other robot file that these drives were not asked about: this one has none."""
    if history.like is None:
        return []
    asked = {number.name.rpartition(".")[0] for number in history.course.numbers}
    asked |= {applied.name for applied in history.robot.effects}
    return [applied.name for applied in history.like.effects if applied.name not in asked]


def there(history: History, number: Number) -> float:
    """A parameter of the other robot file, in the units of this one."""
    robot = history.like
    assert robot is not None
    left, right = (float(getattr(robot, name)) for name in MULTIPLIERS[1:])
    own = history.robot
    radii, base = (
        robot.wheel_radius / own.wheel_radius,
        robot.wheel_separation / own.wheel_separation,
    )
    if number.name == "unequal_wheel_radii":
        return right / left
    if number.name == "wheel_radius_scale":
        return 0.5 * (left + right) * radii
    if number.name == BASE_OVER_RADIUS:
        return robot.wheel_separation_multiplier * base / (0.5 * (left + right) * radii)
    try:
        value = value_of(robot, number.name)
    except KeyError:
        return 0.0  # an effect that is not in the file
    if number.name in MULTIPLIERS:
        return value * (base if number.name == MULTIPLIERS[0] else radii)
    return value


def _share(share: float, std: float) -> str:
    more = "more" if share > 0.0 else "less"
    return f"{with_std(100.0 * abs(share), 100.0 * abs(std))} % {more}"


def table_of(history: History) -> Table:
    """Current parameters of the robot."""
    heads = ["number", "now", "robot file", "drive to drive ±"]
    heads += ["the other file"] if history.like is not None else []
    rows = []
    for number in history.course.numbers:
        now, unit = in_small_unit(float(number.level[-1]), float(number.level_std[-1]), number.unit)
        factor = 1e3 if unit != number.unit else 1.0
        cells = [
            TITLES.get(number.name, number.name),
            f"{now} {unit}".rstrip(),
            f"{factor * number.given:.5g}",
            f"{factor * number.scatter:.2g}",
        ]
        if history.like is not None:
            cells.append(f"{factor * there(history, number):.5g}")
        rows.append(cells)
    return Table("The robot now", heads, rows)
