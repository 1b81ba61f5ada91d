# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The search for set-up mistakes, before anything else is looked for.

They are the commonest cause of bad odometry, and so large that no derivative at the null value
finds them: counters exchanged or of the wrong sign, factors of 2, 4, pi, 57.3 or 1000, a laser
mounted at 90 degrees, a clock that is off by seconds. See docs/set_up.md.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.calibration_sizes import skidding
from werrimbi_odom.inference.legs.no_driving import looked_at
from werrimbi_odom.inference.rules import FEWEST_CUTS, MILLIMETRES_FROM, MOST_CREEP, SURE_SIZE
from werrimbi_odom.inference.set_up.delay import lag_of
from werrimbi_odom.inference.set_up.explanation import Estimate, Setting, setting_of, wirings
from werrimbi_odom.inference.set_up.findings import (
    IN_DEGREES,
    WIRING_WORDS,
    SetUpFinding,
    as_skid,
    findings_of,
)
from werrimbi_odom.inference.set_up.poses import degrees_gain, search_poses
from werrimbi_odom.inference.set_up.positions import search_positions
from werrimbi_odom.inference.set_up.records import (
    Record,
    cut,
    effective_track,
    measured_by,
    record_of,
)
from werrimbi_odom.inference.set_up.regression import Turning, swept, turning
from werrimbi_odom.inference.set_up.robot import with_findings
from werrimbi_odom.inference.set_up.sparse import is_sparse, search_sparse
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot

__all__ = ["IN_DEGREES", "SetUp", "SetUpFinding", "look_for_mistakes"]


IN_MILLIMETRES = (
    "the reference's positions are in millimetres, and x_m and y_m mean metres: convert these "
    "columns (divide by 1000) and diagnose again"
)


@dataclass(frozen=True)
class SetUp:
    """What is set up wrongly, and the robot with it put right."""

    findings: tuple[SetUpFinding, ...]
    """The most important first; empty where all is set up right."""
    robot: Robot
    """The given robot with the findings' effects, and sizes near enough for fits to begin.

    Where one wheel alone is off, a `wheel_radius_scale` goes with the ratio, which keeps the mean
    of the radii."""

    @property
    def wrong(self) -> tuple[SetUpFinding, ...]:
        """The findings that are mistakes: that driven wheels skid in turns is none."""
        return tuple(each for each in self.findings if each.effect != "skid_steer")

    @property
    def to_convert(self) -> str | None:
        """What of the reference is in another unit, in words: no effect can mend that."""
        for finding in self.findings:
            if finding.effect == IN_DEGREES:
                return finding.words
        # Base and radii need not be right for that: half the base may be entered beside.
        larger = {each.effect: each.values.get("multiplier", 1.0) for each in self.findings}
        sizes = (larger.get(name, 1.0) for name in ("track_width", "wheel_radius_scale"))
        return IN_MILLIMETRES if all(size > MILLIMETRES_FROM for size in sizes) else None


