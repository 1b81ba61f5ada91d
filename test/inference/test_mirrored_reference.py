# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with y down shows the same drive, if the robot file says that it is left-handed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import parts, run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.calibration.any_driving import errors_of_legs
from werrimbi_odom.inference.fitting.start_headings import first_heading
from werrimbi_odom.inference.legs.cutting import match, match_for_fit

MIRRORED = replace(ROBOT, effects=(*ROBOT.effects, find("reference_mirrored").using()))


def y_down(run: Run) -> Run:
    reference = run.reference
    assert reference is not None
    return replace(run, reference=replace(reference, y=-reference.y, yaw=-reference.yaw))


@pytest.fixture(scope="module")
def run() -> Run:
    return run_of(ROBOT, 3, 60)


def test_a_fit_of_positions_begins_with_the_heading_of_a_right_handed_frame(run: Run) -> None:
    assert run.reference is not None
    positions = parts(run, "positions")
    for drive, robot in ((positions, ROBOT), (y_down(positions), MIRRORED)):
        (matched,) = match_for_fit([drive], robot, 1.0)
        assert first_heading(robot, matched) == pytest.approx(run.reference.yaw[0], abs=0.02)


@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
def test_legs_err_alike_in_a_mirrored_frame(run: Run, which: str) -> None:
    seen = parts(run, which)
    plain, mirrored = (
        errors_of_legs(robot, [match(drive, robot)], [0.0])
        for drive, robot in ((seen, ROBOT), (y_down(seen), MIRRORED))
    )
    np.testing.assert_allclose(mirrored, plain, atol=1e-12)
