# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Search for set-up mistakes, which comes before any other estimation.

They are the commonest cause of bad odometry, and too large for linearisation at the null value:
counters exchanged or of the wrong sign, factors of 2, 4, pi, 57.3 or 1000, a laser mounted at 90
degrees, a clock that is off by seconds. See docs/set_up.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.tables.mislabelled_columns import YAW_IN_DEGREES
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import effective_track, skids_in_turns
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.set_up.clock_offset_search import lag_of
from werrimbi_odom.inference.set_up.corrected_robot import with_findings
from werrimbi_odom.inference.set_up.explanation import Setting, SetUpEstimate, setting_of, wirings
from werrimbi_odom.inference.set_up.few_poses import is_sparse, search_sparse
from werrimbi_odom.inference.set_up.findings import (
    IN_DEGREES,
    WIRING_WORDS,
    SetUpFinding,
    as_skid_steer,
    findings_of,
    of_odometry,
)
from werrimbi_odom.inference.set_up.misentered_values import (
    LENGTHS,
    counts_words,
    unit_of_positions,
)
from werrimbi_odom.inference.set_up.poses import degrees_gain, search_poses
from werrimbi_odom.inference.set_up.positions import search_positions
from werrimbi_odom.inference.set_up.records import (
    SetUpRecord,
    cut,
    measured_by,
    ratio_of_ticks,
    record_of,
)
from werrimbi_odom.inference.set_up.regression import HeadingRegression, swept, turning
from werrimbi_odom.model.effect import AppliedEffect, extended_by
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

DELAY, RADIUS = "reference_delay", "wheel_radius_scale"
SWAPPED, MOUNT = "wheels_swapped", "reference_yaw_offset"
BEYOND = "correct its stamps or positions, and diagnose again"
IN_UNIT = (
    "the reference's positions are in {unit}, and x_m and y_m mean metres: convert these columns "
    "(divide by {size:.6g})"
)


@dataclass(frozen=True)
class SetUp:
    """Set-up mistakes, and the corrected robot."""

    findings: tuple[SetUpFinding, ...]
    """In order of importance; empty if the set-up is right."""
    robot: Robot
    """The given robot with the findings' effects, and sizes close enough for fits to start from.

    If only one wheel is wrong, the ratio comes with a `wheel_radius_scale`, since the ratio alone
    keeps the mean radius."""

    @property
    def wrong(self) -> tuple[SetUpFinding, ...]:
        """Findings that are mistakes; skidding wheels are none."""
        return tuple(each for each in self.findings if each.effect != "skid_steer")

    def on_its_clock(self, robot: Robot) -> Robot:
        """A robot with the delay found, if the clocks differ: drives are cut by it.

        While the clocks are seconds apart, a gyro turns while the wheels stand, and legs end
        elsewhere than the poses that are compared there.
        """
        if all(each.effect != DELAY for each in self.findings):
            return robot
        return on_the_clock_of(self.robot, robot)

    def beside(self, effects: tuple[AppliedEffect, ...]) -> SetUp:
        """The set-up without findings that some of these effects have anew in each drive."""
        anew = extended_by(effects)
        kept = tuple(each for each in self.findings if each.effect not in anew)
        return replace(self, findings=kept)

    @property
    def to_convert(self) -> str | None:
        """Sentence about a reference in the wrong unit, or beyond what an effect can correct."""
        for finding in self.findings:
            if finding.effect == IN_DEGREES:
                return finding.words
            mends = find(finding.effect)
            if mends.stage == "reference" and not mends.allows(finding.values):
                return f"{finding.words}, more than {finding.effect} can hold: {BEYOND}"
        # Base and radii need not be right for that: half the base may be entered beside.
        larger = {each.effect: each.values.get("multiplier", 1.0) for each in self.findings}
        base, radius = (larger.get(name, 1.0) for name in ("track_width", RADIUS))
        if min(base, radius) > rules.MILLIMETRES_FROM:
            return IN_UNIT.format(unit="millimetres", size=1000.0)
        if (unit := unit_of_positions(radius, base)) is not None:
            return IN_UNIT.format(unit=unit, size=LENGTHS[unit])
        if radius > rules.MOST_COUNTS:
            return next(each.words for each in self.findings if each.effect == RADIUS)
        return None


