# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stamps of wheels that scatter about the instant of reading are no slip of the wheels.

A stamp that is late makes the robot slow and behind at once, one that is early fast and ahead: as
wheels that slip do, if speed and place are taken from the same part of a message.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, parameters_to_fit
from werrimbi_odom.inference.legs.cutting import match_for_fit

TRUE = WhiteNoiseRobot(left_noise=2e-4, right_noise=2e-4)
SCATTER = 4e-3
"""Of stamps [s], of messages every 20 ms."""


def scattered(seed: int) -> Run:
    """A drive whose wheels are read when they should be, and stamped somewhat beside."""
    random = np.random.default_rng([seed, 9])
    run = drive(TRUE, wandering(random, 120.0), random, sigma_xy=5e-4, sigma_yaw=1e-3, every=5)
    time = np.sort(run.ticks.time + SCATTER * random.standard_normal(run.ticks.rows))
    return replace(run, name=f"run_{seed}", ticks=replace(run.ticks, time=time))


@pytest.mark.evidence
def test_stamps_that_scatter_are_no_slip() -> None:
    slip = find("longitudinal_slip")
    robot = replace(TRUE.entered(), effects=(slip.using(coefficient=0.0),))
    runs = concatenated(match_for_fit([scattered(seed) for seed in range(10)], robot, 1.0))
    numbers = (
        *CALIBRATION,
        *(replace(each, bounds=(-0.3, 0.3)) for each in parameters_to_fit(slip)),
    )
    found = fit_model(runs, start_point(runs, robot), numbers)
    which = [number.name for number in found.free].index("longitudinal_slip.coefficient")
    size = found.point.model.value(found.free[which])
    assert abs(size) < 3.0 * np.sqrt(found.covariance[which, which])


def test_speeds_of_the_body_add_up_to_its_path_and_turn() -> None:
    """Else what is off by a share of the turn would not be the base alone: a gyro sees as much."""
    robot = TRUE.entered()
    runs = concatenated(match_for_fit([scattered(1)], robot, 1.0))
    seen, travel = runs.drive(robot), runs.raw(robot)
    turned = (travel.right - travel.left) / robot.track
    assert np.allclose(seen.yaw_rate.end * seen.duration, turned, rtol=0.0, atol=1e-12)
    gone = 0.5 * (travel.left + travel.right)
    assert np.allclose(seen.speed.end * seen.duration, gone, rtol=0.0, atol=1e-12)
