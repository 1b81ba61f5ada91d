# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Remarks on a diagnosis: what remains, and objections."""

from __future__ import annotations

import math

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import at_bounds, values_of, widest
from werrimbi_odom.inference.diagnosis.misfit import Misfit
from werrimbi_odom.inference.diagnosis.outlying_drives import RecordedOtherwise
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis, beyond_chance
from werrimbi_odom.model.effect import applied_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.costs import error_kind, judged
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.diagnosis.phrases import sizes
from werrimbi_odom.report.number_format import (
    chance_words,
    change_words,
    error_words,
    listed,
    quantity,
    two_digits,
)
from werrimbi_odom.report.phrases import held_law_words


def remainder(advised: AdvisedDiagnosis) -> list[str]:
    """What speaks against the model with everything found put in."""
    bounds = at_bounds_told(advised.diagnosis)
    return [*rest(advised), *bounds]


def rest(advised: AdvisedDiagnosis) -> list[str]:
    """What is left, if anything, and whether that is the reference's own noise."""
    told = [*law(advised), *scatter(advised)]
    return [*told, *left_is_noise(advised)] if told else []


def law(advised: AdvisedDiagnosis) -> list[str]:
    """The misfit that remains with everything found, or that of a law in the robot file."""
    misfit = advised.diagnosis.misfit
    if misfit is None:
        return []
    cell = f"{dependence_words(misfit.cell)} ({chance_words(misfit.cell.p_value)})"
    if misfit.only_in is not None:
        return [
            f"But: drive {misfit.only_in} alone shows something more: in it {cell}. (It stands out "
            "by what its errors go with. By their size, which `werrimbi compare` tells, another "
            "may.) The others "
            "hold as much driving that would show it, and do not. So no law of the robot is seen "
            "in it: "
            "something happened on that drive, its reference erred, or it was recorded otherwise"
            f"{held_law_words(advised.diagnosis.robot, ' there')}."
        ]
    if misfit.effect is None:
        return [
            f"But: something is left. With everything found put in, {cell}.{little_words(misfit)}"
        ]
    share = "" if misfit.share is None else f", {100.0 * misfit.share:.2g} % of what it explains,"
    return [
        f"But: the law of {misfit.effect} does not fit fully. What it leaves{share} is in what it "
        f"looks at: {cell}. That is a matter of the law's form, and no other effect."
    ]


def little_words(misfit: Misfit) -> str:
    """How little of the errors a remainder without a law is, where it is that little."""
    if misfit.share is None:
        return ""
    return (
        f" That is {100.0 * misfit.share:.2g} % of the squared errors, and what the robot file "
        "holds explains more than ten times as much: a law of it may not quite fit."
    )


def left_is_noise(advised: AdvisedDiagnosis) -> list[str]:
    """That what is left is the reference's own noise, with its whiteness; else nothing."""
    diagnosis, left = advised.diagnosis, advised.diagnosis.left
    if left is None or not left.is_noise:
        return []
    error, noise = (
        error_words(each, left.unit) for each in (left.holdout.error, left.holdout.reference)
    )
    without = " and no such event" if diagnosis.happened.left_out else ""
    lines = [
        f"What is left, {error} on {judged(advised)}{without}, is the reference's own noise: that, "
        f"with the rounding of the counts, makes {noise} of such legs by itself. "
    ]
    most = max((cell.gain for cell in beyond_chance(diagnosis.remaining)), default=0.0)
    if most:
        off = 1.0 - math.sqrt(max(1.0 - most / diagnosis.runs.data, 0.0))
        lines.append(f"A law of one variable would take some {two_digits(100.0 * off)} % off it. ")
    if not (alike := left.not_white):
        lines.append("From a short leg to the next it is white, as noise is.")
    else:
        told = listed([f"{name} {size:+.2f}" for name, size in alike.items()])
        lines.append(
            f"But it is not white: from a short leg to the next it is correlated ({told}), so "
            "something slower is in it."
        )
    return ["".join(lines)]


