# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Law of a spot on the floor: a share of the travel that is lost or gained there."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence, certainty_of_places, place_of
from werrimbi_odom.inference.drafting.law_forms import Declared, Form
from werrimbi_odom.inference.drafting.variable_source import rounded


def spot_of(cell: Dependence, track: float) -> Form:
    """A circle around the place on the floor where the errors are."""
    x, y = place_of(cell)
    places = [(x + off, y + off) for off in (-rules.SPOT_OFF, 0.0, rules.SPOT_OFF)]
    size = rounded(float(cell.coefficients[np.argmax(certainty_of_places(cell))]))
    return spot_form(places, rules.SPOT_RADII, size, 0.5 * track)


def spot_form(
    places: Sequence[tuple[float, float]], radii: Sequence[float], size: float, half: float
) -> Form:
    """A share on a circular spot of the floor."""
    xs = tuple(dict.fromkeys(round(place[0], 3) for place in places))
    ys = tuple(dict.fromkeys(round(place[1], 3) for place in places))
    return Form(
        "spot",
        (
            Declared("share", "", 0.0, size, (-0.9, 0.9), "gained on the spot; lost if negative"),
            _middle("x", "centre of the spot, in the reference's frame", xs),
            _middle("y", "the same, across", ys),
            Declared("radius", "m", 0.5, 0.5, (0.02, 50.0), "of the spot", tries=tuple(radii)),
        ),
        lambda side: (
            "share * share_inside(*standing(drive, "
            f"{'HALF' if side == 'left' else '-HALF'}), x, y, radius)"
        ),
        "travel *= 1 + share, where the wheel stands inside the circle",
        4,
        (f"HALF = {half:.4g}  # m, from the axle's midpoint to a wheel",),
    )


def _middle(name: str, says: str, tries: tuple[float, ...]) -> Declared:
    """A coordinate of its centre: anywhere, on a map too."""
    low, high = min(0.0, *tries) - rules.SPOT_FAR, max(0.0, *tries) + rules.SPOT_FAR
    bounds = (math.floor(low), math.ceil(high))
    return Declared(name, "m", 0.5, 0.5, bounds, says, tries=tries, digits=12)
