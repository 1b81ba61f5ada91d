# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Positions without headings and a gyro, judged together: sizes, mount and delays, and no crab."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects.lookup import all_effects, find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.references.merged_reference import merged
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.effect_support import able
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import ModelFit, fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, parameters_to_fit
from werrimbi_odom.inference.fitting.run_phases import with_own_values
from werrimbi_odom.inference.fitting.whitened_innovations import jacobian_of
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot

TRUE = WhiteNoiseRobot(left_noise=4e-4, right_noise=5.8e-4)
ARM = 0.3 + 0.2j
LATE, HEADING_LATE = 0.15, -0.12
OPTIONS = EvaluationOptions(reference_kind="local_map")


def seen(seed: int, noise: float = 0.02) -> Run:
    """100 s of an aerial off the axle at 5 Hz, and a gyro with bias, noise and another delay."""
    random = np.random.default_rng([seed, 8])
    run = drive(TRUE, wandering(random, 100.0), random, sigma_xy=0.0, sigma_yaw=0.0, every=1)
    true = run.reference
    assert true is not None
    yaw = np.unwrap(true.yaw)
    aerial = true.x + 1j * true.y + ARM * np.exp(1j * yaw)
    fixes = np.arange(0.4, 99.0, 0.2)
    error = noise * random.standard_normal((2, fixes.size))
    x, y = (np.interp(fixes - LATE, true.time, each) for each in (aerial.real, aerial.imag))
    places = Reference(fixes, x + error[0], y + error[1], np.full(fixes.size, np.nan))
    shown = np.interp(true.time - LATE - HEADING_LATE, true.time, yaw) - yaw[0] + 8e-3 * true.time
    shown += 4e-4 * np.cumsum(random.standard_normal(yaw.size)) / np.sqrt(50.0)
    nothing = np.full(yaw.size, np.nan)
    both, _ = merged("", places, Reference(true.time, nothing, nothing, shown))
    return replace(run, name=f"run_{seed}", reference=both)


def robot_of(*effects: AppliedEffect) -> Robot:
    """Its base is entered 5 % too small, and its right wheel 1 %."""
    true = TRUE.entered()
    return replace(
        true,
        wheel_separation_multiplier=true.wheel_separation_multiplier / 1.05,
        right_wheel_radius_multiplier=true.right_wheel_radius_multiplier / 1.01,
        effects=effects,
    )


def fitted(robot: Robot, runs: list[Run]) -> ModelFit:
    laid = concatenated(match_for_fit(runs, robot, 1.0))
    point, numbers = with_own_values(laid, start_point(laid, robot, OPTIONS))
    return fit_model(laid, point, (*CALIBRATION, *numbers))


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return [seen(1)]


def test_sizes_mount_and_both_delays_are_found(runs: list[Run]) -> None:
    """And the angle between heading and path stays as the robot file has it."""
    robot = robot_of(
        AppliedEffect(find("reference_lever_arm"), {"x": 0.25, "y": 0.25}),
        AppliedEffect(find("reference_delay"), {"delay": 0.12}),
        AppliedEffect(find("reference_heading_delay"), {"delay": -0.08}),
        AppliedEffect(find("reference_yaw_offset"), {"angle": 0.0}),
    )
    found = fitted(robot, runs)
    true = {name.name: getattr(TRUE.entered(), name.name) for name in CALIBRATION}
    true |= {"reference_lever_arm.x": ARM.real, "reference_lever_arm.y": ARM.imag}
    true |= {"reference_delay.delay": LATE, "reference_heading_delay.delay": HEADING_LATE}
    assert {number.name for number in found.free} == set(true)
    for number, std in zip(found.free, np.sqrt(np.diag(found.covariance)), strict=True):
        off = found.point.model.value(number) - true[number.name]
        assert abs(off) < 3.0 * std < 0.03, number.name


def test_an_angle_between_heading_and_path_is_not_asked_nor_added(runs: list[Run]) -> None:
    robot = robot_of()
    laid = concatenated(match_for_fit(runs, robot, 1.0))
    asked = {each.name for each in able(all_effects(()).effects, laid, robot)}
    assert {"reference_lever_arm", "reference_heading_delay", "reference_gyro_drift"} <= asked
    for name in ("reference_yaw_offset", "sideways_drift"):
        assert name not in asked
        with pytest.raises(InputError, match="laid upon its path: they tell nothing of it"):
            add_effects([find(name)], runs, robot, OPTIONS)


def test_both_delays_turn_a_heading_alike(runs: list[Run]) -> None:
    """By other steps of the derivatives they did not, and a gyro seemed to tell them apart."""
    robot = robot_of(
        *(
            AppliedEffect(find(name), {"delay": 0.1})
            for name in ("reference_delay", "reference_heading_delay")
        )
    )
    laid = concatenated(match_for_fit(runs, robot, 1.0))
    numbers = [each for item in robot.effects for each in parameters_to_fit(item.effect)]
    one, other = np.moveaxis(
        jacobian_of(laid, start_point(laid, robot, OPTIONS).model, numbers), -1, 0
    )
    assert np.abs(one[:, 2]).max() > 0.1
    np.testing.assert_allclose(one[:, 2], other[:, 2], atol=1e-9)
