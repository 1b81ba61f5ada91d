# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Objections to an effect: why it should not be added."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter
from werrimbi_odom.inference.adding.start_values import is_of_set_up
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.fitting.score_tests import CALIBRATED
from werrimbi_odom.inference.rules import SURE_WHEN_ASKED
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect


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
            return (
                f"{name} would need {key} = {item.value:g}{_in(item)}, the limit of what is "
                f"physically possible; so it is not that effect{hint}"
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
    if worth.held or worth.chance is None or worth.chance <= SURE_WHEN_ASKED:
        return None
    return (
        f"the drives do not show {name}: chance alone would make the fit as much better "
        f"in {100.0 * worth.chance:.2g} % of cases"
    )


def _in(item: FittedParameter) -> str:
    return f" {item.declared.unit}" if item.declared.unit else ""
