# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the workbench was started with, read and cut into legs once, shared by all who look."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from werrimbi_odom.files.asked import Judging
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import Comparison, judged
from werrimbi_odom.inference.comparison.judged_legs import Prepared
from werrimbi_odom.inference.comparison.verdict import Verdict, verdict_of
from werrimbi_odom.inference.diagnosis.holdout import judge_of
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.model.robot import Robot

Show = Callable[[float, str], None]


@dataclass(frozen=True, eq=False)
class Given:
    """What was given: enough to open it again in another process, to the same legs."""

    robot: Robot
    runs: tuple[Run, ...]
    holdout: tuple[Run, ...]
    judging: Judging
    effect_files: tuple[Path, ...]


@dataclass(frozen=True, eq=False)
class Drives:
    """Drives cut into legs, by the travel of the robot as given."""

    prepared: Prepared

    def compared(self, robot: Robot, show: Show = lambda share, words: None) -> Comparison:
        """How a robot does on these drives."""
        return judged(self.prepared, robot, show=show)


@dataclass(frozen=True, eq=False)
class Look:
    """A robot over all drives, cut into the same legs as every other robot."""

    robot: Robot
    train: Comparison
    holdout: Comparison
    verdict: Verdict
    """On the fitted drives."""
    holdout_verdict: Verdict

    @property
    def holdout_error(self) -> float:
        """Position error of the held-out legs, rms; NaN where no position was measured [m]."""
        return self.holdout.main.all.figures.rmse_position_m

    @property
    def train_error(self) -> float:
        """The same of the drives that are fitted [m]."""
        return self.train.main.all.figures.rmse_position_m


@dataclass(frozen=True, eq=False)
class Opened:
    """Drives to learn from, drives to judge on, and how they are to be read."""

    given: Given
    train: Drives
    holdout: Drives
    judged_on: tuple[str, ...]
    """Names of the held-out drives, given or put aside."""

    def look(self, robot: Robot, show: Show = lambda share, words: None) -> Look:
        """Compare a robot on all drives."""
        train = self.train.compared(robot, lambda share, words: show(0.6 * share, words))
        show(0.6, "held-out drives")
        holdout = self.holdout.compared(robot)
        return Look(robot, train, holdout, verdict_of(train), verdict_of(holdout))


def opened(given: Given) -> Opened:
    """Match and cut everything.

    Raises
    ------
    InputError
        When a run has no usable reference or no ticks.
    """
    robot, judging = given.robot, given.judging
    runs, holdout = (given.runs, given.holdout) if given.holdout else set_aside(given.runs)
    judge = judge_of(runs, holdout, robot, **judging)
    return Opened(
        given,
        Drives(judge.train),
        Drives(judge.holdout),
        tuple(run.name for run in judge.kept_back),
    )
