# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sentences about one effect: what it is, its size, significance, cost, and how to check it."""

from __future__ import annotations

import math
from collections.abc import Iterable

from werrimbi_odom.effects.effect_docstring import page_of
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import (
    Value,
    best_sizes,
    mistakes,
    ranked_of,
    values_of,
)
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.rivals import own_scale_instead
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis.manual_check import expected_words
from werrimbi_odom.report.number_format import (
    capital,
    chance_words,
    each_its_own,
    error_words,
    listed,
    quantity,
)
from werrimbi_odom.report.phrases import leg_words, rarer_than_asked, sizes_words


def about(advised: AdvisedDiagnosis, name: str) -> list[str]:
    """What the effect is, its size, significance, cost, and how to check it."""
    diagnosis = advised.diagnosis
    effect = diagnosis.effect_named(name)
    lines = []
    if effect is not None:
        lines.append(f"What it is: {effect.summary}")
    lines += _large(diagnosis, name)
    ranked = ranked_of(diagnosis, name)
    if ranked is not None and name not in mistakes(diagnosis):
        lines.append(f"How sure: {chance_words(ranked.p_value)}{_deviations(diagnosis, name)}.")
    lines += cost(advised, name)
    lines += ruler(diagnosis, effect, "Check it")
    return lines


def also(advised: AdvisedDiagnosis, name: str) -> list[str]:
    """Short form for another effect that was found."""
    effect = advised.diagnosis.effect_named(name)
    size = sizes(advised.diagnosis, name)
    ranked = ranked_of(advised.diagnosis, name)
    sure = f"; {chance_words(ranked.p_value)}" if ranked is not None else ""
    what = f" {effect.summary}" if effect is not None else ""
    own = own_scale_instead(
        name, advised.diagnosis.final, advised.diagnosis.given, advised.diagnosis.runs
    )
    if own:
        what += f" Headings alone cannot tell it from {listed(own, 'or')}."
    twins = effect.twins if effect is not None else ()
    near = advised.diagnosis.rivals_of_others.get(name, ())
    if rivals := [each for each in near if each not in (*twins, *own)]:
        what += f" These drives cannot tell it from {listed(rivals, 'or')}, in its place."
    if twins:
        what += f" To the reference it is one with {listed(twins, 'or')}, on any drive."
    what = hang_together(values_of(advised.diagnosis, name).values()) + what
    return [f"- Also {name}: {size}{sure}.{what}"]


def _large(diagnosis: Diagnosis, name: str) -> list[str]:
    every = values_of(diagnosis, name)
    if not every:
        return []
    values = {key: value for key, value in every.items() if not _unseen(value)} or every
    parts = [
        f"{parameter} is {each_its_own(value.of_runs, value.unit)} ({value.says})"
        if value.per_run
        else f"{parameter} {'=' if value.determined else 'is'} {_value(value)} ({value.says})"
        for parameter, value in values.items()
    ]
    unseen = [key for key in every if key not in values]
    late = f" None is seen of {listed(unseen)}." if unseen else ""
    if name == "reference_delay" and values["delay"].value < 0.0:
        late += " Negative: it is the encoders' stamps that are late against the reference's."
    return [f"How large: {'; '.join(parts)}.{hang_together(every.values())}{late}"]


def set_up_lines(diagnosis: Diagnosis) -> list[str]:
    """Set-up mistakes, which come first because all else depends on them; then skid steering."""
    findings = diagnosis.set_up.findings
    wrong = diagnosis.set_up.wrong
    lines = ["Something is set up wrongly:"] if wrong else []
    for finding in wrong:
        words = set_up_words(diagnosis, finding)
        lines.append(f"- {capital(words)}: {finding.effect}.")
    skids = [finding for finding in findings if finding not in wrong]
    return [
        *lines,
        *(f"This robot is a skid steer ({each.effect}): {each.words}." for each in skids),
    ]


def set_up_words(diagnosis: Diagnosis, finding: SetUpFinding) -> str:
    """A set-up mistake in words; a delay as it was fitted, for it is looked for in coarse steps."""
    words = finding.words.rstrip(".")
    fitted = values_of(diagnosis, finding.effect).get("delay")
    if fitted is None or "delay" not in finding.values:
        return words
    said, size = (
        f"{seconds} s too {'late' if delay > 0.0 else 'early'}"
        for delay, seconds in (
            (finding.values["delay"], f"{abs(finding.values['delay']):.1f}"),
            (fitted.value, f"{abs(fitted.value):.2g}"),
        )
    )
    return words.replace(said, size)


def _unseen(value: Value) -> bool:
    """Whether a parameter is not significantly different from null, as in `add`."""
    if not value.determined:
        return False
    away = abs(value.value - value.null)
    if away == 0.0 and not value.is_shape and not value.per_run:
        return True
    told = not value.per_run and not value.is_shape and value.std > 0.0
    return told and away < rules.SIGNIFICANT * value.std


