# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The course of a robot's numbers over many drives, put together from what each drive tells."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT as DRIVEN
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.changes.dated_drives import Dated, History
from werrimbi_odom.inference.changes.drive_estimate import DriveEstimate, estimate_of_drive
from werrimbi_odom.inference.changes.history import Course, course_of
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.logarithmic_sizes import in_logarithms
from werrimbi_odom.inference.changes.scatter import scatter_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.history_words import words_of
from werrimbi_odom.report.terminal import as_text

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
DAY = 86400.0
STD = 3e-4


def course(
    levels: np.ndarray,
    random: np.random.Generator,
    scatter: float = 0.0,
    dumb: tuple[int, ...] = (),
) -> Course:
    """Of drives that tell base and radii with an error of `STD`; the `dumb` ones hardly."""
    told = []
    for number, level in enumerate(levels):
        std = STD * (300.0 if number in dumb else 1.0)
        seen = level + random.normal(size=3) * np.hypot(std, scatter)
        information = np.eye(3) / std**2
        told.append(DriveEstimate(MULTIPLIERS, information, information @ seen, 0.0, 500, 20.0))
    return course_of(told, ROBOT, DAY * np.arange(len(levels)))


def changed(found: Course) -> list[tuple[str, str, str]]:
    return [(move.what, move.kind, move.from_run) for move in found.changes]


def number(found: Course, name: str) -> int:
    return [each.name for each in found.numbers].index(name)


def test_drives_that_scatter_alike_tell_no_change_and_how_much_they_scatter() -> None:
    random = np.random.default_rng(6)
    told, sizes = 0, []
    for _ in range(60):
        found = course(np.ones((40, 3)), random, scatter=3.0 * STD)
        told += bool(found.changes)
        sizes.append(found.numbers[0].scatter)
        assert found.off == ()
    assert told <= 1
    assert np.median(sizes) == pytest.approx(3.0 * STD, rel=0.15)


def test_a_change_is_found_above_the_scatter() -> None:
    random = np.random.default_rng(7)
    levels = np.ones((40, 3))
    levels[25:, 2] += 12.0 * STD
    found = course(levels, random, scatter=2.0 * STD)
    assert changed(found) == [("right_wheel_radius_multiplier", "step", "25")]
    assert [each.name for each in found.off] == ["right_wheel_radius_multiplier"]
    ratio = found.numbers[number(found, "unequal_wheel_radii")]
    assert ratio.level[[0, -1]] == pytest.approx([1.0, 1.0 + 12.0 * STD], abs=2.0 * STD)


def test_of_few_drives_a_change_is_held_against_what_they_differ_by() -> None:
    random = np.random.default_rng(8)
    told = sum(
        bool(course(np.ones((5, 3)), random, scatter=20.0 * STD).changes) for _ in range(100)
    )
    assert told <= 2


def test_a_drive_that_tells_little_is_taken_for_what_those_around_it_are() -> None:
    random = np.random.default_rng(9)
    levels = np.ones((20, 3))
    levels[10:, 1] -= 20.0 * STD
    found = course(levels, random, scatter=2.0 * STD, dumb=(14,))
    left = found.numbers[number(found, "left_wheel_radius_multiplier")]
    assert np.isnan(left.own[14])
    assert left.pooled[14] == pytest.approx(levels[14, 1], abs=2.0 * STD)
    assert left.pooled_std[14] > left.pooled_std[13]
    # A drive that tells much keeps most of its own.
    kept = (left.pooled[13] - left.level[13]) / (left.own[13] - left.level[13])
    assert 0.5 < kept <= 1.0


def test_wear_over_a_thousand_drives_is_one_trend() -> None:
    random = np.random.default_rng(10)
    levels = np.ones((1000, 3))
    levels[:, 1] -= 0.01 * np.arange(1000) / 1000.0
    levels[600:, 2] += 2e-3
    found = course(levels, random, scatter=STD)
    assert ("right_wheel_radius_multiplier", "step", "600") in changed(found)
    (wear,) = [move for move in found.changes if move.what == "left_wheel_radius_multiplier"]
    assert wear.kind == "trend"
    assert wear.after - wear.before == pytest.approx(-0.01, abs=5e-4)
    assert len(found.changes) == 2


def test_drives_that_differ_all_alike_scatter_by_what_the_median_says() -> None:
    """The search ended at the largest difference, 5 % below it."""
    seen = np.tile([0.0, 1.0], 5)
    assert scatter_of(seen, np.full(10, 1e-6)) == pytest.approx(1.0 / np.sqrt(2.0 * 0.4549))


def test_the_scatter_of_a_number_is_that_of_the_drives_that_know_it() -> None:
    """Of thirty drives four have a reference that shows the mount, which is never quite the same.

    With all thirty counted, each such history told that the mount had changed.
    """
    random = np.random.default_rng(12)
    mount = ("reference_lever_arm.x", "reference_lever_arm.y")
    told = 0
    for _ in range(15):
        drives = []
        for number in range(30):
            knows = number % 8 == 0
            names, level = (*MULTIPLIERS, *mount * knows), [1.0] * 3 + [0.0] * 2 * knows
            std = np.array([STD] * 3 + [1e-4] * 2 * knows)
            scatter = np.array([0.0] * 3 + [5e-4] * 2 * knows)
            seen = level + np.hypot(std, scatter) * random.normal(size=std.size)
            information = np.diag(std**-2.0)
            drives.append(DriveEstimate(names, information, information @ seen, 0.0, 500, 20.0))
        told += bool(course_of(drives, ROBOT, DAY * np.arange(30)).changes)
    assert told <= 1


