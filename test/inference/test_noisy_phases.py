# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Satellites without a fixed solution for a while: no hand moves the robot, and no wheel errs."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.legs.aligned_run import record_of
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.report.phrases import left_out_words

MACHINE = WhiteNoiseRobot()
ROBOT = MACHINE.entered()
FIXED = 6e-3
FLOATS = (60.0, 80.0)


@pytest.fixture(scope="module")
def run() -> Run:
    """Positions at 5 Hz; the robot stands for some seconds while they float."""
    random = np.random.default_rng(3)
    speed, turning = wandering(random, 150.0)
    at = np.arange(speed.size) / 50.0
    stands = (at > 70.0) & (at < 73.0)
    commands = np.where(stands, 0.0, speed), np.where(stands, 0.0, turning)
    return drive(MACHINE, commands, random, every=10, sigma_xy=FIXED)


def floating(run: Run, begin: float, end: float, sigma: float) -> Run:
    seen, random = run.reference, np.random.default_rng(4)
    assert seen is not None
    noisy = (seen.time > begin) & (seen.time < end)
    x, y = (each + noisy * random.normal(0.0, sigma, noisy.size) for each in (seen.x, seen.y))
    return replace(run, reference=replace(seen, x=x, y=y, yaw=np.full(x.size, np.nan)))


def test_a_phase_of_much_more_noise_is_told_as_such_and_left_out(run: Run) -> None:
    (part,) = with_no_driving(floating(run, *FLOATS, 0.04), ROBOT).no_driving or ()
    assert part.why == "gap"
    reach = rules.NOISY_PHASE_LASTS
    assert FLOATS[0] - reach < part.begin < FLOATS[0] + 0.2
    assert FLOATS[1] - 0.2 < part.end < FLOATS[1] + reach
    assert part.words.startswith("the reference scatters ")
    assert int(part.words.split()[3]) == pytest.approx(0.04 / FIXED, abs=2.0)


def test_a_pose_that_came_twice_hides_no_phase(run: Run) -> None:
    seen = floating(run, *FLOATS, 0.04).reference
    assert seen is not None
    twice = seen.chosen(np.sort(np.append(np.arange(seen.time.size), 100)))
    found = with_no_driving(replace(run, reference=twice), ROBOT).no_driving or ()
    assert len([part for part in found if "scatters" in part.words]) == 1


def test_what_is_stated_of_poses_that_are_left_out_is_no_noise_of_the_others(run: Run) -> None:
    """A receiver states 4 cm while it floats; all poses were taken to err by 15 mm."""
    given = floating(run, *FLOATS, 0.04)
    seen = given.reference
    assert seen is not None
    floats = (seen.time > FLOATS[0]) & (seen.time < FLOATS[1])
    stated = replace(seen, sigma_xy=np.where(floats, 0.04, FIXED))
    found = record_of(replace(given, reference=stated), ROBOT)
    assert found.sigma_xy == pytest.approx(FIXED, rel=0.2)


@pytest.mark.parametrize(
    ("span", "sigma"),
    [((0.0, 150.0), 0.04), (FLOATS, 0.008), (FLOATS, 0.0), ((60.0, 61.0), 0.04)],
    ids=["all along", "not three times", "never", "for a second"],
)
def test_noise_that_is_that_of_the_drive_is_no_phase(
    run: Run, span: tuple[float, float], sigma: float
) -> None:
    found = with_no_driving(floating(run, *span, sigma), ROBOT).no_driving or ()
    assert not [part for part in found if "scatters" in part.words]


def test_satellites_that_float_for_a_while_make_no_wheel_err(run: Run) -> None:
    """The robot was told to be carried where it stood, and most of the drive was left out."""
    found = compare([floating(run, *FLOATS, 0.04)], ROBOT, EvaluationOptions(leg=0.5))
    assert 0.6 < found.main.all.figures.nees < 1.4
    (line,) = left_out_words(found.left_out)
    assert "the reference scatters" in line
