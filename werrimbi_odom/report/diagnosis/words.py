# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis in words: what is missing, its significance, size, cost, and what to do."""

from __future__ import annotations

import math

from werrimbi_odom.inference.changes.between_drives import driven_in_order
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.estimated_values import (
    mistakes,
    one_wheel,
    reference_wanders,
)
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.report.changes import changes_words
from werrimbi_odom.report.diagnosis import costs, phrases, reference_remarks, remarks
from werrimbi_odom.report.diagnosis.ambiguous import ambiguous_words
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.unknown import mounted_anew, unknown_words
from werrimbi_odom.report.document import Paragraph, paragraphs
from werrimbi_odom.report.events import events_words
from werrimbi_odom.report.number_format import error_words, listed
from werrimbi_odom.report.phrases import either_side, jumps_words, left_out_words, remark_words


def words_of(advised: AdvisedDiagnosis, steps: NextSteps) -> tuple[Paragraph, ...]:
    """All sentences, and the commands of the next step."""
    diagnosis = advised.diagnosis
    tell = {"none": _none, "named": _named, "ambiguous": ambiguous_words, "unknown": unknown_words}
    said = [
        *_changes(advised, steps),
        *tell[diagnosis.verdict](advised, steps),
        *remarks.otherwise(diagnosis),
    ]
    suspect = either_side(diagnosis.ahead_or_behind) + reference_remarks.wandering(diagnosis)
    if not mounted_anew(advised):
        suspect += [f"But: {remark_words(remark)}" for remark in diagnosis.remarks]
    left_out = [*_shorter(advised), *suspect, *left_out_words(diagnosis.left_out)]
    left_out += jumps_words(diagnosis.left_out)
    left_out += events_words(diagnosis.happened, diagnosis.robot.track, diagnosis.left_by)
    left_out += remarks.without_events(advised) + reference_remarks.coarse_counters(diagnosis)
    left_out += reference_remarks.rare_counts(diagnosis) + reference_remarks.crab_not_asked(
        diagnosis
    )
    last = (index for index, text in enumerate(said) if text.startswith("Next: "))
    place = next(last, len(said))
    said[place:place] = left_out
    checks = [f"Check {name}" for name in diagnosis.rivals]
    return paragraphs(said, hanging=[*_HEADS, *checks])


def _shorter(advised: AdvisedDiagnosis) -> list[str]:
    """Why the legs are shorter than was asked for, or that they are too few."""
    if advised.open_at is None:
        few = not advised.diagnosis.runs.tells_noise
        return [
            "The legs are so few that their noise is assumed: they do not tell it, nor from which "
            "size on an effect would have been seen."
        ] * few
    if advised.too_few:
        return [
            f"Legs of {advised.open_at:g} m are so few here that they do not tell the noise; all "
            f"that is said here is of legs of {advised.leg:g} m."
        ]
    return [
        f"Legs of {advised.open_at:g} m leave it open: it is like another error over whole turns "
        f"of a wheel, or from a start to a stop. Legs of {advised.leg:g} m show what happens "
        "within these; all that is said here, and the command below, is of those."
    ]


def _changes(advised: AdvisedDiagnosis, steps: NextSteps) -> list[str]:
    """Changes between the drives, before what they have in common."""
    changes = changes_words(advised.changes, advised.diagnosis.robot)
    if not changes:
        return []
    unknown = advised.drives_differ
    floor = [] if unknown else reference_remarks.floor_not_asked(advised.diagnosis)
    what, one = "The robot", "one robot, the mean of both"
    command: list[str] = []
    if all(change.group == "reference_delay" for change in advised.changes):
        what, one = "The reference's clock", "one clock, the mean of all"
        now = (
            "Shift the reference of each drive by its own delay, record both with one clock, or "
            "add reference_clock_drift, which has a delay of its own in each drive."
        )
    else:
        now, command = _as_it_is_now(advised, steps)
    follows = (
        "That alone may be why no effect explains them all, so what else is missing is not asked."
        if unknown
        else f"What follows takes them for {one}."
    )
    return [
        f"{what} was not the same in all of these drives.",
        *(f"- {words}" for words in changes),
        *(f"Or the floor is why. {words}" for words in floor),
        f"{follows} {now}",
        *command,
        "",
    ]


def _as_it_is_now(advised: AdvisedDiagnosis, steps: NextSteps) -> tuple[str, list[str]]:
    """Which of the drives tell what the robot is now, and the command that asks these."""
    runs = advised.diagnosis.runs.runs
    order = driven_in_order([float(run.counters.time[0]) for run in runs])
    drives = [runs[number].name for number in order.tolist()]
    odd = {change.from_run for change in advised.changes if change.kind == "alone"}
    lasting = [change for change in advised.changes if change.kind != "alone"]
    first = max((drives.index(change.surely_from) for change in lasting), default=0)
    kept = [name for name in drives[first:] if name not in odd]
    which = [f"with the drives from {drives[first]} on alone"] if lasting else []
    if others := [name for name in drives[first:] if name in odd]:
        which.append(f"without {listed(others)}")
    now = f"For what it is now, ask again {', '.join(which)}"
    command = steps.again(kept) if kept else ""
    return (f"{now}:", [f"    {command}"]) if command else (f"{now}.", [])


