# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Helpers of the laws: an assertion with a message, and parameter values to test."""

from __future__ import annotations

from collections.abc import Mapping

from werrimbi_odom.model.effect import Effect

Values = Mapping[str, float]


def demand(kept: bool, effect: Effect, law: str, what: str) -> None:
    """Raise an AssertionError with a message if a law is broken."""
    if not kept:
        raise AssertionError(f"{effect.name} breaks a law ({law}): {what}")


def typical(effect: Effect) -> dict[str, float]:
    """Typical values on real robots."""
    return {name: item.typical for name, item in effect.parameters.items()}


def settings(effect: Effect) -> list[dict[str, float]]:
    """Typical values, and their mirror images about null where the bounds allow them."""
    other = {}
    for name, item in effect.parameters.items():
        mirrored = 2.0 * item.null - item.typical
        allowed = item.bounds[0] <= mirrored <= item.bounds[1] and not item.tries
        other[name] = mirrored if allowed else item.typical
    return [typical(effect), other]


def corners(effect: Effect) -> list[dict[str, float]]:
    """All parameters at their bounds, together and one by one."""
    found = []
    for end in (0, 1):
        at_bound = {name: item.bounds[end] for name, item in effect.parameters.items()}
        found.append(at_bound)
        found += [{**typical(effect), name: value} for name, value in at_bound.items()]
    return found


def in_words(values: Values) -> str:
    """Values as text."""
    return ", ".join(f"{name} = {value:g}" for name, value in values.items()) or "no parameters"
