# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect that the library does not hold, for drafts to find."""

from __future__ import annotations

from typing import Any

from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(
    channels=("load_kg",),
    softness=Parameter("", 0.0, 2e-3, (-0.1, 0.1), "relative loss of radius per kilogram"),
)
def soft_tyres(travel: Any, drive: Any, softness: float) -> Any:
    """Tyres give way under a load.

    Formula    travel *= 1 - softness * load      [m]
    Signature  distances shrink with the load
    Ruler      load it, and measure the axle's height
    """
    kept = 1.0 - softness * drive.channels["load_kg"].mean
    return WheelTravel(travel.left * kept, travel.right * kept)
