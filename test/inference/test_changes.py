# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between drives: found where they are, and not told where there are none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import COMMON, parts
from test.recorded_robots import ROBOTS
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference.changes.between_drives import (
    ParameterChange,
    changes_between,
    is_within,
    of_several,
)
from werrimbi_odom.inference.changes.change_points import (
    ChangePoints,
    GroupChange,
    find_changes,
    only_these,
)
from werrimbi_odom.inference.changes.drive_estimate import estimate_of_drive
from werrimbi_odom.inference.changes.history import course_of
from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.parameter_groups import NumberGroup, groups_of
from werrimbi_odom.inference.changes.shapes import Shape, gains, rows_of
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, MULTIPLIERS
from werrimbi_odom.inference.linear import nuisance, score_test
from werrimbi_odom.report.changes import changes_words

IN_JUNE = ROBOTS / "optitrack_in_june"
PRICE = 9.0
BASE, LEFT, RIGHT = range(3)
STD = 1e-3


def drives_of(levels: np.ndarray, random: np.random.Generator) -> DriveNumbers:
    """Each drive tells three numbers, one of them hardly, with errors that hang together."""
    count, size = levels.shape
    mixed = random.normal(size=(count, size, size)) + 3.0 * np.eye(size)
    information = mixed.swapaxes(-1, -2) @ mixed / (9.0 * STD**2)
    spread = np.linalg.inv(information)
    errors = (np.linalg.cholesky(spread) @ random.normal(size=(count, size, 1)))[..., 0]
    weighted = (information @ (levels + errors)[..., None])[..., 0]
    return DriveNumbers(MULTIPLIERS, information, weighted, np.arange(count, dtype=np.float64))


def found_in(drives: DriveNumbers, kinds: tuple = ("step", "alone", "trend")) -> ChangePoints:
    return find_changes(drives, groups_of(MULTIPLIERS, np.ones(3), 3), np.ones(3), PRICE, kinds)


def test_what_a_change_would_explain_is_what_least_squares_says() -> None:
    random = np.random.default_rng(1)
    drives = drives_of(random.normal(scale=3.0 * STD, size=(12, 3)), random)
    rows = rows_of(drives)
    beside = nuisance(rows.constant)
    rest = beside.residual(rows.seen.ravel())
    directions = np.eye(3)[:, [LEFT, RIGHT]]
    for kind in ("step", "alone", "trend"):
        each = gains(rows, beside, rest, directions, kind)
        assert len(each.first) > 5
        for first, gain, degrees in zip(*each, strict=True):
            columns = rows.column(Shape(kind, first), directions)
            test = score_test(columns, beside.residual(columns), rest)
            assert test is not None
            assert gain == pytest.approx(test.gain, rel=1e-9)
            assert degrees == test.degrees


@pytest.mark.parametrize(("before", "possible"), [(-0.92, False), (0.98, True), (2.0, False)])
def test_no_wheel_had_a_radius_below_zero_or_doubled(before: float, possible: bool) -> None:
    """Derivatives that hold for a percent had told of one of -46 mm, by a yaw that was none.

    And of a base twice as wide, by the steps of counters along lines.
    """
    name = CALIBRATION[RIGHT].name
    bounds = {name: CALIBRATION[RIGHT].bounds_about(1.0)}
    drives = ("first", "second", "second")
    moved = ParameterChange(name, "sizes", "step", *drives, before, 1.0, 0.01, 0.01, "", 1e-9)
    assert is_within(moved, bounds) == possible
    back = replace(moved, before=1.0, after=before)
    assert is_within(back, bounds) == possible


def test_a_change_of_one_wheel_is_found_at_its_drive() -> None:
    random = np.random.default_rng(2)
    found = right = 0
    for _ in range(60):
        levels = np.ones((10, 3))
        first = int(random.integers(3, 8))
        levels[first:, RIGHT] -= 5.0 * STD
        steps = found_in(drives_of(levels, random)).steps
        found += [step.group.what for step in steps] == ["right_wheel"]
        right += [step.shape for step in steps] == [Shape("step", first)]
    assert found >= 58
    assert right >= 56


def test_nothing_is_told_where_nothing_changed() -> None:
    random = np.random.default_rng(3)
    told = [bool(found_in(drives_of(np.ones((12, 3)), random)).steps) for _ in range(300)]
    assert sum(told) <= 2  # one in a thousand


def test_wear_is_no_staircase_and_a_new_tyre_beside_it_is_found() -> None:
    random = np.random.default_rng(4)
    levels = np.ones((60, 3))
    levels[:, LEFT] -= 0.02 * np.arange(60) / 59.0
    levels[40:, LEFT] += 0.012
    levels[25:, BASE] += 0.008
    found = found_in(drives_of(levels, random))
    trend, base, tyre = found.steps
    assert (trend.group.what, trend.shape.kind) == ("left_wheel", "trend")
    assert trend.shape.first < 5
    assert (base.group.what, base.shape) == ("wheel_base", Shape("step", 25))
    assert (tyre.group.what, tyre.shape) == ("left_wheel", Shape("step", 40))
    assert np.abs(found.levels - levels).max() < 3.0 * STD
    std = np.sqrt(np.einsum("rii->ri", found.spread))
    assert np.mean(np.abs(found.levels - levels) < 2.0 * std) > 0.8