def on_the_clock_of(other: Robot, robot: Robot) -> Robot:
    """A robot with the delay of another; itself where that has none."""
    late = next((item for item in other.effects if item.name == DELAY), None)
    if late is None:
        return robot
    return replace(robot, effects=(late, *(e for e in robot.effects if e.name != DELAY)))


def look_for_mistakes(
    runs: Sequence[Run], robot: Robot, options: EvaluationOptions = EvaluationOptions()
) -> SetUp:
    """Search the whole range of set-up mistakes.

    `runs`: recorded runs. `robot`: the robot as its file has it; its effects are kept, and undone
    for the search. `options`: limits of the encoders. InputError if a size would be beyond what its
    effect allows.
    """
    runs = [with_no_driving(run, robot, options.limits) for run in runs]
    records = [each for run in runs if (each := record_of(run, robot, options.limits)) is not None]
    measured = measured_by(records)
    if measured is None:
        return SetUp((), robot)
    degrees, late = [], []
    gain = degrees_gain(records, robot, measured)
    if gain > 1.0:
        records = [each.in_degrees() for each in records]
        degrees.append(_in_degrees(gain))
    lag, gain = lag_of(records)
    if lag != 0.0:
        records = [each.delayed(lag) for each in records]
        late.append(_late(lag, gain))
    if measured == "heading":
        found, setting = _search_headings(records, robot)
    elif is_sparse(records, robot, measured):
        found, setting = search_sparse(records, robot, measured)
    elif measured == "pose":
        found, setting = search_poses(records, robot)
    else:
        found, setting = search_positions(records, robot)
    made = all(run.wheels_from == "odometry" for run in runs)
    found = [of_odometry(each) for each in found] if made else _with_counts(found, robot)
    mount = [each for each in found if find(each.effect).stage == "reference"]
    # How the wheels are wired first: sizes mean nothing before, and which of two mistakes makes the
    # larger errors may be another one with every second pose.
    wheels = sorted(
        (each for each in found if each not in mount),
        key=lambda each: (each.effect not in WIRING_WORDS, -each.gain),
    )
    if skids_in_turns(robot):
        wheels = [as_skid_steer(each) for each in wheels]
    try:
        mended, findings = with_findings(robot, [*degrees, *wheels, *late, *mount], setting)
    except ValueError as error:  # a size beyond what its effect allows
        of_a_gyro = "radians, about the upright axis of a gyro that is alive"
        raise InputError(
            f"{runs[0].path}: wheels and reference have nothing in common (no robot is as far off "
            "as would explain it): is it the reference of this robot and this drive, in "
            f"{of_a_gyro if measured == 'heading' else 'metres'}?"
        ) from error
    return SetUp(findings, mended)


def require_sizes_to_mean_something(run: Run, robot: Robot, options: EvaluationOptions) -> None:
    """Check the reference's unit and the wheels' wiring: InputError if one of them is wrong."""
    found = look_for_mistakes([run], robot, options)
    wired = (each.words for each in found.findings if each.effect in WIRING_WORDS)
    if (words := found.to_convert or next(wired, None)) is not None:
        raise InputError(f"{run.path}: {words}")


def mistakes_without_sizes(
    run: Run, robot: Robot, options: EvaluationOptions
) -> tuple[SetUpFinding, ...]:
    """Mistakes of wiring and mount alone, for a robot whose sizes need not be known."""
    try:
        findings = look_for_mistakes([run], robot, options).findings
    except InputError:  # nothing in common, by sizes that may be mere placeholders
        return ()
    return tuple(each for each in findings if each.effect in (*WIRING_WORDS, MOUNT))


