# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A model with added effects, and the evidence for and against each of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter, Moved
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.consistency import Consistency
from werrimbi_odom.inference.comparison.judged_legs import Legs, statistics_of
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.inference.comparison.verdict import Verdict, verdict_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.misfit import Misfit
from werrimbi_odom.inference.diagnosis.paired_comparison import (
    Sides,
    Unit,
    error_of,
    promised_of,
    promised_variances,
    sides_of,
)
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.noise import NoiseEstimate
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

WHEEL_NOISES = ("left_wheel_noise", "right_wheel_noise")


@dataclass(frozen=True)
class JudgedSide:
    """One set of drives, judged with three models."""

    before: Legs
    """Legs with the robot as given."""
    calibrated: Legs
    """Legs with everything fitted but the effects."""
    after: Legs
    promising: Legs
    """`after`, with the wander of the reference as that model leaves it, where one wanders."""

    def figures(self, which: str) -> LegStatistics:
        """Statistics of the legs without jumps of the reference; the median is of all legs."""
        return statistics_of(getattr(self, which))

    @property
    def unit(self) -> Unit:
        """Radians where only headings were measured."""
        return "m" if np.isfinite(self.after.errors.error[:, 0]).any() else "rad"

    def error(self, which: str) -> float:
        """Root mean square error of legs: of positions, or of headings without positions."""
        return error_of(getattr(self, which), self.unit)

    @property
    def sides(self) -> Sides:
        """Error before and after."""
        return sides_of(self.before, self.after, self.unit)

    @property
    def promised(self) -> float:
        """Root mean square error that the covariance of the final model predicts, in the same unit.

        It is the error by noise alone if the model explains the drives (`Added.noise_alone`).
        """
        return promised_of(self.promising, self.unit)

    @property
    def of_few_legs(self) -> tuple[int, int]:
        """Legs that hold half of the predicted squared error, the fewest that do, and all legs."""
        shares = np.cumsum(np.sort(promised_variances(self.promising, self.unit))[::-1])
        half = int(np.searchsorted(shares, 0.5 * shares[-1])) + 1 if shares.size else 0
        return half, shares.size


@dataclass(frozen=True, kw_only=True)
class Added:
    """A model with added effects, fitted together, and the evidence for each."""

    effects: tuple[Effect, ...]
    """In the order of the request."""
    fitted: Mapping[str, Mapping[str, FittedParameter]]
    """Fitted parameters of each effect."""
    moved: tuple[Moved, ...]
    """Values of effects that the given file held already, which moved by more than their ±."""
    also: tuple[str, ...]
    """Set-up mistakes that were corrected with them."""
    given: Robot
    robot: Robot
    """The robot to write."""
    multiplier_stds: Mapping[str, float | None]
    """None where the multiplier is as in the given file."""
    ratio_std: float
    """Relative standard deviation of the ratio of the radii."""
    train: JudgedSide
    holdout: JudgedSide
    without: Mapping[str, float]
    """Position error of the held-out drives without one of several effects [m]."""
    set_aside: tuple[str, ...]
    """Names of the runs of which parts were held out; empty where held-out drives were given."""
    written_from_all: bool
    """Whether the written values were fitted on all runs, including the held-out parts."""
    noises: Mapping[str, NoiseEstimate]
    explained: bool
    """Whether the errors depend on nothing more and the wheels' noise is plausible. Then the noise
    is written, and the predicted covariance is that of noise."""
    remaining: tuple[Dependence, ...]
    """Significant dependences that remain."""
    misfit: Misfit | None
    """The law of slightly wrong form, if that is what remains."""
    ahead_or_behind: bool
    """Whether the measured point may as well lie on the other side of the axle."""
    set_up: SetUp
    per_run: tuple[str, ...]
    """Per-run parameters; the file leaves them out."""
    chances: Mapping[str, float | None]
    """P-value of each effect's gain, with the others in the model; None for calibration and for
    mistakes, which are not tested so."""
    objections: Mapping[str, str]
    """Why an effect should not be added, by its name; empty if nothing speaks against any."""
    left_out: tuple[LeftOut, ...]
    """Stretches of all runs that are excluded."""
    happened: Events
    """Abrupt errors, which no law explains; left out of the fits."""
    compared: Comparison
    """Comparison of the written robot on the held-out drives, or on all if none were given: the
    result of `compare` with that file."""

    @property
    def changes(self) -> dict[str, float]:
        """Parameters of the robot file to write: sizes, and noise where it is determined."""
        names = [*MULTIPLIERS]
        if self.explained:
            names += [name for name in WHEEL_NOISES if self.noises[name].determined]
        return {name: float(getattr(self.robot, name)) for name in names}

    @property
    def verdict(self) -> Verdict:
        """Verdict of `compare` on the written file."""
        return verdict_of(self.compared)

    @property
    def covariance(self) -> Consistency:
        """Whether the covariance of the written file is consistent, by `compare`."""
        return self.verdict.covariance

    @property
    def name(self) -> str:
        """Names of the effects, as on the command line."""
        return ",".join(effect.name for effect in self.effects)

    @property
    def parameters(self) -> dict[str, FittedParameter]:
        """All parameters: by NAME if one effect was added, else by EFFECT.NAME."""
        if len(self.effects) == 1:
            return dict(self.fitted[self.effects[0].name])
        return {
            f"{effect}.{name}": item
            for effect, items in self.fitted.items()
            for name, item in items.items()
        }

    @property
    def objection(self) -> str | None:
        """All objections, in one line."""
        return "; ".join(self.objections.values()) or None

    @property
    def is_calibration(self) -> bool:
        """Whether only sizes were asked for."""
        return all(effect.name in CALIBRATED for effect in self.effects)

    def noise_alone(self, side: JudgedSide) -> float:
        """Position error by noise alone [m]; NaN while an effect is still missing."""
        return side.promised if self.explained else float("nan")
