# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The search where poses were measured: two regressions tell everything."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.comparison.reference_noise import Measure
from werrimbi_odom.inference.set_up.explanation import (
    AS_ENTERED,
    Estimate,
    Setting,
    setting_of,
    wirings,
)
from werrimbi_odom.inference.set_up.findings import SetUpFinding, arm_finding, findings_of
from werrimbi_odom.inference.set_up.records import Cuts, Record, cut, effective_track
from werrimbi_odom.inference.set_up.regression import Moving, Turning, errors, moving, turning
from werrimbi_odom.model.robot import Robot

FEWEST = 20
"""Cuts that a regression is trusted with."""

SURE = 8.0
"""Standard deviations that a wheel's or the base's size must lie from zero to be one."""


@dataclass(frozen=True, slots=True)
class Regressed:
    """Both regressions of a session."""

    cuts: Cuts
    turning: Turning
    moving: Moving

    @property
    def is_sure(self) -> bool:
        """Whether both wheels and the base are told."""
        turn, move = self.turning, self.moving
        return (
            abs(turn.left) > SURE * turn.left_std
            and abs(turn.right) > SURE * turn.right_std
            and abs(move.half_base) > SURE * move.half_base_std
        )

    def misfit(self, setting: Setting, track: float) -> float:
        """Typical error of a cut, in units of the scatter of the best fit."""
        move, turn = errors(self.cuts, *setting.numbers(track))
        known = np.isfinite(move) & np.isfinite(turn)
        square = np.abs(move / self.moving.scatter) ** 2
        square += np.abs(turn / self.turning.scatter) ** 2
        return float(np.exp(0.5 * np.mean(np.log1p(square[known]))))

    def share(self) -> float:
        """Scatter left, of what there is to explain: small where both fits are good."""
        moved = float(np.nanmedian(np.abs(self.cuts.move)))
        turned = float(np.nanmedian(np.abs(self.cuts.turn)))
        return math.hypot(
            self.moving.scatter / (moved + 1e-12), self.turning.scatter / (turned + 1e-12)
        )


def regressed(records: Sequence[Record], robot: Robot) -> Regressed | None:
    """Both regressions; None where the drives do not tell."""
    cuts = cut(records, robot, "pose")
    if cuts.count < FEWEST:
        return None
    turn = turning(cuts)
    move = None if turn is None else moving(cuts, turn.left, turn.right)
    return None if turn is None or move is None else Regressed(cuts, turn, move)


def degrees_gain(records: Sequence[Record], robot: Robot, measured: Measure) -> float:
    """How many times better the reference's yaw fits as degrees; 1 where it does not."""
    yaw = np.concatenate([each.yaw[np.isfinite(each.yaw)] for each in records])
    if measured == "position" or yaw.size == 0 or np.ptp(yaw) < 2.1 * math.pi:
        return 1.0
    if measured == "heading":
        # Where it was wrapped, it was wrapped at a whole turn.
        jumps = np.concatenate([np.abs(np.diff(each.yaw)) for each in records])
        wrapped = int(np.sum((jumps > 300.0) & (jumps < 361.0)))
        return math.inf if wrapped > np.sum((jumps > 4.0) & (jumps < 7.0)) else 1.0
    radians = regressed(records, robot)
    degrees = regressed([each.in_degrees() for each in records], robot)
    if degrees is None or radians is None:
        return 1.0
    gain = radians.moving.scatter / degrees.moving.scatter
    return gain if gain > 2.0 else 1.0


def search_poses(
    records: Sequence[Record], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """What is wrong, and the sizes that were measured; None where they were not."""
    fit = regressed(records, robot)
    if fit is None or not fit.is_sure:
        return [], None
    track = effective_track(robot)
    half_base = fit.moving.half_base
    estimate = Estimate(
        fit.turning.left,
        fit.turning.right,
        2.0 * abs(half_base),
        -cmath.phase(half_base),
        fit.moving.arm,
    )
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(tried: Setting) -> float:
        return fit.misfit(tried, track)

    found = findings_of(setting, ways, misfit)
    found += arm_finding(setting, misfit, setting.base * track)
    if not found or misfit(AS_ENTERED) < misfit(setting):
        return [], None
    return found, setting
