# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison in plain words: is the model good, where does it fail, what to do next."""

from __future__ import annotations

import math
from collections.abc import Sequence

from werrimbi_odom.inference.calibration_sizes import skidding
from werrimbi_odom.inference.comparison.compare import KINDS, Comparison, LegFigures
from werrimbi_odom.inference.comparison.consistency import AtLength, trend_of
from werrimbi_odom.inference.comparison.verdict import Depends, Verdict, verdict_of
from werrimbi_odom.inference.rules import FEWEST_LEGS
from werrimbi_odom.report.comparison.phrases import systematic_told
from werrimbi_odom.report.left_out import left_out_words
from werrimbi_odom.report.printed import filled

NAMES = {"line": "straight driving", "arc": "curves", "spin": "spins"}
_FEW = 0.6  # of the squared errors, held by a twentieth of the legs
_AGREES = {"line": "is", "arc": "are", "spin": "are"}
_CHANNELS = {
    "along": "the error along the way",
    "sideways": "the sideways error",
    "heading": "the heading error",
    "size": "the size of the errors",
}


def words_of(
    comparison: Comparison,
    *,
    next_step: str = "werrimbi diagnose",
    verdict: Verdict | None = None,
) -> str:
    """A few sentences, filled to 80 columns.

    Parameters
    ----------
    next_step : str
        Command that looks for what is missing.
    verdict : Verdict, optional
        If it is known already.
    """
    verdict = verdict or verdict_of(comparison)
    paragraphs = [_headline(comparison, verdict)]
    if verdict.enough:
        paragraphs += _by_motion(comparison, verdict)
        if not verdict.gross:
            paragraphs += _elsewhere(comparison, verdict)
            paragraphs += covariance_words(verdict, comparison.main.all.figures.nees)
    paragraphs += _reference(comparison)
    paragraphs.append(_next(verdict, next_step))
    return "\n".join(filled(text) for text in paragraphs if text)


def _headline(comparison: Comparison, verdict: Verdict) -> str:
    count = comparison.main.all.figures.count
    if not verdict.enough:
        return (
            f"Too little to judge: {_counted(count, 'leg')} of "
            f"{_metres(comparison.prepared.leg)}, {FEWEST_LEGS} are the least. "
            "Drive more, or try a shorter --leg."
        )
    if verdict.good:
        shortest, longest = comparison.lengths[0].leg, comparison.lengths[-1].leg
        over = f"over legs of {_metres(shortest)} to {_metres(longest)}"
        if shortest == longest:
            over = f"over legs of {_metres(longest)}"
        return (
            f"The model explains these drives: {over} its errors are what its covariance "
            "promises, and nothing systematic is left in them."
        )
    if verdict.gross and skidding(comparison.model.robot):
        return (
            "The model is grossly wrong: that is not calibration. This robot's driven wheels skid "
            "in turns, and how much is to be found first; or something is set up wrongly."
        )
    if verdict.gross:
        return (
            "The model is grossly wrong: that is not calibration, but something set up wrongly "
            "(a number of the robot file, a wheel, or the reference's mounting)."
        )
    if verdict.mean_is_right and not verdict.off_at_all and verdict.covariance == "too large":
        return "The model is right, and better than its covariance says."
    if verdict.mean_is_right and verdict.noise == "too small":
        return "On average the model is right, but its errors are larger than it promises."
    if verdict.mean_is_right and verdict.covariance == "honest" and verdict.off_at_all:
        where = _listed([NAMES[kind] for kind in KINDS if kind in verdict.off_at_all])
        return f"The model's errors are larger than it promises in {where}."
    if verdict.mean_is_right:
        return "The model's errors are larger than it promises."
    failing = [kind for kind in KINDS if any(part.kind == kind for part in verdict.systematic)]
    if failing:
        return f"The model goes wrong in {_listed([NAMES[kind] for kind in failing])}."
    return "The model goes wrong, in a way that travel and turn alone do not show."