def look_for_mistakes(
    runs: Sequence[Run], robot: Robot, options: EvaluationOptions = EvaluationOptions()
) -> SetUp:
    """Search the whole range of what can be set up wrongly.

    Parameters
    ----------
    robot : Robot
        As the robot file has it; effects that it holds already are kept and undone first.
    """
    runs = [looked_at(run, robot, options.limits) for run in runs]
    records = [each for run in runs if (each := record_of(run, robot, options.limits)) is not None]
    measured = measured_by(records)
    if measured is None:
        return SetUp((), robot)
    extra = []
    gain = degrees_gain(records, robot, measured)
    if gain > 1.0:
        records = [each.in_degrees() for each in records]
        extra.append(_in_degrees(gain))
    lag, gain = lag_of(records)
    if lag != 0.0:
        records = [each.delayed(lag) for each in records]
        extra.append(_late(lag, gain))
    if is_sparse(records, robot, measured):
        found, setting = search_sparse(records, robot, measured)
    elif measured == "pose":
        found, setting = search_poses(records, robot)
    elif measured == "position":
        found, setting = search_positions(records, robot)
    else:
        found, setting = _search_headings(records, robot)
    mount = [each for each in found if find(each.effect).stage == "reference"]
    # How the wheels are wired first: sizes mean nothing before, and which of two mistakes makes the
    # larger errors may be another one with every second pose.
    wheels = sorted(
        (each for each in found if each not in mount),
        key=lambda each: (each.effect not in WIRING_WORDS, -each.gain),
    )
    if skidding(robot):
        wheels = [as_skid(each) for each in wheels]
    degrees = [each for each in extra if each.effect == IN_DEGREES]
    late = [each for each in extra if each.effect != IN_DEGREES]
    try:
        mended, findings = with_findings(robot, [*degrees, *wheels, *late, *mount], setting)
    except ValueError as error:  # a size beyond what its effect allows
        raise InputError(
            f"{runs[0].path}: wheels and reference have nothing in common (no robot is as far off "
            "as would explain it): is it the reference of this robot and this drive, in metres?"
        ) from error
    return SetUp(findings, mended)


def _search_headings(
    records: Sequence[Record], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """Signs, and radii over base, where yaw alone was measured, by a gyro perhaps.

    Mount, lever arm, a factor common to base and radii, and which way is forwards do not show;
    sizes are not measured, so the second is always None.
    """
    cuts = cut(records, robot, "heading")
    if cuts.count < FEWEST_CUTS:
        return [], None
    fit = turning(cuts, with_bias=True)
    signs_alone = not _is_sure(fit)
    if signs_alone:
        fit = turning(cuts, with_bias=True, squares=True)
    if fit is None or not _is_sure(fit):
        return [], None
    track = effective_track(robot)
    estimate = Estimate(fit.left, fit.right, None, None)
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(tried: Setting) -> float:
        left, right, _, _ = tried.numbers(track)
        off = wrap_all(cuts.turn - swept(cuts, left, right)[1])
        off = off - _creep(off, cuts.duration) * cuts.duration
        return float(np.exp(0.5 * np.mean(np.log1p((off / fit.scatter) ** 2))))

    found = findings_of(setting, ways, misfit, yaw_alone=True)
    # A few short turns tell which way the wheels count, and no size: a delay makes them smaller.
    return [each for each in found if each.effect in WIRING_WORDS or not signs_alone], None


def _creep(off: Floats, duration: Floats) -> float:
    """A gyro's bias, as it would be seen with a set-up [rad/s].

    The median over all of the time: what stands tells it best, and a robot that drives straight at
    one speed on a reversed wheel would else pass for one that spins before a gyro of that bias.
    """
    known = np.isfinite(off) & (duration > 0.0)
    rates, weights = off[known] / duration[known], duration[known]
    order = np.argsort(rates)
    until = np.cumsum(weights[order])
    if until.size == 0:
        return 0.0
    middle = rates[order][np.searchsorted(until, 0.5 * until[-1])]
    return float(np.clip(middle, -MOST_CREEP, MOST_CREEP))


def _is_sure(fit: Turning | None) -> bool:
    """Whether it is beyond doubt which way each wheel turns the robot."""
    if fit is None:
        return False
    left, right = abs(fit.left) / SURE_SIZE, abs(fit.right) / SURE_SIZE
    return left > fit.left_std and right > fit.right_std


def _in_degrees(gain: float) -> SetUpFinding:
    words = (
        "the reference's yaw is in degrees, and yaw_rad means radians: convert that column "
        "(times pi/180) and diagnose again"
    )
    return SetUpFinding(IN_DEGREES, {}, "180/pi", words, (), gain)


def _late(lag: float, gain: float) -> SetUpFinding:
    words = (
        f"the reference's stamps are {abs(lag):.1f} s too {'late' if lag > 0.0 else 'early'} "
        "against the encoders': two computers whose clocks differ"
    )
    return SetUpFinding("reference_delay", {"delay": lag}, None, words, (), gain)
