# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison in words: is the model good, where does it fail, what to do next."""

from __future__ import annotations

import math

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import skids_in_turns
from werrimbi_odom.inference.comparison.compare import KINDS, Comparison, LegFigures
from werrimbi_odom.inference.comparison.consistency import judged_lengths
from werrimbi_odom.inference.comparison.verdict import Depends, Verdict, verdict_of
from werrimbi_odom.inference.recording_info import leg_of_positions
from werrimbi_odom.inference.seldom_measured import more_to_judge, tell_sizes
from werrimbi_odom.report.comparison.phrases import (
    NAMES,
    covariance_words,
    length_of,
    reference_words,
    systematic_told,
)
from werrimbi_odom.report.document import Paragraph, paragraphs
from werrimbi_odom.report.number_format import (
    capital,
    counted,
    length,
    listed,
    more_like_these,
    two_digits,
)
from werrimbi_odom.report.phrases import leg_words, rarer_than_asked

_CHANNELS = {
    "along": "the error along the way",
    "sideways": "the sideways error",
    "heading": "the heading error",
    "size": "the size of the errors",
}


def words_of(
    comparison: Comparison,
    *,
    next_step: str = "`werrimbi diagnose`",
    verdict: Verdict | None = None,
    command: str = "",
    fit: str = "",
) -> tuple[Paragraph, ...]:
    """Summary of a comparison.

    `next_step` is the command that searches for a missing effect, "" to omit it, `command` the full
    command of the next step, and `fit` that of a calibration by drives too seldom measured for it.
    """
    verdict = verdict or verdict_of(comparison)
    said = [headline(comparison, verdict)]
    if verdict.enough:
        said += _by_motion(comparison, verdict)
        if not verdict.gross:
            said += _elsewhere(comparison, verdict)
            said += _own_scale(comparison, verdict)
            said += covariance_words(verdict, comparison.main.all.figures.nees)
    said += reference_words(comparison)
    step = _next(verdict, next_step)
    if fit and _is_seldom(comparison, verdict) and tell_sizes(comparison.prepared.runs):
        step, command = "Base and radii alone are told by these drives together:", fit
    return paragraphs([*said, step, command if step and not verdict.good else ""])


def _is_seldom(comparison: Comparison, verdict: Verdict) -> bool:
    """Whether legs are few because no leg is shorter than from pose to pose."""
    rare = rarer_than_asked(comparison.median_length, comparison.main.leg)
    return rare and not verdict.enough and not verdict.too_short


def headline(comparison: Comparison, verdict: Verdict) -> str:
    """One sentence on whether the model is good."""
    count = comparison.main.all.figures.count
    if verdict.too_short:
        longer = leg_of_positions(verdict.too_short)
        return (
            f"Legs of {comparison.main.leg:g} m are too short for this reference: its positions "
            f"err by {two_digits(1e3 * verdict.too_short)} mm each, and that is what is seen. Try "
            f"--leg {longer:g}."
        )
    if not verdict.enough:
        median, asked = comparison.median_length, comparison.main.leg
        more = "Drive more, or try a shorter --leg"
        if _is_seldom(comparison, verdict):
            these = more_like_these(more_to_judge(comparison.prepared.runs))
            more = f"Drive more{these}, or measure the robot more often on its way"
        return (
            f"Too little to judge: {counted(count, 'leg')} of {leg_words(median, asked)} m, "
            f"{rules.FEWEST_LEGS} are the least. {more}."
        )
    if verdict.good:
        shortest, longest = length_of(comparison.lengths[0]), length_of(comparison.lengths[-1])
        over = f"over legs of {shortest} to {longest}"
        if shortest == longest:
            over = f"over legs of {longest}"
        return (
            f"The model explains these drives: {over} its errors are what its covariance "
            "promises, and nothing systematic is left in them."
        )
    if verdict.gross and skids_in_turns(comparison.model.robot):
        return (
            "The model is grossly wrong: that is not calibration. This robot's driven wheels skid "
            "in turns, and how much is to be found first; or something is set up wrongly."
        )
    if verdict.gross and verdict.runs:
        names = listed([comparison.runs[index].run.name for index in verdict.runs])
        one = len(verdict.runs) == 1
        return (
            f"The model is grossly wrong in {'drive' if one else 'drives'} {names} alone: look for "
            f"what was otherwise {'on it' if one else 'on them'} (a plug, a wheel, the reference's "
            f"mounting), or for what {'it' if one else 'they'} alone drove."
        )
    if verdict.gross:
        return (
            "The model is grossly wrong: that is not calibration, but something set up wrongly "
            "(a number of the robot file, a wheel, or the reference's mounting)."
        )
    if verdict.mean_is_right and not verdict.off_at_all and verdict.covariance == "too large":
        return "The model is right, and better than its covariance says."
    if verdict.mean_is_right and verdict.noise == "too small":
        return "Nothing systematic is seen, but the errors are larger than the model promises."
    if verdict.mean_is_right and verdict.covariance == "honest" and verdict.off_at_all:
        where = listed([NAMES[kind] for kind in KINDS if kind in verdict.off_at_all])
        return f"The model's errors are larger than it promises in {where}."
    if verdict.mean_is_right:
        return "The model's errors are larger than it promises."
    failing = [kind for kind in KINDS if any(part.kind == kind for part in verdict.systematic)]
    if failing:
        return f"The model goes wrong in {listed([NAMES[kind] for kind in failing])}."
    return "The model goes wrong, in a way that travel and turn alone do not show."


