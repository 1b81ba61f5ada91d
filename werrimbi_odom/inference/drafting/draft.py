# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Draft of an effect from the evidence, where no effect of the library explains the errors.

The strongest cells of the evidence map say which error depends on which variable. For each of them
a few laws are written as effect files (a line, a square, a step, a curve, a wave, a spot), checked
against the contract of effects, and fitted as any effect is. The draft is the simplest of those
that explain about as much as the best.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.start_values import FitDrives
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.drafting.candidate_law import (
    Claim,
    LawForm,
    Option,
    by_score,
    fitted_plan,
    planned,
    value_of,
    with_values,
    worth_fitting,
)
from werrimbi_odom.inference.drafting.formula import factor_of, in_a_line
from werrimbi_odom.inference.drafting.law_forms import Form, Seen, forms_of
from werrimbi_odom.inference.drafting.spot import spot_of
from werrimbi_odom.inference.drafting.variable_source import rounded, seen_as
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.progress import Show, silent


@dataclass(frozen=True)
class Draft:
    """An effect file with its evidence and its fit."""

    name: str
    source: str
    effect: Effect
    claim: Claim
    form: str
    fit: Fitted
    diagnosis: Diagnosis
    tried: tuple[tuple[str, str, float], ...]
    """Effect, form and cost above the best draft, of all drafts that were fitted."""
    law: str = ""
    """The law as a formula in rates, with its numbers: sideways = -0.011 * v * w; "" if it is no
    sum of products."""
    of_two: OfTwo | None = None
    """Evidence for a law of two variables; None for one variable."""


@dataclass(frozen=True)
class OfTwo:
    """Comparison of a law of two variables with the best law of one variable."""

    variables: tuple[str, ...]
    terms_tried: int
    one: Draft | None
    """None where no law of one variable could be drafted."""
    held_out: Sides | None = None
    """Change of the held-out error with the law of one variable instead, with its p-value."""


def draft_effect(diagnosis: Diagnosis, show: Show = silent) -> Draft:
    """Draft the effect that explains the strongest dependence.

    InputError when there is no significant dependence, or no draft of it can be fitted.
    """
    cells = worth_drafting(diagnosis)
    if not cells:
        beside = f"with {' and '.join(diagnosis.found)} put in, " if diagnosis.found else ""
        raise InputError(
            f"there is nothing to draft: {beside}the errors go with no measured variable beyond "
            "chance that a law can be written of"
        )
    final = diagnosis.final
    drives = FitDrives(diagnosis.runs, final.point.excluded, final.point.options)
    options: list[Option] = []
    plans = [
        (cell, seen, form) for cell in cells for seen, form in _forms(cell, diagnosis.given.track)
    ]
    show(0.0, "the forms of a law")
    drafted = [
        planned(diagnosis, Claim(cell.amount, cell.name, cell.p_value), seen, form)
        for cell, seen, form in plans
    ]
    ordered = by_score(diagnosis, drives, drafted, final.point.variances)
    for number in range(rules.MOST_FITTED):
        ordered = worth_fitting(ordered)
        waiting = [
            plan for plan in ordered if all(plan.effect is not o.plan.effect for o in options)
        ]
        plan = next((plan for plan in waiting if plan.lawful()), None)
        if plan is None:
            break
        show((number + 1) / (rules.MOST_FITTED + 2), f"{plan.claim.variable}: {plan.form.kind}")
        options.append(fitted_plan(diagnosis, drives, plan))
        if number == 0 and len(drafted) > 1:
            # Without the law its errors inflated the wheels' noise, which hid differences between
            # forms.
            ordered = by_score(diagnosis, drives, drafted, options[0].fit.point.variances)
    if not options:
        names = ", ".join(dict.fromkeys(cell.name for cell in cells))
        raise InputError(f"no law can be drafted that is a line, step or curve in {names}")
    least = min(option.fit.total for option in options)
    if not least < final.total:  # as likely without it, for what its parameters cost
        names = ", ".join(dict.fromkeys(option.plan.claim.variable for option in options))
        raise InputError(
            f"no simple law of {names} explains the errors, though they go with it: what was "
            "fitted is nothing beside its ±. `depends_on` in the JSON of `werrimbi diagnose` has "
            "the curve"
        )
    near = [option for option in options if option.fit.total < least + rules.RIVAL]
    best = min(near, key=lambda option: (option.plan.form.numbers, option.fit.total))
    show(0.95, "writing")
    last = with_values(diagnosis, best)
    return Draft(
        last.effect.name,
        last.source,
        last.effect,
        last.claim,
        last.form.kind,
        best.fit,
        diagnosis,
        tuple(
            (option.plan.effect.name, option.plan.form.kind, option.fit.total - least)
            for option in options
        ),
        _in_a_line(last, best.fit),
    )


def _in_a_line(last: LawForm, fit: Fitted) -> str:
    """The law as a formula, if it is linear in its variable."""
    if last.form.kind != "line":
        return ""
    (name,) = (item.name for item in last.form.parameters)
    amount = last.claim.amount
    return in_a_line(amount, [value_of(fit, last, name)], [[factor_of(amount, last.seen)]])


def worth_drafting(diagnosis: Diagnosis) -> list[Dependence]:
    """The strongest dependences of which a law can be written, one a channel and variable."""
    believed = [
        cell for cell in diagnosis.remaining if cell.p_value < rules.SURE and _has_a_form(cell)
    ]
    believed.sort(key=lambda cell: -(cell.gain - rules.USELESS_NUMBER * cell.degrees))
    chosen: dict[tuple[str, str, str], Dependence] = {}
    for cell in believed:
        chosen.setdefault((cell.channel, cell.amount.per, cell.variable.name), cell)
    cells = list(chosen.values())
    strong = [cell for cell in cells if cell.gain > rules.DRAFTED_TOO * cells[0].gain]
    return strong[: rules.MOST_DRAFTED]


def as_a_floor(diagnosis: Diagnosis) -> bool:
    """Whether the strongest is of a heading whose zero each drive has anew, as a slope by scans.

    No law of it holds in another drive, and one of the next strongest would be wrong.
    """
    seen = [cell.variable for cell in worth_drafting(diagnosis)[:1]]
    return any(variable.name == "heading" and variable.per_run for variable in seen)


def _has_a_form(cell: Dependence) -> bool:
    """A spot on the floor is a law of travel alone; an effect may read no other place."""
    if cell.variable.form == "place":
        return cell.amount.channel in ("left", "right", "along")
    return seen_as(cell.variable) is not None


def _forms(cell: Dependence, track: float) -> Iterator[tuple[Seen, Form]]:
    if cell.variable.form == "place":
        yield Seen("position", "m", lambda side: ""), spot_of(cell, track)
        return
    seen = seen_as(cell.variable)
    assert seen is not None  # by `_has_a_form`
    coefficients = np.abs(cell.coefficients)
    size = float(np.median(coefficients[coefficients > 0.0])) if coefficients.any() else 1e-3
    for form in forms_of(seen, cell.amount, rounded(max(size, 1e-7))):
        yield seen, form
