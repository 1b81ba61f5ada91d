# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where one variable does not explain what is left: a law of two, found by sparse regression.

For each kind of error all terms of two variables (`draft_terms`) are summed along the drives and
regressed on what is left. The few best laws are written as effect files, scored and fitted as those
of one variable are. The best of them must earn its place twice: on the drives that are fitted, all
terms that were tried counted in its price, and on drives that were held out of both fits, where it
must err less than the law of one variable does, by more than chance.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import replace

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.draft_law_of_two import LawOfTwo
from werrimbi_odom.inference.adding.draft_plan import (
    Claim,
    Option,
    by_score,
    fitted_plan,
    keeps_laws,
    planned,
    with_values,
)
from werrimbi_odom.inference.adding.draft_regression import selections
from werrimbi_odom.inference.adding.draft_sums import Sums, sums_of
from werrimbi_odom.inference.adding.draft_terms import is_of_two, terms_of
from werrimbi_odom.inference.adding.draft_variables import signals_of
from werrimbi_odom.inference.adding.drafting import Draft, OfTwo, draft_effect
from werrimbi_odom.inference.adding.start_values import Drives
from werrimbi_odom.inference.chances import chi2_above, in_any_of
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.evidence import AMOUNTS
from werrimbi_odom.inference.diagnosis.paired_comparison import sides_of
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.rules import MOST_FITTED, RIVAL, SECOND_VARIABLE, WORTH_FITTING
from werrimbi_odom.progress import Show, silent


def best_draft(
    diagnosis: Diagnosis, tried_out: Callable[[Draft], Added], show: Show = silent
) -> tuple[Draft, Added]:
    """The draft of one variable, or of two where held-out drives want the second.

    Parameters
    ----------
    tried_out
        What a draft does to the errors once it is added.

    Raises
    ------
    InputError
        When the errors depend on nothing beyond chance, or no draft of it can be fitted.
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
    """The best law of two variables, if it explains the fitted drives better than one of one does.

    Parameters
    ----------
    one
        The draft of one variable; None where there is none: then calibration alone is to be beaten.
    """
    base = diagnosis.final
    drives = Drives(diagnosis.runs, base.point.excluded, base.point.options)
    # As with laws of one: without a law the wheels' noise stands for it, and hides what tells.
    noise = base.point.variances if one is None else one.fit.point.variances
    show(0.0, "laws of two variables")
    laws, tried = _searched(diagnosis, replace(base.point, variances=noise))
    plans = []
    for law in laws:
        chance = in_any_of(tried, chi2_above(law.gain, len(law.terms)))
        claim = Claim(law.amount, law.name, chance)
        plans.append(planned(diagnosis, claim, law.seen, law.form))
    ordered = [
        plan for plan in by_score(diagnosis, drives, plans, noise) if keeps_laws(plan.effect)
    ]
    options: list[Option] = []
    for number, plan in enumerate(ordered[:MOST_FITTED]):
        if plan.excess > ordered[0].excess - WORTH_FITTING:
            show((number + 1) / (MOST_FITTED + 1), f"{plan.claim.variable}: {plan.form.kind}")
            options.append(fitted_plan(diagnosis, drives, plan))

    def total(option: Option) -> float:
        searched = _price_of_search(tried) * option.plan.form.numbers
        return option.fit.total + searched * option.fit.scatter

    best = min(options, key=total, default=None)
    if best is None or total(best) > (base if one is None else one.fit).total - RIVAL:
        return None
    last = with_values(diagnosis, best)
    law = next(
        law for law, plan in zip(laws, plans, strict=True) if plan.effect is best.plan.effect
    )
    held = best.fit.point.model.robot.effects
    applied = next(item for item in held if item.name == last.effect.name)
    line = law.in_a_line([applied.values[item.name] for item in last.form.parameters])
    return Draft(
        last.effect.name,
        last.source,
        last.effect,
        last.claim,
        last.form.kind,
        best.fit,
        diagnosis,
        tuple(
            (option.plan.effect.name, option.plan.form.kind, option.fit.total - best.fit.total)
            for option in options
        ),
        OfTwo(law.variables, line, law.symbols(line), tried, one),
    )


def better_held_out(two: Draft, with_two: Added, with_one: Added | None) -> Draft | None:
    """The law of two, where drives held out of both fits want it beyond chance; else None.

    Parameters
    ----------
    with_one
        What the law of one does to the same drives; None where there is none, then calibration.
    """
    assert two.of_two is not None
    side = with_two.holdout
    other = side.calibrated if with_one is None else with_one.holdout.after
    sides = sides_of(side.after, other, side.unit)
    if sides.chance >= SECOND_VARIABLE:
        return None
    return replace(two, of_two=replace(two.of_two, held_out=sides))


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
    price = diagnosis.final.price_of_one + _price_of_search(tried)
    found = []
    for amount, each in sums.items():
        for chosen in selections(each.square, each.cross, price, _of_two_variables(each)):
            own = tuple(each.terms[index] for index in chosen.terms)
            sizes = (chosen.coefficients / each.size[list(chosen.terms)]).tolist()
            law = LawOfTwo(amount, own, tuple(sizes), chosen.gain)
            if chosen.worth(price) > 0.0 and any(is_of_two(term, amount) for term in own):
                found.append(law)
    found = [law for law in found if len(law.variables) == 2]
    found.sort(key=lambda law: price * len(law.terms) - law.gain)
    return found[: 2 * MOST_FITTED], tried


def _price_of_search(tried: int) -> float:
    """What a term must be worth because so many were looked at (`draft_regression`)."""
    return 2.0 * math.log(max(tried, 1))


def _of_two_variables(sums: Sums) -> Callable[[Collection[int], int], bool]:
    """Whether a term may join others: so that there are two variables, and no more."""

    def may_join(chosen: Collection[int], one: int) -> bool:
        names = sums.terms[one].variables.union(*(sums.terms[each].variables for each in chosen))
        return len(names) <= 2

    return may_join
