# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`calibrate fit` uses the same squares better than UMBmark: it looks at all of the way."""

from __future__ import annotations

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, square
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration.recorded_square import (
    SquareRecording,
    recorded_square,
    squares_of,
)
from werrimbi_odom.inference.calibration.umbmark import corrected, umbmark
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.robot import Robot

NOMINAL = Robot(0.35, 0.05, 2000.0, 2000.0)
SIDE = 4.0


def both(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """(base, ratio of the radii) by UMBmark and by maximum likelihood, from five squares a sense.

    The robot's own odometry is right about its wheels here, so that the squares it means to drive
    are squares by odometry; its wheels are noisy, which is what calibration has to live with.
    """
    random = np.random.default_rng(seed)
    robot = WhiteNoiseRobot(0.35, 0.05, 0.05, 1.0e-3, 1.0e-3)
    runs = [drive(robot, square(SIDE, sense), random) for sense in (1.0, -1.0) * 5]
    records = []
    for run in runs:
        ticks, seen = run.ticks, run.reference
        record = SquareRecording(
            run.name, ticks.time, ticks.left, ticks.right, seen.time, seen.x, seen.y, seen.yaw
        )
        records.append(recorded_square(record, NOMINAL, SIDE))
    old = corrected(NOMINAL, umbmark(squares_of(records, SIDE), NOMINAL).factors)
    turn = 0.25 * rules.QUARTER_TURN
    matched = concatenated([match(run, NOMINAL, 0.25, turn=turn) for run in runs])
    new = fit_model(matched, start_point(matched, NOMINAL)).robot
    return tuple(  # type: ignore[return-value]
        np.array(
            [
                found.wheel_separation_multiplier,
                found.right_wheel_radius_multiplier / found.left_wheel_radius_multiplier,
            ]
        )
        for found in (old, new)
    )


@pytest.mark.evidence
def test_maximum_likelihood_scatters_less_than_umbmark_on_the_same_squares() -> None:
    found = np.array([both(seed) for seed in range(30)])
    bias = found.mean(axis=0) - 1.0
    spread = found.std(axis=0, ddof=1)
    ratio = spread[0] / spread[1]
    for index, name in enumerate(("base", "ratio of the radii")):
        print(
            f"{name:20s} UMBmark {bias[0, index]:+.1e} ± {spread[0, index]:.1e}   "
            f"maximum likelihood {bias[1, index]:+.1e} ± {spread[1, index]:.1e}   "
            f"ratio of the spreads {ratio[index]:.2f}"
        )
    assert np.all(np.abs(bias) < 4.0 * spread / np.sqrt(30.0))
    assert np.all(ratio > 1.0)
