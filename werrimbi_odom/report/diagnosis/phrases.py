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
    mistakes,
    ranked_of,
    values_of,
)
from werrimbi_odom.inference.diagnosis.rivals import own_scale_instead
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis import costs
from werrimbi_odom.report.diagnosis.manual_check import expected_words
from werrimbi_odom.report.number_format import (
    capital,
    chance_words,
    each_its_own,
    listed,
    quantity,
)


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
        sure = _chance(diagnosis, name, ranked.p_value)
        lines.append(f"How sure: {sure}{_deviations(diagnosis, name)}.")
    lines += costs.cost(advised, name)
    lines += ruler(diagnosis, effect, "Check it")
    return lines


def also(advised: AdvisedDiagnosis, name: str) -> list[str]:
    """Short form for another effect that was found."""
    effect = advised.diagnosis.effect_named(name)
    size = sizes(advised.diagnosis, name)
    ranked = ranked_of(advised.diagnosis, name)
    sure = ""
    if ranked is not None:
        sure = f"; {_chance(advised.diagnosis, name, ranked.p_value)}"
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


def _chance(diagnosis: Diagnosis, name: str, p_value: float | None) -> str:
    """Chance of an effect in words: of one number, no less than its distance from null allows.

    The ± of that number includes what the likelihood cannot see: the steps of coarse counters.
    """
    far = _in_deviations(diagnosis, name)
    if p_value is not None and len(far) == 1:
        p_value = max(p_value, chi2_survival(max(far.values()) ** 2, 1))
    return chance_words(p_value)


def _in_deviations(diagnosis: Diagnosis, name: str) -> dict[str, float]:
    """Distance of each determined parameter from null, in standard deviations."""
    return {
        parameter: abs(value.value - value.null) / value.std
        for parameter, value in values_of(diagnosis, name).items()
        if value.std > 0.0 and math.isfinite(value.value) and value.determined
    }


def _deviations(diagnosis: Diagnosis, name: str) -> str:
    """Distance of the most significant parameter from null, in standard deviations."""
    far = _in_deviations(diagnosis, name)
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
