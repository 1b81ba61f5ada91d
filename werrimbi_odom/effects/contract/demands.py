# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the laws are made of: a demand, and the values at which it is made."""

from __future__ import annotations

from collections.abc import Mapping

from werrimbi_odom.model.effect import Effect

Values = Mapping[str, float]


def demand(kept: bool, effect: Effect, law: str, what: str) -> None:
    """Raise an AssertionError in words where a law is not kept."""
    if not kept:
        raise AssertionError(f"{effect.name} breaks a law ({law}): {what}")


def typical(effect: Effect) -> dict[str, float]:
    """Values that real robots show."""
    return {name: item.typical for name, item in effect.parameters.items()}


def settings(effect: Effect) -> list[dict[str, float]]:
    """Typical values, and the same to the other side of null where physics allows that."""
    other = {}
    for name, item in effect.parameters.items():
        mirrored = 2.0 * item.null - item.typical
        allowed = item.bounds[0] <= mirrored <= item.bounds[1] and not item.tries
        other[name] = mirrored if allowed else item.typical
    return [typical(effect), other]


def corners(effect: Effect) -> list[dict[str, float]]:
    """All parameters at their bounds, and each alone."""
    found = []
    for end in (0, 1):
        at_bound = {name: item.bounds[end] for name, item in effect.parameters.items()}
        found.append(at_bound)
        found += [{**typical(effect), name: value} for name, value in at_bound.items()]
    return found


def told(values: Values) -> str:
    """Values in words."""
    return ", ".join(f"{name} = {value:g}" for name, value in values.items()) or "no parameters"
