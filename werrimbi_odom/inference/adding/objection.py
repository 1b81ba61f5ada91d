# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The evidence for each effect of a joint fit, and the objections to it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.added import JudgedSide
from werrimbi_odom.inference.adding.fits import Fits
from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter, parameters_of
from werrimbi_odom.inference.adding.start_values import FitDrives, is_of_set_up
from werrimbi_odom.inference.diagnosis.cross_validation import holds_when_cross_validated
from werrimbi_odom.inference.diagnosis.p_values import chance
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides, sides_of
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
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
        return chi2_survival(away**2, 1) < rules.SURE_WHEN_ASKED

    def _without(self, effect: Effect) -> Fitted:
        return self.fits.without.get(effect.name, self.fits.none)


class Worth(NamedTuple):
    """The evidence for an effect beside all others that are added."""

    kept: Sides
    """Held-out error with the given file, and with everything."""
    alone: Sides | None
    """Held-out error with everything but the effect, and with everything; None if it is not tested:
    for a mistake that was corrected with others."""
    asked_for: bool
    """Whether the fitted drives need it by cross-validation, even if the held-out ones do not show
    it."""
    chance: float | None
    """P-value; None if it is not tested."""
    held: bool
    """Whether the file had it before."""
    others: tuple[str, ...]
    """The other effects that were asked for."""


def objection(
    effect: Effect, parameters: Mapping[str, FittedParameter], worth: Worth, set_up: SetUp
) -> str | None:
    """Why the effect should not be added, in one line; None if nothing speaks against it."""
    name = effect.name
    after, unit = worth.kept.after, worth.kept.unit
    figures = f"{_told(worth.kept.before, unit)} before, {_told(after, unit)} after"
    hint = ""
    if set_up.findings and not is_of_set_up(effect, set_up):
        hint = f"; look at {set_up.findings[0].effect} first ({set_up.findings[0].words})"
    for key, item in parameters.items():
        if item.remark == "bound":
            value = f"{item.value:g} {item.declared.unit}".rstrip()
            return (
                f"{name} would need {key} = {value}, the limit of what is physically possible; so "
                f"it is not that effect{hint}"
            )
    if not (np.isfinite(after) or worth.asked_for):
        return f"{name} cannot be judged: the held-out drives have no leg that was measured"
    if (against := _not_lower(worth.kept, worth)) is not None:
        return f"{name} does not lower the error of the held-out drives ({figures}){against}{hint}"
    if name in CALIBRATED or not parameters:
        shown = [item for item in parameters.values() if item.std is not None]
        if shown and not shown[0].significant:
            value = f"{shown[0].value:.5g} ± {shown[0].std:.1g}"
            rest = " and ".join(["the rest of the calibration", *worth.others])
            return (
                f"{name} is as the robot file says ({value}): what lowers the error of the "
                f"held-out drives ({figures}) is {rest}{hint}"
            )
        return _by_chance(name, worth)
    alone = worth.alone
    if not worth.held and alone is not None and (against := _not_lower(alone, worth)) is not None:
        rest = " and ".join(["calibration", *worth.others]) if worth.others else "calibration alone"
        verb = "leave" if worth.others else "leaves"
        errors = f"{_told(alone.before, unit)}, with the effect it is {_told(after, unit)}"
        return (
            f"{name} does not lower the error of the held-out drives: {rest} {verb} "
            f"{errors}{against}{hint}"
        )
    return _by_chance(name, worth)


def _not_lower(sides: Sides, worth: Worth) -> str | None:
    """Objection to an error that did not fall; None if there is none.

    A rise that is not significant is no evidence against an effect that these drives hardly excite.
    Then the fitted drives decide, by cross-validation, as in a diagnosis.
    """
    if sides.rose:
        return ", and chance does not raise it so"
    if sides.fell or worth.asked_for:
        return None
    return ", and the fitted drives do not ask for it either"


def _told(error: float, unit: str) -> str:
    return f"{1e3 * error:.3g} mm" if unit == "m" else f"{math.degrees(error):.3g}°"


def _by_chance(name: str, worth: Worth) -> str | None:
    if worth.held or worth.chance is None or worth.chance <= rules.SURE_WHEN_ASKED:
        return None
    return (
        f"the drives do not show {name}: chance alone would make the fit as much better "
        f"in {100.0 * worth.chance:.2g} % of cases"
    )
