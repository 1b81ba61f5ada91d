# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The input of the workbench, read and cut into legs once, shared by all tabs."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from werrimbi_odom.api.compare_diagnose_add import compared
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.comparison.verdict import Verdict, verdict_of
from werrimbi_odom.inference.diagnosis.holdout import judge_of
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent


def error_of(figures: LegStatistics) -> tuple[float, str]:
    """RMSE of legs and its unit: of positions [m], or of headings [rad] without any."""
    if math.isfinite(figures.rmse_position_m):
        return figures.rmse_position_m, "m"
    return figures.rmse_yaw_rad, "rad"


@dataclass(frozen=True, eq=False)
class Look:
    """Comparison of a robot on all drives, over the same legs as every other robot."""

    robot: Robot
    train: Comparison
    holdout: Comparison
    verdict: Verdict
    """Verdict on the fitted drives."""
    holdout_verdict: Verdict

    @property
    def unit(self) -> str:
        """Unit of both errors: m of positions, or rad of headings, if only these were measured."""
        return error_of(self.holdout.main.all.figures)[1]

    @property
    def holdout_error(self) -> float:
        """RMSE of the held-out legs, in `unit`."""
        return error_of(self.holdout.main.all.figures)[0]

    @property
    def train_error(self) -> float:
        """RMSE of the fitted legs, in `unit`."""
        return error_of(self.train.main.all.figures)[0]


@dataclass(frozen=True, eq=False)
class Opened:
    """Drives for fitting, held-out drives, and how they are read."""

    given: Recordings
    """As given; sufficient to open them in another process with the same legs."""
    train: PreparedRuns
    """Fitted drives, cut into legs by the travel of the robot as given."""
    holdout: PreparedRuns
    judged_on: tuple[str, ...]
    """Names of the held-out drives, given or split off."""

    def look(self, robot: Robot, show: Show = silent) -> Look:
        """Compare a robot on all drives."""
        given = replace(self.given, fitted=robot)
        train = compared(given, lambda share, words: show(0.6 * share, words), over=self.train)
        show(0.6, "held-out drives")
        holdout = compared(given, over=self.holdout)
        return Look(
            robot, train.found, holdout.found, verdict_of(train.found), verdict_of(holdout.found)
        )


def opened(given: Recordings) -> Opened:
    """Match and cut all drives; InputError if a run has no usable reference or no ticks."""
    both = split(given)
    judge = judge_of(both.runs, both.holdout, given.robot, given.evaluation)
    names = tuple(run.name for run in judge.kept_back)
    return Opened(given, judge.train, judge.holdout, names)


def split(given: Recordings) -> Recordings:
    """With held-out runs: those given, or parts of all runs."""
    if given.holdout:
        return given
    runs, holdout = set_aside(given.runs)
    return replace(given, runs=runs, holdout=holdout)
