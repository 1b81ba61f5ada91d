# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which column of a stranger's log may be meant by one of ours, and how its values are converted.

Nothing is converted unasked: a name tells the unit only perhaps.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

_OTHER_NAMES = {
    "t_s": (
        *("t", "time", "timestamp", "stamp", "elapsed", "sec", "secs", "seconds"),
        *("ms", "millis", "micros", "us", "ns"),
    ),
    "left_ticks": ("left", "l", "vl", "wl", "encl"),
    "right_ticks": ("right", "r", "vr", "wr", "encr"),
    "x_m": ("x", "px", "tx"),
    "y_m": ("y", "py", "ty"),
    "yaw_rad": ("yaw", "theta", "heading", "th", "phi"),
}
"""Words of the names that other logs have for a column."""


def _set(words: str) -> frozenset[str]:
    return frozenset(words.split())


_COMMANDED = _set(
    "cmd command commanded target setpoint ref goal desired des pwm duty voltage volt current error"
)
"""Words of what a wheel or the robot was told to do, or of its motor."""
_COUNTED = _set("ticks tick enc encoder encoders encl encr count counts pulse pulses")
_SPEEDS = _set("v vel velocity speed rpm rps rate omega w vl vr wl wr gyro angular acc accel dps")
_OWN = _set("odom odometry wheel wheels fused ekf kf kalman")
"""Words of poses that the robot computed from its wheels, or of filters that fuse them."""
_STEPS = _set("d delta diff inc increment")
_WAYS = _set("s dist distance travel odom m mm cm rad deg angle pos position")

_MILLI = dict.fromkeys(("ms", "msec", "millis", "milliseconds"), ", divided by 1000")
_MICRO = dict.fromkeys(("us", "usec", "usecs", "micros", "microseconds"), ", divided by 10^6")
_NANO = dict.fromkeys(
    ("ns", "nsec", "nsecs", "nanos", "nanosec", "nanosecs", "nanoseconds"), ", divided by 10^9"
)
_SECONDS = _set("s sec secs seconds")
_LENGTHS = {"mm": ", divided by 1000", "cm": ", divided by 100", "in": ", times 0.0254"}
_CONVERTED = {
    "t_s": _MILLI | _MICRO | _NANO,
    "x_m": _LENGTHS,
    "y_m": _LENGTHS,
    "yaw_rad": dict.fromkeys(("deg", "degree", "degrees"), ", times pi/180"),
}
"""By a word of the other name, what is to be done with its values."""


def perhaps_meant(missing: Sequence[str], names: Sequence[str]) -> str:
    """Columns that may be meant by those that are missing, and how their values are converted."""
    found: dict[str, list[str]] = {}
    for name in missing:
        like = _like(name, names)
        if name == "t_s" and (parts := _in_two_parts(names)):
            found[f", plus {parts[1]}{parts[2].removeprefix(',')}"] = [f"{name} for {parts[0]}"]
        elif len(like) == 1:
            conversion = _conversion(name, _words(like[0]))
            found.setdefault(conversion, []).append(f"{name} for {like[0]}")
    groups = [f"{', '.join(each)}{conversion}" for conversion, each in found.items()]
    told = f" (perhaps {'; '.join(groups)})" if groups else ""
    if "t_s" in missing and not _like("t_s", names):
        told += (
            "; no column is called like a time: where rows come at a steady rate, it is the number "
            "of the row divided by that rate"
        )
    return told


def _in_two_parts(names: Sequence[str]) -> tuple[str, str, str] | None:
    """Columns of whole seconds and of their fraction, and how the fraction is converted."""
    whole = [own for own in names if _words(own) & _SECONDS]
    for units in (_NANO, _MICRO):
        rest = [own for own in names if _words(own) & set(units)]
        if len(whole) == len(rest) == 1 and whole != rest:
            return whole[0], rest[0], next(iter(units.values()))
    return None


def _like(name: str, names: Sequence[str]) -> list[str]:
    """Columns that may be meant by a name: of a wheel, what it counted before its speed."""
    words = {own: _words(own) for own in names}
    like = [own for own in names if words[own] & set(_OTHER_NAMES.get(name, ()))]
    if name == "t_s":
        return like
    like = [own for own in like if not words[own] & _COMMANDED]
    if name.endswith("_ticks"):
        return [own for own in like if words[own] & _COUNTED] or like
    return [own for own in like if not words[own] & (_SPEEDS | _COUNTED | _OWN)]


def _conversion(name: str, words: set[str]) -> str:
    if not name.endswith("_ticks"):
        known = _CONVERTED.get(name, {})
        return next((known[word] for word in sorted(words) if word in known), "")
    if words & _STEPS:
        return ", if that is what came since the row before, its running sum"
    if words & _COUNTED:
        return ""
    speed = "it / 60 (turns)" if "rpm" in words else "it"
    if words & _SPEEDS:
        return (
            f", a speed: the running sum of {speed} times the seconds since the row before, as "
            "whole numbers of small steps"
        )
    return ", a way or an angle: as whole numbers of small steps" if words & _WAYS else ""


def _words(name: str) -> set[str]:
    """Words of a column's name, also of `leftEncoder`."""
    return set(re.findall(r"[a-z]+", re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()))