def test_one_odd_drive_is_one_odd_drive() -> None:
    random = np.random.default_rng(5)
    levels = np.ones((20, 3))
    levels[7, LEFT:] += 8.0 * STD
    (step,) = found_in(drives_of(levels, random)).steps
    assert (step.group.what, step.shape) == ("both_wheels", Shape("alone", 7))


def test_a_change_that_is_refused_does_not_come_back() -> None:
    """An odd drive of a reference with correlated errors, beside a change of the same wheel."""
    levels = np.ones((12, 3))
    levels[6:, LEFT] += 10.0 * STD
    levels[3, LEFT] += 10.0 * STD
    drives = drives_of(levels, np.random.default_rng(0))
    both = found_in(drives)
    kept = [step for step in both.steps if step.shape.kind == "step"]
    assert len(both.steps) == 2
    (left,) = only_these(drives, both, kept, np.ones(3), PRICE).steps
    assert (left.group.what, left.shape, left.span) == ("left_wheel", Shape("step", 6), (6, 6))
    none = only_these(drives, both, [], np.ones(3), PRICE)
    assert none.steps == ()
    assert np.ptp(none.levels, axis=0) == pytest.approx(0.0)


def test_parameters_that_are_projected_out_leave_the_same_of_the_others() -> None:
    random = np.random.default_rng(5)
    drives = drives_of(random.normal(1.0, 3.0 * STD, (4, 3)), random)
    base, left, right = MULTIPLIERS
    less = drives.without({left: (1.0, 2e-3)})
    assert less.names == (base, right)
    prior = np.diag([0.0, 2e-3**-2.0, 0.0])
    spread = np.linalg.inv(drives.information + prior)
    values = spread @ (drives.weighted + prior @ np.ones(3))[..., None]
    kept = [BASE, RIGHT]
    assert np.linalg.inv(less.information) == pytest.approx(spread[:, kept][:, :, kept])
    found = np.linalg.solve(less.information, less.weighted[..., None])
    assert found == pytest.approx(values[:, kept])


@pytest.mark.parametrize("seed", range(7))
def test_one_wheel_that_grew_and_one_that_shrank_are_told_as_these(seed: int) -> None:
    """They were "the right wheel became larger" and "both wheels became smaller"."""
    random = np.random.default_rng(seed)
    levels = np.ones((6, 3))
    levels[3:, LEFT] -= 12.0 * STD
    levels[3:, RIGHT] += 12.0 * STD
    found = found_in(drives_of(levels, random))
    assert {(step.group.what, step.shape) for step in found.steps} == {
        ("left_wheel", Shape("step", 3)),
        ("right_wheel", Shape("step", 3)),
    }


@pytest.mark.parametrize(
    ("what", "span", "told"),
    [
        ("left_backlash", (3, 4), True),
        ("left_backlash", (5, 6), False),  # only the last drive is surely after it
        ("left_backlash", (1, 3), False),
        ("left_wheel", (5, 6), True),
    ],
)
def test_an_effect_changes_only_between_several_drives(
    what: str, span: tuple[int, int], told: bool
) -> None:
    """A drive of another kind gives another size of play, though nothing about the robot did."""
    step = GroupChange(
        NumberGroup(what, ("a number",), np.ones((1, 1))), Shape("step", span[0]), span=span
    )
    assert of_several(step, 7, "absolute") is told


BUILT = WhiteNoiseRobot(left_noise=4e-4, right_noise=5.8e-4)


