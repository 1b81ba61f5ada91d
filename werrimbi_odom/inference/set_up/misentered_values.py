# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Simple factors between true and entered values, and the mistakes that cause them."""

from __future__ import annotations

import math
from collections.abc import Mapping

from werrimbi_odom.inference import rules

FACTORS: dict[str, float] = {
    "2": 2.0,
    "1/2": 0.5,
    "4": 4.0,
    "1/4": 0.25,
    "pi": math.pi,
    "1/pi": 1.0 / math.pi,
    "180/pi": 180.0 / math.pi,
    "pi/180": math.pi / 180.0,
    "100": 100.0,
    "1/100": 0.01,
    "1000": 1000.0,
    "1/1000": 1e-3,
}
"""Ratios of true to entered value, by name."""

_SKID = (
    "it has four driven wheels, or tracks, which skid in turns and act as on a base 1.3 to 2.5 "
    "times as wide: then all is entered rightly, this is its effective base, and its name is "
    "skid_steer (list all wheels in left_wheel_names and right_wheel_names)"
)

RADIUS: dict[str, str] = {
    "2": "half the radius was entered, or twice the counts of a turn",
    "1/2": "a diameter was entered for the radius, or half the counts of a turn (both edges count)",
    "4": "counts of a turn were entered four times too large (an encoder that counts lines alone)",
    "1/4": "lines were entered for counts of a turn, and the encoder counts four edges a line",
    "pi": "a pi too many was divided out: diameter over circumference",
    "1/pi": "a circumference was halved and entered for the radius",
    "180/pi": "the wheels' angles are in radians and were entered as degrees",
    "pi/180": "the wheels' angles are in degrees and are taken for radians",
    "1000": "kilometres for metres, or counts of a turn in thousandths",
    "1/1000": "millimetres were entered for metres",
    "1/100": "centimetres were entered for metres",
}
"""Causes of a factor on both radii."""

BASE: dict[str, str] = {
    "2": "half the base was entered (axle's middle to wheel)",
    "1/2": "twice the base was entered",
    "4": "a quarter of the base was entered",
    "1/4": "four times the base was entered",
    "180/pi": "radians and degrees were mixed up where the base was worked out",
    "pi/180": "radians and degrees were mixed up where the base was worked out",
    "1000": "kilometres were entered for metres",
    "1/1000": "millimetres were entered for metres",
    "1/100": "centimetres were entered for metres",
}
"""Causes of a factor on the base."""

METRE: dict[str, str] = {
    "1000": "the reference's positions are in millimetres",
    "1/1000": "base and radius were both entered in millimetres, or the reference is in kilometres",
    "100": "the reference's positions are in centimetres",
    "1/100": "base and radius were both entered in centimetres",
}
"""Causes of a common factor on base and radii."""

LENGTHS: dict[str, float] = {"centimetres": 100.0, "inches": 39.3701, "feet": 3.28084}
"""Units in which positions are recorded, and how many make a metre; millimetres are recognised from
less (`MILLIMETRES_FROM`)."""


def simple_factor(value: float) -> str | None:
    """Name of the simple factor nearest to a positive value in log scale; None if none is near."""
    nearest = min(FACTORS, key=lambda name: abs(math.log(value / FACTORS[name])))
    return nearest if abs(math.log(value / FACTORS[nearest])) <= math.log(rules.NEAR) else None


def unit_of_positions(radius: float, base: float) -> str | None:
    """Unit of the reference's positions that explains a common factor on radii and base."""
    near = math.log(rules.UNIT_NEAR)
    for unit, size in LENGTHS.items():
        if max(abs(math.log(radius / size)), abs(math.log(base / size))) <= near:
            return unit
    return None


def counts_words(left: float, right: float, radius: float) -> str:
    """What counters give that have so many counts in a turn of a wheel of this radius [m]."""
    shown, exact = _digits(left, 4), _exact_counts(left, radius)
    if left == right:
        has = f"the wheel has {shown} {'count' if shown == '1' else 'counts'}"
        write = f"left_ticks_per_revolution: {exact}, and the same to the right"
    else:
        has = f"the left wheel has {shown} counts, of the right {_digits(right, 4)},"
        write = (
            f"left_ticks_per_revolution: {exact} and "
            f"right_ticks_per_revolution: {_exact_counts(right, radius)}"
        )
    return f"a turn of {has} by these drives: if that is right, write {write}"


def _exact_counts(counts: float, radius: float) -> str:
    """The number to write for so many counts, and the unit that makes it, if one does.

    Angles differ from the expected count by the error of the radius, lengths do not.
    """
    turn = 2.0 * math.pi
    units = {"radians": turn, "degrees": 360.0, "turns": 1.0}
    units |= {"metres": turn * radius, "centimetres": 1e2 * turn * radius}
    units |= {"millimetres": 1e3 * turn * radius}
    unit = min(units, key=lambda name: abs(math.log(counts / units[name])))
    near = abs(math.log(counts / units[unit])) <= math.log(rules.COUNTS_NEAR)
    return f"{units[unit]:.6g} ({unit})" if near else _digits(counts, 4)


def _digits(value: float, digits: int) -> str:
    """A number to so many digits, and no power of ten, which YAML may take for a word."""
    return f"{float(f'{value:.{digits}g}'):.15g}"


def is_ordinary(value: float) -> bool:
    """Whether a positive factor is so near to 1 that calibration handles it."""
    return abs(math.log(value)) <= math.log(rules.ORDINARY)


def skids(base: float) -> bool:
    """Whether skidding wheels can explain such an effective base, relative to the true one."""
    return rules.ORDINARY < base < rules.MOST_OF_A_SKID


def skid_words(value: float) -> str:
    """Sentence about the base of a robot that is known to skid."""
    return (
        "its driven wheels skid in turns, so in the mean of these drives it turns as if its two "
        f"sides were {value:.3g} times as far apart as the robot file says: such robots do, and "
        "nothing is entered wrongly"
    )


ENTERED = "what the robot file says"
_OF_A_WHEEL = "the {0} encoder's counts of a turn or its gear were entered wrongly"
_ENTERED: dict[str, tuple[str, Mapping[str, str], str]] = {
    "radius": ("both wheels' radius is", RADIUS, "look at radius, gear and encoder"),
    "base": ("the wheel base is", BASE, "measure it anew"),
    "metre": (
        "radius and base alike are",
        METRE,
        "the reference's metre, or the robot file's, is not one",
    ),
    "turning": ("radius over base is", {}, "radius or base were entered wrongly"),
    **{
        side: (f"the {side} wheel's travel alone is", {}, _OF_A_WHEEL.format(side))
        for side in ("left", "right")
    },
}
"""By what a factor is on: its name and verb, known causes by factor, and what is said of other
factors; "turning" is for a reference that measures yaw alone."""


def factor_words(on: str, value: float) -> str:
    """Sentence about a factor on `radius`, `base`, `metre`, `turning`, or on one wheel's side."""
    what, causes, else_ = _ENTERED[on]
    factor = simple_factor(value)
    near = f", near {factor}" if factor else ""
    times = _digits(value, 3) if value >= 1.0 else f"1/{_digits(1.0 / value, 3)}"
    cause = causes.get(factor or "", else_)
    words = f"{what} {times} times {ENTERED}{near}: {cause}"
    base = {"base": value, "turning": 1.0 / value}.get(on, 1.0)
    words += f"; or {_SKID}" if skids(base) else ""
    tell = "; yaw alone cannot tell which: drive a taped distance" if on == "turning" else ""
    return words + tell
