# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Values of effects in the robot file that the drives contradict.

Every fit frees the effects that the file holds, so a wrong value of one is no missing effect, and
no search looks for it. The errors of the robot as given are as wrong for it.
"""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.calibration_parametrisation import base_name
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import bonferroni, chi2_survival
from werrimbi_odom.inference.rules import CALIBRATION_WORTH, SURE
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def outdated(fit: Fitted, given: Robot) -> tuple[str, ...]:
    """Names of the effects of the given robot whose values are not those of its drives.

    As certain as a missing effect, and worth as much as a size that is reported.
    """
    held = [item for item in given.effects if not base_name(item.effect)]
    found = []
    for item in held:
        columns, away = _away(item, fit)
        if not columns:
            continue
        spread = fit.covariance[np.ix_(columns, columns)]
        gain = float(away @ np.linalg.pinv(spread, hermitian=True) @ away)
        sure = bonferroni(len(held), chi2_survival(gain, len(columns))) < SURE
        if sure and gain > CALIBRATION_WORTH * fit.penalty_of_one * len(columns):
            found.append(item.name)
    return tuple(found)


def _away(item: AppliedEffect, fit: Fitted) -> tuple[list[int], Floats]:
    """Columns of the effect's determined values common to all drives, and their differences."""
    columns, away = [], []
    for index, (number, run) in enumerate(fit.design.columns):
        name, _, parameter = number.name.rpartition(".")
        if name != item.name or run >= 0 or number.name in fit.held:
            continue
        columns.append(index)
        away.append(fit.point.model.value(number, 0) - float(item.values[parameter]))
    return columns, np.array(away)
