# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis in plain words: what is missing, how sure, how large, what it costs, what to do."""

from __future__ import annotations

import math
from dataclasses import dataclass

from werrimbi_odom.inference.diagnosis.diagnosis import SURE, VERY_SURE, Diagnosis, chance
from werrimbi_odom.inference.set_up.mistakes import IN_DEGREES
from werrimbi_odom.report.diagnosis.as_json import significant
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.diagnosis.phrases import (
    Told,
    about,
    also,
    cost,
    judged,
    mistakes,
    ruler,
    sizes,
    whole,
)
from werrimbi_odom.report.diagnosis.values import effect_named
from werrimbi_odom.report.numbers import chance_words, error_words, listed
from werrimbi_odom.report.printed import filled

__all__ = ["NextSteps", "Told", "words_of"]


@dataclass(frozen=True)
class NextSteps:
    """Commands for the same robot and drives, as one would type them."""

    add: str = "werrimbi add {effect} --robot R RUN... --out NEW.yaml"
    """With {effect} where its name goes."""
    draft: str = "werrimbi draft --robot R RUN... --out my_effect"
    diagnose: str = "werrimbi diagnose"


def words_of(told: Told, steps: NextSteps) -> str:
    """All sentences, filled to 80 columns; commands are left whole."""
    diagnosis = told.diagnosis
    tell = {
        "none": _none,
        "named": _named,
        "ambiguous": _ambiguous,
        "unknown": _unknown,
    }[diagnosis.verdict]
    paragraphs = tell(told, steps)
    return "\n".join(_filled(text) for text in paragraphs if text)


def _filled(text: str) -> str:
    """Paragraphs filled; what begins with four blanks is a command and is left alone."""
    if text.startswith("    ") or not text.strip():
        return text.rstrip()
    first, _, _ = text.partition(": ")
    head = first in _HEADS or first.startswith("Check ")
    return filled(text, hanging=head)


_HEADS = ("What it is", "How large", "How sure", "What it costs", "Check it", "Next", "But", "Why")


def _none(told: Told, steps: NextSteps) -> list[str]:
    diagnosis = told.diagnosis
    hidden = [sight for sight in told.sights if sight.hidden]
    wanders = any(cell.p_value < VERY_SURE for cell in diagnosis.depends_on)
    lines = [
        "Nothing is missing that these drives could show"
        + ("." if wanders else ": the model explains them to their noise.")
    ]
    errors = diagnosis.holdout.after
    if math.isfinite(errors):
        like = "" if wanders else ", and they look like noise"
        lines.append(
            f"Its errors on {judged(told)} are {error_words(errors, diagnosis.holdout.unit)}{like}."
        )
    if wanders:
        lines.append(
            "But: for seconds together the errors are alike, more than noise is, and the parts of "
            "the drives do not agree on what they go with. So errs a reference that wanders (a "
            "camera, a map that is matched); what is smaller than that is not seen."
        )
    seen = [sight for sight in told.sights if not sight.hidden]
    if seen:
        lines.append(
            "How well that is known: the table says from which size on each effect would have been "
            "seen."
        )
    if hidden:
        lines += _not_shown(told)
    lines.append(
        "Next: `werrimbi compare` says whether the covariance is honest; `werrimbi calibrate fit` "
        "fits the wheels' noise."
    )
    return lines


def _named(told: Told, steps: NextSteps) -> list[str]:
    diagnosis = told.diagnosis
    name = diagnosis.effect or ""
    lines = _set_up(diagnosis)
    if not lines:
        lines.append(f"One thing is missing: {name}." if len(diagnosis.found) == 1 else
                     f"{_count(len(diagnosis.found))} things are missing: "
                     f"{listed(diagnosis.found)}. The most important one first.")  # fmt: skip
    lines += about(told, name)
    for other in diagnosis.found[1:]:
        if other not in mistakes(diagnosis):
            lines += also(told, other)
    lines += [*whole(told), *_law(told), *_at_bounds(diagnosis)]
    lines += _next_add(told, name, steps)
    return [*lines, *_not_shown(told)]


def _ambiguous(told: Told, steps: NextSteps) -> list[str]:
    diagnosis = told.diagnosis
    rivals = diagnosis.rivals
    first = effect_named(diagnosis, rivals[0])
    lines = _set_up(diagnosis)
    which = listed(rivals, "or")
    lines.append(
        f"These drives cannot tell which it is, {which}."
        if rivals[0] in mistakes(diagnosis)
        else f"Something is missing, but these drives cannot tell which: {which}."
    )
    twins = [name for name in rivals[1:] if first is not None and name in first.twins]
    if twins:
        lines.append(
            f"To the reference {listed([rivals[0], *twins])} are one and the same, on any drive."
        )
    for name in rivals:
        effect = effect_named(diagnosis, name)
        if effect is not None:
            size = sizes(diagnosis, name, believed=True)
            lines.append(f"- {name}: {effect.summary}{f' Fitted: {size}.' if size else ''}")
    lines += cost(told, rivals[0])
    move = told.manoeuvre
    if move is not None:
        lines.append(f"Why: {move.why}.")
        time = f" About {move.minutes:.0f} min of it are enough." if move.minutes else ""
        lines.append(f"Next: {move.do} ({move.name}).{time}")
        if move.minutes:
            lines.append(f"  Then give that drive to `{steps.diagnose}` together with these.")
    else:
        lines.append(
            "No manoeuvre of the library tells them apart in reasonable time; a ruler may."
        )
    lines.append("Or, if you know which it is, add it, for example:")
    lines.append(f"    {steps.add.format(effect=rivals[0])}")
    for name in rivals[:3]:
        lines += ruler(effect_named(diagnosis, name), f"Check {name}")
    for other in diagnosis.found[1:]:
        if other not in rivals and other not in mistakes(diagnosis):
            lines += also(told, other)
    return [*lines, *_law(told), *_at_bounds(diagnosis)]


