# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""With nothing hidden, the engine's robot is the textbook's, but for the noise asked for.

The dead reckoning is written here, so that the simulation is judged by nothing of ours.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from test.evidence import in_evidence
from werrimbi_odom import simulation as sim
from werrimbi_odom.simulation import TrueRobot, free, record

Floats = NDArray[np.float64]

NOMINAL = sim.TrueRobot()
ODD = sim.TrueRobot(wheel_separation=0.357, left_wheel_radius=0.0505, right_wheel_radius=0.0495)
BRISK = {"speed": 0.8, "yaw_rate": 2.5, "acceleration": 2.0}
DRIVES = [
    sim.square(1.0),
    sim.square(1.0, "cw"),
    sim.out_and_back(5.0),
    sim.spin(3.0),
    sim.figure_eight(0.5),
    sim.arcs((0.3, 1.0)),
    sim.pivots(),
    sim.start_stop(3),
    sim.free(30.0, seed=1),
    sim.free(30.0, seed=2, **BRISK),
]


def exact_arcs(left: Floats, right: Floats, base: float, start: Floats) -> Floats:
    """Poses (n, 3) from cumulative travel of the wheels (n,) [m], each step an exact arc."""
    steps_left, steps_right = np.diff(left), np.diff(right)
    middle = (steps_left + steps_right) / 2
    turn = (steps_right - steps_left) / base
    yaw = start[2] + np.concatenate(([0.0], np.cumsum(turn)))
    chord = middle * np.sinc(turn / (2 * np.pi))
    heading = yaw[:-1] + turn / 2
    x = start[0] + np.concatenate(([0.0], np.cumsum(chord * np.cos(heading))))
    y = start[1] + np.concatenate(([0.0], np.cumsum(chord * np.sin(heading))))
    return np.column_stack((x, y, yaw))


def distance(poses: Floats) -> float:
    """Length of the path through `poses` (n, 3) [m]."""
    return float(np.hypot(np.diff(poses[:, 0]), np.diff(poses[:, 1])).sum())


def true_poses(recording: sim.Recording) -> Floats:
    path = recording.true_path
    return np.column_stack((path.x_m, path.y_m, path.yaw_rad))


def reckoned_from_angles(recording: sim.Recording, robot: sim.TrueRobot) -> Floats:
    path = recording.true_path
    return exact_arcs(
        path.left_angle_rad * robot.left_wheel_radius,
        path.right_angle_rad * robot.right_wheel_radius,
        robot.wheel_separation,
        true_poses(recording)[0],
    )


@pytest.mark.parametrize("robot", [in_evidence(NOMINAL), ODD], ids=["nominal", "odd"])
@pytest.mark.parametrize("drive", DRIVES, ids=lambda d: d.name)
def test_rolling_is_exact_dead_reckoning(robot: sim.TrueRobot, drive: sim.Manoeuvre) -> None:
    recording = sim.record(robot, drive, seed=3)
    error = reckoned_from_angles(recording, robot) - true_poses(recording)
    assert np.hypot(error[:, 0], error[:, 1]).max() < 1.0e-4
    assert np.abs(error[:, 2]).max() < 4.0e-5


@pytest.mark.parametrize("seed", [1, *(in_evidence(seed) for seed in (2, 3))])
def test_counters_alone_close_to_a_hundredth_of_a_percent_of_the_distance(seed: int) -> None:
    """The issue asks for 0.2 %. What is left is the counters' rounding to a tick."""
    recording = sim.record(NOMINAL, sim.free(60.0, seed=seed), seed=seed)
    path = recording.true_path
    tick = 2 * math.pi * NOMINAL.left_wheel_radius / NOMINAL.left_ticks_per_revolution
    first = [np.interp(recording.t_s[0], path.t_s, v) for v in (path.x_m, path.y_m, path.yaw_rad)]
    last = [np.interp(recording.t_s[-1], path.t_s, v) for v in (path.x_m, path.y_m)]
    poses = exact_arcs(
        recording.left_ticks * tick,
        recording.right_ticks * tick,
        NOMINAL.wheel_separation,
        np.array(first),
    )
    assert math.hypot(*(poses[-1, :2] - last)) < 1e-4 * distance(poses)


def test_the_robot_drives_where_it_is_told_when_its_beliefs_are_true() -> None:
    path = sim.record(NOMINAL, sim.square(2.0), seed=5).true_path
    assert math.hypot(path.x_m[-1] - path.x_m[0], path.y_m[-1] - path.y_m[0]) < 1e-3
    assert path.yaw_rad[-1] - path.yaw_rad[0] == pytest.approx(2 * math.pi, abs=2e-3)


def test_a_base_that_is_wider_than_believed_turns_too_little() -> None:
    path = sim.record(sim.TrueRobot(wheel_separation=0.357), sim.spin(3.0), seed=5).true_path
    turned = path.yaw_rad[-1] - path.yaw_rad[0]
    assert turned == pytest.approx(6 * math.pi * 0.35 / 0.357, rel=1e-4)


def test_larger_wheels_go_further() -> None:
    robot = sim.TrueRobot(left_wheel_radius=0.051, right_wheel_radius=0.051)
    path = sim.record(robot, sim.moves("line", [(2.0, 0.0)]), seed=5).true_path
    went = math.hypot(path.x_m[-1] - path.x_m[0], path.y_m[-1] - path.y_m[0])
    assert went == pytest.approx(2.0 * 0.051 / 0.05, rel=1e-4)