def scatter(advised: AdvisedDiagnosis) -> list[str]:
    """Remark that values differ between parts of the drives by more than noise."""
    diagnosis = advised.diagnosis
    widened = widest(diagnosis)
    if widened <= 1.0:
        return []
    left = next(iter(beyond_chance(diagnosis.remaining)), None)
    most = f" What is left goes most with this: {dependence_words(left)}." if left else ""
    return [
        f"But: the parts of the drives do not agree on these values; each ± is as wide as they "
        f"scatter, up to {widened:.2g} times what the noise would make. So they are no more than "
        "the mean of something that is still missing: a law that the library lacks, a reference "
        f"that wanders, or a robot that was changed.{most}"
    ]


def without_events(advised: AdvisedDiagnosis) -> list[str]:
    """Errors without the legs of abrupt events that are told."""
    if not advised.diagnosis.happened.events:
        return []  # marked beside a first model, and none beside the last
    every, quiet = advised.diagnosis.holdout, advised.diagnosis.quiet[1]
    if (quiet.before, quiet.after) == (every.before, every.after) or not math.isfinite(quiet.after):
        return []
    change = f"is {error_words(quiet.after, quiet.unit)}"
    if advised.diagnosis.found:
        change = change_words(quiet.before, quiet.after, quiet.unit)
    one = len(advised.diagnosis.happened.events) == 1
    return [
        f"In the errors {'it counts' if one else 'they count'}, as in those of `werrimbi compare`. "
        f"Without {'its' if one else 'their'} legs the "
        f"{error_kind(quiet)} error on {judged(advised)} {change}."
    ]


def at_bounds_words(diagnosis: Diagnosis) -> dict[str, str]:
    """Effects that would help only at a physically impossible value, and that value."""
    return {
        name: f"{parameter} = {quantity(value, math.nan, unit)}"
        for name, (parameter, value, unit) in at_bounds(diagnosis).items()
    }


def otherwise(diagnosis: Diagnosis) -> list[str]:
    """Drives that were recorded differently from the fitted ones, by the difference."""
    alike: dict[tuple[str, ...], list[RecordedOtherwise]] = {}
    for each in diagnosis.otherwise:
        alike.setdefault(each.effects, []).append(each)
    lines = []
    for drives in alike.values():
        names = listed([each.run for each in drives])
        what = "; ".join(finding.words for finding in drives[0].findings)
        one = len(drives) == 1
        lines.append(
            f"But: {'drive' if one else 'drives'} {names} {'was' if one else 'were'} recorded "
            f"otherwise than the drives that the diagnosis is of: {what}. "
            f"{'It has' if one else 'They have'} no part in what is said here, but for the figures "
            "of held-out drives where there are no others."
        )
    return lines


def instead_of_held(diagnosis: Diagnosis) -> list[str]:
    """Rivals of an effect in the robot file, and how to separate them; twins by no drive."""
    lines = []
    for name, others in diagnosis.rivals_of_held.items():
        effect = diagnosis.effect_named(name)
        alike = {
            twin.name: twin
            for twin in (effect.indistinguishable_from if effect else ())
            if twin.name in others and (diagnosis.runs.headings_alone or not twin.of_headings)
        }
        lines += [
            f"But: whether it is {name}, which the robot file holds, or {twin.name}, these drives "
            f"do not show: {twin.told_apart_by}."
            for twin in alike.values()
        ]
        if rest := [other for other in others if other not in alike]:
            nothing = ["nothing"] if name in diagnosis.needless_of_held else []
            lines.append(
                f"But: that it is {name}, which the robot file holds, these drives do not show: "
                f"{listed([*rest, *nothing], 'or')} in its place would explain them as well. "
                "`werrimbi explain` says how each is checked on the robot; a reference that "
                "measures more often tells them apart."
            )
    return lines


def outdated_told(advised: AdvisedDiagnosis) -> list[str]:
    """Effects in the robot file whose values these drives contradict, and the errors."""
    diagnosis, sides = advised.diagnosis, advised.diagnosis.holdout
    lines = []
    for name in diagnosis.outdated:
        values = applied_of(diagnosis.given.effects, name).values
        file = ", ".join(
            f"{parameter} {quantity(values[parameter], math.nan, item.unit)}"
            for parameter, item in values_of(diagnosis, name).items()
            if item.reported
        )
        lines.append(f"- {name}: {sizes(diagnosis, name)}, where the robot file has {file}.")
    if lines and math.isfinite(sides.before):
        goes = change_words(sides.before, sides.after, sides.unit)
        lines.append(
            f"With these values the {error_kind(sides)} error on {judged(advised)} {goes}."
        )
    return lines