def _by_motion(comparison: Comparison, verdict: Verdict) -> list[str]:
    """A line for each motion type that was driven."""
    lines = []
    common = (
        "" if verdict.depends or verdict.cells or verdict.gross else ", without a common direction"
    )
    for kind in KINDS:
        figures = comparison.main.by_motion[kind]
        if figures.figures.count < FEWEST_LEGS:
            if kind in verdict.few_and_bad:
                number = _counted(figures.figures.count, "leg")
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
            lines.append(f"- {name}: {_listed(said)}. Errors of a leg: {errors}.")
        elif kind in verdict.off:
            times = math.sqrt(figures.scatter_nees)
            lines.append(
                f"- {name}: errors of a leg {errors}, {times:.1f} times what is promised{common}."
            )
        else:
            promised = ", as promised" if verdict.noise == "honest" else ""
            lines.append(f"- {name} {_AGREES[kind]} good: errors of a leg {errors}{promised}.")
    return lines


def _errors(figures: LegFigures) -> str:
    parts = []
    if math.isfinite(figures.figures.rmse_position_m):
        parts.append(_millimetres(figures.figures.rmse_position_m))
    if math.isfinite(figures.figures.rmse_yaw_rad):
        parts.append(f"{math.degrees(figures.figures.rmse_yaw_rad):.2f}°")
    return " and ".join(parts)


def _elsewhere(comparison: Comparison, verdict: Verdict) -> list[str]:
    lines = []
    count = comparison.main.all.figures.count // 20
    if verdict.few > _FEW and count > 1 and not verdict.good:
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
            f"of {cell.side:.1f} m): {_millimetres(cell.figures.rmse_position_m)} over "
            f"{_counted(cell.figures.count, 'leg')}."
        )
    return lines


def _dependence(item: Depends, others: list[str]) -> str:
    variable = item.variable.split(" [")[0]
    channels = _listed([_CHANNELS[channel] for channel in (item.channel, *others)])
    verb = "go" if others or item.channel == "size" else "goes"
    verb = "goes" if item.channel == "size" and not others else verb
    return (
        f"{channels[0].upper()}{channels[1:]} {verb} with the {variable} ({_chance(item.p_value)})."
    )


def _chance(p_value: float) -> str:
    if p_value < 1e-12:
        return "beyond any chance"
    return f"chance of it without a cause: {p_value:.0e}"


def _run_told(comparison: Comparison, index: int) -> str:
    item = comparison.runs[index]
    figures = item.legs.figures
    return (
        f"- Run {item.run.name} stands out: NEES {figures.nees:.3g} over its "
        f"{_counted(figures.count, 'leg')}."
    )


def covariance_words(verdict: Verdict, nees: float) -> list[str]:
    """What is said of the covariance, true to the table of lengths.

    Parameters
    ----------
    nees : float
        Of all legs of the length asked for.
    """
    if verdict.covariance == "unknown":
        return [f"- NEES is {nees:.3g} (1 is right); legs are too few to judge by it."]
    if verdict.covariance == "honest":
        return [_honest(verdict, nees)]
    small = verdict.covariance == "too small"
    at = next((item for item in verdict.lengths if item.leg == verdict.judged_at), None)
    by_noise = verdict.mean_is_right and verdict.noise == verdict.covariance
    if by_noise and at is not None and at.says == verdict.noise and verdict.factor.told:
        return [_by_noise(verdict, at)]
    size = "small" if small else "large"
    text = f"The covariance is too {size}, {_where(verdict.lengths, small=small)}"
    if not verdict.mean_is_right:
        return [
            f"- {text}. Whether the wheels' noise is stated rightly can be told when what goes "
            "wrong is mended."
        ]
    if verdict.noise == "grows":
        return [f"- {text}: that is no noise of the wheels, something systematic is missing."]
    if small:
        return [
            f"- {text}: something comes and goes along the way, which no noise of the wheels does."
        ]
    return [f"- {text}."]


def _honest(verdict: Verdict, nees: float) -> str:
    if verdict.mean_is_right and verdict.off:
        where = _listed([NAMES[kind] for kind in verdict.off])
        return (
            f"- Over all legs together the covariance is honest (NEES {nees:.2f}, 1 is right); in "
            f"{where} it is too small: something comes and goes there, which no noise of the "
            "wheels does."
        )
    so_far = "" if verdict.mean_is_right else " so far"
    return f"- The covariance is honest{so_far} (NEES {nees:.2f}, 1 is right)."


