# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether what is left is the wheels' alone: then it is the robot's, and no reference's.

Errors that are alike for seconds, and follow no law on which the parts of the drives agree, may be
those of a reference that wanders. But its errors along the path and in heading have nothing to do
with one another, and so are put down to both wheels alike: the covariance of the two is that of the
wheels' variances, (k_R² - k_L²) / 2 a metre over the base. Nor are they alike along the path alone,
as those of a wheel are whose radius changes: a reference does not know where the robot heads.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.uncertainty import noises_of
from werrimbi_odom.inference.diagnosis.what_is_left import lasts_along_alone
from werrimbi_odom.inference.distributions import NORMAL_95
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.noise import NoiseEstimate


@dataclass(frozen=True, slots=True)
class OneSidedNoise:
    """Errors of wheels [m^0.5] that are no noise of two wheels of one robot."""

    side: Literal["left", "right", "both"]
    """Wheel that errs more; "both" where neither surely does."""
    left: NoiseEstimate
    right: NoiseEstimate
    along: float | None
    """By how much more the variance of errors along the path grows from a leg to some seconds than
    that of errors to the side; None where it does not, but for chance."""

    @property
    def times(self) -> float:
        """Noise of that wheel, in those of the other."""
        ratio = self.left.value / self.right.value
        return 1.0 / ratio if self.side == "right" else ratio


def one_sided_noise(runs: Concatenated, fit: Fitted) -> OneSidedNoise | None:
    """The noise of the wheels of a fit, if it is none of two of one robot; else None.

    One errs too much more than the other; or what they err lasts from leg to leg, where the
    reference is absolute: one of another kind may err along the path, by its metre.
    """
    told = noises_of(runs, fit)
    left, right = (told[f"{side}_wheel_noise"] for side in ("left", "right"))
    surely = 0.0
    if left.determined and right.determined:
        apart = float(np.log(left.value / right.value))
        unsure = NORMAL_95 * float(np.hypot(left.share, right.share))
        surely = float(np.sign(apart)) * max(abs(apart) - unsure, 0.0)
    absolute = fit.point.options.reference_kind == "absolute"
    along = lasts_along_alone(runs, fit.point) if absolute else None
    if abs(surely) < np.log(rules.UNLIKE_WHEELS) and along is None:
        return None
    side: Literal["left", "right", "both"] = "left" if surely > 0.0 else "right"
    if abs(surely) < np.log(rules.PAIR_OF_WHEELS):
        side = "both"
    return OneSidedNoise(side, left, right, along)