def hang_together(values: Iterable[Value]) -> str:
    """Remark that the sizes of an effect are significant only jointly; "" otherwise."""
    known = [value for value in values if value.reported and value.determined and value.std > 0.0]
    if len(known) < 2 or not all(map(_unseen, known)):
        return ""
    return " Any one of these may be none, but not all of them: they hang together in these drives."


def _deviations(diagnosis: Diagnosis, name: str) -> str:
    """Distance of the most significant parameter from null, in standard deviations."""
    far = {
        parameter: abs(value.value - value.null) / value.std
        for parameter, value in values_of(diagnosis, name).items()
        if value.std > 0.0 and math.isfinite(value.value) and value.determined
    }
    if not far:
        return ""
    first = max(far, key=lambda parameter: far[parameter])
    return f"; {first} is {far[first]:.0f} standard deviations from none"


def sizes(diagnosis: Diagnosis, name: str, *, believed: bool = False) -> str:
    """Values of an effect, on request without those within one standard deviation of null."""
    values = values_of(diagnosis, name)
    return ", ".join(
        f"{parameter} {_value(value)}"
        for parameter, value in values.items()
        if value.of_runs
        or (value.reported and not (believed and value.std > abs(value.value - value.null)))
    )


def _value(value: Value) -> str:
    if value.of_runs:
        return each_its_own(value.of_runs, value.unit)
    if not value.determined:
        return "not determined by these drives"
    return quantity(value.value, value.std, value.unit, value.or_else)


def cost(advised: AdvisedDiagnosis, name: str) -> list[str]:
    """Errors without an effect and with it."""
    ranked = ranked_of(advised.diagnosis, name)
    if ranked is None or ranked.holdout is None:
        return []
    return _fall(advised, ranked.holdout)


def _fall(advised: AdvisedDiagnosis, sides: Sides) -> list[str]:
    before, after = sides.before, sides.after
    if not (math.isfinite(before) and math.isfinite(after)):
        return []
    where, kind = f"on {judged(advised)}", error_kind(sides)
    if after >= before:
        both = (
            f"{where} the {kind} error is {error_words(before, sides.unit)} without it and "
            f"{error_words(after, sides.unit)} with it"
        )
        if sides.rose:
            return [
                f"But: {both}, and chance does not raise it so. These drives are not like those "
                "it was found in: look what is different."
            ]
        turned = _fall_of_headings(advised.diagnosis)
        if turned:
            return [f"What it costs: {where} {turned}; positions are as good without it."]
        return [f"What it costs is not seen yet: {both}, which these legs do not tell from chance."]
    told_before, told_after = (error_words(each, sides.unit) for each in (before, after))
    if told_before == told_after:
        return [
            f"What it costs: hardly anything {where}; the {kind} error there is "
            f"{told_before} with it and without."
        ]
    part = math.sqrt(before**2 - after**2)
    return [
        f"What it costs: {error_words(part, sides.unit)} {_each(advised, sides)}; {where} the "
        f"{kind} error falls from {told_before} to {told_after} when it is put in."
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
    return sizes_words(diagnosis.given, best_sizes(diagnosis))


def whole(advised: AdvisedDiagnosis) -> list[str]:
    """Errors with everything that was found, if that is more than one effect."""
    diagnosis = advised.diagnosis
    sides = diagnosis.holdout
    if len(diagnosis.found) < 2 or not math.isfinite(sides.before):
        return []
    before, after = (error_words(each, sides.unit) for each in (sides.before, sides.after))
    goes = f"{'falls' if sides.after < sides.before else 'goes'} from {before} to {after}"
    if before == after:
        goes = f"stays at {before}"
    return [f"With all of them put in, the {error_kind(sides)} error on {judged(advised)} {goes}."]


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
    before, after = (error_words(each, sides.unit) for each in (sides.before, sides.after))
    return [
        f"Base and radii by themselves: {words}. With these the {error_kind(sides)} error on "
        f"{judged(advised)} falls from {before} to {after}. They are off, or stand in for the mean "
        "of what follows."
    ]


def ruler(diagnosis: Diagnosis, effect: Effect | None, head: str) -> list[str]:
    """How to check an effect on the robot, with a heading and the expected result."""
    if effect is None:
        return []
    found = values_of(diagnosis, effect.name)
    seen = any(not _unseen(item) for item in found.values())
    values = {name: _to_expect(item, seen) for name, item in found.items()}
    if diagnosis.runs.headings_alone and effect.name == "reference_delay":
        effect = find("reference_heading_delay")  # one model, and a gyro sees no mark passed
    text = page_of(effect).sections.get("Ruler")
    if not text:
        return []
    numbers = expected_words(effect.name, values, diagnosis.robot) if values else ""
    ending = f"; {numbers}" if numbers else ""
    return [f"{head}: {' '.join(text.split())}{ending}."]


def _to_expect(value: Value, seen: bool) -> float:
    """A value for the check: NaN if it is not known, and none of what is not seen (as `add`)."""
    if not (value.determined or value.is_shape):
        return math.nan
    return value.null if seen and _unseen(value) else value.value
