# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The search where yaw alone was measured, by a gyro perhaps: signs, and radii over base.

Mount, lever arm, a factor common to base and radii, and which way is forwards do not show.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference.rules import FEWEST_CUTS, SURE_SIZE
from werrimbi_odom.inference.set_up.explanation import (
    Estimate,
    Setting,
    setting_of,
    wirings,
)
from werrimbi_odom.inference.set_up.findings import SetUpFinding, findings_of
from werrimbi_odom.inference.set_up.records import Record, cut, effective_track
from werrimbi_odom.inference.set_up.regression import swept, turning
from werrimbi_odom.model.pose import wrap_all
from werrimbi_odom.model.robot import Robot


def search_headings(
    records: Sequence[Record], robot: Robot
) -> tuple[list[SetUpFinding], Setting | None]:
    """What is wrong; sizes are not measured, so the second is always None."""
    cuts = cut(records, robot, "heading")
    fit = turning(cuts, with_bias=True) if cuts.count >= FEWEST_CUTS else None
    if fit is None:
        return [], None
    if abs(fit.left) < SURE_SIZE * fit.left_std or abs(fit.right) < SURE_SIZE * fit.right_std:
        return [], None
    track = effective_track(robot)
    estimate = Estimate(fit.left, fit.right, None, None)
    ways = wirings(estimate)
    setting = setting_of(estimate, ways[0], track)

    def misfit(tried: Setting) -> float:
        left, right, _, _ = tried.numbers(track)
        off = wrap_all(cuts.turn - swept(cuts, left, right)[1])
        # A gyro's bias, as it would be seen with this set-up.
        rate = float(np.median(off[cuts.duration > 0.0] / cuts.duration[cuts.duration > 0.0]))
        off = off - rate * cuts.duration
        return float(np.exp(0.5 * np.mean(np.log1p((off / fit.scatter) ** 2))))

    return findings_of(setting, ways, misfit, yaw_alone=True), None