def _by_noise(verdict: Verdict, at: AtLength) -> str:
    """Where one factor on the wheels' noise explains it."""
    factor = verdict.factor
    times, low, high = (math.sqrt(part) for part in factor)
    between = f"{low:.2g} to {high:.2g}" if math.isfinite(high) else f"at least {low:.2g}"
    leg, errors = _metres(at.leg), math.sqrt(at.nees)
    if at.says == "too small":
        text = f"{_times(at.nees)} times too small over legs of {leg} (NEES {at.nees:.3g}, 1 is "
        text += f"right: errors are {errors:.2g} times what it promises)"
    else:
        text = f"too large (NEES {at.nees:.3g} over legs of {leg}, 1 is right)"
    return (
        f"- The covariance is {text}. Beside the reference's own noise they scatter as if the "
        f"wheels' noise k were {times:.2g} times what the robot file says ({between})."
    )


def _where(lengths: Sequence[AtLength], *, small: bool) -> str:
    """Over which legs NEES is off, and how it goes with their length."""
    first, last = lengths[0], lengths[-1]
    worst = (max if small else min)(lengths, key=lambda item: item.nees)
    if len(lengths) == 1:
        return f"NEES {worst.nees:.3g} over legs of {_metres(worst.leg)} (1 is right)"
    trend = trend_of(lengths)
    if trend == ("longer" if small else "shorter"):
        how = "and the more so the longer the leg"
    elif trend != "between":
        how = "and the more so the shorter the leg"
    else:
        how = f"most over legs of {_metres(worst.leg)}"
        others = [item for item in (first, last) if item is not worst]
        beside = " and ".join(f"{item.nees:.3g} over {_metres(item.leg)}" for item in others)
        return f"{how} (NEES {worst.nees:.3g}, where 1 is right; {beside})"
    return (
        f"{how} (NEES {first.nees:.3g} over {_metres(first.leg)}, {last.nees:.3g} over "
        f"{_metres(last.leg)}, where 1 is right)"
    )


def _times(value: float) -> str:
    return f"{value:.1f}" if value < 10.0 else f"{value:.0f}" if value < 1e4 else f"{value:.0e}"


def _reference(comparison: Comparison) -> list[str]:
    lines = []
    each = "pose" if comparison.prepared.kind == "absolute" else "interval"
    for measure, noise in comparison.prepared.noises:
        parts = []
        if measure != "heading":
            parts.append((f"{1e3 * noise.sigma_xy:.2g} mm", noise.xy_told))
        if measure != "position":
            parts.append((f"{math.degrees(noise.sigma_yaw):.2g}°", noise.yaw_told))
        values = " and ".join(value for value, _ in parts)
        told = (
            parts[0][1] if len({how for _, how in parts}) == 1 else _listed([h for _, h in parts])
        )
        how = {
            "estimated": "estimated from its own small differences",
            "assumed": "assumed, for its poses are too few to tell; --reference-sigma-xy says it",
            "stated": "as the record states it",
            "given": "as given",
        }.get(told, told)
        what = {"pose": "", "position": " (positions alone)", "heading": " (headings alone)"}
        lines.append(f"The reference's own noise{what[measure]}, {values} each {each}, is {how}.")
    outliers = comparison.main.all.outliers
    if outliers:
        total = outliers + comparison.main.all.figures.count
        they = "it is" if outliers == 1 else "they are"
        lines.append(f"On {outliers} of {total} legs the reference jumped; {they} left out.")
    return [*lines, *left_out_words(comparison.left_out)]


def _next(verdict: Verdict, next_step: str) -> str:
    if not verdict.enough or verdict.good:
        return ""
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


def _metres(value: float) -> str:
    return f"{value:g} m"


def _millimetres(value: float) -> str:
    millimetres = 1e3 * value
    if millimetres >= 1e4:
        return f"{value:.1f} m"
    return f"{millimetres:.1f} mm" if millimetres < 100.0 else f"{millimetres:.0f} mm"


def _counted(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _listed(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