def knows_left(run: Run, robot: Robot, options: EvaluationOptions) -> bool:
    """Whether a run shows which counter is left: exchanged ones would be a mistake."""
    exchanged, _ = with_findings(robot, [SetUpFinding(SWAPPED, {}, None, "")], None)
    found = mistakes_without_sizes(run, exchanged, options)
    return any(each.effect == SWAPPED for each in found)


def _search_headings(
    records: Sequence[SetUpRecord], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """Signs, and radii over base, where only yaw was measured, perhaps by a gyro.

    Mounting, lever arm, a common factor on base and radii, and the forward direction are not
    identifiable; sizes are not measured, so the second value is always None.
    """
    cuts = cut(records, robot, "heading")
    if cuts.count < rules.FEWEST_CUTS:
        return [], None
    fit = turning(cuts, with_bias=True)
    signs_alone = not _is_sure(fit)
    if signs_alone:
        fit = turning(cuts, with_bias=True, squares=True)
    if fit is None or not _is_sure(fit):
        return [], None
    track = effective_track(robot)
    estimate = SetUpEstimate(fit.left, fit.right, None, None, ticks=ratio_of_ticks(robot))
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(tried: Setting) -> float:
        left, right, _, _ = tried.numbers(track)
        off = wrap_all(cuts.turn - swept(cuts, left, right)[1])
        off = off - _creep(off, cuts.duration) * cuts.duration
        return float(np.exp(0.5 * np.mean(np.log1p((off / fit.scatter) ** 2))))

    found = findings_of(setting, ways, misfit, yaw_alone=True)
    # A few short turns determine signs but no sizes: a delay makes the turns look smaller.
    return [each for each in found if each.effect in WIRING_WORDS or not signs_alone], None


def _creep(off: Floats, duration: Floats) -> float:
    """Gyro bias as estimated under a set-up [rad/s].

    It is the median rate weighted by time. Standing tells it best; otherwise a robot that drives
    straight at constant speed with a reversed wheel would pass for one that spins with that bias.
    """
    known = np.isfinite(off) & (duration > 0.0)
    rates, weights = off[known] / duration[known], duration[known]
    order = np.argsort(rates)
    until = np.cumsum(weights[order])
    if until.size == 0:
        return 0.0
    middle = rates[order][np.searchsorted(until, 0.5 * until[-1])]
    return float(np.clip(middle, -rules.MOST_CREEP, rules.MOST_CREEP))


def _is_sure(fit: HeadingRegression | None) -> bool:
    """Whether the sign of each wheel's turn is significant."""
    if fit is None:
        return False
    left, right = abs(fit.left) / rules.SURE_SIZE, abs(fit.right) / rules.SURE_SIZE
    return left > fit.left_std and right > fit.right_std


def _with_counts(found: Sequence[SetUpFinding], robot: Robot) -> list[SetUpFinding]:
    """Say how many counts a turn has, where no simple factor explains both radii alone."""
    if any(each.effect in ("track_width", "unequal_wheel_radii") for each in found):
        return list(found)
    told = []
    for each in found:
        if each.effect == RADIUS and each.factor is None and not each.twins:
            ticks = robot.left_ticks_per_revolution, robot.right_ticks_per_revolution
            left, right = (side / each.values["multiplier"] for side in ticks)
            words = f"{each.words}; {counts_words(left, right, robot.wheel_radius)}"
            each = replace(each, words=words)
        told.append(each)
    return told


def _in_degrees(gain: float) -> SetUpFinding:
    return SetUpFinding(IN_DEGREES, {}, "180/pi", f"{YAW_IN_DEGREES}, and diagnose again", (), gain)


def _late(lag: float, gain: float) -> SetUpFinding:
    more = " or more" if abs(lag) >= rules.DELAY_LONGEST else ""
    words = (
        f"the reference's stamps are {abs(lag):.1f} s{more} too {'late' if lag > 0.0 else 'early'} "
        "against the encoders': by a driver, a network, or two computers' clocks"
    )
    return SetUpFinding(DELAY, {"delay": lag}, None, words, (), gain)
