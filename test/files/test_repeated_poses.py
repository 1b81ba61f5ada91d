# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses that a tracker holds while the robot goes on are not taken for measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.files import recorded
from test.files.recorded import ROBOT
from werrimbi_odom.files.references.held_poses import (
    held_poses,
    without_held_poses,
    words_about_held,
)
from werrimbi_odom.files.run import Reference, Run, Ticks


def driven(seed: int, **seen: float) -> Run:
    """A minute of lines, curves, spins and stops."""
    return recorded.driven(seed, 30.0, **seen)


def held(reference: Reference, begin: int, end: int) -> Reference:
    """The same, where the pose of `begin` is repeated until `end`."""
    rows = np.arange(reference.time.size)
    rows[begin:end] = begin
    return replace(reference.chosen(rows), time=reference.time)


def moving(run: Run) -> int:
    """A row from which the robot goes straight on for a while."""
    assert run.reference is not None
    way = np.hypot(np.diff(run.reference.x), np.diff(run.reference.y))
    return int(np.argmax(np.convolve(way, np.ones(30), "valid")))


@given(st.integers(0, 50))
def test_a_reference_that_never_repeats_stays_as_it_is(seed: int) -> None:
    run = driven(seed)
    assert without_held_poses(run, ROBOT) is run


@given(st.integers(0, 20), st.integers(2, 25))
def test_held_poses_are_left_out_but_not_the_first_of_them(seed: int, length: int) -> None:
    run = driven(seed)
    assert run.reference is not None
    begin = moving(run)
    lost = replace(run, reference=held(run.reference, begin, begin + length))
    np.testing.assert_array_equal(
        np.flatnonzero(held_poses(lost, ROBOT)), np.arange(begin + 1, begin + length)
    )
    left = without_held_poses(lost, ROBOT)
    assert left.held_poses == length - 1
    assert left.reference is not None
    assert left.reference.time[begin] == run.reference.time[begin]
    assert left.reference.time.size == run.reference.time.size - length + 1


def test_a_robot_that_stands_is_measured_where_it_stands() -> None:
    """Without any noise its pose repeats, as it should."""
    run = driven(1, sigma_xy=0.0, sigma_yaw=0.0)
    assert run.reference is not None
    rows = np.arange(run.reference.time.size)
    still = np.diff(run.reference.x, append=np.nan) == 0.0
    assert still.sum() > 5
    assert not held_poses(run, ROBOT)[rows[still]].any()


def test_a_late_reference_shows_a_robot_at_rest_for_a_while_after_it_has_set_off() -> None:
    run = driven(1, sigma_xy=0.0, sigma_yaw=0.0)
    late = 0.3
    assert run.reference is not None
    seen = replace(run.reference, time=run.reference.time + late)
    assert not held_poses(replace(run, reference=seen), ROBOT).any()


@pytest.mark.parametrize("grid", [0.003, 0.01, 0.05])
def test_a_coarse_reference_repeats_between_its_steps(grid: float) -> None:
    run = driven(2)
    assert run.reference is not None
    coarse = replace(
        run.reference,
        x=np.round(run.reference.x / grid) * grid,
        y=np.round(run.reference.y / grid) * grid,
        yaw=np.full(run.reference.time.size, np.nan),
    )
    repeats = (np.diff(coarse.x) == 0.0) & (np.diff(coarse.y) == 0.0)
    assert repeats.sum() > 5
    assert not held_poses(replace(run, reference=coarse), ROBOT).any()


def test_marks_on_the_floor_may_be_the_same_twice() -> None:
    """Driven back onto its mark, as it was by hand."""
    run = driven(3)
    times = run.ticks.time[[0, -1]]
    twice = Reference(times, np.zeros(2), np.zeros(2), np.zeros(2))
    assert not held_poses(replace(run, reference=twice), ROBOT).any()


