# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether what is left is put down to one wheel: then it is the robot's, and no reference's.

Errors that are alike for seconds, and follow no law on which the parts of the drives agree, may be
those of a reference that wanders. But its errors along the path and in heading have nothing to do
with one another, and so are put down to both wheels alike: the covariance of the two is that of the
wheels' variances, (k_R² - k_L²) / 2 a metre over the base.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.uncertainty import noises_of
from werrimbi_odom.inference.distributions import NORMAL_95
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.noise import NoiseEstimate


@dataclass(frozen=True, slots=True)
class OneSidedNoise:
    """Fitted noise of wheels that are too unlike to be two of one robot [m^0.5]."""

    side: Literal["left", "right"]
    """Wheel that errs more."""
    left: NoiseEstimate
    right: NoiseEstimate

    @property
    def times(self) -> float:
        """Noise of that wheel, in those of the other."""
        ratio = self.left.value / self.right.value
        return ratio if self.side == "left" else 1.0 / ratio


def one_sided_noise(runs: Concatenated, fit: Fitted) -> OneSidedNoise | None:
    """The noise of the wheels of a fit, if one errs too much more than the other; else None."""
    told = noises_of(runs, fit)
    left, right = (told[f"{side}_wheel_noise"] for side in ("left", "right"))
    if not (left.determined and right.determined):
        return None
    apart = float(np.log(left.value / right.value))
    unsure = NORMAL_95 * float(np.hypot(left.share, right.share))
    if abs(apart) - unsure < np.log(rules.UNLIKE_WHEELS):
        return None
    return OneSidedNoise("left" if apart > 0.0 else "right", left, right)
