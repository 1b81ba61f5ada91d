# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Phrases of a comparison: systematic errors, and the consistency of the covariance."""

from __future__ import annotations

import math
from collections.abc import Sequence

from werrimbi_odom.inference.comparison.compare import Comparison, OfLength
from werrimbi_odom.inference.comparison.consistency import AtLength, trend_of
from werrimbi_odom.inference.comparison.residuals import Measure
from werrimbi_odom.inference.comparison.systematic import Systematic
from werrimbi_odom.inference.comparison.verdict import Verdict
from werrimbi_odom.report.number_format import from_start, listed, two_digits
from werrimbi_odom.report.phrases import left_out_words, leg_words, remark_words

NAMES = {"line": "straight driving", "arc": "curves", "spin": "spins"}


def leg_when(comparison: Comparison, index: int) -> str:
    """Start and end time of a leg."""
    legs = comparison.legs
    started = float(comparison.runs[int(legs.run[index])].run.ticks.time[0])
    begin, end = from_start(started, float(legs.start_time[index]), float(legs.end_time[index]))
    return f"{begin:.1f} to {end:.1f} s"


def systematic_told(part: Systematic) -> str:
    """A systematic error in words: the robot's motion relative to the model."""
    value, std = part.value, part.std
    if part.channel == "heading" and part.per == "turn":
        return _share("turns", "the other way", value, std)
    if part.channel == "heading" and part.per == "size of turn":
        side = "left" if value > 0.0 else "right"
        return (
            f"whatever the sense, it turns {_degrees(value, std)} per turned radian to the {side}"
        )
    if part.channel == "heading":
        side = "left" if value > 0.0 else "right"
        return f"driving forward the robot veers to the {side} by {_degrees(value, std)} per metre"
    if part.channel == "along" and part.per == "travel":
        return _share("goes", "backward where the model says forward", value, std)
    if part.channel == "sideways" and part.per == "travel":
        side = "left" if value > 0.0 else "right"
        return f"the robot ends {_to_side(value, std)} to the {side} per metre forward"
    quarter = 1.0 if part.per == "sine of turn" else 0.5 * math.pi
    where = {
        ("along", True): "forward",
        ("along", False): "back",
        ("sideways", True): "to the left",
        ("sideways", False): "to the right",
    }[(part.channel, value > 0.0)]
    return (
        f"what the reference measures moves {_to_side(value * quarter, std * quarter)} {where} "
        "in a quarter turn to the left"
    )


def _share(verb: str, otherwise: str, value: float, std: float) -> str:
    """As a percentage: the robot turns 1.8 ± 0.1 % less than the model says."""
    if value < -1.0:
        return f"the robot {verb} {otherwise}"
    if value > 1.0:
        return f"the robot {verb} {two_digits(1.0 + value)} times as far as the model says"
    word = "more" if value > 0.0 else "less"
    return (
        f"the robot {verb} {_rounded(100.0 * abs(value), 100.0 * std)} % {word} than the model says"
    )


def _degrees(value: float, std: float) -> str:
    return f"{_rounded(math.degrees(abs(value)), math.degrees(std))}°"


def _to_side(value: float, std: float) -> str:
    return f"{_rounded(1e3 * abs(value), 1e3 * std)} mm"


def _rounded(value: float, std: float) -> str:
    """Value and standard error, rounded by the standard error."""
    if not std > 0.0:
        return f"{value:.3g}"
    digits = min(max(-math.floor(math.log10(std)), 0), 6)
    return f"{value:.{digits}f} ± {std:.{digits}f}"


def covariance_words(verdict: Verdict, nees: float) -> list[str]:
    """Consistency of the covariance, in agreement with the table of leg lengths.

    `nees` is that of all legs of the requested length.
    """
    if verdict.covariance == "unknown":
        return [f"- NEES is {nees:.3g} (1 is right); legs are too few to judge by it."]
    if verdict.covariance == "honest":
        return [_honest(verdict, nees)]
    small = verdict.covariance == "too small"
    at = next((item for item in verdict.lengths if item.leg == verdict.judged_at), None)
    by_noise = verdict.mean_is_right and verdict.noise == verdict.covariance
    if by_noise and at is not None and at.says == verdict.noise and verdict.factor.determined:
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
            f"- {text}: something comes and goes along the way, which no noise of the wheels does, "
            "or the reference's own noise is larger or lasts."
        ]
    return [f"- {text}."]


def _honest(verdict: Verdict, nees: float) -> str:
    if verdict.mean_is_right and verdict.off:
        where = listed([NAMES[kind] for kind in verdict.off])
        return (
            f"- Over all legs together the covariance is honest (NEES {nees:.2f}, 1 is right); in "
            f"{where} it is too small: something comes and goes there, which no noise of the "
            "wheels does."
        )
    so_far = "" if verdict.mean_is_right else " so far"
    return f"- The covariance is honest{so_far} (NEES {nees:.2f}, 1 is right)."


