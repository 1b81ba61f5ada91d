# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences shared by several verbs: what is left out or suspect, and sizes in mm."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.number_format import from_start, listed, picked, two_digits, with_std

_MOST = 5  # stretches that are reported one by one
_TOLD = 3  # the same, for a suspect reference


def drive_names(runs: Iterable[Path]) -> dict[Path, str]:
    """A name for each drive: that of its folder, with those above where two are called alike."""
    every = dict.fromkeys(runs)
    for parts in range(1, max((len(run.parts) for run in every), default=0) + 1):
        names = {run: "/".join(run.parts[-parts:]) for run in every}
        if len(set(names.values())) == len(every):
            return names
    return {run: str(run) for run in every}


def left_out_words(parts: Sequence[LeftOut], *, named: bool = True) -> list[str]:
    """A sentence for each of the longest stretches, drive by drive, and one for the rest.

    Empty for none. Jumps of the reference are not included; see `jumps_words`. `named`: whether the
    reader needs the names of the drives.
    """
    names = drive_names(part.run for part in parts)
    drives = list(names)
    silent = [part for part in parts if part.why != "reference"]
    silent.sort(key=lambda part: (drives.index(part.run), part.begin))
    long = sorted(silent, key=lambda part: part.begin - part.end)[:_MOST]
    lines = []
    for part in (each for each in silent if each in long):
        where = f" of {names[part.run]}" if named else ""
        from_s, to_s = from_start(part.started, part.begin, part.end)
        end = ". Left out." if ":" in part.words else ": left out."
        first, last = f"{from_s:.1f} s", f"{to_s:.1f} s"
        when = f"At {first}" if first == last else f"From {first} to {last}"
        lines.append(f"{when}{where} {part.words}{end}")
    rest = [part for part in silent if part not in long]
    if rest:
        seconds = sum(part.end - part.begin for part in rest)
        lines.append(
            f"So {'is' if len(rest) == 1 else 'are'} {len(rest)} more such "
            f"stretch{'' if len(rest) == 1 else 'es'}, {seconds:.1f} s in all."
        )
    return lines


def jumps_words(parts: Sequence[LeftOut]) -> list[str]:
    """Number of legs on which the reference jumped; empty for none."""
    count = sum(part.why == "reference" for part in parts)
    if not count:
        return []
    legs, they = ("1 leg", "it is") if count == 1 else (f"{count} legs", "they are")
    return [f"On {legs} the reference jumped; {they} left out."]


def held_law_words(robot: Robot, where: str = "") -> str:
    """That the form of a law in the model may differ slightly from the true one; empty for none."""
    laws = [each.name for each in robot.effects if not each.effect.is_mistake]
    return f", or the law of {listed(laws, 'or')} does not quite fit{where}" if laws else ""


def rarer_than_asked(length: float, asked: float) -> bool:
    """Whether legs are longer than was asked for [m], because poses are rare."""
    return length > rules.LONGER_LEG * asked


def leg_words(length: float, asked: float) -> str:
    """Length of legs in metres: as they are, where poses are rarer than was asked for."""
    return f"{length:.2g}" if rarer_than_asked(length, asked) else f"{asked:g}"


def either_side(open_side: bool) -> list[str]:
    """Of positions on one circle a drive, which do not tell on which side the point lies."""
    if not open_side:
        return []
    return [
        "But: the measured point may as well lie as far on the other side of the axle, with x of "
        "the other sign: positions alone do not tell ahead from behind where each drive keeps to "
        "one circle. A line and a curve in one drive do, or a look at the robot."
    ]


def left_out_json(parts: Sequence[LeftOut]) -> list[dict[str, Any]]:
    """Fields of each stretch; times in the run's own clock [s]."""
    return [picked(part, "run from_s:begin to_s:end why words") for part in parts]


_NAMES = dict(zip(MULTIPLIERS, ("wheel base", "left wheel", "right wheel"), strict=True))


def sizes_words(
    given: Robot, found: Mapping[str, tuple[float, float | None]], ratio_std: float
) -> str:
    """Changed sizes in a sentence without its full stop; "" if all are as in the given robot.

    `found` holds the multipliers by name, with their standard deviations if known. `ratio_std`:
    relative standard deviation of right over left radius. Headings tell that ratio where positions
    are too coarse for either radius; then it is told in their place.
    """
    moved = {name for name in MULTIPLIERS if found[name][0] != getattr(given, name)}
    if not moved:
        return ""
    ratio = _ratio_alone(given, found, ratio_std)
    parts = []
    for name in MULTIPLIERS[:1] if ratio else MULTIPLIERS:
        if name in moved:
            parts.append(_moved(name, given, found))
        elif name != MULTIPLIERS[0]:
            parts.append(f"{_NAMES[name]} right as it is")
    return ", ".join([*parts, *ratio])


def _ratio_alone(
    given: Robot, found: Mapping[str, tuple[float, float | None]], std: float
) -> list[str]:
    """The ratio of the radii, where it has surely changed but neither radius has."""
    sizes, stds = zip(*(_relative(given, name, found) for name in MULTIPLIERS[1:]), strict=True)
    ratio = sizes[1] / sizes[0]
    if any(
        abs(size - 1.0) > rules.SIGNIFICANT * own for size, own in zip(sizes, stds, strict=True)
    ):
        return []
    if not abs(ratio - 1.0) > rules.SIGNIFICANT * std * ratio:
        return []
    return [
        f"right over left radius {_change(ratio, std * ratio)}, both radii known by these drives "
        f"only to {two_digits(100.0 * max(stds))} %"
    ]


