# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The evidence for each effect of a joint fit, and the objections to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from werrimbi_odom.inference.adding.added import JudgedSide
from werrimbi_odom.inference.adding.fits import Fits
from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter, parameters_of
from werrimbi_odom.inference.adding.objection import Worth, objection
from werrimbi_odom.inference.adding.start_values import FitDrives
from werrimbi_odom.inference.diagnosis.cross_validation import holds_when_cross_validated
from werrimbi_odom.inference.diagnosis.p_values import chance
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides, sides_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.score_tests import CALIBRATED
from werrimbi_odom.inference.rules import SURE_WHEN_ASKED
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True)
class Question:
    """Which of some effects should be added."""

    effects: tuple[Effect, ...]
    drives: FitDrives
    fits: Fits
    final: Fitted
    """The fit with all of them, with unneeded sizes reset."""
    given: Robot
    also: tuple[str, ...]
    """Set-up mistakes that are corrected together."""
    kept: JudgedSide
    """The held-out drives."""
    alone: Mapping[str, Sides]
    """Their error without one of several effects, and with all."""
    set_up: SetUp

    @property
    def chances(self) -> dict[str, float | None]:
        """P-value of each effect's gain; None for what is not judged by its fit alone."""
        return {effect.name: self._chance(effect) for effect in self.effects}

    @property
    def objections(self) -> dict[str, str]:
        """Why an effect should not be added, by its name; empty if nothing speaks against any."""
        against = {effect.name: self._objection(effect) for effect in self.effects}
        return {name: words for name, words in against.items() if words is not None}

    def _objection(self, effect: Effect) -> str | None:
        name, kept = effect.name, self.kept
        found = parameters_of(effect, self.final, self.given)
        without = sides_of(kept.calibrated, kept.after, kept.unit)
        worth = Worth(
            kept.sides,
            None if name in self.also else self.alone.get(name, without),
            self._asked_for(effect, found),
            self._chance(effect),
            any(item.name == name for item in self.given.effects),
            tuple(other.name for other in self.effects if other is not effect),
        )
        return objection(effect, found, worth, self.set_up)

    def _chance(self, effect: Effect) -> float | None:
        if effect.name in CALIBRATED or effect.name in self.also:
            return None
        return chance(self.fits.all, self._without(effect), 1)

    def _asked_for(self, effect: Effect, found: Mapping[str, FittedParameter]) -> bool:
        """Whether the fitted drives need the effect, by cross-validation as in a diagnosis.

        A size is in every fit, so for it the test is its deviation from the file's value.
        """
        if effect.name not in CALIBRATED:
            return holds_when_cross_validated(
                self.drives.laid, self._without(effect), self.fits.all
            )
        [size] = found.values()
        away = ((size.value or 0.0) - size.declared.null) / size.std if size.std else 0.0
        return chi2_survival(away**2, 1) < SURE_WHEN_ASKED

    def _without(self, effect: Effect) -> Fitted:
        return self.fits.without.get(effect.name, self.fits.none)