def session(change: float, count: int = 6, seconds: float = 40.0) -> list[Run]:
    """Drives of a robot whose right wheel is another one in the second half of them."""
    random = np.random.default_rng(11)
    runs = []
    for number in range(count):
        factor = 1.0 + change * (number >= count // 2)
        robot = replace(BUILT, right_radius=BUILT.right_radius * factor)
        run = drive(robot, wandering(random, seconds), random)
        runs.append(replace(run, name=f"drive_{number}", path=Path(f"drive_{number}")))
    return runs


def told_of(runs: list[Run]) -> tuple[ParameterChange, ...]:
    return changes_between(diagnose(runs, BUILT.entered(), COMMON), COMMON)


def test_a_diagnosis_tells_a_wheel_that_was_exchanged() -> None:
    (moved,) = told_of(session(0.003))
    assert (moved.what, moved.from_run) == ("right_wheel_radius_multiplier", "drive_3")
    assert moved.last_before == "drive_2"
    change, std = moved.after / moved.before - 1.0, np.hypot(moved.before_std, moved.after_std)
    assert change == pytest.approx(0.003, abs=4.0 * std / moved.before)
    assert std / moved.before < 5e-4
    assert moved.p_value < 1e-6


@pytest.mark.evidence
def test_a_gyro_alone_tells_a_wheel_that_was_exchanged() -> None:
    """No heading tells the robot's scale: its levels were of no size, which physics refused."""
    runs = [parts(run, "yaw") for run in session(-0.01)]
    given = BUILT.entered()
    (moved,) = told_of(runs)
    assert (moved.what, moved.from_run) == ("right_wheel_radius_multiplier", "drive_3")
    std = np.hypot(moved.before_std, moved.after_std) / moved.before
    assert moved.after / moved.before == pytest.approx(0.99, abs=4.0 * std)
    assert std < 2e-3

    of_each = [estimate_of_drive(run, given, EvaluationOptions()) for run in runs]
    course = course_of(of_each, given, np.arange(6.0))
    (since,) = course.changes
    assert (since.what, since.from_run) == ("right_wheel_radius_multiplier", "3")
    ratio = next(each for each in course.numbers if each.name == "unequal_wheel_radii")
    assert ratio.level[-1] / ratio.level[0] == pytest.approx(0.99, abs=2e-3)
    assert ratio.level_std[-1] < 1e-3


@pytest.mark.evidence
def test_a_gyro_alone_does_not_tell_a_base_that_changed_from_both_wheels() -> None:
    random = np.random.default_rng(12)
    runs = []
    for number in range(6):
        robot = replace(BUILT, separation=BUILT.separation * (0.98 if number > 2 else 1.0))
        run = drive(robot, wandering(random, 40.0), random)
        named = replace(run, name=f"drive_{number}", path=Path(f"drive_{number}"))
        runs.append(parts(named, "yaw"))
    (moved,) = told_of(runs)
    assert (moved.group, moved.from_run) == ("wheels_over_base", "drive_3")
    assert moved.after / moved.before == pytest.approx(0.98, abs=4e-3)
    (words,) = changes_words([moved], BUILT.entered())
    assert "both wheels, or the base, or the gyro's own scale" in words


@pytest.mark.evidence
def test_clocks_that_stand_otherwise_in_each_drive_are_told() -> None:
    """Recordings that were begun by hand: 0, 30 and 60 ms came out as slip or as *unknown*."""
    late = (0.0, 0.03, 0.06)
    runs = []
    for run, delay in zip(session(0.0, count=3), late, strict=True):
        assert run.reference is not None
        seen = replace(run.reference, time=run.reference.time + delay)
        runs.append(replace(run, reference=seen))
    moved = told_of(runs)
    assert {each.group for each in moved} == {"reference_delay"}
    levels = [moved[0].before, *(each.after for each in moved)]
    assert levels == pytest.approx(late, abs=0.004)


@pytest.mark.evidence
def test_an_askew_mount_that_changed_is_told_by_the_one_name_that_the_file_has() -> None:
    """Beside its twin its angle was 0.16 ± 0.13 rad before and 0.15 ± 0.13 rad after."""
    runs = session(0.0, count=4)
    for index in (2, 3):
        seen = runs[index].reference
        assert seen is not None
        runs[index] = replace(runs[index], reference=replace(seen, yaw=seen.yaw + 6e-3))
    crab = find("sideways_drift").using(angle=1e-3)
    given = replace(BUILT.entered(), effects=(crab,))
    (moved,) = changes_between(diagnose(runs, given, COMMON), COMMON)
    assert (moved.what, moved.from_run) == ("sideways_drift.angle", "drive_2")
    assert moved.after - moved.before == pytest.approx(-6e-3, abs=1e-3)
    assert moved.after_std < 1e-3


@pytest.mark.evidence
def test_a_diagnosis_of_one_robot_tells_no_change() -> None:
    assert told_of(session(0.0)) == ()


@pytest.mark.evidence
def test_drives_with_dates_are_taken_in_their_order() -> None:
    dated = []
    for number, run in enumerate(session(0.003)):
        ticks, reference = run.ticks, run.reference
        assert reference is not None
        shift = 1.7e9 + 86400.0 * number
        moved = replace(reference, time=reference.time + shift)
        dated.append(replace(run, ticks=replace(ticks, time=ticks.time + shift), reference=moved))
    (moved,) = told_of([dated[index] for index in (4, 1, 5, 0, 3, 2)])
    assert (moved.last_before, moved.from_run) == ("drive_2", "drive_3")


@pytest.mark.skipif(not IN_JUNE.is_dir(), reason="no recordings of `make recordings` here")
def test_a_marker_mounted_anew_is_told_beside_the_time_that_it_looks_like() -> None:
    """Squares and circles, and on another day lines and spins, which end within eleven seconds."""
    kinds = ("square_*", "circular_*", "ivanjko_*")
    runs = [read_run_folder(path) for kind in kinds for path in sorted(IN_JUNE.glob(kind))]
    robot = read_robot_file(IN_JUNE / "robot.yaml").robot
    found = {each.what: each for each in changes_between(diagnose(runs, robot, LIBRARY), LIBRARY)}
    ahead = found["reference_lever_arm.x"]
    assert ahead.from_run == "ivanjko_250620201618_01"
    assert (ahead.before, ahead.after) == pytest.approx((-0.7e-3, 1.0e-3), abs=0.2e-3)
