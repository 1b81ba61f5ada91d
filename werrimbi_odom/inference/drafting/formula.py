# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The law of a draft as a formula with its numbers, as one would write it by hand.

In rates: sideways = -0.011 * v * w says by how many metres a second the robot moves sideways.
"""

from __future__ import annotations

import re
from collections.abc import Sequence

from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.law_forms import Seen

_RATES = {"travel": "v", "path": "|v|", "turn": "w"}
_ORDER = ("v", "|v|", "w", "|w|")


def in_a_line(amount: Amount, values: Sequence[float], terms: Sequence[Sequence[str]]) -> str:
    """Sum of terms: each a value times its factors and what the error is proportional to."""
    base = [_RATES[amount.per]] if amount.per in _RATES else []
    line = ""
    for value, factors in zip(values, terms, strict=True):
        sign = "-" if value < 0.0 else "+"
        line += f" {sign} " if line else sign.strip("+")
        line += " * ".join([f"{abs(value):.2g}", *sorted([*base, *factors], key=_place)])
    return f"{amount.channel} = {line}"


def factor_of(amount: Amount, seen: Seen) -> str:
    """Variable as a factor of a formula; minus its usual value if zero is no natural origin."""
    speed = "wheel_speed" if amount.of_wheels else "speed"
    names = {speed: "|v|", "yaw_rate": "w", "yaw_rate_size": "|w|"}
    name = seen.name if seen.channels else names.get(seen.name, seen.name)
    if seen.from_zero or not seen.middle:
        return name
    return f"({name} {'+' if seen.middle < 0.0 else '-'} {seen.told(abs(seen.middle))})"


def symbols_of(amount: Amount, line: str) -> str:
    """Explanation of the symbols of a formula; "" where there are none."""
    whose = " of that wheel" if amount.of_wheels else ""
    words = []
    if re.search(r"\bv\b", line):
        words.append(f"v: speed{whose} [m/s], backwards negative")
    if re.search(r"\bw\b", line):
        words.append("w: yaw rate [rad/s]")
    return "; ".join(words)


def _place(factor: str) -> int:
    """Order of a factor: speeds and turning first, then measured quantities, then gates."""
    return _ORDER.index(factor) if factor in _ORDER else 5 if factor.startswith("(") else 4
