# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistakes beside what the robot file holds of the reference, and words about them."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from ruamel.yaml import YAML

from test.inference.driven import run_by, run_of
from test.inference.set_up_mistakes import mounted
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.set_up.clock_offset_search import lag_of
from werrimbi_odom.inference.set_up.misentered_values import counts_words, factor_words
from werrimbi_odom.inference.set_up.poses import regressed
from werrimbi_odom.inference.set_up.positions import windows_of
from werrimbi_odom.inference.set_up.records import Cuts, SetUpRecord, record_of
from werrimbi_odom.inference.set_up.search import SetUp, look_for_mistakes
from werrimbi_odom.model.robot import Robot

DRIVES = tuple(run_of(ROBOT, seed, 60) for seed in (3, 5))


def on(angle: float, point: complex = 0j) -> list[Run]:
    """The drives, seen by a reference mounted so."""
    mount = mounted(angle, point)
    return [replace(run, reference=mount(run.reference)) for run in DRIVES if run.reference]


def late(delay: float, runs: list[Run] | tuple[Run, ...] = DRIVES) -> list[Run]:
    return [
        replace(run, reference=replace(run.reference, time=run.reference.time + delay))
        for run in runs
        if run.reference
    ]


def holding(effect: str, **values: float) -> Robot:
    return replace(ROBOT, effects=(find(effect).using(**values),))


def named(found: SetUp) -> list[str]:
    return [each.effect for each in found.findings]


@pytest.mark.parametrize("degrees", [90.0, 180.0, -120.0])
def test_a_lever_arm_in_the_file_stays_right_where_its_axes_are_turned(degrees: float) -> None:
    """It was told as one of 0.9 m, as what was undone of it pointed the other way."""
    found = look_for_mistakes(
        on(math.radians(degrees), 0.3 + 0.1j), holding("reference_lever_arm", x=0.3, y=0.1)
    )
    assert named(found) == ["reference_yaw_offset"]


def test_a_lever_arm_beyond_that_of_the_file_is_found_in_turned_axes() -> None:
    found = look_for_mistakes(on(math.pi, -0.6 - 0.5j), holding("reference_lever_arm", x=0.3))
    assert named(found) == ["reference_yaw_offset", "reference_lever_arm"]
    arm = found.findings[1]
    assert (arm.values["x"], arm.values["y"]) == pytest.approx((-0.6, -0.5), abs=0.01)
    assert "0.90 m behind the axle's middle and 0.50 m to its right" in arm.words
    assert "with what the robot file holds, reference_lever_arm is x -0.6" in arm.words


@pytest.mark.parametrize(("seed", "wobble"), [(0, 0.005), (2, 0.005), (3, 0.01)])
def test_a_marker_that_goes_round_a_robot_that_spins_is_no_wrong_size(
    seed: int, wobble: float
) -> None:
    """Spins alone: the marker's circle was taken for the wheels', of a robot five times as large.

    `wobble`: of the speed [m/s], as wheels have it whose controllers are two.
    """
    speed = wobble * np.random.default_rng(seed).standard_normal(1800)
    turning = 0.8 * np.clip(4.0 * np.sin(2.0 * np.pi * np.arange(1800) / 240.0), -1.0, 1.0)
    run = run_by(ROBOT, speed, turning, seed)
    assert run.reference is not None
    seen = replace(run, reference=mounted(0.0, 0.06 - 0.02j)(run.reference))
    assert look_for_mistakes([seen], ROBOT).findings == ()

    record = record_of(seen, ROBOT, None)
    assert record is not None
    fit = regressed([record], ROBOT)
    assert fit is not None
    assert abs(fit.moving.half_base - 0.175) < 3.0 * fit.moving.half_base_std
    assert fit.moving.arm.real == pytest.approx(0.06, abs=0.002)


def test_a_mount_entered_with_the_wrong_sign_is_told_as_it_is_in_all() -> None:
    found = look_for_mistakes(
        on(-0.5 * math.pi), holding("reference_yaw_offset", angle=0.5 * math.pi)
    )
    assert named(found) == ["reference_yaw_offset"]
    assert found.findings[0].values["angle"] == pytest.approx(-0.5 * math.pi, abs=0.01)
    assert found.findings[0].words.endswith("reference_yaw_offset is angle -1.57 rad")
    (alone,) = look_for_mistakes(on(-0.5 * math.pi), ROBOT).findings
    assert "with what the robot file holds" not in alone.words


