# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect written from the evidence, where the library holds none that explains it.

The strongest cells of the evidence map say which error goes with which variable. For each of them a
few forms are written as effect files (a line, a square, a step, a curve, a wave, a spot), held
against the laws of effects, and fitted as any effect is. The simplest of those that explain about
as much as the best is the draft.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from werrimbi_odom.effects.collection import load_file
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.adding.draft_laws import Form, Seen, forms_of, spot_form
from werrimbi_odom.inference.adding.draft_source import name_of, source_of
from werrimbi_odom.inference.adding.start_values import Drives, scored, start_at
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence, place_of
from werrimbi_odom.inference.diagnosis.selection import Fitted
from werrimbi_odom.inference.diagnosis.variables import Variable, variables_of
from werrimbi_odom.inference.fitting.candidates import Score
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.rules import (
    DRAFTED_TOO,
    MOST_DRAFTED,
    MOST_FITTED,
    RIVAL,
    SPOT_OFF,
    SPOT_RADII,
    SURE,
    USELESS_NUMBER,
    WIDER_THAN_FITTED,
    WORTH_FITTING,
)
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.progress import Show, silent

STEADY = {
    "speed": ("abs(drive.speed.end)",) * 2,
    "wheel_speed": ("abs(drive.left_speed.end)", "abs(drive.right_speed.end)"),
    "direction": ("drive.direction",) * 2,
    "yaw_rate": ("drive.yaw_rate.end",) * 2,
    "yaw_rate_size": ("abs(drive.yaw_rate.end)",) * 2,
    "acceleration": ("drive.speed.change / drive.duration",) * 2,
}
"""Variables that keep their value through a step, as Python for the left and right wheel."""

SPANS = {
    "time": "drive.time",
    "distance": "drive.distance",
    "travel_since_reversal": "drive.since_reversal",
    "heading": "drive.heading",
}
"""Variables that change from a step's start to its end."""

FROM_ZERO = ("speed", "wheel_speed", "yaw_rate", "yaw_rate_size", "time", "distance")


@dataclass(frozen=True)
class Draft:
    """An effect file, and what it was made of."""

    name: str
    source: str
    effect: Effect
    dependence: Dependence
    form: str
    fit: Fitted
    diagnosis: Diagnosis
    tried: tuple[tuple[str, str, float], ...]
    """Effect, form and cost beyond the best of all drafts that were fitted."""


@dataclass(frozen=True)
class _Option:
    cell: Dependence
    seen: Seen
    form: Form
    effect: Effect
    source: str
    fit: Fitted


def draft_effect(
    diagnosis: Diagnosis,
    show: Show = silent,
) -> Draft:
    """Write the effect that the strongest dependence asks for.

    Raises
    ------
    InputError
        When the errors depend on nothing beyond chance, or no draft of it can be fitted.
    """
    cells = _worth_drafting(diagnosis)
    if not cells:
        raise InputError(
            "there is nothing to draft: the errors go with no measured variable beyond chance"
        )
    final = diagnosis.final
    drives = Drives(diagnosis.runs, final.point.excluded, final.point.options)
    variables = {item.name: item for item in variables_of(diagnosis.runs, final.point.model)}
    options: list[_Option] = []
    plans = [
        (cell, seen, form)
        for cell in cells
        for seen, form in _forms(diagnosis, cell, variables[cell.variable.name])
    ]
    show(0.0, "the forms of a law")
    drafted = [_plan(diagnosis, *plan) for plan in plans]
    ordered = _by_score(diagnosis, drives, drafted, final.point.variances)
    for number in range(MOST_FITTED):
        ordered = [plan for plan in ordered if plan.excess > ordered[0].excess - WORTH_FITTING]
        waiting = [plan for plan in ordered if all(plan.effect is not o.effect for o in options)]
        plan = next((plan for plan in waiting if keeps_laws(plan.effect)), None)
        if plan is None:
            break
        show((number + 1) / (MOST_FITTED + 2), f"{plan.cell.name}: {plan.form.kind}")
        options.append(_fitted(diagnosis, drives, plan))
        if number == 0:
            # Without the law the wheels' noise had to stand for it, and hid what tells forms apart.
            ordered = _by_score(diagnosis, drives, drafted, options[0].fit.point.variances)
    if not options:
        names = ", ".join(dict.fromkeys(cell.name for cell in cells))
        raise InputError(f"no law can be drafted that is a line, step or curve in {names}")
    least = min(option.fit.total for option in options)
    near = [option for option in options if option.fit.total < least + RIVAL]
    best = min(near, key=lambda option: (option.form.numbers, option.fit.total))
    show(0.95, "writing")
    last = _with_values(diagnosis, best)
    return Draft(
        last.effect.name,
        last.source,
        last.effect,
        best.cell,
        best.form.kind,
        best.fit,
        diagnosis,
        tuple(
            (option.effect.name, option.form.kind, option.fit.total - least) for option in options
        ),
    )


