# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Start headings that positions alone do not tell at once."""

from __future__ import annotations

from dataclasses import replace

import pytest

from test.inference.positions import FRAME, positions_of_a_point
from test.model.drives import ROBOT
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import START_YAW, Model
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.pose import wrap

SPINS, BENDS = [1.0, -1.0, 1.0, -1.0], [0.3, -0.3, 0.2]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("off", [2.0, 3.0, -2.0])
def test_a_drive_that_begins_on_the_spot_finds_its_heading_later(seed: int, off: float) -> None:
    drive = positions_of_a_point("late", [0.0] * 4 + [0.3] * 3, SPINS + BENDS, seed=seed)
    runs = match_for_fit([drive], ROBOT, 1.0)
    point = start_point(runs, ROBOT)
    wrong = Model(point.model.robot, ({START_YAW: FRAME + off},))
    fit = fit_model(runs, replace(point, model=wrong), find_jumps=False)
    (own,) = fit.point.model.own
    assert wrap(own[START_YAW] - FRAME) == pytest.approx(0.0, abs=0.02)
