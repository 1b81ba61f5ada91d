# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Base and radii as one measures them on the robot: which is off, by how much, how long it is."""

from __future__ import annotations

from collections.abc import Mapping

from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.numbers import with_std

_NAMES = dict(zip(MULTIPLIERS, ("wheel base", "left wheel", "right wheel"), strict=True))


def sizes_words(given: Robot, found: Mapping[str, tuple[float, float | None]]) -> str:
    """All three in a sentence without its stop; "" where none differs from the given robot's.

    Parameters
    ----------
    found
        Multipliers by name, with their standard deviations where they are known.
    """
    moved = {name for name in MULTIPLIERS if found[name][0] != getattr(given, name)}
    if not moved:
        return ""
    parts = []
    for name in MULTIPLIERS:
        if name in moved:
            parts.append(_moved(name, given, *found[name]))
        elif name != MULTIPLIERS[0]:
            parts.append(f"{_NAMES[name]} right as it is")
    return ", ".join(parts)


def _moved(name: str, given: Robot, value: float, std: float | None) -> str:
    """One size: by how much it is larger or smaller, and how long that is."""
    ratio = value / float(getattr(given, name))
    nominal = given.wheel_separation if name == MULTIPLIERS[0] else given.wheel_radius
    what = "" if name == MULTIPLIERS[0] else "radius "
    long = f"{what}{_millimetres(nominal * value)}"
    if not 0.5 < ratio < 2.0:
        return f"{_NAMES[name]} {ratio:.4g} times as large ({long})"
    share = with_std(100.0 * abs(ratio - 1.0), 100.0 * (std or 0.0) / float(getattr(given, name)))
    return f"{_NAMES[name]} {share} % {'larger' if ratio > 1.0 else 'smaller'} ({long})"


def _millimetres(metres: float) -> str:
    value = 1e3 * metres
    return f"{value:.2f} mm" if value < 100.0 else f"{value:.1f} mm"
