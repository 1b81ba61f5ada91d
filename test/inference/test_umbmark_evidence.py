# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""UMBmark's claims: what one calibration gains, and whether its error bars hold.

docs/calibration.md holds the tables that `pytest -s -m evidence` prints here.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from test.inference.driven import record_of
from werrimbi_odom.inference.calibration.recorded_square import recorded_square, squares_of
from werrimbi_odom.inference.calibration.squares import Squares, e_max_of_scatter, e_max_syst
from werrimbi_odom.inference.calibration.umbmark import corrected, umbmark
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.simulation import Manoeuvre, TrueRobot, record, square

Floats = NDArray[np.float64]

TRACK, RADIUS = 0.35, 0.05
ROBOT = Robot(TRACK, RADIUS, 2000.0, 2000.0)
K_LEFT, K_RIGHT = 4.0e-4, 5.8e-4


def noisy_squares(
    rng: np.random.Generator, side: float, sense: int, base: float, imbalance: float, runs: int
) -> Floats:
    """Offsets of squares of a robot with white noise on its wheels: simulated step by step here.

    `base` is true over believed wheel base, `imbalance` half the relative difference of the radii.
    """
    per_leg, per_corner = 200, 40
    corner = sense * math.pi / 4 * TRACK / per_corner
    leg = [(side / per_leg, side / per_leg)] * per_leg
    path = np.array((leg + [(-corner, corner)] * per_corner) * 4)
    size = (runs, len(path))
    noise = np.sqrt(np.abs(path))
    left = path[:, 0] * (1 - imbalance) + K_LEFT * noise[:, 0] * rng.standard_normal(size)
    right = path[:, 1] * (1 + imbalance) + K_RIGHT * noise[:, 1] * rng.standard_normal(size)
    turn = (right - left) / (TRACK * base)
    middle = np.cumsum(turn, axis=1) - turn / 2
    along = (left + right) / 2 * np.sinc(turn / (2 * np.pi))
    return np.stack([(along * np.cos(middle)).sum(1), (along * np.sin(middle)).sum(1)], axis=-1)


def covered(calibrations: int, runs: int, seed: int) -> dict[str, float]:
    """Share of calibrations whose value ± 1.96 std holds the truth."""
    rng = np.random.default_rng(seed)
    inside = {"C_B": 0, "C_L": 0, "C_R": 0}
    for _ in range(calibrations):
        base, imbalance = 1 + rng.uniform(-0.02, 0.02), rng.uniform(-0.01, 0.01)
        cw, ccw = (noisy_squares(rng, 2.0, sense, base, imbalance, runs) for sense in (-1, 1))
        result = umbmark(Squares(2.0, cw, ccw), ROBOT)
        for name, estimate, true in (
            ("C_B", result.base, base),
            ("C_L", result.left, 1 - imbalance),
            ("C_R", result.right, 1 + imbalance),
        ):
            inside[name] += abs(estimate.value - true) < 1.96 * estimate.std
    return {name: count / calibrations for name, count in inside.items()}


@pytest.mark.evidence
def test_calibrations_hold_the_truth_in_their_error_bars() -> None:
    for share in covered(200, 5, seed=1).values():
        assert 0.90 <= share <= 0.99


@pytest.mark.evidence
@pytest.mark.parametrize("runs", [2, 3, 5, 20])
def test_error_bars_hold_for_few_runs_and_many(runs: int) -> None:
    """1000 calibrations: 95 % to within what chance does to a thousand."""
    shares = covered(1000, runs, seed=2)
    print(f"{runs:3} squares a sense: inside 95 %:", shares)
    for share in shares.values():
        assert 0.93 <= share <= 0.985


def by_controller(manoeuvre: Manoeuvre, believed: Robot, true: TrueRobot) -> Manoeuvre:
    """The manoeuvre as a controller drives it that believes in `believed`'s multipliers.

    The simulation's own controller knows one radius for both wheels; this turns what it is told.
    """
    nominal = true.nominal
    left = nominal.wheel_radius / (believed.wheel_radius * believed.left_wheel_radius_multiplier)
    right = nominal.wheel_radius / (believed.wheel_radius * believed.right_wheel_radius_multiplier)
    knots = []
    for t, speed, yaw_rate in manoeuvre.knots:
        on_left = (speed - believed.track * yaw_rate / 2) * left
        on_right = (speed + believed.track * yaw_rate / 2) * right
        knots.append((t, (on_left + on_right) / 2, (on_right - on_left) / nominal.wheel_separation))
    return Manoeuvre(manoeuvre.name, tuple(knots))


