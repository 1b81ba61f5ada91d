# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters count, the reference measures, files hold what was recorded, seeds rule it all.

A robot that is driven live sees what a recorded one sees of the same commands.
"""

from __future__ import annotations

import ast
import csv
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom.simulation as simulation
from werrimbi_odom.simulation import (
    AxlePose,
    Nominal,
    ReferenceSensor,
    TrueRobot,
    free,
    moves,
    record,
    square,
    write_run,
)
from werrimbi_odom.simulation.live import KEPT
from werrimbi_odom.simulation.manoeuvres import MoveLimits
from werrimbi_odom.simulation.recorder import wheel_speeds
from werrimbi_odom.simulation.rooms import arena
from werrimbi_odom.simulation.sensors import count, wrap

SHORT = moves("short", [(0.3, 0.4)])


@pytest.mark.parametrize(
    ("angle", "ticks"), [(0.0, 0), (0.99, 0), (1.01, 1), (-0.01, -1), (-1.01, -2), (2000.5, 2000)]
)
def test_a_counter_steps_at_its_marks(angle: float, ticks: int) -> None:
    turned = np.full(2, angle * 2 * math.pi / 2000)
    shown = count(np.array([0.0, 1.0]), turned, np.array([0.5]), 2000.0)
    assert shown.tolist() == [ticks]


def test_counters_follow_the_shafts_to_a_tick() -> None:
    robot = TrueRobot(left_ticks_per_revolution=500.0, right_ticks_per_revolution=4096.0)
    recording = record(robot, free(10.0, seed=1), seed=1)
    path = recording.true_path
    for ticks, angle, resolution in (
        (recording.left_ticks, path.left_angle_rad, 500.0),
        (recording.right_ticks, path.right_angle_rad, 4096.0),
    ):
        exact = np.interp(recording.t_s, path.t_s, angle) / (2 * math.pi) * resolution
        above = exact - ticks
        assert np.ptp(above) <= 1.0


def test_counters_start_anywhere_unless_they_keep_their_zero() -> None:
    runs = [record(TrueRobot(), SHORT, seed=s) for s in range(3)]
    assert len({int(r.left_ticks[0]) for r in runs}) == 3
    keeping = record(TrueRobot(counters_keep_zero=True), SHORT, seed=1)
    angle = keeping.true_path.left_angle_rad[0]
    assert keeping.left_ticks[0] == pytest.approx(angle / (2 * math.pi) * 2000, abs=1.5)


def test_reference_noise_is_of_the_stated_size() -> None:
    sensor = ReferenceSensor(rate_hz=100.0, sigma_xy=3e-3, sigma_yaw=1e-2)
    recording = record(TrueRobot(), free(20.0, seed=1), seed=1, reference=sensor)
    path, t = recording.true_path, recording.reference_t_s
    five_sigma = 5 / math.sqrt(2 * len(t))
    for measured, true, sigma in (
        (recording.reference_x_m, path.x_m, 3e-3),
        (recording.reference_y_m, path.y_m, 3e-3),
        (recording.reference_yaw_rad, path.yaw_rad, 1e-2),
    ):
        error = measured - np.interp(t, path.t_s, true)
        if true is path.yaw_rad:
            error = wrap(error)
        assert np.sqrt(np.mean(error**2)) == pytest.approx(sigma, rel=five_sigma)


def test_the_reference_has_its_own_frame() -> None:
    exact = {"sigma_xy": 0.0, "sigma_yaw": 0.0}
    frame = AxlePose(0.5, -0.2, 1.0)
    here = record(TrueRobot(), SHORT, seed=1, reference=ReferenceSensor(**exact))
    there = record(TrueRobot(), SHORT, seed=1, reference=ReferenceSensor(**exact, frame=frame))
    cos, sin = math.cos(frame.yaw), math.sin(frame.yaw)
    x = frame.x + cos * there.reference_x_m - sin * there.reference_y_m
    y = frame.y + sin * there.reference_x_m + cos * there.reference_y_m
    np.testing.assert_allclose(x, here.reference_x_m, atol=1e-12)
    np.testing.assert_allclose(y, here.reference_y_m, atol=1e-12)
    np.testing.assert_allclose(
        wrap(there.reference_yaw_rad + frame.yaw - here.reference_yaw_rad), 0.0, atol=1e-12
    )


def test_clocks_have_their_own_rates_and_starts() -> None:
    recording = record(
        TrueRobot(), SHORT, seed=1, reference=ReferenceSensor(rate_hz=30.0), ticks_rate_hz=100.0
    )
    np.testing.assert_allclose(np.diff(recording.t_s), 0.01)
    np.testing.assert_allclose(np.diff(recording.reference_t_s), 1 / 30)
    assert recording.t_s[0] != recording.reference_t_s[0]


def test_wrap_keeps_directions() -> None:
    angles = np.array([0.0, math.pi, -math.pi, 3.5, -3.5, 100.0])
    wrapped = wrap(angles)
    assert (wrapped > -math.pi).all()
    assert (wrapped <= math.pi).all()
    np.testing.assert_allclose(np.cos(wrapped), np.cos(angles), atol=1e-12)
    np.testing.assert_allclose(np.sin(wrapped), np.sin(angles), atol=1e-12)


def test_a_seed_is_a_run() -> None:
    first, second = (record(TrueRobot(), SHORT, seed=7) for _ in range(2))
    np.testing.assert_array_equal(first.left_ticks, second.left_ticks)
    np.testing.assert_array_equal(first.reference_x_m, second.reference_x_m)


def test_seeds_change_start_wheels_and_counters() -> None:
    first, second = (record(TrueRobot(), SHORT, seed=s).true_path for s in (1, 2))
    assert first.x_m[0] != second.x_m[0]
    assert first.left_angle_rad[0] != second.left_angle_rad[0]


def test_noise_leaves_the_other_random_streams_alone() -> None:
    quiet = record(TrueRobot(), SHORT, seed=4)
    noisy = record(TrueRobot(left_wheel_noise=1e-3), SHORT, seed=4)
    assert quiet.true_path.x_m[0] == noisy.true_path.x_m[0]
    np.testing.assert_array_equal(quiet.t_s, noisy.t_s)
    np.testing.assert_array_equal(quiet.left_ticks[:10], noisy.left_ticks[:10])


def test_the_controller_acts_on_what_the_maker_believes() -> None:
    believed = TrueRobot(nominal=Nominal(wheel_separation=0.35, wheel_radius=0.1))
    path = record(believed, moves("line", [(1.0, 0.0)]), seed=1).true_path
    went = math.hypot(path.x_m[-1] - path.x_m[0], path.y_m[-1] - path.y_m[0])
    assert went == pytest.approx(0.5, rel=1e-3)


def test_a_run_folder_holds_the_recording(tmp_path: Path) -> None:
    recording = record(TrueRobot(), SHORT, seed=1)
    warmth = np.linspace(20.0, 21.0, len(recording.t_s))
    folder = write_run(replace(recording, channels={"warmth_c": warmth}), tmp_path / "a" / "b")
    with (folder / "ticks.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["t_s", "left_ticks", "right_ticks", "warmth_c"]
    assert [int(row["left_ticks"]) for row in rows] == recording.left_ticks.tolist()
    np.testing.assert_allclose([float(r["t_s"]) for r in rows], recording.t_s, atol=1e-6)
    np.testing.assert_allclose([float(r["warmth_c"]) for r in rows], warmth, rtol=1e-5)
    with (folder / "reference.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == ["t_s", "x_m", "y_m", "yaw_rad"]
    for column, values in (
        ("x_m", recording.reference_x_m),
        ("yaw_rad", recording.reference_yaw_rad),
    ):
        np.testing.assert_allclose([float(r[column]) for r in rows], values, atol=1e-6)
    assert sorted(p.name for p in folder.iterdir()) == ["reference.csv", "ticks.csv"]


def test_nothing_of_the_package_goes_into_the_simulation() -> None:
    """Else a test with it would judge our physics by our physics."""
    allowed = {*sys.stdlib_module_names, "numpy", "mujoco", "rosbags", "ruamel"}
    assert simulation.__file__ is not None
    for file in Path(simulation.__file__).parent.rglob("*.py"):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                roots = {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                roots = {str(node.module).split(".")[0]}
            elif isinstance(node, ast.ImportFrom):
                deep = len(file.relative_to(Path(simulation.__file__).parent).parts)
                assert node.level <= deep, f"{file.name} reaches out of simulation/"
                continue
            else:
                continue
            assert roots <= allowed, f"{file.name} imports {roots - allowed}"


def test_square_recording_has_a_plausible_length() -> None:
    recording = record(TrueRobot(), square(1.0), seed=1)
    span = recording.left_ticks[-1] - recording.left_ticks[0]
    four_sides_less_the_corners = (4.0 - 2 * math.pi * 0.175) / (2 * math.pi * 0.05) * 2000
    assert span == pytest.approx(four_sides_less_the_corners, abs=3)


ROBOT = simulation.TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
EXACT = simulation.ReferenceSensor(sigma_xy=0.0, sigma_yaw=0.0)
DRIVE = simulation.moves(
    "there", [(0.6, 0.5), (-0.3, 0.2)], MoveLimits(speed=0.7, acceleration=2.0, pause=0.1)
)
START = simulation.AxlePose(0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "wish",
    [
        *("left_backlash=0.004", "right_missed_ticks=0.05", "encoder_skew=0.015"),
        *("wheels_swapped", "reference_delay=-0.08", "base_by_payload"),
    ],
)
def test_live_and_recorded_are_one(wish: str) -> None:
    odd = [each.peculiarity for each in simulation.wished([wish], seed=3)]
    recorded = simulation.record(ROBOT, DRIVE, seed=5, start=START, hidden=odd, reference=EXACT)
    live = simulation.LiveRobot(ROBOT, seed=5, start=START, hidden=odd, reference=EXACT)
    radius, base = ROBOT.nominal.wheel_radius, ROBOT.nominal.wheel_separation
    counts, poses = [], []
    ticks, measured = recorded.t_s.tolist(), recorded.reference_t_s.tolist()
    for left, right in wheel_speeds(ROBOT, DRIVE).tolist():
        live.command(0.5 * radius * (left + right), radius * (right - left) / base)
        live.advance()
        while len(counts) < len(ticks) and ticks[len(counts)] + live.counters_lag <= live.time:
            counts.append(live.counters(ticks[len(counts)]))
        while len(poses) < len(measured) and (
            measured[len(poses)] + live.reference_lag <= live.time
        ):
            poses.append(live.reference(measured[len(poses)]))
    assert len(counts) > 0.9 * len(ticks)
    both = np.column_stack([recorded.left_ticks, recorded.right_ticks])[: len(counts)]
    assert np.abs(both - np.array(counts)).max() <= 1  # rounding, at a mark
    assert np.ptp(both, axis=0).min() > 1000
    there = np.column_stack([recorded.reference_x_m, recorded.reference_y_m])[: len(poses)]
    np.testing.assert_allclose(there, np.array(poses)[:, :2], atol=1e-6)


def test_the_gyro_integrates_to_the_turn_and_memory_stays_bounded() -> None:
    live = simulation.LiveRobot(ROBOT, seed=2)
    live.command(0.2, 0.8)
    turned, before = 0.0, 0.0
    for step in range(3 * KEPT):
        live.advance()
        if step % 2:
            turned += live.gyro(before, live.time) * (live.time - before)
            before = live.time
    assert live.pose.yaw == pytest.approx(turned, rel=0.03)  # its bias and scale
    assert live.pose.yaw > 4.0
    assert len(live._rows) == 2 * KEPT
    assert live.gyro(0.0, live.time) == pytest.approx(0.8, rel=0.05)  # read once in six seconds


def test_a_late_reference_is_late_by_as_much_live() -> None:
    """Also by more than the memory of a prompt one holds."""
    odd = simulation.hide("reference_delay", 4.0, seed=1).peculiarity
    live = simulation.LiveRobot(ROBOT, seed=1, start=START, hidden=[odd], reference=EXACT)
    live.command(0.2, 0.0)
    path = {}
    for step in range(1700):
        live.advance()
        path[step] = live.pose
    assert live.reference(live.time)[:2] == pytest.approx(path[1699 - 800][:2], abs=1e-6)


@pytest.mark.parametrize(
    "name", ["reference_jump", "reference_clock_drift", "reference_gyro_drift"]
)
def test_what_is_made_in_a_whole_record_is_refused_live(name: str) -> None:
    """Nothing was hidden, and the truth said that it was."""
    odd = simulation.hide(name, seed=1).peculiarity
    with pytest.raises(ValueError, match="is made in a whole record"):
        simulation.LiveRobot(ROBOT, seed=1, hidden=[odd])


def test_the_lidar_sees_the_room_from_where_the_robot_is() -> None:
    live = simulation.LiveRobot(ROBOT, seed=2, room=arena(2.6))
    live.command(0.4, 0.0)
    turn = 1.0 / live.lidar.rate_hz
    beams = live.lidar.beams
    ahead = []
    for step in range(300):
        live.advance()
        if step in (40, 280):
            ranges = live.sweep(live.time - turn)
            ahead.append(np.median(ranges[[beams // 2 - 1, beams // 2, beams // 2 + 1]]))
    assert ahead[0] == pytest.approx(1.3, abs=0.1)  # behind the robot, where nothing stands
    assert ahead[1] - ahead[0] == pytest.approx(0.4 * 240 * 0.005, abs=0.03)


def test_a_wish_that_cannot_be_is_told() -> None:
    with pytest.raises(simulation.UnknownEffectError, match="castor_kick"):
        simulation.wished(["castor_kik"], seed=1)
    with pytest.raises(simulation.StrengthError, match="'much' of castor_kick is not a number"):
        simulation.wished(["castor_kick=much"], seed=1)