def _worth_drafting(diagnosis: Diagnosis) -> list[Dependence]:
    """The strongest dependences, one for each channel and variable."""
    believed = [cell for cell in diagnosis.remaining if cell.p_value < SURE]
    believed.sort(key=lambda cell: -(cell.gain - USELESS_NUMBER * cell.degrees))
    chosen: dict[tuple[str, str, str], Dependence] = {}
    for cell in believed:
        chosen.setdefault((cell.channel, cell.amount.per, cell.variable.name), cell)
    cells = list(chosen.values())
    return [cell for cell in cells if cell.gain > DRAFTED_TOO * cells[0].gain][:MOST_DRAFTED]


def _forms(
    diagnosis: Diagnosis, cell: Dependence, variable: Variable
) -> Iterator[tuple[Seen, Form]]:
    if variable.form == "place":
        if cell.amount.channel in ("left", "right", "along"):
            yield Seen("position", "m", lambda side: ""), _spot(diagnosis, cell)
        return
    seen = _seen(variable)
    if seen is None:
        return
    coefficients = np.abs(cell.coefficients)
    size = float(np.median(coefficients[coefficients > 0.0])) if coefficients.any() else 1e-3
    for form in forms_of(seen, cell.amount, _round(max(size, 1e-7))):
        yield seen, form


def _seen(variable: Variable) -> Seen | None:
    """How an effect sees a variable; None for one that no effect can see."""
    name = variable.name
    pooled = np.concatenate([variable.left, variable.right])
    low, high = (float(value) for value in np.quantile(pooled, [0.02, 0.98]))
    knots = np.unique(np.quantile(pooled, [0.01, 0.25, 0.5, 0.75, 0.99]))
    plain = Seen(
        name,
        variable.unit,
        lambda side: "",
        middle=_round(float(np.mean(pooled)), 3),
        low=low,
        high=high,
        from_zero=name in FROM_ZERO,
        knots=tuple(float(f"{knot:.4g}") for knot in knots),
        waves=variable.form == "turns",
        per_run=variable.per_run,
        harmonic=variable.harmonic,
    )
    if name in STEADY:
        left, right = STEADY[name]
        return replace(
            plain,
            span=lambda side: f"steady({left if side == 'left' else right})",
            per_wheel=left != right,
            rate=name == "acceleration",
        )
    for side in ("left", "right"):
        if name.startswith(f"{side}_wheel_angle"):
            return replace(plain, span=_angle_of(side))
    if name in SPANS:
        return replace(plain, span=lambda side: SPANS[name])
    if variable.looks_at == (name,):
        return replace(plain, span=lambda side: f'drive.channels["{name}"]', channel=name)
    return None


def _angle_of(side: str) -> Callable[[str], str]:
    """A wheel's angle, on whichever wheel it acts."""
    return lambda _: f"drive.{side}_angle"


def _spot(diagnosis: Diagnosis, cell: Dependence) -> Form:
    """A circle around the place on the floor that the errors point at."""
    x, y = place_of(cell)
    offsets = (-SPOT_OFF, 0.0, SPOT_OFF)
    places = [(x + dx, y + dy) for dx, dy in zip(offsets, offsets, strict=True)]
    size = _round(float(cell.coefficients[np.argmax(np.abs(cell.coefficients))]))
    half = 0.5 * diagnosis.given.track
    return spot_form(places, SPOT_RADII, size, half)


