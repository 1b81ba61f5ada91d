# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Formatting of numbers in sentences, tables and JSON."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np

TIME_OF_DAY = 1e7
"""Smallest time of a clock that shows the time of day [s]; clocks since a start are below it."""


def from_start(started: float, *times: float) -> tuple[float, ...]:
    """Times as reported [s]: since a run's first tick, if its clock shows the time of day."""
    return tuple(time - started for time in times) if started > TIME_OF_DAY else times


def length(value: float) -> str:
    """A length [m] in m or mm."""
    if not math.isfinite(value):
        return "-"
    millimetres = 1e3 * value
    if millimetres >= 1e3:
        return f"{value:.2f} m"
    return f"{millimetres:.1f} mm" if millimetres < 100.0 else f"{millimetres:.0f} mm"


def two_digits(value: float) -> str:
    """A number rounded to two digits, without an exponent below a million."""
    return f"{float(f'{value:.2g}'):g}"


def error_words(value: float, unit: str) -> str:
    """A leg error: of position [m] in m or mm, or of heading [rad] in degrees."""
    if unit != "rad":
        return length(value)
    return f"{math.degrees(value):.2f}°" if math.isfinite(value) else "-"


def change_words(before: float, after: float, unit: str) -> str:
    """What a leg error does: it falls or goes from one figure to another, or stays at it."""
    one, other = error_words(before, unit), error_words(after, unit)
    if one == other:
        return f"stays at {one}"
    return f"{'falls' if after < before else 'goes'} from {one} to {other}"


def with_std(value: float, std: float) -> str:
    """Value and standard deviation, with two digits of the latter."""
    if not math.isfinite(value):
        return "-"
    if not (math.isfinite(std) and std > 0.0):
        return f"{value:.4g}"
    digits = 1 - math.floor(math.log10(std))
    if not -3 <= digits <= 6:
        return f"{value:.4g} ± {std:.2g}"
    digits = max(digits, 0)
    return f"{value:.{digits}f} ± {std:.{digits}f}"


def scaled_with_std(value: float, std: float, unit: str = "") -> str:
    """Value, standard deviation and unit, with an exponent if the value is small or large.

    Only the value, if the standard deviation is zero, infinite, or NaN.
    """
    behind = f" {unit}" if unit else ""
    if not 0.0 < std < math.inf:
        return f"{value:g}{behind}"
    power = math.floor(math.log10(std)) - 1
    size = math.floor(math.log10(max(abs(value), std)))
    if power >= -5 and size < 6:
        digits = max(-power, 0)
        return f"{value:.{digits}f} ± {std:.{digits}f}{behind}"
    digits = max(size - power, 0)
    value, std = value / 10.0**size, std / 10.0**size
    return f"({value:.{digits}f} ± {std:.{digits}f})e{size}{behind}"


_SMALLER = {"m": ("mm", 1e3), "s": ("ms", 1e3), "m/m": ("mm/m", 1e3), "m/s": ("mm/s", 1e3)}
"""Smaller units, and the factors to them."""

SMALL = 0.1
"""Values below it are shown in the smaller unit."""


def in_unit(value: float, std: float, unit: str) -> tuple[str, str]:
    """Value with standard deviation, and the more readable unit."""
    small, factor = _SMALLER.get(unit, (unit, 1.0))
    if not abs(value) < SMALL:
        small, factor = unit, 1.0
    return with_std(factor * value, factor * std), small


def or_else_json(told: tuple[float, float] | None) -> dict[str, dict[str, float]]:
    """What a value may be instead, as a field for JSON; nothing where it is one value."""
    return {} if told is None else {"or_else": {"value": told[0], "std": told[1]}}


def quantity(
    value: float, std: float, unit: str, or_else: tuple[float, float] | None = None
) -> str:
    """Value, standard deviation and unit; an angle also in degrees; then what it may be instead."""
    if or_else is not None:
        return f"{quantity(value, std, unit)} or as well {quantity(*or_else, unit)}"
    text, small = in_unit(value, std, unit)
    angle = f", {math.degrees(value):.3g}°" if unit == "rad" and math.isfinite(value) else ""
    return f"{text} {small}".rstrip() + angle


def each_its_own(values: Sequence[float], unit: str) -> str:
    """What a parameter is that each drive has anew: the range of its `values`, if there are any."""
    if not values:
        return "another one in each drive"
    rounded = [float(f"{value:.2g}") for value in (min(values), max(values))]
    low, high = (quantity(value, math.nan, unit) for value in rounded)
    return f"another one in each drive, from {low} to {high}"


def chance_words(p_value: float | None) -> str:
    """A p-value in words; None if it was not tested."""
    if p_value is None:
        return "not tested: so large that it is seen without a test"
    if p_value < 1e-12:
        return "beyond any chance"
    if p_value < 1e-4:
        return f"chance would show as much once in 10^{-math.ceil(math.log10(p_value))} diagnoses"
    if p_value < 0.5:
        return f"chance would show as much in {100.0 * p_value:.2g} % of diagnoses"
    return "no more than chance shows"


def p_words(p_value: float | None) -> str:
    """A p-value for a table."""
    if p_value is None:
        return "not tested"
    if p_value >= 0.995:
        return "1"
    if p_value >= 0.01:
        return f"{p_value:.2f}"
    return "< 1e-12" if p_value < 1e-12 else f"{p_value:.0e}"


def listed(words: Sequence[str], last: str = "and") -> str:
    """Enumeration: a, b and c."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} {last} {words[-1]}"


def capital(words: str) -> str:
    """Words as the beginning of a sentence; the name of a file stays as it is."""
    if "." in words.partition(" ")[0].rstrip(".:,"):
        return words
    return words[:1].upper() + words[1:]


def plain(value: Any) -> Any:
    """Values as in JSON; null for non-finite numbers, text for a path."""
    if isinstance(value, Mapping):
        return {key: plain(part) for key, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(part) for part in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return str(value) if isinstance(value, Path) else value


def picked(item: object, names: str) -> dict[str, Any]:
    """Selected attributes for JSON; KEY:ATTRIBUTE renames one; paths become text."""
    pairs = (name.partition(":") for name in names.split())
    values = {key: attrgetter(attribute or key)(item) for key, _, attribute in pairs}
    return {key: str(each) if isinstance(each, Path) else each for key, each in values.items()}


def counted(number: int, word: str) -> str:
    """A count with its noun: 1 leg, 2 legs."""
    return f"{number} {word}{'' if number == 1 else 's'}"


def more_like_these(drives: int, apart: str = "") -> str:
    """How many more drives are needed, behind the words that ask for them; "" if none are."""
    return f" ({counted(drives, 'more drive')} like these{apart})" if drives else ""
