# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of adding effects in words and tables: parameters, errors, and what remains."""

from __future__ import annotations

import math

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.report.comparison.words import headline
from werrimbi_odom.report.diagnosis.dependence import amount_words, variable_words
from werrimbi_odom.report.diagnosis.remarks import little_words
from werrimbi_odom.report.document import Definition, Part, Table, paragraphs
from werrimbi_odom.report.events import events_words
from werrimbi_odom.report.number_format import (
    each_its_own,
    in_unit,
    listed,
    quantity,
    scaled_with_std,
)
from werrimbi_odom.report.phrases import (
    either_side,
    jumps_words,
    left_out_words,
    leg_words,
    sizes_words,
)


def words_of(added: Added) -> list[Part]:
    """Headline, parameters, errors and remarks."""
    return [
        *paragraphs([_headline(added)]),
        *_parameters(added),
        *paragraphs([_sizes(added), *_moved(added)], apart=True),
        _errors(added),
        *paragraphs(_remarks(added)),
    ]


def judged_on(added: Added) -> str:
    """What judges: held-out drives, or the part that was held out where no drives were."""
    return "the held-out part" if added.set_aside else "the held-out drives"


def _headline(added: Added) -> str:
    sides = added.holdout.sides
    leg = leg_words(sides.length, added.holdout.after.leg)
    share = 100.0 * (1.0 - sides.after / sides.before) if sides.before > 0.0 else math.nan
    way = "lower" if share > 0 else "higher" if sides.rose else "higher, not told from chance"
    change = f"{abs(share):.{0 if abs(share) >= 10 else 1}f} % {way}"
    names = listed([effect.name for effect in added.effects])
    if math.isfinite(sides.before) and math.isfinite(sides.after):
        text = (
            f"With {names} the error of {judged_on(added)} is {_told(sides.after, sides.unit)} "
            f"where it was {_told(sides.before, sides.unit)} ({change}; rms over legs of "
            f"{leg} m)."
        )
    else:
        text = f"What {names} does to the error of {judged_on(added)} is not known."
    if added.also:
        text += f" Put right with it, as one set-up: {', '.join(added.also)}."
    if added.objection is not None:
        text += f" Forced, against this objection: {added.objection}."
    return text


def _parameters(added: Added) -> list[Definition]:
    return [
        Definition(
            f"{name} = {value_told(item)}", item.declared.says + remark_told(item), number == 0
        )
        for number, (name, item) in enumerate(added.parameters.items())
    ]


def _sizes(added: Added) -> str:
    """Changed wheel base and radii as lengths on the robot, or that none changed."""
    stds = added.multiplier_stds
    found = {name: (getattr(added.robot, name), stds[name]) for name in MULTIPLIERS}
    words = sizes_words(added.given, found, added.ratio_std)
    if not words:
        return "Base and radii stay as the robot file has them."
    return f"On the robot: {words}. It is written as the robot file's multipliers."


def _moved(added: Added) -> list[str]:
    """What else the file holds another value of now."""
    told = []
    for name, before, now in added.moved:
        ends = [
            in_unit(value, now.std or math.nan, now.declared.unit)
            for value in (before, now.value or 0.0)
        ]
        (old, its), (new, unit) = ends
        told.append(
            f"{name} from {old.partition(' ±')[0]} {its}".rstrip() + f" to {new} {unit}".rstrip()
        )
    return [f"Fitted anew with it, of what the file held: {listed(told)}."] if told else []


def value_told(item: FittedParameter) -> str:
    """A value with its standard deviation and unit, rounded to significant digits."""
    if item.remark == "undetermined" and not item.written:
        usual = quantity(item.declared.null, math.nan, item.declared.unit)
        return f"not determined by these drives, left at {usual}"
    if item.value is None:
        own = () if item.declared.unit == "rad" else item.of_runs
        return each_its_own(own, item.declared.unit)
    std = math.nan if item.std is None else item.std
    return quantity(item.value, std, item.declared.unit, item.or_else)


def remark_told(item: FittedParameter) -> str:
    """Remark that follows a value."""
    if item.remark == "null":
        return "; these drives show none of it, so it stays at null"
    if item.remark == "undetermined" and item.written:
        return "; THESE DRIVES DO NOT DETERMINE IT"
    if item.remark == "bound":
        return "; AT THE LIMIT OF WHAT IS PHYSICALLY POSSIBLE"
    if item.remark == "per run" and item.declared.tries:
        return (
            "; not written: compare, diagnose and add find it anew in each drive, by its "
            "reference; the node does not, and leaves the effect out"
        )
    if item.remark == "per run" and item.declared.unit != "rad":
        return "; not written: compare, diagnose and add find it anew in each drive"
    if item.remark == "per run":
        return "; not written: the node learns it anew in each drive"
    return ""


