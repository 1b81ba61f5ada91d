# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference with y down, or turned, shows the same drive, if the robot file says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import parts, run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.calibration.any_driving import errors_of_legs
from werrimbi_odom.inference.comparison.compare import judged
from werrimbi_odom.inference.comparison.judged_legs import in_runs, judged_legs
from werrimbi_odom.inference.comparison.over_variable import wheel_errors
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.fitting.start_headings import first_heading
from werrimbi_odom.inference.legs.cutting import match, match_for_fit
from werrimbi_odom.model.pose import wrap_all

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


@pytest.mark.parametrize("which", ["poses", "positions"])
def test_legs_err_alike_by_a_marker_that_is_turned(run: Run, which: str) -> None:
    """A radius that was too small was an error to the side of a marker turned by 90 degrees."""
    smaller = replace(ROBOT, left_wheel_radius_multiplier=0.97 * ROBOT.left_wheel_radius_multiplier)
    stated = find("reference_yaw_offset").using(angle=0.5 * np.pi)
    marker = replace(smaller, effects=(*smaller.effects, stated))
    assert run.reference is not None
    turned = replace(run, reference=replace(run.reference, yaw=run.reference.yaw + 0.5 * np.pi))
    plain, found = (
        judged_legs(prepared, in_runs(prepared, robot), 1.0).errors
        for robot, prepared in (
            (robot, prepare([parts(seen, which)], robot, EvaluationOptions()))
            for robot, seen in ((smaller, run), (marker, turned))
        )
    )
    assert np.abs(plain.error[:, 0]).max() > 0.01
    np.testing.assert_allclose(found.error, plain.error, atol=1e-10)
    np.testing.assert_allclose(found.covariance, plain.covariance, atol=1e-12)
    np.testing.assert_allclose(wrap_all(found.heading - plain.heading), 0.0, atol=1e-9)


def test_the_error_of_a_wheel_is_the_same_by_a_marker_above_it_and_turned(run: Run) -> None:
    """By such a marker a wheel seemed to err as the other one, and by the way to the side."""
    stated = (
        find("reference_yaw_offset").using(angle=0.5 * np.pi),
        find("reference_lever_arm").using(x=0.0, y=0.1),
    )
    marker = replace(ROBOT, effects=(*ROBOT.effects, *stated))
    seen = run.reference
    assert seen is not None
    arm = 0.1j * np.exp(1j * seen.yaw)
    yaw = seen.yaw + 0.5 * np.pi
    turned = replace(
        run, reference=replace(seen, x=seen.x + arm.real, y=seen.y + arm.imag, yaw=yaw)
    )
    plain, found = (
        wheel_errors(judged(prepare([drive], robot, EvaluationOptions()), robot), 0, 1)[1]
        for drive, robot in ((run, ROBOT), (turned, marker))
    )
    np.testing.assert_allclose(found, plain, atol=1e-4)
