# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A model with one more effect, and what speaks for it and against."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.adding.values import FittedParameter
from werrimbi_odom.inference.comparison.consistency import AtLength, Consistency, of_all
from werrimbi_odom.inference.comparison.judged_legs import Legs, statistics_of
from werrimbi_odom.inference.comparison.legs import LegStatistics
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.holdout import Sides
from werrimbi_odom.inference.fitting.noise import NoiseEstimate
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.set_up.mistakes import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

UNUSUAL = 25.0
"""Times the median variance, beyond which a leg's promise says nothing about noise."""


@dataclass(frozen=True)
class Side:
    """One set of drives, judged with three models."""

    before: Legs
    """With the robot as given."""
    calibrated: Legs
    """With everything fitted but the effect."""
    after: Legs

    def figures(self, which: str) -> LegStatistics:
        """Over legs on which the reference did not jump, the median over all."""
        return statistics_of(getattr(self, which))

    @property
    def sides(self) -> Sides:
        """Position error before and after [m]."""
        before, after = self.figures("before"), self.figures("after")
        return Sides(before.rmse_position_m, after.rmse_position_m)

    @property
    def floor(self) -> float:
        """Position error that the noise of the final model promises [m].

        Without the few legs that begin with a heading that nobody knows yet.
        """
        errors = self.after.errors.chosen(~self.after.outlier)
        measured = np.isfinite(errors.error[:, 0])
        promised = errors.covariance[measured, 0, 0] + errors.covariance[measured, 1, 1]
        if promised.size == 0:
            return float("nan")
        usual = promised <= UNUSUAL * np.median(promised)
        return float(np.sqrt(np.mean(promised[usual])))


@dataclass(frozen=True)
class Added:
    """A model with one more effect, and what speaks for it."""

    effect: Effect
    parameters: dict[str, FittedParameter]
    also: tuple[str, ...]
    """Set-up mistakes that were put right with it."""
    given: Robot
    robot: Robot
    """To be written."""
    multiplier_stds: dict[str, float]
    train: Side
    holdout: Side
    set_aside: tuple[str, ...]
    """Names of the runs that were put aside for judging; empty where some were given for it."""
    written_from_all: bool
    """Whether the written values were fitted on all runs, those put aside too."""
    noises: dict[str, NoiseEstimate]
    noise_written: bool
    remaining: tuple[Dependence, ...]
    """What the errors still depend on beyond chance."""
    set_up: SetUp
    per_run: tuple[str, ...]
    """Parameters that each run has anew; the file leaves them out."""
    p_value: float
    """Of as much of a better fit by chance, against calibration alone."""
    objection: str | None
    """Why it should not be added; None: nothing speaks against it."""
    left_out: tuple[LeftOut, ...] = ()
    """Stretches of all runs that none of it is about."""
    lengths: tuple[AtLength, ...] = ()
    """What the held-out legs of each length say of its covariance."""

    @property
    def covariance(self) -> Consistency:
        """Whether the final model's is honest on the held-out drives."""
        return of_all(self.lengths)