def _errors(added: Added) -> Table:
    fitted = "fitted part" if added.set_aside else "fitted drives"
    sides = ((judged_on(added).removeprefix("the "), added.holdout), (fitted, added.train))
    columns = {"before": "before", "calibrated": "calibrated", "after": "with it"}
    unit = added.holdout.unit
    what = "Position" if unit == "m" else "Heading"
    leg = leg_words(added.holdout.sides.length, added.holdout.after.leg)
    title = f"{what} error, rms over legs of {leg} m"
    if added.is_calibration:
        del columns["calibrated"]
    else:
        what = "the effect" if len(added.effects) == 1 else "the effects"
        title += f" (calibrated: all fitted but {what})"
    floors = ["noise alone"] if added.explained else []
    rows = [
        [
            name,
            *(_number(side.error(which), unit) for which in columns),
            *(_number(added.noise_alone(side), unit) for _ in floors),
        ]
        for name, side in sides
    ]
    rows[1:1] = [  # below the held-out drives, to which they belong
        [
            f"  without {name}",
            *("" for _ in range(len(columns) - 1)),
            _number(error, unit),
            *("" for _ in floors),
        ]
        for name, error in added.without.items()
    ]
    head = "[mm]" if unit == "m" else "[°]"
    return Table(title, [head, *columns.values(), *floors], rows)


def _remarks(added: Added) -> list[str]:
    texts = [*_more_than_errors(added), *either_side(added.ahead_or_behind)]
    texts += [_rest(added), _noise(added)]
    if added.set_aside:
        judged = listed(list(dict.fromkeys(added.set_aside)))
        texts.append(
            f"Judged on parts put aside of {judged}; the values that are written were then fitted "
            "on all of it."
        )
    else:
        texts.append("The written values are fitted on RUN alone; --holdout only judged them.")
    texts += [*left_out_words(added.left_out), *jumps_words(added.left_out)]
    return [*texts, *events_words(added.happened, added.robot.track)]


def _rest(added: Added) -> str:
    verdict = added.verdict
    nees = added.compared.main.all.figures.nees
    misfit = added.misfit
    if misfit is None:
        if verdict.good:
            return (
                f"What remains is noise: nothing more is seen in the errors, and they are as large "
                f"as the covariance says (NEES {nees:.2f}, honest is 1)."
            )
        which = "these" if added.set_aside else "the held-out"
        return (
            "Nothing more is seen in the errors of the fitted drives. But `werrimbi compare` of "
            f"the new file says of {which} drives: {headline(added.compared, verdict)}"
        )
    first = misfit.cell
    if misfit.only_in is not None:
        return (
            f"Drive {misfit.only_in} alone shows something more: in it {amount_words(first)} goes "
            f"with {variable_words(first)} (p = {first.p_value:.0e}); the others could show it "
            "and do not."
        )
    if misfit.effect is not None:
        share = 100.0 * (misfit.share or 0.0)
        return (
            f"The law of {misfit.effect} does not fit fully: what is left in {amount_words(first)} "
            f"goes with {variable_words(first)}, {share:.2g} % of what the law explains "
            f"(NEES {nees:.2f}, honest is 1)."
        )
    what = "Something is still missing" if misfit.share is None else "Something is left"
    return (
        f"{what}: {amount_words(first)} goes with {variable_words(first)} "
        f"(p = {first.p_value:.0e}; NEES {nees:.2f}, honest is 1).{little_words(misfit)}"
    )


def _more_than_errors(added: Added) -> list[str]:
    """Why noise alone would leave a larger error than there is."""
    whose = {"held-out": added.holdout, "fitted": added.train}
    unit = added.holdout.unit
    more = {
        name: side
        for name, side in whose.items()
        if added.noise_alone(side) > side.error("after")
        and _number(added.noise_alone(side), unit) != _number(side.error("after"), unit)
    }
    if not more:
        return []
    what = f"Noise alone is what the covariance promises, and the {listed([*more])} drives err less"
    if added.covariance == "too large":
        return [f"{what}, for it is too large."]
    few, legs = next(iter(more.values())).of_few_legs
    return [
        f"{what}: by chance ({few} of the {legs} legs hold half of the squared error that it "
        "promises), or because the noise is stated too large."
    ]


def _noise(added: Added) -> str:
    if not added.explained:
        return (
            "The wheels' noise in the file is left alone, and how large an error noise alone would "
            "leave is not known, until the model explains the drives."
        )
    wheels = []
    for name, short in (("left_wheel_noise", "k_L"), ("right_wheel_noise", "k_R")):
        item = added.noises[name]
        wheels.append(
            f"{short} = {scaled_with_std(item.value, item.std, 'm^0.5')}"
            if item.determined
            else f"{short} not determined, left alone"
        )
    return f"The noise of the wheels was fitted too: {', '.join(wheels)}."


def _told(error: float, unit: str) -> str:
    """A leg error with its unit: of positions [m], or of headings [rad]."""
    return f"{_number(error, unit)} mm" if unit == "m" else f"{_number(error, unit)}°"


def _number(error: float, unit: str) -> str:
    if not math.isfinite(error):
        return "-"
    value = 1e3 * error if unit == "m" else math.degrees(error)
    return f"{value:.2f}" if value < 100.0 else f"{value:.0f}"
