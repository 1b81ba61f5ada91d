# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up search where poses were measured: two linear regressions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import effective_track
from werrimbi_odom.inference.comparison.residuals import Measure
from werrimbi_odom.inference.set_up.clock_offset_search import lag_of
from werrimbi_odom.inference.set_up.corrected_robot import mount_of
from werrimbi_odom.inference.set_up.explanation import (
    AS_ENTERED,
    Setting,
    SetUpEstimate,
    setting_of,
    wirings,
)
from werrimbi_odom.inference.set_up.findings import SetUpFinding, arm_finding, findings_of
from werrimbi_odom.inference.set_up.records import Cuts, SetUpRecord, cut, ratio_of_ticks
from werrimbi_odom.inference.set_up.regression import (
    HeadingRegression,
    Moving,
    errors,
    moving,
    turning,
)
from werrimbi_odom.model.pose import wrap_all
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class Regressed:
    """Both regressions of a session."""

    cuts: Cuts
    turning: HeadingRegression
    moving: Moving

    @property
    def is_sure(self) -> bool:
        """Whether both wheels and the base are determined."""
        turn, move = self.turning, self.moving
        return (
            abs(turn.left) > rules.SURE_SIZE * turn.left_std
            and abs(turn.right) > rules.SURE_SIZE * turn.right_std
            and abs(move.half_base) > rules.SURE_SIZE * move.half_base_std
        )

    def misfit(self, setting: Setting, track: float) -> float:
        """Typical error of a cut, in units of the best fit's dispersion."""
        move, turn = errors(self.cuts, *setting.numbers(track))
        known = np.isfinite(move) & np.isfinite(turn)
        square = np.abs(move / self.moving.scatter) ** 2
        square += np.abs(turn / self.turning.scatter) ** 2
        return float(np.exp(0.5 * np.mean(np.log1p(square[known]))))


def regressed(records: Sequence[SetUpRecord], robot: Robot) -> Regressed | None:
    """Both regressions; None where the drives do not determine them."""
    cuts = cut(records, robot, "pose")
    if cuts.count < rules.FEWEST_CUTS:
        return None
    turn = turning(cuts)
    move = None if turn is None else moving(cuts, turn.left, turn.right)
    return None if turn is None or move is None else Regressed(cuts, turn, move)


def degrees_gain(records: Sequence[SetUpRecord], robot: Robot, measured: Measure) -> float:
    """Improvement of the fit if the reference's yaw is in degrees; 1 if it is in radians."""
    yaw = np.concatenate([each.yaw[np.isfinite(each.yaw)] for each in records])
    if measured == "position" or yaw.size == 0 or np.ptp(yaw) < rules.DEGREES_RANGE:
        return 1.0
    if measured == "heading":
        # Wrapped angles jump by a whole turn.
        jumps = np.concatenate([np.abs(np.diff(each.yaw)) for each in records])
        degrees, radians = (
            int(np.sum((jumps > low) & (jumps < high)))
            for low, high in (rules.DEGREES_WRAPS, rules.RADIANS_WRAPS)
        )
        if degrees > radians or _turns_in_degrees(records, robot):
            return math.inf
        return 1.0
    mended = [each.in_degrees() for each in records]
    gain = _gain_over(records, mended, robot)
    if gain <= rules.DEGREES_BETTER and (lag := lag_of(mended)[0]) != 0.0:
        # While the clocks are seconds apart, poses fit in no unit.
        given = [each.delayed(lag) for each in records]
        gain = _gain_over(given, [each.delayed(lag) for each in mended], robot)
    return gain if gain > rules.DEGREES_BETTER else 1.0


def _gain_over(given: Sequence[SetUpRecord], mended: Sequence[SetUpRecord], robot: Robot) -> float:
    """How much less the poses scatter once mended; 1 where these drives do not tell."""
    before, after = regressed(given, robot), regressed(mended, robot)
    if before is None or after is None:
        return 1.0
    return before.moving.scatter / after.moving.scatter


def _turns_in_degrees(records: Sequence[SetUpRecord], robot: Robot) -> bool:
    """Whether headings that never wrap turn as a robot does only if they are in degrees.

    By the wheels alone that is the same as a radius over base that is off by 57.3. So in degrees
    they must also agree better with the robot file.
    """
    turned = np.concatenate([np.abs(wrap_all(np.diff(each.yaw))) for each in records])
    lasted = np.concatenate([np.diff(each.seen) for each in records])
    if not np.nansum(turned**2 / lasted) > rules.FASTEST_TURN * np.nansum(turned):
        return False
    # Turns that are 57 times too large look like those of a robot that is turned by hand.
    mended = [replace(each.in_degrees(), not_driven=()) for each in records]
    lag, _ = lag_of(mended)
    cuts = cut([each.delayed(lag) for each in mended], robot, "heading")
    fit = turning(cuts, with_bias=True) if cuts.count >= rules.FEWEST_CUTS else None
    if fit is None:
        return False
    ratio = math.sqrt(abs(fit.left * fit.right)) * effective_track(robot)
    return ratio > 1.0 / math.sqrt(math.degrees(1.0))


def search_poses(
    records: Sequence[SetUpRecord], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """Findings, and the measured sizes; None where these are not determined."""
    fit = regressed(records, robot)
    if fit is None or not fit.is_sure:
        return [], None
    track = effective_track(robot)
    half_base = fit.moving.half_base
    estimate = SetUpEstimate(
        fit.turning.left,
        fit.turning.right,
        2.0 * abs(half_base),
        -cmath.phase(half_base),
        fit.moving.arm,
        ratio_of_ticks(robot),
    )
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)
    misfit = partial(fit.misfit, track=track)
    # On one circle, sizes that are all far off cancel: each is needed beside the others.
    if misfit(AS_ENTERED) < rules.WIDE * misfit(setting):
        return [], None
    found = findings_of(setting, ways, misfit)
    # The robot file's lever arm was undone in its own axes: where these are turned, a part is left.
    view = mount_of(robot)
    undone = (1.0 - cmath.exp(1j * setting.wired.yaw)) * complex(view.ahead, view.left)
    found += arm_finding(setting, misfit, setting.base * track, undone)
    return found, setting if found else None