def at_bounds_told(diagnosis: Diagnosis) -> list[str]:
    """Sentences on the effects of `at_bounds_words`."""
    return [
        f"But: {name} would lower the error too, only with {value}, the limit of what physics "
        "allows: it is not that effect."
        for name, value in at_bounds_words(diagnosis).items()
    ]


def like_noise(diagnosis: Diagnosis, *, noise: bool) -> str:
    """That held-out errors look like noise, or that they are larger than those of the fitted.

    `noise`: whether the fitted drives leave noise.
    """
    if not unlike_the_fitted(diagnosis):
        return ", and they look like noise." if noise else "."
    error = error_words(diagnosis.train.before, diagnosis.train.unit)
    return f"; on what was fitted they are {error}, so they are not noise alone."


def unlike_the_fitted(diagnosis: Diagnosis) -> bool:
    """Whether held-out errors are far larger than those of the fitted drives."""
    return diagnosis.holdout.before > rules.UNLIKE * diagnosis.train.before


def drowned(advised: AdvisedDiagnosis) -> list[str]:
    """Of a *none* whose errors are a large part of the way: of little worth."""
    sides = advised.diagnosis.holdout
    leg = max(advised.leg, sides.length)
    if sides.unit != "m" or not sides.after > rules.WRONG_OF_A_LEG * leg:
        return []
    return [
        f"But: that is {100.0 * sides.after / leg:.0f} % of the way. If the reference errs so, it "
        "hides all that is smaller; longer legs (--leg) or a better reference show more. If it "
        "does not, something is wrong that looks like noise: see where both paths part, by "
        "`werrimbi compare` with --report."
    ]


def wanders_words(robot: Robot) -> str:
    """That errors are alike for seconds and go with nothing in all parts of the drives."""
    return (
        "But: for seconds together the errors are alike, more than noise is, and the parts of the "
        "drives do not agree on what they go with. So errs a reference that wanders (a camera, a "
        f"map that is matched){held_law_words(robot)}; what is smaller than that is not seen."
    )


def alike(diagnosis: Diagnosis) -> list[str]:
    """Of a *none* whose errors are alike from leg to leg, and far above the reference's noise."""
    left = diagnosis.left
    if left is None:
        return []
    found = [
        each.correlation for each in left.neighbours.values() if each.p_value < rules.VERY_SURE
    ]
    times = min(side.error / max(side.reference, 1e-9) for side in (left.train, left.holdout))
    if not max(found, default=0.0) > 0.0 or times < rules.FAR_ABOVE_NOISE:
        return []
    return [
        f"But: neighbouring legs err alike (correlation {max(found):+.2g}), by {two_digits(times)} "
        "times what the reference's own noise makes. Noise of wheels that roll is not alike: "
        "something is missing that goes with nothing measured here, as where wheels skid."
    ]


def nearest(diagnosis: Diagnosis, law_told: bool) -> list[str]:
    """The effect that lowers the error most, beside base and radii; held against the law told."""
    calibrated = diagnosis.holdout
    others = [item for item in diagnosis.ranking if item.effect not in CALIBRATED]
    best = min(others, key=lambda item: _after(item.holdout), default=None)
    if best is None or best.holdout is None or not best.holdout.after < calibrated.after:
        return []
    sides = (best.holdout.after, calibrated.after)
    with_it, without = (error_words(each, calibrated.unit) for each in sides)
    if with_it == without:
        return []
    return [
        f"Nearest in the library is {best.effect}: errors are {with_it} with it, and {without} "
        "without. "
        + (
            "Yet parts of these drives do not agree on it, or chance could do as much: look there "
            "first, and drive more."
            if diagnosis.explained_by(best.effect)
            else "The above explains far more than it does, so that is not it, or not all of it."
            if law_told
            else "That is too little to name it."
        )
    ]


def _after(sides: Sides | None) -> float:
    return math.inf if sides is None or math.isnan(sides.after) else sides.after
