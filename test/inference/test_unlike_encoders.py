# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistakes of a robot whose two wheels count differently, as its file says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import parts, run_of, swapped
from test.inference.set_up_mistakes import two_poses
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.calibration_parametrisation import sizes_of
from werrimbi_odom.inference.set_up.search import look_for_mistakes
from werrimbi_odom.model.robot import Robot

UNLIKE = {
    "encoders": replace(ROBOT, right_ticks_per_revolution=2500.0),
    "gears": replace(ROBOT, left_ticks_per_revolution=1000.0, right_ticks_per_revolution=4096.0),
    "wheels": replace(ROBOT, left_wheel_radius_multiplier=0.8, right_wheel_radius_multiplier=1.1),
}


def counted(seed: int, robot: Robot) -> Run:
    """A drive of `ROBOT`, counted by the encoders of another, or rolled on its wheels."""
    run = run_of(ROBOT, seed, 60)
    left = np.floor(run.ticks.left * ROBOT.left_tick / robot.left_tick)
    right = np.floor(run.ticks.right * ROBOT.right_tick / robot.right_tick)
    return replace(run, ticks=replace(run.ticks, left=left, right=right))


@pytest.mark.parametrize(
    ("unlike", "which"),
    [
        pytest.param(unlike, which, marks=[pytest.mark.evidence] * ((row + column) % 3 > 0))
        for row, unlike in enumerate(UNLIKE)
        for column, which in enumerate(("poses", "positions", "yaw", "two poses"))
    ],
)
def test_exchanged_counters_are_all_that_is_wrong_however_each_counts(
    unlike: str, which: str
) -> None:
    """A wheel of 0.64 or of a 17th of the radius was told beside them."""
    robot = UNLIKE[unlike]
    seeds = range(3, 11) if which == "two poses" else (3, 5)
    drives = [swapped(counted(seed, robot)) for seed in seeds]
    seen = [two_poses(run) if which == "two poses" else parts(run, which) for run in drives]
    found = look_for_mistakes(seen, robot)
    assert [each.effect for each in found.findings] == ["wheels_swapped"]
    assert sizes_of(found.robot) == pytest.approx(sizes_of(robot), rel=0.02)


def test_a_robot_entered_stern_first_is_told_from_one_with_exchanged_counters() -> None:
    """By the counts of a turn, where each wheel has its own; a mirrored reference looks alike."""
    robot = UNLIKE["gears"]
    astern = []
    for run in (counted(seed, robot) for seed in (3, 5)):
        assert run.reference is not None
        ticks = replace(run.ticks, left=-run.ticks.left, right=-run.ticks.right)
        turned = replace(run.reference, yaw=run.reference.yaw + np.pi)
        astern.append(replace(run, ticks=ticks, reference=turned))
    found = look_for_mistakes(astern, robot)
    named = {each.effect for each in found.findings}
    assert named == {"left_wheel_reversed", "right_wheel_reversed", "reference_yaw_offset"}
    assert all("reference_mirrored" in each.twins for each in found.findings)
    assert sizes_of(found.robot) == pytest.approx(sizes_of(robot), rel=0.02)
