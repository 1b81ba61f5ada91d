# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis begins with the robot file as it is: of one that is right it finds that again."""

from __future__ import annotations

from dataclasses import replace

import pytest

from test.inference.driven import COMMON
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit


@pytest.mark.evidence
@with_recordings
def test_what_happened_once_does_not_lead_away_from_a_file_that_is_right() -> None:
    """A Kobuki with tape on its left tread, by its gyro; once it was turned by 3.4 degrees."""
    taped = ROBOTS / "kobuki_left_taped"
    robot = replace(
        read_robot_file(taped / "robot.yaml").robot,
        wheel_separation_multiplier=1.0635,
        left_wheel_noise=2.1e-3,
        effects=(
            find("reference_delay").using(delay=0.0824),
            replace(find("left_tread_bump").using(height=1.02e-3), unknown=("place",)),
        ),
    )
    runs = [read_run_folder(taped / f"part_{number}") for number in (1, 2, 3, 4)]
    laid = concatenated(match_for_fit(runs, robot, leg=1.0))
    fit = fit_calibration(laid, robot, EvaluationOptions(reference_kind="incremental"))
    fitted = fit.point.model.robot
    delay, bump = fitted.effects
    assert delay.values["delay"] == pytest.approx(0.0824, abs=0.01)
    assert bump.values["height"] == pytest.approx(1.02e-3, abs=3e-4)
    assert fitted.wheel_separation_multiplier == pytest.approx(1.0635, abs=0.003)
    assert set(fit.calibrated) <= {"unequal_wheel_radii"}
    ratio = fitted.left_wheel_radius_multiplier / fitted.right_wheel_radius_multiplier
    assert 0.0 <= ratio - 1.0 < 0.34e-2 + 1.96 * 0.19e-2, "the tape, by plain least squares"


@pytest.mark.evidence
@with_recordings
def test_of_a_file_whose_base_was_found_the_late_clock_comes_first() -> None:
    """The Labyrinth's robot after its own advice: its wheels exchanged, its base twice as wide.

    The whole way there is followed by `make evidence` (test/hidden/test_real_robots.py).
    """
    labyrinth = ROBOTS / "labyrinth"
    robot = replace(
        read_robot_file(labyrinth / "robot.yaml").robot,
        wheel_separation_multiplier=1.9625,
        effects=(find("wheels_swapped").using(),),
    )
    found = diagnose([read_run_folder(labyrinth / "drive")], robot, COMMON)
    assert found.final.names[0] == "reference_delay", "the first that the search takes"
    assert "reference_delay" in found.found
    assert found.train.after < found.train.before
    assert found.holdout.after < 0.5 * found.holdout.before