def _unknown(told: Told, steps: NextSteps) -> list[str]:
    diagnosis = told.diagnosis
    lines = _set_up(diagnosis)
    cells = significant(diagnosis)
    lines.append("Something is missing that no effect of the library explains.")
    if cells:
        lines.append(
            f"What is known of it: {dependence_words(cells[0])} ({chance_words(cells[0].p_value)})."
        )
        others = [cell for cell in cells[1:] if cell.variable.name != cells[0].variable.name]
        if others:
            lines.append(
                f"- Less of it is explained by this: {dependence_words(others[0])}. What goes with "
                "the one may go with the other because of how it was driven."
            )
    best = diagnosis.ranking[0] if diagnosis.ranking else None
    if best is not None and best.holdout is not None and best.holdout.after < best.holdout.before:
        lines.append(
            f"Nearest in the library is {best.effect}: errors fall from "
            f"{error_words(best.holdout.before, best.holdout.unit)} to "
            f"{error_words(best.holdout.after, best.holdout.unit)} with it. The above "
            "explains far more than it does, so that is not what it is."
        )
    lines += _at_bounds(diagnosis)
    lines.append("Next: write it as an effect of your own, from what these drives show:")
    lines.append(f"    {steps.draft}")
    if told.manoeuvre is not None:
        move = told.manoeuvre
        lines.append(f"To know more first, {move.do} ({move.name}): {move.why}.")
    return lines


def _set_up(diagnosis: Diagnosis) -> list[str]:
    """Set-up mistakes first: nothing else counts while they are there."""
    findings = diagnosis.set_up.findings
    if not findings:
        return []
    lines = ["Something is set up wrongly:"]
    for finding in findings:
        lines.append(f"- {_sentence(finding.words)[:-1]}: {finding.effect}.")
    return lines


def _law(told: Told) -> list[str]:
    """What is left once everything found is put in."""
    left = [cell for cell in told.diagnosis.remaining if cell.p_value < VERY_SURE]
    if not left:
        return []
    return [
        f"But: the law does not fit fully. With everything found put in, "
        f"{dependence_words(left[0])} ({chance_words(left[0].p_value)})."
    ]


def _at_bounds(diagnosis: Diagnosis) -> list[str]:
    """Effects that would help at a value that physics does not allow."""
    said: dict[str, str] = {}
    for this in diagnosis.rounds:
        for fit in this.tried:
            name = fit.names[-1]
            helps = fit.total < this.before.total and chance(fit, this.before, this.number) < SURE
            wild = [knob for knob in fit.at_bound if knob.startswith(f"{name}.")]
            if helps and wild and name not in diagnosis.found:
                value = fit.point.model.robot.effects[-1].values[wild[0].rpartition(".")[2]]
                said.setdefault(name, f"{wild[0].rpartition('.')[2]} = {value:g}")
    return [
        f"But: {name} would lower the error too, only with {value}, beyond what physics allows: it "
        "is not that effect. Look how the reference is made; one that was integrated from the same "
        "counters errs so."
        for name, value in said.items()
    ]


def _next_add(told: Told, name: str, steps: NextSteps) -> list[str]:
    diagnosis = told.diagnosis
    if name == IN_DEGREES:
        return ["Next: convert the reference's yaw to radians, and diagnose again."]
    lines = ["Next: add it to the model, fitted with all calibration:"]
    lines.append(f"    {steps.add.format(effect=name)}")
    if len(diagnosis.found) > 1:
        lines.append("and diagnose again with the new robot file.")
    return lines


def _not_shown(told: Told) -> list[str]:
    """Effects that would have stayed hidden, and what would show them."""
    hidden = [sight for sight in told.sights if sight.hidden]
    if not hidden:
        return []
    by_drive = [
        f"{sight.effect} ({sight.shown_by} would show it)" for sight in hidden if sight.shown_by
    ]
    lines = []
    if by_drive:
        lines.append(
            f"These drives cannot show whether there is, of usual size, {listed(by_drive, 'or')}."
        )
    needing = [sight.effect for sight in hidden if sight.needs_more]
    if needing:
        lines.append(
            f"No drive shows {listed(needing)} with such a reference; one that measures positions "
            "and headings does (motion capture, a scan matcher)."
        )
    return lines


def _count(number: int) -> str:
    return {2: "Two", 3: "Three", 4: "Four", 5: "Five"}.get(number, str(number))


def _sentence(text: str) -> str:
    return f"{text[0].upper()}{text[1:].rstrip('.')}."
