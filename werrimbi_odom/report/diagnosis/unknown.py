# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict *unknown* in words: no effect of the library, or no reference of this drive."""

from __future__ import annotations

from werrimbi_odom.inference.diagnosis.one_sided_noise import OneSidedNoise
from werrimbi_odom.inference.drafting.draft import as_a_floor, worth_drafting
from werrimbi_odom.inference.events.events import Channel, Events
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis, significant
from werrimbi_odom.report.diagnosis import costs, phrases, reference_remarks, remarks
from werrimbi_odom.report.diagnosis.dependence import dependence_words
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.events import most_of
from werrimbi_odom.report.number_format import (
    chance_words,
    error_words,
    scaled_with_std,
    two_digits,
)


def unknown_words(advised: AdvisedDiagnosis, steps: NextSteps) -> list[str]:
    """What nothing explains: what is known of it, and what to do next."""
    diagnosis = advised.diagnosis
    if diagnosis.of_another_drive and mounted_anew(advised):
        return [
            "No mount of the reference fits all of these drives, so together they tell nothing: "
            "where an axis of its own begins anew with each recording (an IMU's heading beside "
            "the positions of another sensor), diagnose each drive by itself.",
            "Next: ask again with fewer drives, as above.",
        ]
    if diagnosis.of_another_drive:
        if any(remark.what == "no_turn" for remark in diagnosis.remarks):
            return [
                "Nothing can be told of the robot from these drives.",
                "Next: turn the robot by hand once about, from a line on the floor back onto it: "
                "the reference's heading must turn by 360° with it.",
            ]
        if any(remark.what == "scale" for remark in diagnosis.remarks):
            return [
                "Nothing more can be told of the robot from these drives.",
                "Next: mend that in the robot file, and diagnose again.",
            ]
        unrelated = any(remark.what == "another_drive" for remark in diagnosis.remarks)
        mend = " Give the reference of the same drive." if unrelated else ""
        return [
            "Nothing can be told of the robot from these drives.",
            "Next: `werrimbi info` of a recording says what is in it, and `werrimbi compare` with "
            f"--report draws both paths.{mend}",
        ]
    lines = phrases.set_up_lines(diagnosis)
    if advised.drives_differ:
        return lines
    cells = significant(diagnosis)
    lines += costs.by_sizes_alone(advised)
    lines.append("Something is missing that no effect of the library explains.")
    if diagnosis.one_sided is not None:
        return [*lines, *_of_wheels(diagnosis.one_sided)]
    if diagnosis.by_events:
        return [*lines, *_of_events(diagnosis.happened), *_to_know_more(advised)]
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
        lines += reference_remarks.or_a_compass(diagnosis, cells[0].variable.name)
    lines += reference_remarks.floor_not_asked(diagnosis)
    lines += remarks.nearest(diagnosis, bool(cells))
    lines += remarks.at_bounds_told(diagnosis)
    lines += remarks.left_is_noise(advised)
    if as_a_floor(diagnosis):
        return [
            *lines,
            "No law of that heading holds in another drive, so none is drafted. Next: record a "
            "drive with motion capture or a localiser's map.",
        ]
    if worth_drafting(diagnosis):
        lines.append("Next: write it as an effect of your own, from what these drives show:")
        lines.append(f"    {steps.draft}")
    elif cells:
        lines.append(
            "No law can be written of it. Next: see where both paths part, by `werrimbi compare` "
            "with --report."
        )
    else:
        lines.append(
            "It goes with nothing that was looked at, so there is no law to write. Next: see where "
            "both paths part, by `werrimbi compare` with --report. A clock that is off by a large "
            "part of a second, a reference that loses its place, or one of another drive look so."
        )
    return [*lines, *_to_know_more(advised)]


def _to_know_more(advised: AdvisedDiagnosis) -> list[str]:
    move = advised.manoeuvre
    return [] if move is None else [f"To know more first, {move.do} ({move.name}): {move.why}."]


def mounted_anew(advised: AdvisedDiagnosis) -> bool:
    """Whether places differ, and turns do not, because the reference was mounted otherwise."""
    places = any(remark.what == "places" for remark in advised.diagnosis.remarks)
    return places and any(change.group == "mount" for change in advised.changes)


def _of_events(happened: Events) -> list[str]:
    """What is known of errors that come at once, again and again with the same thing."""
    common = happened.alike
    assert common is not None
    channel = most_of(happened.events)
    own = [event for event in happened.events if event.channel == channel]
    sides = [side for side in (1.0, -1.0) if any(side * event.size > 0.0 for event in own)]
    does, forth, back = _DOES[channel]
    where = "to either side" if len(sides) == 2 else forth if sides == [1.0] else back
    where = "to and fro" if len(sides) == 2 and channel == "along" else where
    least, most = (
        error_words(pick(abs(event.size) for event in own), own[0].unit) for pick in (min, max)
    )
    size = least if least == most else f"{least} to {most}"
    when = "a reversal" if common.what == "reversal" else "a start or a stop"
    return [
        f"What is known of it: it comes at once, {common.count} times of {common.of} with {when}, "
        f"and {does} by {size} {where}.",
        "Next: look at what gives way then: castor, gears, couplings, tyres; and at the times of "
        "counters and reference. `werrimbi draft` writes laws of what goes on for a while, and "
        "none of what comes at once. Where both paths part, `werrimbi compare` with --report "
        "shows.",
    ]


_DOES: dict[Channel, tuple[str, str, str]] = {
    "along": ("throws the robot", "ahead", "back"),
    "sideways": ("pushes the robot", "to the left", "to the right"),
    "heading": ("turns the robot", "to the left", "to the right"),
    "reference": ("moves what the reference sees", "on", "on"),
}
"""What an event of a channel does, and where to, by the sign of its size."""


def _of_wheels(noise: OneSidedNoise) -> list[str]:
    """What is known of errors of wheels that follow no law on which the drives agree."""
    if noise.along is None:
        why = ", more than noise is. A reference that errs makes both wheels err alike"
    else:
        why = (
            f": along the path they add up, to {two_digits(noise.along)} times the variance of "
            "independent ones, and to the side they do not. A reference errs to all sides"
        )
    if noise.side == "both":
        whose = "both wheels err, and for seconds together their"
        look = "the wheels, their tyres and load"
    else:
        other = "right" if noise.side == "left" else "left"
        sizes = (
            f"{short} = {scaled_with_std(item.value, item.std, 'm^0.5')}"
            for short, item in (("k_L", noise.left), ("k_R", noise.right))
        )
        whose = (
            f"the {noise.side} wheel errs {two_digits(noise.times)} times as much as the {other} "
            f"one ({', '.join(sizes)}), and for seconds together its"
        )
        look = f"the {noise.side} wheel, its tyre, axle, motor and encoder"
    return [
        f"What is known of it: {whose} errors are alike{why}, so it is the robot's.",
        "The parts of the drives do not agree on what these errors go with, so no law can be "
        f"written of them. Next: look at {look}, and at what the robot drove over; where both "
        "paths part, `werrimbi compare` with --report shows.",
    ]