def test_headings_alone_are_held_where_the_robot_turns() -> None:
    run = driven(4)
    assert run.reference is not None
    nothing = np.full(run.reference.time.size, np.nan)
    turn = np.convolve(np.abs(np.diff(run.reference.yaw)), np.ones(20), "valid")
    begin = int(np.argmax(turn))
    yaw = replace(run.reference, x=nothing, y=nothing)
    lost = replace(run, reference=held(yaw, begin, begin + 10))
    assert held_poses(lost, ROBOT).sum() >= 7
    assert not held_poses(replace(run, reference=yaw), ROBOT).any()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("slow", [("yaw",), ("x", "y")])
@pytest.mark.parametrize("every", [3, 10])
def test_a_slower_part_of_the_pose_is_held_between_its_readings(
    seed: int, slow: tuple[str, ...], every: int
) -> None:
    """As where a log has a row for each message of the fastest sensor."""
    run = driven(seed)
    assert run.reference is not None
    rows = np.arange(run.reference.time.size)
    last = rows // every * every
    logged = replace(run.reference, **{name: getattr(run.reference, name)[last] for name in slow})
    left = without_held_poses(replace(run, reference=logged), ROBOT).reference
    assert left is not None
    kept = np.isin(run.reference.time, left.time)
    np.testing.assert_array_equal(np.flatnonzero(kept), np.unique(last))


@pytest.mark.parametrize("seed", range(4))
def test_a_heading_without_noise_repeats_on_a_straight_line(seed: int) -> None:
    """Also by a robot file that takes straight lines for turns: one counter reversed."""
    run = driven(seed, sigma_xy=0.0, sigma_yaw=0.0)
    ticks = run.ticks
    wired = replace(run, ticks=Ticks(ticks.time, ticks.left, -ticks.right))
    assert not held_poses(run, ROBOT).any()
    assert not held_poses(wired, ROBOT).any()


def test_it_is_said_once_for_all_runs() -> None:
    run = driven(5)
    assert run.reference is not None
    assert words_about_held([run, replace(run, reference=None)]) is None
    begin = moving(run)
    lost = without_held_poses(replace(run, reference=held(run.reference, begin, begin + 11)), ROBOT)
    told = words_about_held([run, lost, lost])
    assert told is not None
    assert told.startswith(f"drive and 1 more: 20 of {2 * run.reference.time.size} reference poses")


@pytest.mark.parametrize("lacking", [(), ("x", "y"), ("yaw",)])
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_counter_that_counts_backwards_makes_no_spin_of_a_line(
    side: str, lacking: tuple[str, ...]
) -> None:
    """A heading that repeats while the robot drives straight on: "held, not measured"."""
    run = straight()
    nothing = np.full(run.reference.time.size, np.nan)
    run = replace(run, reference=replace(run.reference, **dict.fromkeys(lacking, nothing)))
    wrong = replace(run, ticks=replace(run.ticks, **{side: -getattr(run.ticks, side)}))
    assert not held_poses(wrong, ROBOT).any()
    lost = replace(wrong, reference=held(wrong.reference, 60, 80))
    np.testing.assert_array_equal(
        held_poses(lost, ROBOT), held_poses(replace(lost, ticks=run.ticks), ROBOT)
    )


def straight() -> Run:
    """Lines of 10 s, by a simulator that knows no noise, with spins and curves between."""
    time = np.arange(0.0, 60.0, 0.1)
    spins = time % 15.0 >= 10.0
    way = np.cumsum(np.where(spins & (time % 15.0 < 14.0), 0.0, 0.03))
    yaw = np.cumsum(np.where(spins, 0.05, 0.0))
    step = np.diff(way, prepend=0.0) * np.exp(1j * yaw)
    place = np.cumsum(step)
    left, right = way - 0.5 * ROBOT.track * yaw, way + 0.5 * ROBOT.track * yaw
    counts = Ticks(time, left / ROBOT.left_tick, right / ROBOT.right_tick)
    return Run("lines", Path("lines"), counts, Reference(time, place.real, place.imag, yaw))
