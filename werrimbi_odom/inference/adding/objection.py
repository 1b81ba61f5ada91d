# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Why an effect should not be added."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.adding.start import is_of_set_up
from werrimbi_odom.inference.adding.values import FittedParameter
from werrimbi_odom.inference.diagnosis.holdout import Sides
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.rules import HELD_OUT_FALL, SURE_WHEN_ASKED
from werrimbi_odom.inference.set_up.mistakes import SetUp
from werrimbi_odom.model.effect import Effect


class Worth(NamedTuple):
    """What an effect is worth beside all others that are added."""

    kept: Sides
    """Held-out position error with the given file, and with everything [m]."""
    alone: float
    """The same with everything but the effect."""
    chance: float | None
    """None where it is not tested."""
    held: bool
    """Whether the file held it before."""
    others: tuple[str, ...]
    """What else was asked for."""


def objection(
    effect: Effect, parameters: Mapping[str, FittedParameter], worth: Worth, set_up: SetUp
) -> str | None:
    """Why the effect should not be added, in a line; None where nothing speaks against it."""
    name = effect.name
    before, after = worth.kept.before, worth.kept.after
    unit = worth.kept.unit
    figures = f"{_told(before, unit)} before, {_told(after, unit)} after"
    hint = ""
    if set_up.findings and not is_of_set_up(effect, set_up):
        hint = f"; look at {set_up.findings[0].effect} first ({set_up.findings[0].words})"
    for key, item in parameters.items():
        if item.remark == "bound":
            return (
                f"{name} would need {key} = {item.value:g}{_in(item)}, the limit of what is "
                f"physically possible; so it is not that effect{hint}"
            )
    if not np.isfinite(after):
        return f"{name} cannot be judged: the held-out drives have no leg that was measured"
    if not after < before * (1.0 - HELD_OUT_FALL):
        return f"{name} does not lower the error of the held-out drives ({figures}){hint}"
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
    if not worth.held and not worth.alone * (1.0 - HELD_OUT_FALL) > after:
        rest = " and ".join(["calibration", *worth.others]) if worth.others else "calibration alone"
        verb = "leave" if worth.others else "leaves"
        return (
            f"{name} does not lower the error of the held-out drives: {rest} {verb} "
            f"{_told(worth.alone, unit)}, with the effect it is {_told(after, unit)}{hint}"
        )
    return _by_chance(name, worth)


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
