# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning beside every position of a reference that measures no headings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from test.inference.positions import positions_of_a_point
from test.model.drives import ROBOT
from werrimbi_odom.inference.comparison.residuals import residuals_of
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.cutting import every_pose


def test_a_step_is_no_longer_wrong_where_the_robot_reverses_than_elsewhere() -> None:
    run = positions_of_a_point("to and fro", [0.4, -0.4] * 4, [0.0] * 8)
    reference = run.reference
    assert reference is not None
    seldom = replace(run, reference=reference.chosen(np.arange(reference.time.size) % 4 == 0))
    runs = concatenated([every_pose(record_of(seldom, ROBOT))])
    ((item,), _) = residuals_of(Model(ROBOT, ({},)), runs, "position")
    errors = np.hypot(*item.intervals[:, :2].T)
    assert errors.max() < 5.0 * 1e-3 * np.sqrt(2.0)  # a step is of 80 mm, a position of 1 mm
