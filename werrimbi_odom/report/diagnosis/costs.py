# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences about errors: without an effect and with it, with everything found, by sizes alone."""

from __future__ import annotations

import math

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, mistakes, ranked_of
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.report.number_format import change_words, error_words
from werrimbi_odom.report.phrases import leg_words, rarer_than_asked, sizes_words


def cost(advised: AdvisedDiagnosis, name: str) -> list[str]:
    """Errors without an effect and with it."""
    ranked = ranked_of(advised.diagnosis, name)
    if ranked is None or ranked.holdout is None:
        return []
    return _fall(advised, ranked.holdout, both_sized=_sized_beside(advised.diagnosis, name))


def _sized_beside(diagnosis: Diagnosis, name: str) -> bool:
    """Whether base or radii are off beside what was found first, and are no part of it."""
    own = name in CALIBRATED or name in mistakes(diagnosis)
    return not own and bool(sizes_found(diagnosis))


def _fall(advised: AdvisedDiagnosis, sides: Sides, *, both_sized: bool) -> list[str]:
    """`both_sized`: whether base and radii are fitted before and after."""
    before, after = sides.before, sides.after
    if not (math.isfinite(before) and math.isfinite(after)):
        return []
    where, kind = f"on {judged(advised)}", error_kind(sides)
    sized = " (base and radii fitted in both)" if both_sized else ""
    if after >= before:
        both = (
            f"{where} the {kind} error is {error_words(before, sides.unit)} without it and "
            f"{error_words(after, sides.unit)} with it{sized}"
        )
        if sides.rose:
            return [
                f"But: {both}, and chance does not raise it so. These drives are not like those "
                "it was found in: look what is different."
            ]
        turned = _fall_of_headings(advised.diagnosis)
        if turned:
            return [f"What it costs: {where} {turned}; alone it does not lower the position error."]
        return [f"What it costs is not seen yet: {both}, which these legs do not tell from chance."]
    told_before, told_after = (error_words(each, sides.unit) for each in (before, after))
    if told_before == told_after:
        return [
            f"What it costs: hardly anything {where}; the {kind} error there is "
            f"{told_before} with it and without{sized}."
        ]
    part = math.sqrt(before**2 - after**2)
    return [
        f"What it costs: {error_words(part, sides.unit)} {_each(advised, sides)}; {where} the "
        f"{kind} error falls from {told_before} to {told_after} when it is put in{sized}."
    ]


def _fall_of_headings(diagnosis: Diagnosis) -> str:
    """The fall of the heading error, if it is halved: spins on the spot leave a robot in place."""
    sides = diagnosis.headings[1]
    if not 2.0 * sides.after < sides.before:
        return ""
    before, after = (error_words(each, "rad") for each in (sides.before, sides.after))
    together = " with all that is found" if len(diagnosis.found) > 1 else ""
    return f"the heading error falls from {before} to {after}{together}"


def error_kind(sides: Sides) -> str:
    """Kind of an error."""
    return "heading" if sides.unit == "rad" else "position"


def _each(advised: AdvisedDiagnosis, sides: Sides) -> str:
    if rarer_than_asked(sides.length, advised.leg):
        return f"on each leg of {leg_words(sides.length, advised.leg)} m"
    return f"on each {'metre' if advised.leg == 1.0 else f'{advised.leg:g} m'} or quarter turn"


def judged(advised: AdvisedDiagnosis) -> str:
    """Drives and legs of the held-out errors."""
    which = "the drives held out" if advised.held_out else "a part put aside for judging"
    leg = leg_words(advised.diagnosis.holdout.length, advised.leg)
    return f"{which} (legs of {leg} m)"


def sizes_found(diagnosis: Diagnosis) -> str:
    """Wheel base and radii of the best model in measurable units; "" if all are right."""
    spread = diagnosis.told.std_of_size("unequal_wheel_radii")
    return sizes_words(diagnosis.given, best_sizes(diagnosis), spread)


def whole(advised: AdvisedDiagnosis) -> list[str]:
    """Errors with everything that was found, if that is more than one effect, sizes included."""
    diagnosis = advised.diagnosis
    sides = diagnosis.holdout
    one = len(diagnosis.found) == 1
    alone = one and not _sized_beside(diagnosis, diagnosis.found[0])
    if not diagnosis.found or alone or not math.isfinite(sides.before):
        return []
    them = "it and these sizes" if one else "all of them"
    goes = change_words(sides.before, sides.after, sides.unit)
    return [f"With {them} put in, the {error_kind(sides)} error on {judged(advised)} {goes}."]


def by_sizes_alone(advised: AdvisedDiagnosis) -> list[str]:
    """Of errors that base and radii lower, where something else is missing as well.

    Sizes that are off by more than calibration may stand in for what is missing, and sizes that are
    as uncertain as they are off are not said to be off.
    """
    diagnosis = advised.diagnosis
    sides, words = diagnosis.holdout, sizes_found(diagnosis)
    sizes = [
        (value, getattr(diagnosis.given, name), std)
        for name, (value, std) in best_sizes(diagnosis).items()
    ]
    usual = all(1.0 / rules.ORDINARY < value / given < rules.ORDINARY for value, given, _ in sizes)
    seen = any(abs(value - given) > rules.SIGNIFICANT * (std or 0.0) for value, given, std in sizes)
    if not (words and sides.fell and usual and seen):
        return []
    goes = change_words(sides.before, sides.after, sides.unit)
    return [
        f"Base and radii by themselves: {words}. With these the {error_kind(sides)} error on "
        f"{judged(advised)} {goes}. They are off, or stand in for the mean of what follows."
    ]