@pytest.mark.parametrize("base", [1.0, 1.05, 0.9])
def test_a_gyro_and_poses_tell_one_robot_however_far_its_file_is_off(base: float) -> None:
    """Ten drives beside a gyro alone, then ten beside poses."""
    random = np.random.default_rng(13)
    sizes, std = np.array([base, 1.0, 1.0]), 2e-4
    drives = []
    for number in range(20):
        slopes = np.diag(sizes**-1.0) / std
        if number < 10:
            slopes = np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]) @ slopes
        information = slopes.T @ slopes
        weighted = information @ sizes + slopes.T @ random.normal(size=len(slopes))
        drive = in_logarithms(
            DriveNumbers(MULTIPLIERS, information[None], weighted[None], np.zeros(1)), sizes, ROBOT
        )
        drives.append(
            DriveEstimate(MULTIPLIERS, drive.information[0], drive.weighted[0], 0.0, 500, 20.0)
        )
    found = course_of(drives, ROBOT, DAY * np.arange(20))
    assert found.changes == ()
    assert found.numbers[0].level[-1] == pytest.approx(
        base, abs=4.0 * found.numbers[0].level_std[-1]
    )
    assert found.numbers[0].level_std[-1] < 1e-3


def test_a_length_that_the_drive_fits_does_not_stand_at_zero_for_the_history() -> None:
    """The size of a kick goes with the length that it takes, which no history tells.

    With the length left out as if it were zero, the kick was 0.023 ± 0.0002 instead of 0.03, and
    the base 0.2 % off.
    """
    kick = find("castor_kick").using(angle=0.03, length=0.08)
    robot = replace(DRIVEN, effects=(kick,))
    drives = [estimate_of_drive(run_of(robot, 1, 40), robot, EvaluationOptions())]
    found = course_of(drives, robot, np.zeros(1))
    assert "castor_kick.length" not in drives[0].names
    for name, true in (("castor_kick.angle", 0.03), ("wheel_separation_multiplier", 1.0)):
        each = found.numbers[number(found, name)]
        assert abs(each.own[0] - true) < 3.0 * each.own_std[0] < 0.002


@pytest.mark.evidence
def test_a_marker_that_moved_is_seen_though_the_file_does_not_hold_it() -> None:
    """Each drive knew its own to 2 mm, as what the file lacks passed for noise of the wheels."""
    ahead_of_it = [0.020] * 3 + [0.028] * 3
    drives = []
    for seed, ahead in enumerate(ahead_of_it):
        run = run_of(DRIVEN, seed, 40)
        seen = run.reference
        assert seen is not None
        x, y = seen.x + ahead * np.cos(seen.yaw), seen.y + ahead * np.sin(seen.yaw)
        moved = replace(run, reference=replace(seen, x=x, y=y))
        drives.append(estimate_of_drive(moved, DRIVEN, EvaluationOptions()))
    found = course_of(drives, DRIVEN, DAY * np.arange(6.0))
    told = found.numbers[number(found, "reference_lever_arm.x")]
    assert np.all(told.own_std < 5e-4)
    assert np.abs(told.own - ahead_of_it).max() < 1.5e-3
    (change,) = [each for each in found.changes if each.what == "reference_lever_arm.x"]
    assert change.from_run == "3"
    assert change.after - change.before == pytest.approx(0.008, abs=1e-3)


def test_headings_alone_tell_the_base_over_the_radius_and_the_ratio_of_the_radii() -> None:
    """Of another scale the robot turns alike: no size is told by itself, and the file is off."""
    names = MULTIPLIERS
    told = []
    for level in (1.03, 1.03):
        # base - (left + right) / 2 and right - left, each to a thousandth.
        rows = np.array([[1.0, -0.5, -0.5], [0.0, -1.0, 1.0]]) / 1e-3
        information = rows.T @ rows
        seen = np.log([level, 1.0, 1.005]) + 1.0
        told.append(DriveEstimate(names, information, information @ seen, 0.0, 500, 20.0))
    found = course_of(told, ROBOT, DAY * np.arange(2))
    assert [each.name for each in found.numbers] == ["unequal_wheel_radii", "base_over_mean_radius"]
    ratio, base = found.numbers
    assert ratio.level[-1] == pytest.approx(1.005, abs=1e-4)
    assert base.level[-1] == pytest.approx(1.03 / 1.0025, abs=1e-4)
    assert base.level_std[-1] == pytest.approx(1e-3 / np.sqrt(2.0) * base.level[-1], rel=0.05)
    assert [off.name for off in found.off] == ["unequal_wheel_radii", "base_over_mean_radius"]
    sized = course(np.ones((8, 3)), np.random.default_rng(1))
    assert "base_over_mean_radius" not in [each.name for each in sized.numbers]


def test_drives_that_tell_nothing_are_no_proof_that_nothing_changed() -> None:
    dumb = DriveEstimate(MULTIPLIERS, np.zeros((3, 3)), np.zeros(3), 0.0, 50, 2.0)
    found = course_of([dumb, dumb], ROBOT, DAY * np.arange(2))
    drives = tuple(Dated(Path(name), dumb, 0.0, "order") for name in ("one", "other"))
    said = as_text(words_of(History(ROBOT, drives, found, (), None)))
    assert "These drives tell no number of this robot" in said
    assert "Nothing changed" not in said