def _by_motion(comparison: Comparison, verdict: Verdict) -> list[str]:
    """A line for each driven type of motion."""
    lines = []
    common = (
        "" if verdict.depends or verdict.cells or verdict.gross else ", without a common direction"
    )
    for kind in KINDS:
        figures = comparison.main.by_motion[kind]
        if figures.figures.count < rules.FEWEST_LEGS:
            if kind in verdict.few_and_bad:
                number = counted(figures.figures.count, "leg")
                times = math.sqrt(figures.figures.nees)
                lines.append(
                    f"- {NAMES[kind].capitalize()} ({number} only): errors of a leg "
                    f"{_errors(figures)}, {times:.1f} times what is promised."
                )
            continue
        parts = [part for part in verdict.systematic if part.kind == kind]
        said = [systematic_told(part) for part in parts]
        name = NAMES[kind].capitalize()
        errors = _errors(figures)
        if said:
            lines.append(f"- {name}: {listed(said)}. Errors of a leg: {errors}.")
        elif kind in verdict.off:
            times = math.sqrt(figures.dispersion_nees)
            lines.append(
                f"- {name}: errors of a leg {errors}, {times:.1f} times what is promised{common}."
            )
        else:
            told = _against_promise(comparison, kind, elsewhere=not verdict.good)
            lines.append(f"- {name}: errors of a leg {errors}, {told}.")
    return lines


def _against_promise(comparison: Comparison, kind: str, *, elsewhere: bool) -> str:
    """Errors of a type of motion relative to the covariance, and at the length that errs most."""
    asked = comparison.main.consistency_of(kind)
    told = {
        "too small": f"{math.sqrt(asked.nees):.1f} times what is promised",
        "too large": "less than what is promised",
    }.get(asked.says, "as promised")
    others = [
        each
        for each in judged_lengths([item.consistency_of(kind) for item in comparison.lengths])
        if elsewhere and each.says == "too small"
    ]
    worst = max(others, key=lambda each: each.nees, default=asked)
    if worst.leg == asked.leg:
        return told
    times = f"{math.sqrt(worst.nees):.1f} times"
    whose = times if asked.says == "too small" else f"{times} what is promised"
    return f"{told}, but over legs of {length_of(worst)} {whose}"


def _errors(figures: LegFigures) -> str:
    parts = []
    if math.isfinite(figures.figures.rmse_position_m):
        parts.append(length(figures.figures.rmse_position_m))
    if math.isfinite(figures.figures.rmse_yaw_rad):
        parts.append(f"{math.degrees(figures.figures.rmse_yaw_rad):.2f}°")
    return " and ".join(parts)


def _own_scale(comparison: Comparison, verdict: Verdict) -> list[str]:
    """That a share of the turns may be the reference's own, where it measures headings alone."""
    shares = [
        part.value for part in verdict.systematic if (part.channel, part.per) == ("heading", "turn")
    ]
    if set(comparison.prepared.measures) != {"heading"} or not shares:
        return []
    return [
        f"- Or the robot is right, and {twin.name} is what is off: {twin.told_apart_by}. So "
        f"{twin.do}."
        for twin in find("track_width").indistinguishable_from
        if find(twin.name).stage == "reference"
        and find(twin.name).allows(dict.fromkeys(twin.values, 1.0 + shares[0]))
    ]


def _elsewhere(comparison: Comparison, verdict: Verdict) -> list[str]:
    lines = []
    count = comparison.main.all.figures.count // rules.WORST_OF
    if verdict.few > rules.FEW_HOLD and count > 1 and not verdict.good:
        lines.append(
            f"- A few legs are far worse than all others: the worst {count} hold "
            f"{100.0 * verdict.few:.0f} % of the squared errors. Look what happened there."
        )
    said: set[str] = set()
    for item in verdict.depends:
        if item.variable in said or len(said) == 2:
            continue
        said.add(item.variable)
        others = [
            other.channel
            for other in verdict.depends
            if other.variable == item.variable and other.channel != item.channel
        ]
        lines.append(f"- {_dependence(item, others)}")
    if not verdict.good:
        lines += [_run_told(comparison, index) for index in verdict.runs[:2]]
    for cell in verdict.cells[:2]:
        lines.append(
            f"- Errors are larger on the floor about x {cell.x:.1f} m, y {cell.y:.1f} m (a square "
            f"of {cell.side:.1f} m): {length(cell.figures.rmse_position_m)} over "
            f"{counted(cell.figures.count, 'leg')}."
        )
    return lines


def _dependence(item: Depends, others: list[str]) -> str:
    variable = item.variable.split(" [")[0]
    channels = listed([_CHANNELS[channel] for channel in (item.channel, *others)])
    verb = "go" if others else "goes"
    return f"{capital(channels)} {verb} with the {variable} ({_chance(item.p_value)})."


def _chance(p_value: float) -> str:
    if p_value < 1e-12:
        return "beyond any chance"
    return f"chance of it without a cause: {p_value:.0e}"


def _run_told(comparison: Comparison, index: int) -> str:
    item = comparison.runs[index]
    figures = item.legs.figures
    return (
        f"- Drive {item.run.name} stands out by the size of its errors: NEES {figures.nees:.3g} "
        f"over its {counted(figures.count, 'leg')}."
    )


def _next(verdict: Verdict, next_step: str) -> str:
    if not next_step or not verdict.enough:
        return ""
    if verdict.good:
        return f"Smaller effects may hide in such errors: {next_step} looks for each by itself."
    if verdict.gross:
        return f"Next: {next_step} looks for the mistake."
    if verdict.mean_is_right and verdict.noise in ("too small", "too large"):
        return (
            f"Next: {next_step} says whether an effect is missing; if none is, `werrimbi "
            "calibrate fit` fits the wheels' noise."
        )
    if verdict.mean_is_right:
        return (
            f"Next: {next_step} says whether an effect is missing; if it finds none, look at what "
            "happened on the legs that err most."
        )
    return f"Next: {next_step} says which physical effect explains it."
