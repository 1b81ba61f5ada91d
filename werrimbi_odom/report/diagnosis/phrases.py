# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences about one effect: what it is, how large, how sure, what it costs, how to check it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from werrimbi_odom.effects.page import page_of
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.holdout import Sides
from werrimbi_odom.inference.manoeuvres.proposal import Manoeuvre
from werrimbi_odom.inference.manoeuvres.sight import Sight
from werrimbi_odom.inference.set_up.mistakes import SetUpFinding
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis.values import Value, effect_named, ranked_of, values_of
from werrimbi_odom.report.numbers import chance_words, error_words, with_std


@dataclass(frozen=True)
class Told:
    """A diagnosis and all that is told with it."""

    diagnosis: Diagnosis
    manoeuvre: Manoeuvre | None
    sights: Sequence[Sight]
    leg: float = 1.0
    """Length of the legs that are judged [m]."""
    held_out: bool = True
    """Whether drives to judge on were given, or put aside by the diagnosis itself."""


def mistakes(diagnosis: Diagnosis) -> dict[str, SetUpFinding]:
    """What is set up wrongly, by name."""
    return {finding.effect: finding for finding in diagnosis.set_up.findings}


def about(told: Told, name: str) -> list[str]:
    """What it is, how large, how sure, what it costs, how to check it."""
    diagnosis = told.diagnosis
    effect = effect_named(diagnosis, name)
    lines = []
    if effect is not None:
        lines.append(f"What it is: {effect.summary}")
    lines += _large(diagnosis, name)
    ranked = ranked_of(diagnosis, name)
    if ranked is not None and name not in mistakes(diagnosis):
        lines.append(f"How sure: {chance_words(ranked.p_value)}.")
    lines += cost(told, name)
    lines += ruler(effect, "Check it")
    return lines


def also(told: Told, name: str) -> list[str]:
    """Another effect that was found, in short."""
    effect = effect_named(told.diagnosis, name)
    size = sizes(told.diagnosis, name)
    ranked = ranked_of(told.diagnosis, name)
    sure = f"; {chance_words(ranked.p_value)}" if ranked is not None else ""
    what = f" {effect.summary}" if effect is not None else ""
    return [f"- Also {name}: {size}{sure}.{what}"]


def _large(diagnosis: Diagnosis, name: str) -> list[str]:
    values = values_of(diagnosis, name)
    if not values:
        return []
    parts = [
        f"{parameter} is another one in each drive ({value.says})"
        if value.per_run
        else f"{parameter} = {_value(value)} ({value.says})"
        for parameter, value in values.items()
    ]
    return [f"How large: {'; '.join(parts)}."]


def sizes(diagnosis: Diagnosis, name: str, *, believed: bool = False) -> str:
    """The values of an effect, on request only those that are away from null."""
    values = values_of(diagnosis, name)
    return ", ".join(
        f"{parameter} {_value(value)}"
        for parameter, value in values.items()
        if not value.per_run and not (believed and value.std > abs(value.value - value.null))
    )


def _value(value: Value) -> str:
    return f"{with_std(value.value, value.std)} {value.unit}".rstrip()


def cost(told: Told, name: str) -> list[str]:
    """What the errors were without an effect, and what they are with it."""
    ranked = ranked_of(told.diagnosis, name)
    if ranked is None or ranked.holdout is None:
        return []
    return _fall(told, ranked.holdout)


def _fall(told: Told, sides: Sides) -> list[str]:
    before, after = sides.before, sides.after
    if not (math.isfinite(before) and math.isfinite(after)):
        return []
    where = f"on {judged(told)}"
    if after >= before:
        return [
            f"What it costs: little so far; {where} the {_of(sides)} error is "
            f"{error_words(before, sides.unit)} without it and "
            f"{error_words(after, sides.unit)} with it."
        ]
    part = math.sqrt(before**2 - after**2)
    return [
        f"What it costs: {error_words(part, sides.unit)} {_each(told)}; {where} the {_of(sides)} "
        f"error falls from {error_words(before, sides.unit)} to "
        f"{error_words(after, sides.unit)} when it is put in."
    ]


def _of(sides: Sides) -> str:
    return "heading" if sides.unit == "rad" else "position"


def _each(told: Told) -> str:
    return f"on each {'metre' if told.leg == 1.0 else f'{told.leg:g} m'} or quarter turn"


def judged(told: Told) -> str:
    """On which drives, over which legs."""
    which = "the drives held out" if told.held_out else "a part put aside for judging"
    return f"{which} (legs of {told.leg:g} m)"


def whole(told: Told) -> list[str]:
    """With everything that was found, where that is more than one thing."""
    diagnosis = told.diagnosis
    sides = diagnosis.holdout
    if len(diagnosis.found) < 2 or not math.isfinite(sides.before):
        return []
    return [
        f"With all of them put in, the {_of(sides)} error on {judged(told)} falls from "
        f"{error_words(sides.before, sides.unit)} to {error_words(sides.after, sides.unit)}."
    ]


def ruler(effect: Effect | None, head: str) -> list[str]:
    """How to check an effect on the robot, after some words."""
    if effect is None:
        return []
    text = page_of(effect).sections.get("Ruler")
    return [f"{head}: {' '.join(text.split())}."] if text else []