_HEADS = ["On the robot", "What it is", "How large", "How sure", "What it costs", "Check it"]
_HEADS += ["Next", "But", "Why"]


def _none(advised: AdvisedDiagnosis, steps: NextSteps) -> list[str]:
    diagnosis = advised.diagnosis
    wanders = reference_wanders(diagnosis)
    large = [*remarks.drowned(advised), *remarks.alike(diagnosis)]
    old = remarks.outdated_told(advised)
    noise = not (diagnosis.misfit or wanders or large or old or diagnosis.happened.systematic)
    ending = ": the model explains them to their noise." if noise else "."
    if old:
        ending = ", but values of effects in the robot file are off."
    lines = [
        f"Nothing is missing that these drives could show{ending}",
        *old,
        *remarks.rest(advised),
    ]
    if math.isfinite(diagnosis.holdout.before) and not old:
        errors = error_words(diagnosis.holdout.before, diagnosis.holdout.unit)
        like = remarks.like_noise(diagnosis, noise=noise)
        lines.append(f"Its errors on {costs.judged(advised)} are {errors}{like}")
        lines += large
    lines += remarks.instead_of_held(diagnosis)
    if wanders:
        lines.append(remarks.wanders_words(diagnosis.robot))
    if diagnosis.runs.tells_noise and not all(sight.hidden for sight in advised.sights):
        lines.append(
            "How well that is known: the table says from which size on each effect would have been "
            "seen."
        )
    lines += reference_remarks.not_shown(advised)
    if old:
        return [
            *lines,
            "Next: fit them anew, together with all calibration:",
            f"    {steps.add(diagnosis.outdated)}",
        ]
    if advised.held_out and remarks.unlike_the_fitted(diagnosis):
        return [
            *lines,
            "Next: fit some of the drives held out too, and hold out others: something happens on "
            "them that the fitted ones hardly show.",
        ]
    if wanders and (by_map := reference_remarks.as_one_that_wanders(diagnosis, steps.on_map)):
        return [*lines, *by_map]
    lines.append(
        "Next: there is nothing to add. On drives held out, `werrimbi compare` says whether the "
        "covariance is honest; where it is not, `werrimbi calibrate fit` fits the wheels' noise."
    )
    return lines


def _named(advised: AdvisedDiagnosis, steps: NextSteps) -> list[str]:
    diagnosis = advised.diagnosis
    name = diagnosis.effect or ""
    lines = phrases.set_up_lines(diagnosis)
    things = _things(diagnosis)
    if not lines:
        lines.append(f"One thing is missing: {things[0]}." if len(things) == 1 else
                     f"{_count(len(things))} things are missing: "
                     f"{listed(things)}. The most important one first.")  # fmt: skip
    lines += phrases.about(advised, name)
    for other in diagnosis.found[1:]:
        if other not in mistakes(diagnosis):
            lines += phrases.also(advised, other)
    if sizes := costs.sizes_found(diagnosis):
        lines.append(f"On the robot: {sizes}.")
    it = "it" if len(diagnosis.found) == 1 else "all of it"
    return [
        *lines,
        *costs.whole(advised),
        *remarks.remainder(advised),
        *reference_remarks.or_the_reference_s_scale(diagnosis),
        *reference_remarks.or_its_axes(diagnosis),
        *_add(diagnosis, it, steps),
        *reference_remarks.moved_by_its_odometry(diagnosis),
        *reference_remarks.transform_to_mend(diagnosis),
        *reference_remarks.not_shown(advised),
    ]


def _add(diagnosis: Diagnosis, it: str, steps: NextSteps) -> list[str]:
    """The command that adds everything; on a condition where the reference's metre may be why."""
    metre = bool(reference_remarks.or_its_metre(diagnosis))
    begin = "measure that first. If it is the wheels, add" if metre else "add"
    return [
        f"Next: {begin} {it} to the model, fitted together with all calibration:",
        f"    {steps.add(diagnosis.found)}",
    ]


def _things(diagnosis: Diagnosis) -> list[str]:
    """Names of what was found; effects of one wrong wheel are combined."""
    side = one_wheel(diagnosis)
    if side is None:
        return list(diagnosis.found)
    of_a_wheel = ("unequal_wheel_radii", "wheel_radius_scale")
    radii = [name for name in diagnosis.found if name in of_a_wheel]
    told = {radii[0]: f"the size of the {side} wheel ({' with '.join(radii)})", radii[1]: ""}
    return [words for name in diagnosis.found if (words := told.get(name, name))]


def _count(number: int) -> str:
    names = ("Two", "Three", "Four", "Five", "Six", "Seven", "Eight")
    return dict(enumerate(names, 2)).get(number, str(number))
