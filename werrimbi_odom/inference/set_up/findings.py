# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Findings of the set-up search: what is wrong, by which factor, and the likely mistake."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.set_up.explanation import Setting, Wired, twins_of
from werrimbi_odom.inference.set_up.misentered_values import (
    ENTERED,
    factor_words,
    is_ordinary,
    simple_factor,
    skid_words,
    skids,
)

_OF_ODOMETRY = {
    "wheels_swapped": "its odometry turns the other way, as if left and right were exchanged",
    "left_wheel_reversed": "its odometry is as if the left wheel were counted backwards",
    "right_wheel_reversed": "its odometry is as if the right wheel were counted backwards",
}

Misfit = Callable[[Setting], float]
"""Typical error of a set-up, relative to the best one."""


@dataclass(frozen=True)
class SetUpFinding:
    """One set-up mistake."""

    effect: str
    """Name in the library; `IN_DEGREES` for a reference that no effect can correct."""
    values: Mapping[str, float]
    """Parameters of the effect, combined with those that the robot file already has; empty for
    mistakes without parameters."""
    factor: str | None
    """Name of the simple factor that the value is near, or None."""
    words: str
    """One sentence: what is wrong, and the mistake that causes it."""
    twins: tuple[str, ...] = ()
    """Effects that explain these records equally well."""
    gain: float = math.inf
    """Ratio of the typical error without it to that with it."""
    without: Setting | None = field(default=None, compare=False, repr=False)
    """The set-up found, without this finding."""


IN_DEGREES = "reference_yaw_in_degrees"
"""The one finding that is no effect: the reference must be recorded again or converted."""

WIRING_WORDS = {
    "wheels_swapped": "left and right counters are exchanged: left turns come out as right turns",
    "left_wheel_reversed": "the left counter has the wrong sign: it counts backwards",
    "right_wheel_reversed": "the right counter has the wrong sign: it counts backwards",
}


def findings_of(
    setting: Setting, ways: list[Wired], misfit: Misfit, *, yaw_alone: bool = False
) -> list[SetUpFinding]:
    """All mistakes that clearly increase the errors, in order of importance.

    `setting`: the best set-up. `ways`: all combinations that explain the signs, that of `setting`
    first. `misfit`: typical error of a set-up; only ratios matter. `yaw_alone`: the reference
    measures no position: only radii over base are identifiable.
    """
    best = misfit(setting)
    found = []
    for proposal in _proposals(setting, ways, yaw_alone):
        assert proposal.without is not None
        gain = misfit(proposal.without) / best
        if gain > rules.WIDE:
            found.append(replace(proposal, gain=gain))
    return found


def _proposals(setting: Setting, ways: list[Wired], yaw_alone: bool) -> Iterator[SetUpFinding]:
    yield from _wiring(setting, ways)
    yield from _sizes(setting, yaw_alone)
    yaw = setting.wired.yaw
    if abs(yaw) > rules.ASKEW:
        without = replace(setting, wired=replace(setting.wired, yaw=0.0))
        words = (
            f"the reference's forward axis is turned by {math.degrees(yaw):.0f}° against the "
            "robot's: its marker or laser is mounted otherwise than was entered"
        )
        if abs(yaw) > math.pi - rules.ASKEW and not setting.wired.of_wheels:
            words += (
                ", or what the counters take for ahead is its rear (both exchanged, both with the "
                "wrong sign)"
            )
        twins = (*find("reference_yaw_offset").twins, *twins_of("reference_yaw_offset", ways))
        yield SetUpFinding("reference_yaw_offset", {"angle": yaw}, None, words, twins, 1.0, without)


def _wiring(setting: Setting, ways: list[Wired]) -> Iterator[SetUpFinding]:
    wired = setting.wired
    marks = {
        "wheels_swapped": ("swapped", wired.swapped),
        "left_wheel_reversed": ("left_reversed", wired.left_reversed),
        "right_wheel_reversed": ("right_reversed", wired.right_reversed),
    }
    for name, (mark, made) in marks.items():
        if made:
            right = replace(wired, **{mark: False})
            twins = twins_of(name, ways)
            words = WIRING_WORDS[name]
            if wired.swapped and name != "wheels_swapped":
                words += ", once both are exchanged"
            if "reference_mirrored" in twins:
                words += "; or the reference's frame is left-handed (y down; a lidar upside down)"
            yield SetUpFinding(name, {}, None, words, twins, 1.0, replace(setting, wired=right))