def engine_squares(
    true: TrueRobot, believed: Robot, side: float, runs: int, first_seed: int
) -> Squares:
    """Squares in the physics engine, by a controller and an odometry that believe the same."""
    found = []
    for number in range(runs):
        for sense in ("cw", "ccw"):
            drive = record(
                true,
                by_controller(square(side, sense), believed, true),
                seed=first_seed + 2 * number + (sense == "cw"),
            )
            found.append(
                recorded_square(
                    record_of(f"{sense} {number}", drive),
                    believed,
                    side,
                )
            )
    return squares_of(found, side)


MISTAKES = [
    (2.0, 1.02, 1.01, 0.99),
    (2.0, 0.98, 0.99, 1.01),
    (2.0, 1.02, 1.02, 0.98),
    (2.0, 0.98, 1.02, 1.0),
    (2.0, 0.98, 1.0, 1.0),
    (4.0, 1.02, 1.005, 0.995),
]


def noisy(base: float, left: float, right: float, noise: float) -> TrueRobot:
    """A robot with those mistakes and a share of the paper's wheel noise."""
    return TrueRobot(
        TRACK * base,
        RADIUS * left,
        RADIUS * right,
        left_wheel_noise=noise * K_LEFT,
        right_wheel_noise=noise * K_RIGHT,
    )


def gain(
    side: float, base: float, left: float, right: float, runs: int, noise: float, seed: int
) -> dict[str, float]:
    """E_max,syst of squares in the engine before and after one calibration."""
    true = noisy(base, left, right, noise)
    before = engine_squares(true, ROBOT, side, runs, seed)
    result = umbmark(before, ROBOT)
    after = engine_squares(true, corrected(ROBOT, result.factors), side, runs, seed + 100)
    paper = engine_squares(true, corrected(ROBOT, result.paper), side, runs, seed + 100)
    return {
        "before": result.e_max,
        "after": e_max_syst(after),
        "scatter": e_max_of_scatter(after),
        "paper": e_max_syst(paper),
    }


@pytest.mark.evidence
def test_a_calibration_in_the_engine_gains_twenty_times() -> None:
    found = gain(*MISTAKES[0], runs=2, noise=0.0, seed=1)
    assert found["after"] < found["before"] / 20


@pytest.mark.evidence
@pytest.mark.parametrize("noise", [0.0, 1.0])
def test_one_calibration_gains_twenty_times(noise: float) -> None:
    """Base and radii wrong by up to 2 %: the paper gained 4.5 times.

    What is left is the scatter of both sets of squares, and the share of the offsets by which a
    mean radius that is off stretches them. With the paper's wheel noise scatter is the limit.
    """
    print(f"\nwheel noise: {noise:g} times the paper's; E_max,syst in mm")
    print("side  base  left  right    before   after  gain  by scatter   paper's equations  gain")
    for number, mistake in enumerate(MISTAKES):
        found = gain(*mistake, runs=5, noise=noise, seed=1000 * (number + 1))
        side, base, left, right = mistake
        print(
            f"{side:3g} m {base:6.3f}{left:6.3f}{right:6.3f}"
            f"{1e3 * found['before']:10.1f}{1e3 * found['after']:8.2f}"
            f"{found['before'] / found['after']:6.0f}{1e3 * found['scatter']:12.2f}"
            f"{1e3 * found['paper']:20.1f}{found['before'] / found['paper']:6.1f}"
        )
        stretched = abs((left + right) / 2 - 1) * found["before"]
        assert found["after"] < 3 * math.sqrt(2) * found["scatter"] + stretched
        if noise == 0.0:
            assert found["after"] < found["before"] / 20


@pytest.mark.evidence
def test_with_wheel_noise_no_robot_closes_better() -> None:
    """Five squares a sense: calibrated and perfectly known robots are left with the same."""
    base, sets = 0.98, 5
    true = noisy(base, 1.0, 1.0, 1.0)
    perfect = replace(ROBOT, wheel_separation_multiplier=base)
    calibrated, known = [], []
    for number in range(sets):
        seed = 1000 * (number + 11)
        result = umbmark(engine_squares(true, ROBOT, 2.0, 5, seed), ROBOT)
        new = corrected(ROBOT, result.factors)
        calibrated.append(e_max_syst(engine_squares(true, new, 2.0, 5, seed + 100)))
        known.append(e_max_syst(engine_squares(true, perfect, 2.0, 5, seed + 200)))
        print(
            f"set {number}: before {1e3 * result.e_max:.0f} mm, calibrated "
            f"{1e3 * calibrated[-1]:.1f} mm, perfectly known {1e3 * known[-1]:.1f} mm"
        )
    assert np.median(calibrated) < 2 * np.median(known)