def test_yaw_in_degrees_is_seen_though_the_clock_is_seconds_late() -> None:
    """Before the clocks were put right, poses fitted in no unit, and the delay alone was told."""
    in_degrees = [
        replace(run, reference=replace(run.reference, yaw=np.degrees(run.reference.yaw)))
        for run in late(2.0)
        if run.reference
    ]
    found = look_for_mistakes(in_degrees, ROBOT)
    assert named(found) == ["reference_yaw_in_degrees", "reference_delay"]
    assert found.findings[1].values["delay"] == pytest.approx(2.0, abs=0.05)
    assert named(look_for_mistakes(late(2.0), ROBOT)) == ["reference_delay"]


def test_a_delay_at_the_end_of_the_search_may_be_longer() -> None:
    (found,) = look_for_mistakes(late(5.6), ROBOT).findings
    assert "5.0 s or more too late" in found.words
    (found,) = look_for_mistakes(late(-2.0), ROBOT).findings
    assert "2.0 s too early" in found.words


def test_a_delay_beyond_what_the_effect_holds_is_to_be_converted() -> None:
    """A robot file with it could not be read."""
    found = look_for_mistakes(late(7.0), holding("reference_delay", delay=4.0))
    assert found.to_convert is not None
    assert "reference_delay is delay 7 s, more than reference_delay can hold" in found.to_convert
    assert look_for_mistakes(late(3.0), holding("reference_delay", delay=1.0)).to_convert is None


def test_a_clock_that_gains_as_the_file_says_is_not_late() -> None:
    """It was told as late by what it gains until the middle of the drive: by 0.4 s a minute."""
    fast = [
        replace(run, reference=replace(run.reference, time=run.reference.time / (1.0 - 0.015)))
        for run in DRIVES
        if run.reference
    ]
    assert named(look_for_mistakes(fast, ROBOT)) == ["reference_delay"]
    assert not named(
        look_for_mistakes(fast, holding("reference_clock_drift", rate=0.015, delay=0.0))
    )


def test_a_lag_at_which_nothing_was_seen_is_not_the_best() -> None:
    """Poses rarer than the ticks last: no number stood for the least of all."""
    random = np.random.default_rng(0)
    time = np.arange(0.0, 21.0, 0.05)
    left = 0.01 * np.cumsum(random.random(time.size))
    seen = -45.0 + 12.0 * np.arange(25)
    place = np.cumsum(random.random(25)) + 0j
    record = SetUpRecord(time, left, 1.1 * left, seen, place, random.random(25))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert lag_of([record]) == (0.0, 1.0)


@pytest.mark.parametrize("cuts", [12, 13, 17])
def test_each_drive_has_its_own_windows_wherever_it_begins(cuts: int) -> None:
    """Of six drives of 13 cuts two had one, as windows began at each sixth cut of all."""
    drives = 6
    count = drives * cuts
    one, rows = np.ones(count), np.arange(count)
    stretch = np.repeat(np.arange(drives), cuts)
    windows = windows_of(Cuts(one, one, rows, rows + 1, one, np.nan * one, one + 0j, stretch))
    assert windows is not None
    assert windows.count == drives
    assert windows_of(Cuts(one, one, rows, rows + 1, one, one, one + 0j, rows)) is None
    assert rules.WINDOW == 12


@pytest.mark.parametrize("counts", [1.0003, 4096.0, 20000.0, 245760.0])
def test_counts_are_told_as_a_number_that_yaml_reads(counts: float) -> None:
    """2e+04 is a word to many readers of YAML."""
    words = counts_words(counts, counts, 0.05)
    said = words.split("left_ticks_per_revolution: ")[1].split(",")[0].split(" (")[0]
    assert "e" not in said
    assert YAML(typ="safe").load(f"x: {said}")["x"] == pytest.approx(counts, rel=1e-3)
    assert "1 counts" not in words
    assert words.endswith("and the same to the right")


def test_counters_that_count_otherwise_are_told_each() -> None:
    words = counts_words(1000.0, 2500.0, 0.05)
    assert "1000 counts, of the right 2500," in words
    assert "left_ticks_per_revolution: 1000 and right_ticks_per_revolution: 2500" in words


def test_factors_are_told_as_plain_numbers() -> None:
    assert "radius is 1000 times what" in factor_words("radius", 1000.0)
    assert "radius is 1/1000 times what" in factor_words("radius", 1e-3)
    assert "radius is 1/57.3 times what" in factor_words("radius", math.pi / 180.0)
    assert factor_words("metre", 1000.0).startswith("radius and base alike are 1000 times")