def _relative(
    given: Robot, name: str, found: Mapping[str, tuple[float, float | None]]
) -> tuple[float, float]:
    """One multiplier over that of the given robot, and the standard deviation of that."""
    value, std = found[name]
    before = float(getattr(given, name))
    return value / before, (std or 0.0) / before


def _moved(name: str, given: Robot, found: Mapping[str, tuple[float, float | None]]) -> str:
    """One size: its relative change, and its length."""
    ratio, std = _relative(given, name, found)
    nominal = given.wheel_separation if name == MULTIPLIERS[0] else given.wheel_radius
    what = "" if name == MULTIPLIERS[0] else "radius "
    long = f"{what}{_millimetres(nominal * found[name][0])}"
    if not 0.5 < ratio < 2.0:
        return f"{_NAMES[name]} {ratio:.4g} times as large ({long})"
    return f"{_NAMES[name]} {_change(ratio, std)} ({long})"


def _change(ratio: float, std: float) -> str:
    share = with_std(100.0 * abs(ratio - 1.0), 100.0 * std)
    return f"{share} % {'larger' if ratio > 1.0 else 'smaller'}"


def _millimetres(metres: float) -> str:
    value = 1e3 * metres
    return f"{value:.2f} mm" if value < 100.0 else f"{value:.1f} mm"


def remark_words(remark: ReferenceRemark) -> str:
    """A sentence or two on an anomaly of the reference: what, where, and possible causes."""
    if remark.what == "short":
        elsewhere = ""
        if abs(remark.usual) > 0.05:
            elsewhere = f" Elsewhere it is {_share(remark.usual)} than the wheels' way."
        return (
            f"The reference's path is {_share(remark.size)} than elsewhere, against the wheels, in "
            f"{_places(remark)}: it is wrong there (a scan matcher in a corridor), or the wheels "
            f"slipped there.{elsewhere}"
        )
    if remark.what == "another_drive":
        return (
            "Wheels and reference have nothing in common: whatever is put right, the errors are as "
            "large as the way itself. It is the reference of another robot or another drive, its "
            "clock is far off, or its topic is not where the robot is."
        )
    if remark.what == "scale":
        return (
            f"By the wheels, with this robot file, these drives are {remark.usual:.3g} m long, and "
            f"by the reference {remark.size:.3g} m, part by part alike: wheel_radius is "
            f"{remark.size / remark.usual:.3g} times what is entered, or a turn has "
            f"{remark.usual / remark.size:.3g} times the counts (or the reference is not in "
            "metres). They hardly turn, so that nothing else can be told with such sizes."
        )
    if remark.what == "no_turn":
        shown, turned = (f"{math.degrees(each):.0f}°" for each in (remark.size, remark.usual))
        return (
            f"The reference shows next to no turn: {shown} in all, to and fro, where the wheels "
            f"turned {turned}. Its gyro is dead, is not read, or another of its axes points up. Or "
            "the robot did not turn: it was held, its wheels were off the floor, or it drove "
            "straight and one of its counters is still or runs backwards."
        )
    if remark.what == "places":
        return (
            "The reference turns as the wheels do, but goes elsewhere: whatever is put right, its "
            "places are off by as much as the way itself. It is lost, it slides (scans in a "
            "corridor, or with a narrow view), or it sits far from the axle on a robot that only "
            "turned. A gyro would do to judge the turns; drive on with walls on several sides."
        )
    if remark.what == "metre":
        return (
            f"The reference's path is {_share(remark.size)} than the wheels' way, and its turns "
            "are right: its metre is none, or radius and base were both entered wrongly by that. "
            "Lay a tape beside it."
        )
    if remark.what == "at_rest":
        return (
            f"The left wheel goes on at {1e3 * remark.size:.1f} mm/s and the right one at "
            f"{1e3 * remark.usual:.1f} mm/s where the reference stands still, in "
            f"{_places(remark)}: no robot is held so alike each time. Speeds with an offset of a "
            "driver or a log do so, and counts that were summed up from them: subtract it from the "
            "speeds. Until then the radii seem to go with the speed."
        )
    angle = f"{math.degrees(abs(remark.size)):.1f}°"
    if remark.what == "sideways":
        return (
            f"The reference goes sideways to its own heading by {angle}, all along: its sensor is "
            "mounted askew, the robot crabs, or heading and path are of two sources."
        )
    if remark.what == "apart":
        return (
            f"The reference's heading and its path drift apart, by {angle} in one drive: they do "
            "not belong together. Leave the one out that you trust less (an empty column)."
        )
    return (
        f"The reference goes sideways to its own heading by {angle} in {_places(remark)}: nothing "
        "that rolls does so; its heading or its path is wrong there."
    )


_UNITS = {"short": "", "metre": "", "scale": "m", "at_rest": "m/s"}


def remarks_json(remarks: Sequence[ReferenceRemark]) -> list[dict[str, Any]]:
    """Fields of each remark; sizes are shares of the path, lengths [m], or angles [rad]."""
    return [
        {
            **picked(remark, "what size"),
            "unit": _UNITS.get(remark.what, "rad"),
            "usual": remark.usual,
            "stretches": [
                picked(part, "run from_s:begin to_s:end size") for part in remark.stretches
            ],
            "words": remark_words(remark),
        }
        for remark in remarks
    ]


def _share(size: float) -> str:
    return f"{100.0 * abs(size):.0f} % {'shorter' if size < 0.0 else 'longer'}"


def _places(remark: ReferenceRemark) -> str:
    told = [
        f"{part.run.name} from {begin:.0f} s to {end:.0f} s"
        for part in remark.stretches[:_TOLD]
        for begin, end in [from_start(part.started, part.begin, part.end)]
    ]
    more = ", ..." if len(remark.stretches) > _TOLD else ""
    return f"{len(remark.stretches)} stretches ({', '.join(told)}{more})"