@dataclass(frozen=True)
class _Plan:
    """A form that may be fitted."""

    cell: Dependence
    seen: Seen
    form: Form
    effect: Effect
    source: str
    score: Score | None = None
    """Of the best of its shapes; None before it is scored."""
    excess: float = -math.inf
    """By how much it should cost less than it takes, its numbers paid for."""


def _plan(diagnosis: Diagnosis, cell: Dependence, seen: Seen, form: Form) -> _Plan:
    source = _written(diagnosis, cell, seen, form)
    return _Plan(cell, seen, form, loaded(source), source)


def _by_score(
    diagnosis: Diagnosis, drives: Drives, plans: Sequence[_Plan], noise: Variances
) -> list[_Plan]:
    """The forms that the drives show anything of, the most promising first, all without a fit."""
    base = diagnosis.final
    before = replace(base, point=replace(base.point, variances=noise))
    found = []
    for plan in plans:
        scores = scored(drives, before, [plan.effect], base.numbers)
        if scores:
            best = max(scores, key=lambda each: each.gain)
            paid = base.price_of_one * plan.form.numbers
            found.append(replace(plan, score=best, excess=best.gain - paid))
    return sorted(found, key=lambda plan: -plan.excess)


def _fitted(diagnosis: Diagnosis, drives: Drives, plan: _Plan) -> _Option:
    """A draft of one form, fitted from where its score points."""
    base = diagnosis.final
    assert plan.score is not None
    start = start_at(base, plan.score, base.numbers)
    # After one round the noise is still what stood for the law: a true one cost more than another.
    fit = drives.fit(start.point, start.names, start.numbers, diagnosis.given, rounds=2)
    return _Option(plan.cell, plan.seen, plan.form, plan.effect, plan.source, fit)


def _written(diagnosis: Diagnosis, cell: Dependence, seen: Seen, form: Form) -> str:
    strength = "beyond chance" if cell.p_value < 1e-300 else f"p = {cell.p_value:.0e}"
    name = name_of(cell.amount, cell.name)
    return source_of(name, cell.amount, seen, form, len(diagnosis.runs.runs), strength)


def _with_values(diagnosis: Diagnosis, option: _Option) -> _Option:
    """The draft with the fitted values as what is typical, so that fits begin there."""
    robot = option.fit.point.model.robot
    applied = next(item for item in robot.effects if item.name == option.effect.name)
    parameters = []
    for item in option.form.parameters:
        value = applied.values[item.name]
        if item.tries and item.name in ("x", "y", "radius"):
            parameters.append(replace(item, tries=(_round(value, 3),)))
        elif item.tries:
            at = _round(value, 4)
            parameters.append(replace(item, null=at, typical=at or item.typical, tries=(at,)))
        elif item.per_run or abs(value) < 1e-3 * abs(item.typical):
            parameters.append(item)
        else:
            typical = abs(_round(value)) if item.bounds[0] == 0.0 else _round(value)
            low, high = item.bounds
            wider = max(high, WIDER_THAN_FITTED * abs(typical))
            if item.name == "share":
                wider = high
            parameters.append(replace(item, typical=typical, bounds=(low and -wider, wider)))
    form = replace(option.form, parameters=tuple(parameters))
    source = _written(diagnosis, option.cell, option.seen, form)
    effect = loaded(source)
    if not keeps_laws(effect):
        return option
    return replace(option, form=form, source=source, effect=effect)


def keeps_laws(effect: Effect) -> bool:
    """Whether an effect keeps the laws of effects, on the short drive that they are held on.

    That drive may not reach a speed, a time or a channel's value at which the effect begins; then
    it does nothing there, which is no breach.
    """
    try:
        check_effect(effect)
    except AssertionError as error:
        return "does nothing" in str(error)
    return True


def loaded(source: str) -> Effect:
    """The effect of a source, as `--effects FILE` would load it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "draft.py"
        path.write_text(source, encoding="utf-8")
        (effect,) = load_file(path)
    return effect


def _round(value: float, digits: int = 2) -> float:
    return float(f"{value:.{digits}g}") if math.isfinite(value) else 0.0