def _sizes(setting: Setting, yaw_alone: bool) -> Iterator[SetUpFinding]:
    left, right, base = setting.left, setting.right, setting.base
    common = math.sqrt(left * right)
    ratio = right / left
    if not is_ordinary(ratio):
        side, common = _odd_side(left, right)
        share = ratio if side == "right" else 1.0 / ratio
        yield SetUpFinding(
            "unequal_wheel_radii",
            {"ratio": ratio},
            simple_factor(ratio),
            factor_words(side, share),
            (),
            1.0,
            replace(setting, left=common, right=common),
        )
    factor = simple_factor(common)
    smaller = replace(setting, left=left / common, right=right / common)
    values = {"multiplier": common}
    if yaw_alone:
        if not is_ordinary(common):
            words = factor_words("turning", common)
            name, twin = "wheel_radius_scale", "track_width"
            if skids(1.0 / common):  # blame the base: distances are right
                name, twin, values = twin, name, {"multiplier": 1.0 / common}
                factor = simple_factor(1.0 / common)
            yield SetUpFinding(name, values, factor, words, (twin,), 1.0, smaller)
        return
    odd_radius, odd_base = not is_ordinary(common), not is_ordinary(base)
    wider = replace(setting, base=1.0)
    of_base = simple_factor(base)
    if odd_radius and odd_base and abs(math.log(common / base)) < math.log(rules.NEAR):
        words = factor_words("metre", common)
        without = replace(smaller, base=1.0)
        yield SetUpFinding("wheel_radius_scale", values, factor, words, (), 1.0, without)
        yield SetUpFinding("track_width", {"multiplier": base}, of_base, words, (), 1.0, without)
        return
    if odd_radius:
        words = factor_words("radius", common)
        yield SetUpFinding("wheel_radius_scale", values, factor, words, (), 1.0, smaller)
    if odd_base:
        words = factor_words("base", base)
        yield SetUpFinding("track_width", {"multiplier": base}, of_base, words, (), 1.0, wider)


def of_odometry(finding: SetUpFinding) -> SetUpFinding:
    """Replace words about counters and the robot file, where the wheels are made of odometry.

    Its travel is turned back by the file's sizes, so these cancel.
    """
    words = finding.words.replace(ENTERED, "what its odometry was made with")
    if finding.effect == "track_width" or "track_width" in finding.twins:
        words += "; or a gyro that it fuses turns too far, or too little"
    if finding.effect in WIRING_WORDS:
        words = words.replace(WIRING_WORDS[finding.effect], _OF_ODOMETRY[finding.effect])
    return replace(finding, words=words)


def as_skid_steer(finding: SetUpFinding) -> SetUpFinding:
    """Replace a finding of a wide base by `skid_steer`, for a robot that is known to skid."""
    base = finding.values.get("multiplier", 1.0)
    if finding.effect == "wheel_radius_scale" and "track_width" in finding.twins:
        base = 1.0 / base  # headings only: distances are right
    elif finding.effect != "track_width":
        return finding
    skid = find("skid_steer")
    if base < 1.0 or not skid.allows({"multiplier": base}):
        return finding
    values = {"multiplier": base}
    return replace(
        finding, effect=skid.name, values=values, factor=None, words=skid_words(base), twins=()
    )


def _odd_side(left: float, right: float) -> tuple[str, float]:
    """The wheel that is wrong, and the factor of the other one."""
    known = {"right": left, "left": right}
    side = min(known, key=lambda name: abs(math.log(known[name])))
    for name, other in known.items():
        if not is_ordinary(known[side]) and simple_factor(other) and not simple_factor(known[side]):
            side = name
    return side, known[side]


def arm_finding(
    setting: Setting, misfit: Misfit, base: float, entered: complex = 0j
) -> list[SetUpFinding]:
    """A lever arm longer than the base: not an inexact mount, but another place than entered.

    `base`: wheel base [m]. `entered`: what `setting` has as its lever arm where the point is the
    one that the robot file holds; the finding is what is beyond [m].
    """
    arm = setting.arm - entered
    if not base < abs(arm) or max(abs(arm.real), abs(arm.imag)) > rules.LONGEST_ARM:
        return []
    without = replace(setting, arm=entered)
    gain = misfit(without) / misfit(setting)
    along = "ahead of" if arm.real >= 0.0 else "behind"
    side = "left" if arm.imag >= 0.0 else "right"
    words = (
        f"the reference measures a point {abs(arm.real):.2f} m {along} the axle's middle and "
        f"{abs(arm.imag):.2f} m to its {side}: its marker, laser or aerial is mounted there"
    )
    values = {"x": arm.real, "y": arm.imag}
    if gain < rules.WIDE:
        return []
    return [SetUpFinding("reference_lever_arm", values, None, words, (), gain, without)]
