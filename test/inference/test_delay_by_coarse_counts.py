# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A delay by counters of 40 counts a turn: in spins there is a likely one every few ms."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import of_headings
from test.white_noise_robot import WhiteNoiseRobot, drive
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.fitting.between_counts import variances_between_counts
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import parameters_to_fit
from werrimbi_odom.inference.legs.cutting import match_for_fit

LATE = 8e-3


def spins(counts: float) -> tuple[Run, WhiteNoiseRobot]:
    """Four minutes of spins both ways with rests, and a gyro that is late."""
    random = np.random.default_rng(6)
    true = WhiteNoiseRobot(0.16, 0.033, 0.033, 2e-4, 2e-4, counts)
    rates = [
        part
        for number in range(24)
        for part in (np.zeros(80), np.full(random.integers(300, 500), 0.7 * (-1.0) ** number))
    ]
    rate = np.convolve(np.concatenate(rates), np.ones(10) / 10.0, "same")
    run = drive(true, (np.zeros(rate.size), rate), random, sigma_yaw=1e-4, every=1)
    assert run.reference is not None
    time = run.reference.time
    yaw = np.interp(time - LATE, time, run.reference.yaw)
    return replace(run, reference=of_headings(time, yaw, "incremental")), true


@pytest.mark.parametrize("began", [-0.02, 0.0, 0.02])
def test_a_delay_is_told_no_better_than_the_counts_tell_it(began: float) -> None:
    """15.64 +- 0.46 ms was said of 7.6 ms, and of the next drive -1.48 +- 0.76 ms."""
    run, true = spins(40.0)
    late = find("reference_delay")
    robot = replace(true.entered(), effects=(late.using(delay=began),))
    runs = concatenated(match_for_fit([run], robot, 1.0))
    (number,) = parameters_to_fit(late)
    fit = fit_model(runs, start_point(runs, robot), [number])
    value = fit.robot.effects[0].values["delay"]
    found = variances_between_counts(runs, fit.point, [number], np.eye(1))
    assert found["reference_delay.delay"] ** 0.5 == pytest.approx(abs(value - LATE), abs=2.5e-3)


def test_fine_counts_tell_it_as_well_as_the_noise_lets_them() -> None:
    run, true = spins(4096.0)
    late = find("reference_delay")
    robot = replace(true.entered(), effects=(late.using(delay=0.0),))
    runs = concatenated(match_for_fit([run], robot, 1.0))
    fit = fit_model(runs, start_point(runs, robot), parameters_to_fit(late))
    assert fit.robot.effects[0].values["delay"] == pytest.approx(LATE, abs=5e-4)
    assert not variances_between_counts(runs, fit.point, parameters_to_fit(late), np.eye(1))