def test_the_engines_curve_creep_is_what_theory_says(monkeypatch: pytest.MonkeyPatch) -> None:
    """Uncorrected, wheels creep outwards by CURVE_CREEP * speed * yaw rate: 0.45 ms of it."""
    creep = sim.engine.CURVE_CREEP
    assert creep == pytest.approx(4.5e-4)
    monkeypatch.setattr(sim.engine, "CURVE_CREEP", 0.0)
    recording = sim.record(NOMINAL, sim.figure_eight(0.5), seed=1)
    path, reckoned = recording.true_path, reckoned_from_angles(recording, NOMINAL)
    ahead = (reckoned[1:, 2] + reckoned[:-1, 2]) / 2
    step = np.diff(true_poses(recording), axis=0)
    sideways = np.cos(ahead) * step[:, 1] - np.sin(ahead) * step[:, 0]
    along = np.cos(ahead) * step[:, 0] + np.sin(ahead) * step[:, 1]
    regressor = along / np.diff(path.t_s) * step[:, 2]
    measured = -(sideways @ regressor) / (regressor @ regressor)
    assert measured == pytest.approx(creep, rel=0.02)


K_LEFT, K_RIGHT = 4.0e-4, 5.8e-4


@pytest.fixture(scope="module")
def errors() -> tuple[np.ndarray, np.ndarray]:
    """Errors of both wheels over the square root of their path, stride by stride."""
    robot = TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT)
    drives = [record(robot, free(60.0, seed=s), seed=s) for s in (1, 2)]
    both = [wheel_errors(drive.true_path, robot) for drive in drives]
    left, right = (np.concatenate(parts) for parts in zip(*both, strict=True))
    return left, right


def wheel_errors(path, robot: TrueRobot) -> tuple[np.ndarray, np.ndarray]:
    left = np.diff(path.left_angle_rad) * robot.left_wheel_radius
    right = np.diff(path.right_angle_rad) * robot.right_wheel_radius
    turn = np.diff(path.yaw_rad)
    ahead = path.yaw_rad[:-1] + turn / 2
    along = np.cos(ahead) * np.diff(path.x_m) + np.sin(ahead) * np.diff(path.y_m)
    half = robot.wheel_separation / 2
    moving = (np.abs(left) > 1e-4) & (np.abs(right) > 1e-4)  # at rest there is no noise to see
    left_error, right_error = along - half * turn - left, along + half * turn - right
    return (
        left_error[moving] / np.sqrt(np.abs(left[moving])),
        right_error[moving] / np.sqrt(np.abs(right[moving])),
    )


def test_size(errors: tuple[np.ndarray, np.ndarray]) -> None:
    left, right = errors
    five_sigma = 5 / np.sqrt(2 * len(left))
    assert np.sqrt(np.mean(left**2)) == pytest.approx(K_LEFT, rel=five_sigma)
    assert np.sqrt(np.mean(right**2)) == pytest.approx(K_RIGHT, rel=five_sigma)


def test_unbiased_white_and_independent(errors: tuple[np.ndarray, np.ndarray]) -> None:
    left, right = (e / e.std() for e in errors)
    five_sigma = 5 / np.sqrt(len(left))
    assert abs(left.mean()) < five_sigma
    assert abs(right.mean()) < five_sigma
    assert abs(np.mean(left[1:] * left[:-1])) < five_sigma
    assert abs(np.mean(right[1:] * right[:-1])) < five_sigma
    assert abs(np.mean(left * right)) < five_sigma


def test_noise_moves_the_robot_but_not_its_wheels() -> None:
    quiet = record(TrueRobot(), free(20.0, seed=1), seed=1)
    noisy = record(
        TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT), free(20.0, seed=1), seed=1
    )
    np.testing.assert_allclose(
        quiet.true_path.left_angle_rad, noisy.true_path.left_angle_rad, atol=1e-6
    )
    assert np.abs(quiet.true_path.yaw_rad - noisy.true_path.yaw_rad).max() > 1e-3


def test_no_noise_at_rest() -> None:
    robot = TrueRobot(left_wheel_noise=K_LEFT, right_wheel_noise=K_RIGHT)
    path = record(robot, free(20.0, seed=1), seed=1).true_path
    rest = path.t_s < 0.5
    assert np.ptp(path.x_m[rest]) < 1e-6
    assert np.ptp(path.yaw_rad[rest]) < 1e-6


def test_a_robot_that_tips_over_is_refused_instead_of_recorded() -> None:
    """Its wheels count what its body turns over, which looks like radii that change."""
    high = sim.TrueRobot(2.0, 0.2, 0.2, mass=300.0, nominal=sim.Nominal(2.0, 0.2))
    with pytest.raises(sim.UnstableError, match="tipped by"):
        sim.record(high, sim.start_stop(3, laps=1), seed=1)
    gently = sim.MoveLimits(speed=1.0, acceleration=0.5)
    sim.record(high, sim.moves("line", [(2.0, 0.0)], gently), seed=1)


def test_wheels_larger_than_half_the_base_roll_by_their_radius() -> None:
    """Their spheres overlap; what they sink into each other is not taken for the floor."""
    small = sim.TrueRobot(0.05, 0.03, 0.03, mass=1.0, nominal=sim.Nominal(0.05, 0.03))
    path = sim.record(small, sim.spin(1.0), seed=1).true_path
    counted = np.ptp(path.right_angle_rad - path.left_angle_rad) * 0.03 / 0.05
    assert np.ptp(path.yaw_rad) == pytest.approx(counted, rel=1e-4)
