# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A model with more effects, and what speaks for each and against."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.consistency import Consistency
from werrimbi_odom.inference.comparison.judged_legs import Legs, statistics_of
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.inference.comparison.verdict import Verdict, verdict_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.held_law import Misfit
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides, Unit, error_of, sides_of
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.fitting.noise import NoiseEstimate
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.rules import UNUSUAL_PROMISE
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

WHEEL_NOISES = ("left_wheel_noise", "right_wheel_noise")


@dataclass(frozen=True)
class Side:
    """One set of drives, judged with three models."""

    before: Legs
    """With the robot as given."""
    calibrated: Legs
    """With everything fitted but the effects."""
    after: Legs

    def figures(self, which: str) -> LegStatistics:
        """Over legs on which the reference did not jump, the median over all."""
        return statistics_of(getattr(self, which))

    @property
    def unit(self) -> Unit:
        """Radians where headings alone were measured, and errors are those of the heading."""
        return "m" if np.isfinite(self.after.errors.error[:, 0]).any() else "rad"

    def error(self, which: str) -> float:
        """Root mean square error over legs, of positions, or where there are none of headings."""
        return error_of(getattr(self, which), self.unit)

    @property
    def sides(self) -> Sides:
        """Error before and after."""
        return sides_of(self.before, self.after, self.unit)

    @property
    def promised(self) -> float:
        """The error that the covariance of the final model promises, in the same unit.

        Without the few legs that begin with a heading that nobody knows yet. It is the noise's
        alone where the model explains the drives (`Added.noise_alone`).
        """
        errors = self.after.errors.chosen(~self.after.outlier)
        if self.unit == "rad":
            promised = errors.covariance[np.isfinite(errors.error[:, 2]), 2, 2]
        else:
            measured = np.isfinite(errors.error[:, 0])
            promised = errors.covariance[measured, 0, 0] + errors.covariance[measured, 1, 1]
        if promised.size == 0:
            return float("nan")
        usual = promised <= UNUSUAL_PROMISE * np.median(promised)
        return float(np.sqrt(np.mean(promised[usual])))


@dataclass(frozen=True, kw_only=True)
class Added:
    """A model with more effects, fitted together, and what speaks for each."""

    effects: tuple[Effect, ...]
    """As they were asked for."""
    fitted: Mapping[str, Mapping[str, FittedParameter]]
    """Parameters by effect."""
    also: tuple[str, ...]
    """Set-up mistakes that were put right with them."""
    given: Robot
    robot: Robot
    """To be written."""
    multiplier_stds: Mapping[str, float | None]
    """None where the multiplier stayed as the given file has it."""
    train: Side
    holdout: Side
    without: Mapping[str, float]
    """Position error of the held-out drives without one of several effects [m]."""
    set_aside: tuple[str, ...]
    """Names of the runs of which parts were put aside for judging; empty where some were given."""
    written_from_all: bool
    """Whether the written values were fitted on all runs, those put aside too."""
    noises: Mapping[str, NoiseEstimate]
    explained: bool
    """Whether the errors go with nothing more, and the wheels' noise is some: then it is written,
    and what the covariance promises is noise."""
    remaining: tuple[Dependence, ...]
    """What the errors still depend on beyond chance."""
    misfit: Misfit | None
    """The law that does not fit fully, where that is what is left."""
    set_up: SetUp
    per_run: tuple[str, ...]
    """Parameters that each run has anew; the file leaves them out."""
    chances: Mapping[str, float | None]
    """How often chance would make the fit as much better as an effect does, the others being there;
    None for calibration and for mistakes, which are not tested so."""
    objections: Mapping[str, str]
    """By effect, why it should not be added; empty where nothing speaks against any."""
    left_out: tuple[LeftOut, ...]
    """Stretches of all runs that none of it is about."""
    happened: Events
    """What no law explains, for it happened at an instant; left out of the fits."""
    compared: Comparison
    """The robot as it is written over the held-out drives, or all where none were given: what
    `compare` of that file says."""

    @property
    def changes(self) -> dict[str, float]:
        """Parameters of the robot file to be written: sizes, and noise where it is some."""
        names = [*MULTIPLIERS]
        if self.explained:
            names += [name for name in WHEEL_NOISES if self.noises[name].determined]
        return {name: float(getattr(self.robot, name)) for name in names}

    @property
    def verdict(self) -> Verdict:
        """What `compare` says of the written file."""
        return verdict_of(self.compared)

    @property
    def covariance(self) -> Consistency:
        """Whether the written file's is honest, by `compare`."""
        return self.verdict.covariance

    @property
    def name(self) -> str:
        """Of the effects, as on the command line."""
        return ",".join(effect.name for effect in self.effects)

    @property
    def parameters(self) -> dict[str, FittedParameter]:
        """All of them: by NAME where one effect was added, else by EFFECT.NAME."""
        if len(self.effects) == 1:
            return dict(self.fitted[self.effects[0].name])
        return {
            f"{effect}.{name}": item
            for effect, items in self.fitted.items()
            for name, item in items.items()
        }

    @property
    def objection(self) -> str | None:
        """All that speaks against them, in a line."""
        return "; ".join(self.objections.values()) or None

    @property
    def is_calibration(self) -> bool:
        """Whether nothing but sizes was asked for."""
        return all(effect.name in CALIBRATED for effect in self.effects)

    def noise_alone(self, side: Side) -> float:
        """Position error that noise alone leaves [m]; NaN while something is still missing."""
        return side.promised if self.explained else float("nan")
