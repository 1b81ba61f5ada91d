# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Measured variables as the effect of a draft reads them in a step, as source code."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.effects.shapes import steady
from werrimbi_odom.inference.diagnosis.variables import Variable
from werrimbi_odom.inference.drafting.column_names import as_text, quoted, symbol_of
from werrimbi_odom.inference.drafting.law_forms import Seen
from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.pose import Floats

STEADY = {
    "speed": ("abs(drive.speed.end)",) * 2,
    "wheel_speed": ("abs(drive.left_speed.end)", "abs(drive.right_speed.end)"),
    "direction": ("1.0 - 2.0 * (drive.speed.end < 0.0)",) * 2,
    "yaw_rate": ("drive.yaw_rate.end",) * 2,
    "yaw_rate_size": ("abs(drive.yaw_rate.end)",) * 2,
    "acceleration": ("drive.speed.change / drive.duration",) * 2,
}
"""Variables that are constant during a step, as Python code for the left and right wheel.

`Drive.direction` turns only after some counts, within a step too: no law of it keeps the contract.
"""

_SMOOTH = "steady(0.5 * (drive.left_acceleration + drive.right_acceleration))"

SPANS = {
    "time": "drive.time",
    "distance": "drive.distance",
    "travel_since_reversal": "drive.since_reversal",
    "heading": "drive.heading",
}
"""Variables that change from a step's start to its end."""

FROM_ZERO = ("speed", "wheel_speed", "yaw_rate", "yaw_rate_size", "time", "distance")


def seen_as(variable: Variable) -> Seen | None:
    """How an effect reads a variable; None for one that no effect can read."""
    name = variable.name
    pooled = np.concatenate([variable.left, variable.right])
    low, high = (float(value) for value in np.quantile(pooled, [0.02, 0.98]))
    if not low < high:  # a flag that is seldom set
        low, high = float(pooled.min()), float(pooled.max())
    digits = _digits(low, high)
    knots = np.quantile(pooled, [0.01, 0.25, 0.5, 0.75, 0.99]).tolist()
    plain = Seen(
        as_text(name),
        variable.unit,
        lambda side: "",
        middle=rounded(float(np.mean(pooled)), digits - 1),
        low=low,
        high=high,
        from_zero=name in FROM_ZERO,
        knots=tuple(sorted({rounded(knot, digits) for knot in knots})),
        waves=variable.form == "turns",
        per_run=variable.per_run,
        harmonic=variable.harmonic,
        digits=digits,
    )
    if variable.looks_at == (name,) and not variable.unit:  # a column, whatever it is called
        code = f"drive.channels[{quoted(name)}]"
        return replace(plain, span=lambda side: code, channels=(name,), from_zero=False)
    if name in STEADY:
        left, right = STEADY[name]
        return replace(
            plain,
            span=lambda side: f"steady({left if side == 'left' else right})",
            per_wheel=left != right,
            smooth=_SMOOTH if name == "acceleration" else "",
        )
    if name.startswith(("left_wheel_angle", "right_wheel_angle")):  # of one, whichever it acts on
        wheel = name.partition("_")[0]
        return replace(plain, span=lambda side: f"drive.{wheel}_angle")
    if name in SPANS:
        return replace(plain, span=lambda side: SPANS[name])
    return None


def _digits(low: float, high: float) -> int:
    """Significant digits that tell values between these apart, beside a large offset too."""
    offset = max(abs(low), abs(high)) / max(high - low, 1e-300)
    more = max(math.floor(math.log10(offset)), 0) if offset > 0.0 else 0
    return min(4 + more, sys.float_info.dig)


def rounded(value: float, digits: int = 2) -> float:
    """Round to some significant digits; 0 for what is not finite."""
    return float(f"{value:.{digits}g}") if math.isfinite(value) else 0.0


@dataclass(frozen=True)
class Signal:
    """A measured quantity for laws of two variables, with a left and a right version."""

    name: str
    """Symbol in formulas."""
    variable: str
    """Measured variable: a speed and its size are one variable."""
    source: tuple[str, str]
    """Python code for a number if it is constant during a step, else for a span."""
    values: tuple[Span[Floats], Span[Floats]]
    unit: dict[str, int]
    """Exponents of its units; empty for extra channels, whose units are unknown."""
    spans: bool = False
    channel: str | None = None


def signals_of(drive: Drive[Floats], *, of_wheels: bool) -> list[Signal]:
    """Signals for laws of two variables; laws of the wheels use the speed of each wheel."""
    sides = ("left_speed", "right_speed") if of_wheels else ("speed", "speed")
    speeds = (getattr(drive, sides[0]).end, getattr(drive, sides[1]).end)
    found = []

    def add(
        name: str, variable: str, source: Sequence[str], values: Sequence[Floats], **unit: int
    ) -> None:
        left, right = (steady(each) for each in values)
        found.append(Signal(name, variable, (source[0], source[1]), (left, right), unit))

    rims = [f"drive.{side}.end" for side in sides]
    add("v", "speed", rims, speeds, m=1, s=-1)
    sizes = [np.abs(each) for each in speeds]
    add("|v|", "speed", [f"abs({each})" for each in rims], sizes, m=1, s=-1)
    turning = drive.yaw_rate.end
    add("w", "yaw_rate", ["drive.yaw_rate.end"] * 2, [turning] * 2, rad=1, s=-1)
    add("|w|", "yaw_rate", ["abs(drive.yaw_rate.end)"] * 2, [np.abs(turning)] * 2, rad=1, s=-1)
    spans: dict[str, tuple[str, Span[Floats], dict[str, int], str | None]] = {
        "time": ("drive.time", drive.time, {"s": 1}, None),
        "distance": ("drive.distance", drive.distance, {"m": 1}, None),
    }
    for name, span in drive.channels.items():
        spans[symbol_of(name)] = (f"drive.channels[{quoted(name)}]", span, {}, name)
    for name, (source, span, unit, channel) in spans.items():
        if np.ptp(span.end) > 0.0:
            found.append(Signal(name, name, (source, source), (span, span), unit, True, channel))
    return found
