# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A possible law of a draft: written as an effect file, scored without a fit, fitted, rewritten."""

from __future__ import annotations

import math
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from itertools import count
from pathlib import Path
from typing import NamedTuple

from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.effects.user_effects import load_file
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.start_values import FitDrives, scored, start_at
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.drafting.law_forms import Declared, Form, Seen
from werrimbi_odom.inference.drafting.source import name_of, source_of
from werrimbi_odom.inference.drafting.variable_source import rounded
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.score_tests import Score
from werrimbi_odom.model.effect import Effect


class Claim(NamedTuple):
    """The evidence: which error depends on what."""

    amount: Amount
    variable: str
    """Name of the variable, or of both variables."""
    p_value: float

    @property
    def channel(self) -> str:
        """Error channel."""
        return self.amount.channel


@dataclass(frozen=True)
class LawForm:
    """A form of law that may be fitted."""

    claim: Claim
    seen: Seen
    form: Form
    effect: Effect
    source: str
    lawful: Callable[[], bool]
    """Whether it keeps the contract of effects (`keeps_laws`), which takes a while to test."""
    score: Score | None = None
    """Score of the best of its shapes; None before it is scored."""
    excess: float = -math.inf
    """Gain by the score test, less the penalty of its parameters."""


@dataclass(frozen=True)
class Option:
    """A form of law that was fitted."""

    plan: LawForm
    fit: Fitted


def planned(diagnosis: Diagnosis, claim: Claim, seen: Seen, form: Form) -> LawForm:
    """Write the effect file of a form."""
    source = _written(diagnosis, claim, seen, form)
    effect = loaded(source)
    return LawForm(claim, seen, form, effect, source, cache(partial(keeps_laws, effect)))


def by_score(
    diagnosis: Diagnosis, drives: FitDrives, plans: Sequence[LawForm], noise: Variances
) -> list[LawForm]:
    """Rank forms by their score tests, without a fit; undetermined ones left out."""
    base = diagnosis.final
    before = replace(base, point=replace(base.point, variances=noise))
    found = []
    for plan in plans:
        scores = scored(drives, before, [plan.effect], (*CALIBRATION, *base.numbers))
        if scores:
            best = max(scores, key=lambda each: each.gain)
            paid = base.penalty_of_one * plan.form.numbers
            found.append(replace(plan, score=best, excess=best.gain - paid))
    return sorted(found, key=lambda plan: -plan.excess)


def worth_fitting(ordered: Sequence[LawForm]) -> list[LawForm]:
    """Those that score nearly as well as the best one that keeps the contract of effects."""
    best = next((plan.excess for plan in ordered if plan.lawful()), math.inf)
    return [plan for plan in ordered if plan.excess > best - rules.WORTH_FITTING]


def fitted_plan(diagnosis: Diagnosis, drives: FitDrives, plan: LawForm) -> Option:
    """Fit a draft, starting from the values that its score suggests."""
    base = diagnosis.final
    assert plan.score is not None
    start = start_at(drives.laid, base, plan.score, base.numbers)
    # After one round the noise is still inflated by the missing law, which would favour some laws.
    fit = drives.fit(start.point, start.names, start.numbers, diagnosis.given, rounds=2)
    return Option(plan, fit)


def _written(diagnosis: Diagnosis, claim: Claim, seen: Seen, form: Form) -> str:
    strength = "beyond chance" if claim.p_value < 1e-300 else f"p = {claim.p_value:.0e}"
    held = {applied.name for applied in diagnosis.final.point.model.robot.effects}
    name = name_of(claim.amount, claim.variable)
    if name in held:  # an earlier draft
        name = next(each for n in count(2) if (each := f"{name}_{n}") not in held)
    return source_of(name, claim.amount, seen, form, len(diagnosis.runs.runs), strength)


def with_values(diagnosis: Diagnosis, option: Option) -> LawForm:
    """The draft with the fitted values as typical values, so that fits begin there.

    Where its fitted size is so large that the contract of effects takes it for a mistake (a spot
    that turns the robot by a quarter of a wheel's travel), with the fitted shape alone: a score
    finds the size, but a fit of each shape that is tried takes as long as the draft's.
    """
    plan, robot = option.plan, option.fit.point.model.robot
    applied = next(item for item in robot.effects if item.name == plan.effect.name)
    fitted = [_at(item, applied.values[item.name]) for item in plan.form.parameters]
    shaped = [
        new if old.tries else old for old, new in zip(plan.form.parameters, fitted, strict=True)
    ]
    for parameters in (fitted, shaped):
        form = replace(plan.form, parameters=tuple(parameters))
        last = planned(diagnosis, plan.claim, plan.seen, form)
        if last.lawful():
            return last
    return plan


def _at(item: Declared, value: float) -> Declared:
    """A parameter whose typical value, or only trial shape, is a fitted one."""
    low, high = item.bounds
    if item.tries and item.name in ("x", "y", "radius"):
        return replace(item, tries=(round(value, 3),))
    if item.tries:
        at = rounded(value, item.digits)
        typical = at if abs(at) > 1e-3 * (high - low) else item.typical
        return replace(item, null=at, typical=typical, tries=(at,))
    if item.per_run or abs(value) < 1e-3 * abs(item.typical):
        return item
    typical = abs(rounded(value)) if low == 0.0 else rounded(value)
    wider = max(high, rules.WIDER_THAN_FITTED * abs(typical))
    if item.name == "share":
        wider = high
    return replace(item, typical=typical, bounds=(low and -wider, wider))


def value_of(fit: Fitted, plan: LawForm, name: str) -> float:
    """Fitted value of a parameter of a draft."""
    held = fit.point.model.robot.effects
    return next(item for item in held if item.name == plan.effect.name).values[name]


def keeps_laws(effect: Effect) -> bool:
    """Whether an effect keeps the contract of effects, on the short drive of its test.

    That drive may not reach the speed, time or channel value at which the effect begins. Then it
    does nothing there, which is no violation.
    """
    try:
        check_effect(effect)
    except AssertionError as error:
        return "does nothing" in str(error)
    return True


def loaded(source: str) -> Effect:
    """Load the effect of a source text, as `--effects FILE` would."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "draft.py"
        path.write_text(source, encoding="utf-8")
        (effect,) = load_file(path)
    return effect
