# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences about one effect: what it is, how large, how sure, what it costs, how to check it."""

from __future__ import annotations

import math

from werrimbi_odom.effects.page import page_of
from werrimbi_odom.inference.diagnosis.diagnosis import SURE, Diagnosis, chance
from werrimbi_odom.inference.diagnosis.holdout import Sides
from werrimbi_odom.inference.diagnosis.named import effect_named
from werrimbi_odom.inference.diagnosis.sizes import sizes_at, sizes_needed
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
from werrimbi_odom.inference.rules import ONE_WHEEL, SIGNIFICANT
from werrimbi_odom.inference.set_up.mistakes import SetUpFinding
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis.expected import expected_words
from werrimbi_odom.report.diagnosis.told import Told
from werrimbi_odom.report.diagnosis.values import Value, ranked_of, values_of
from werrimbi_odom.report.numbers import chance_words, error_words, listed, quantity
from werrimbi_odom.report.sizes import sizes_words


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
        lines.append(f"How sure: {chance_words(ranked.p_value)}{_deviations(diagnosis, name)}.")
    lines += cost(told, name)
    lines += ruler(diagnosis, effect, "Check it")
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
    every = values_of(diagnosis, name)
    if not every:
        return []
    values = {key: value for key, value in every.items() if not _unseen(value)} or every
    parts = [
        f"{parameter} is another one in each drive ({value.says})"
        if value.per_run
        else f"{parameter} = {_value(value)} ({value.says})"
        for parameter, value in values.items()
    ]
    unseen = [key for key in every if key not in values]
    late = f" None is seen of {listed(unseen)}." if unseen else ""
    if name == "reference_delay" and values["delay"].value < 0.0:
        late += " Negative: it is the encoders' stamps that are late against the reference's."
    return [f"How large: {'; '.join(parts)}.{late}"]


def _unseen(value: Value) -> bool:
    """Whether a parameter may as well be null, by as much as `add` would put it there."""
    away = abs(value.value - value.null)
    if away == 0.0 and not value.is_shape and not value.per_run:
        return True
    told = not value.per_run and not value.is_shape and value.std > 0.0
    return told and away < SIGNIFICANT * value.std


def _deviations(diagnosis: Diagnosis, name: str) -> str:
    """How far from null the surest of its parameters is, in standard deviations."""
    far = {
        parameter: abs(value.value - value.null) / value.std
        for parameter, value in values_of(diagnosis, name).items()
        if value.std > 0.0 and math.isfinite(value.value)
    }
    if not far:
        return ""
    first = max(far, key=lambda parameter: far[parameter])
    return f"; {first} is {far[first]:.0f} standard deviations from none"


def sizes(diagnosis: Diagnosis, name: str, *, believed: bool = False) -> str:
    """The values of an effect, on request only those that are away from null."""
    values = values_of(diagnosis, name)
    return ", ".join(
        f"{parameter} {_value(value)}"
        for parameter, value in values.items()
        if not value.per_run and not (believed and value.std > abs(value.value - value.null))
    )


def _value(value: Value) -> str:
    return quantity(value.value, value.std, value.unit)


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


def sizes_found(diagnosis: Diagnosis) -> str:
    """Base and radii of the best model as one measures them on the robot; "" where none is off.

    Where set-up mistakes were found, sizes are told with them.
    """
    if mistakes(diagnosis):
        return ""
    given, final = diagnosis.given, diagnosis.final
    sizes = sizes_needed(final, given, set(diagnosis.found) & set(CALIBRATED))
    return sizes_words(given, dict(sizes_at(final, given, sizes)))


def one_wheel(diagnosis: Diagnosis) -> str | None:
    """The wheel that is off alone, where its size is what two effects of calibration are found of.

    A ratio and a scale are then one thing on the robot.
    """
    found = set(diagnosis.found) & set(CALIBRATED)
    if mistakes(diagnosis) or not {"unequal_wheel_radii", "wheel_radius_scale"} <= found:
        return None
    sizes = sizes_at(
        diagnosis.final,
        diagnosis.given,
        sizes_needed(diagnosis.final, diagnosis.given, found),
    )
    left, right = (
        abs(math.log(sizes[name][0] / getattr(diagnosis.given, name))) for name in MULTIPLIERS[1:]
    )
    if min(left, right) > ONE_WHEEL * max(left, right):
        return None
    return "left" if left > right else "right"


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


def ruler(diagnosis: Diagnosis, effect: Effect | None, head: str) -> list[str]:
    """How to check an effect on the robot, after some words, and what to expect there."""
    if effect is None:
        return []
    text = page_of(effect).sections.get("Ruler")
    if not text:
        return []
    values = {name: item.value for name, item in values_of(diagnosis, effect.name).items()}
    numbers = expected_words(effect.name, values, diagnosis.robot) if values else ""
    ending = f"; {numbers}" if numbers else ""
    return [f"{head}: {' '.join(text.split())}{ending}."]


def at_bounds(diagnosis: Diagnosis) -> dict[str, str]:
    """Effects that would help, but only at a value that physics does not allow, and that value."""
    said: dict[str, str] = {}
    for this in diagnosis.rounds:
        for fit in this.tried:
            name = fit.names[-1]
            helps = fit.total < this.before.total and chance(fit, this.before, this.number) < SURE
            wild = [knob for knob in fit.at_bound if knob.startswith(f"{name}.")]
            if helps and wild and name not in diagnosis.found:
                parameter = wild[0].rpartition(".")[2]
                applied = fit.point.model.robot.effects[-1]
                unit = applied.effect.parameters[parameter].unit
                value = quantity(applied.values[parameter], math.nan, unit)
                said.setdefault(name, f"{parameter} = {value}")
    return said
