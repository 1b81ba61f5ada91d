# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Laws of two variables by sparse regression, where one variable does not explain the errors.

For each amount all terms of two variables (`terms`) are summed along the drives and regressed on
the innovations. The few best laws are written as effect files, scored and fitted like those of one
variable. The best is accepted if it passes two tests. On the fitted drives it must pay a penalty
that allows for all terms tried. On held-out drives its error must be significantly lower than that
of the law of one variable.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from itertools import islice
from typing import NamedTuple

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.start_values import FitDrives
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.paired_comparison import sides_of
from werrimbi_odom.inference.diagnosis.step_jacobians import AMOUNTS
from werrimbi_odom.inference.distributions import bonferroni, chi2_survival
from werrimbi_odom.inference.drafting.candidate_law import (
    Claim,
    Option,
    by_score,
    fitted_plan,
    planned,
    value_of,
    with_values,
    worth_fitting,
)
from werrimbi_odom.inference.drafting.draft import Draft, OfTwo, draft_effect
from werrimbi_odom.inference.drafting.regression import Sums, selections, sums_of
from werrimbi_odom.inference.drafting.terms import is_of_two, terms_of
from werrimbi_odom.inference.drafting.two_variable_law import LawOfTwo
from werrimbi_odom.inference.drafting.variable_source import signals_of
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.likelihood import Variances
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.progress import Show, silent


def best_draft(
    diagnosis: Diagnosis, tried_out: Callable[[Draft], Added], show: Show = silent
) -> tuple[Draft, Added]:
    """The best draft of one variable, or of two where the held-out drives support it.

    `tried_out`: adds a draft to the model and returns the change of the errors. InputError when
    there is no significant dependence, or no draft of it can be fitted.
    """
    one, refused = None, None
    try:
        one = draft_effect(diagnosis, show)
    except InputError as error:
        refused = error
    with_one = None if one is None else tried_out(one)
    two = draft_of_two(diagnosis, one, show)
    if two is not None:
        with_two = tried_out(two)
        two = better_held_out(two, with_two, with_one)
        if two is not None:
            return two, with_two
    if one is None or with_one is None:
        assert refused is not None
        raise refused
    return one, with_one


def draft_of_two(diagnosis: Diagnosis, one: Draft | None, show: Show = silent) -> Draft | None:
    """The best law of two variables, if it explains the fitted drives better than a law of one.

    `one`: the draft of one variable; without one, the law must be better than calibration alone.
    """
    base = diagnosis.final
    drives = FitDrives(diagnosis.runs, base.point.excluded, base.point.options)
    noise = _as_calm(base.point.variances if one is None else one.fit.point.variances)
    found: list[_Found] = []
    for number in range(rules.SEARCHES):
        show(number / rules.SEARCHES, "laws of two variables")
        laws, tried = _searched(diagnosis, replace(base.point, variances=noise))
        found += _fitted(diagnosis, drives, laws, tried, noise)
        if not found:
            return None
        noise = min(found, key=lambda each: each.total).option.fit.point.variances
    best = min(found, key=lambda each: each.total)
    if best.total > (base if one is None else one.fit).total - rules.RIVAL:
        return None
    last, fit = with_values(diagnosis, best.option), best.option.fit
    line = best.law.line([value_of(fit, last, item.name) for item in last.form.parameters])
    return Draft(
        last.effect.name,
        last.source,
        last.effect,
        last.claim,
        last.form.kind,
        fit,
        diagnosis,
        tuple(
            (each.option.plan.effect.name, each.option.plan.form.kind, each.total - best.total)
            for each in found
        ),
        line,
        OfTwo(best.law.variables, best.tried, one),
    )


def better_held_out(two: Draft, with_two: Added, with_one: Added | None) -> Draft | None:
    """The law of two, if significantly better than the law of one on held-out drives; else None.

    It is a single test, fixed before the held-out drives are looked at: whether their errors rise
    when the law of one takes its place. So it needs no correction. `with_one`: errors on the same
    drives with the law of one; without it, those with calibration are used.
    """
    assert two.of_two is not None
    side = with_two.holdout
    other = side.calibrated if with_one is None else with_one.holdout.after
    sides = sides_of(side.after, other, side.unit)
    if not sides.rose:
        return None
    return replace(two, of_two=replace(two.of_two, held_out=sides))


