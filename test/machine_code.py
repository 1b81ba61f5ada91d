# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Compiles all machine code once, for the processes of the tests: `python -m test.machine_code`.

Where the sources are new, each of them would else compile it at the same time as the others.
"""

from __future__ import annotations

from dataclasses import replace
from unittest.mock import patch

from test.inference.driven import COMMON, common, runs_of
from test.model.drives import ROBOT, random_drive
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.model import compiled, quick_odometer
from werrimbi_odom.model.quick_odometer import QuickOdometer
from werrimbi_odom.model.trajectory import trajectory


def compile_all() -> None:
    """Whatever recorded runs, streams of messages and fits call."""
    ticks = random_drive(1)
    with patch.object(compiled, "WORTH_COMPILING", 1):
        trajectory(ROBOT, *ticks)
        trajectory(ROBOT, ticks.time, 0.5 * ticks.left, 0.5 * ticks.right)
    with patch.object(quick_odometer, "PATIENCE", 0):
        odometer = QuickOdometer(ROBOT)
        for row in zip(*(column.tolist() for column in ticks), strict=True):
            odometer.update(*row)
    runs = runs_of(replace(ROBOT, effects=(find("castor_kick").using(angle=-0.02),)), (1, 2), 30)
    diagnose(runs, ROBOT, common("castor_swing"))
    diagnose(runs, ROBOT, COMMON[:2], EvaluationOptions(reference_kind="local_map"))


if __name__ == "__main__":
    compile_all()