def _by_noise(verdict: Verdict, at: AtLength) -> str:
    """Words for an inconsistency that a factor on the wheel noise explains."""
    factor = verdict.factor
    times, low, high = (math.sqrt(part) for part in factor)
    between = (
        f"{two_digits(low)} to {two_digits(high)}"
        if math.isfinite(high)
        else f"at least {two_digits(low)}"
    )
    leg, errors = length_of(at), math.sqrt(at.nees)
    if at.says == "too small":
        text = f"{_times(at.nees)} times too small over legs of {leg} (NEES {at.nees:.3g}, 1 is "
        text += f"right: errors are {errors:.2g} times what it promises)"
    else:
        text = f"too large (NEES {at.nees:.3g} over legs of {leg}, 1 is right)"
    return (
        f"- The covariance is {text}. Beside the reference's own noise they scatter as if the "
        f"wheels' noise k were {two_digits(times)} times what the robot file says ({between})."
    )


def length_of(legs: AtLength | OfLength) -> str:
    """Length of legs with its unit: as they are, where poses are rarer than was asked for."""
    return f"{leg_words(legs.median, legs.leg)} m"


def _where(lengths: Sequence[AtLength], *, small: bool) -> str:
    """Leg lengths at which NEES is off, and its trend with length."""
    first, last = lengths[0], lengths[-1]
    worst = (max if small else min)(lengths, key=lambda item: item.nees)
    if len(lengths) == 1:
        return f"NEES {worst.nees:.3g} over legs of {length_of(worst)} (1 is right)"
    trend = trend_of(lengths)
    if trend == ("longer" if small else "shorter"):
        how = "and the more so the longer the leg"
    elif trend != "between":
        how = "and the more so the shorter the leg"
    else:
        how = f"most over legs of {length_of(worst)}"
        others = [item for item in (first, last) if item is not worst]
        beside = " and ".join(f"{item.nees:.3g} over {length_of(item)}" for item in others)
        return f"{how} (NEES {worst.nees:.3g}, where 1 is right; {beside})"
    return (
        f"{how} (NEES {first.nees:.3g} over {length_of(first)}, {last.nees:.3g} over "
        f"{length_of(last)}, where 1 is right)"
    )


def _times(value: float) -> str:
    return f"{value:.1f}" if value < 10.0 else f"{value:.0f}" if value < 1e4 else f"{value:.0e}"


_NO_NOISE = 1e-7  # rad; below that of any gyro, so its digits would be numerical noise


def reference_words(comparison: Comparison) -> list[str]:
    """The reference's own noise, its jumps, what is suspect in it, and what is left out."""
    lines = []
    each = "interval" if comparison.prepared.options.reference_kind == "incremental" else "pose"
    wanders = comparison.prepared.options.reference_kind == "local_map"
    for measure, noise in comparison.prepared.noises:
        hows = [noise.xy_told] if measure != "heading" else []
        hows += [noise.yaw_told] if measure != "position" else []
        values = f"{_sizes(measure, noise.sigma_xy, noise.sigma_yaw)} each {each}"
        if noise.of_runs is not None:
            least, most = (_sizes(measure, *sizes) for sizes in zip(*noise.of_runs, strict=True))
            unlike = f"{least} each {each} in the best drive and {most} in the worst"
            values = unlike if least != most else values
        told = hows[0] if len(set(hows)) == 1 else listed(hows)
        how = {
            "estimated": "fitted with the calibration"
            if wanders
            else "estimated from its own small differences",
            "assumed": "assumed, for its poses are too few to tell; "
            f"--reference-sigma-{'yaw' if measure == 'heading' else 'xy'} says it",
            "stated": "as the record states it",
            "given": "as given",
        }.get(told, told)
        what = {"pose": "", "position": " (positions alone)", "heading": " (headings alone)"}
        if measure == "heading" and told == "estimated" and noise.sigma_yaw < _NO_NOISE:
            lines.append(
                "The reference's own noise (headings alone) is too small to tell: its small "
                "differences scatter no more than reading the counters makes."
            )
            continue
        lines.append(f"The reference's own noise{what[measure]}, {values}, is {how}.")
        if wanders:
            lines[-1] += (
                f" Its error also wanders, by {_sizes(measure, noise.walk_xy, noise.walk_yaw)} in "
                f"a second and {_sizes(measure, *noise.wander)} in the long run."
            )
    outliers = comparison.main.all.outliers
    if outliers:
        total = outliers + comparison.main.all.figures.count
        they = "it is" if outliers == 1 else "they are"
        lines.append(f"On {outliers} of {total} legs the reference jumped; {they} left out.")
    lines += [remark_words(remark) for remark in comparison.remarks]
    return [*lines, *left_out_words(comparison.left_out)]


def _sizes(measure: Measure, xy: float, yaw: float) -> str:
    """Sizes of the measured quantities in words."""
    parts = [f"{two_digits(1e3 * xy)} mm"] if measure != "heading" else []
    parts += [f"{math.degrees(yaw):.2g}°"] if measure != "position" else []
    return " and ".join(parts)