class _Found(NamedTuple):
    """A law of two variables that was fitted."""

    law: LawOfTwo
    option: Option
    tried: int
    """Number of terms that the search selected from."""

    @property
    def total(self) -> float:
        """Cost with the penalty of the parameters and of the search."""
        searched = _price_of_search(self.tried) * len(self.law.terms)
        return self.option.fit.total + searched * self.option.fit.scatter


def _fitted(
    diagnosis: Diagnosis, drives: FitDrives, laws: Sequence[LawOfTwo], tried: int, noise: Variances
) -> Iterator[_Found]:
    """Fit the few most promising laws."""
    planned_from = {}
    for law in laws:
        chance = bonferroni(tried, chi2_survival(law.gain, len(law.terms)))
        plan = planned(diagnosis, Claim(law.amount, law.name, chance), law.seen, law.form)
        planned_from[plan.effect.apply] = law, plan
    ordered = by_score(diagnosis, drives, [plan for _, plan in planned_from.values()], noise)
    likely = (plan for plan in worth_fitting(ordered) if plan.lawful())
    for plan in islice(likely, rules.MOST_FITTED):
        law, _ = planned_from[plan.effect.apply]
        yield _Found(law, fitted_plan(diagnosis, drives, plan), tried)


def _as_calm(noise: Variances) -> Variances:
    """Reduce both wheels' noise to that of the less noisy one, and at most to a typical one.

    While a law is missing, its errors inflate the noise of the wheels concerned, which hides
    differences between laws.
    """
    usual = np.full(noise.left.shape, rules.TYPICAL_WHEEL_NOISE**2)
    calm = np.minimum(np.minimum(noise.left, noise.right), usual)
    return replace(noise, left=calm, right=calm)


def _searched(diagnosis: Diagnosis, point: Point) -> tuple[list[LawOfTwo], int]:
    """The most promising laws of two variables, best first; and how many terms were tried."""
    runs, numbers = diagnosis.runs, (*CALIBRATION, *diagnosis.final.numbers)
    drive = runs.drive(point.model.laid_out(runs.steps))
    terms = {
        of_wheels: terms_of(signals_of(drive, of_wheels=of_wheels)) for of_wheels in (True, False)
    }
    sums = {
        amount: sums_of(runs, point, numbers, amount, terms[amount.of_wheels]) for amount in AMOUNTS
    }
    tried = sum(len(each.terms) for each in sums.values())
    penalty = diagnosis.final.penalty_of_one + _price_of_search(tried)
    found = []
    for amount, each in sums.items():
        for chosen in selections(each.square, each.cross, penalty, _of_two_variables(each)):
            own = tuple(each.terms[index] for index in chosen.terms)
            sizes = (chosen.coefficients / each.size[list(chosen.terms)]).tolist()
            law = LawOfTwo(amount, own, tuple(sizes), chosen.gain)
            if chosen.worth(penalty) > 0.0 and any(is_of_two(term, amount) for term in own):
                found.append(law)
    found = [law for law in found if len(law.variables) == 2]
    found.sort(key=lambda law: penalty * len(law.terms) - law.gain)
    return found[: 2 * rules.MOST_FITTED], tried


def _price_of_search(tried: int) -> float:
    """Penalty of a term for the search among `tried` terms (`regression`)."""
    return 2.0 * math.log(max(tried, 1))


def _of_two_variables(sums: Sums) -> Callable[[Collection[int], int], bool]:
    """Whether a term may join others: a readable law has two variables and one gate at most."""

    def may_join(chosen: Collection[int], one: int) -> bool:
        terms = [sums.terms[each] for each in (*chosen, one)]
        names = frozenset[str]().union(*(term.variables for term in terms))
        gates = {term.gate for term in terms} - {""}
        return len(names) <= 2 and len(gates) <= 1

    return may_join
