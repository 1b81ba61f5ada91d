# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Multipliers and calibration effects are the same sizes by two names."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.model.drives import ROBOT, random_drive
from werrimbi_odom.effects import find
from werrimbi_odom.inference.calibration_parametrisation import (
    calibration_deviation,
    sizes_of,
    std_as_effect,
)
from werrimbi_odom.model.trajectory import trajectory

EFFECTS = (
    find("track_width").using(multiplier=1.02),
    find("unequal_wheel_radii").using(ratio=1.01),
    find("wheel_radius_scale").using(multiplier=0.98),
)
BY_EFFECTS = replace(ROBOT, effects=EFFECTS)


def test_a_robot_by_multipliers_drives_as_one_by_effects() -> None:
    base, left, right = sizes_of(BY_EFFECTS)
    by_multipliers = replace(
        ROBOT,
        wheel_separation_multiplier=base,
        left_wheel_radius_multiplier=left,
        right_wheel_radius_multiplier=right,
    )
    assert sizes_of(by_multipliers) == pytest.approx(sizes_of(BY_EFFECTS), rel=1e-15)
    ticks = random_drive(5, duration=20.0)
    one, other = trajectory(BY_EFFECTS, *ticks), trajectory(by_multipliers, *ticks)
    np.testing.assert_allclose(one.x, other.x, atol=1e-12)
    np.testing.assert_allclose(one.yaw, other.yaw, atol=1e-12)


def test_numbers_of_the_effects_come_back() -> None:
    numbers = sizes_of(BY_EFFECTS).over(sizes_of(ROBOT)).as_effects
    for applied in EFFECTS:
        assert numbers[applied.name] == pytest.approx(*applied.values.values(), rel=1e-12)


def test_deviations_are_the_logarithms_of_the_effects() -> None:
    found = calibration_deviation(BY_EFFECTS, ROBOT)
    assert found == pytest.approx(np.log([1.02, 1.01, 0.98]), abs=2e-5)
    assert not calibration_deviation(BY_EFFECTS, BY_EFFECTS).any()


def test_standard_deviations_follow_the_multipliers() -> None:
    random = np.random.default_rng(1)
    covariance = np.diag([1e-6, 4e-6, 9e-6]) + 1e-6
    drawn = random.multivariate_normal(sizes_of(ROBOT), covariance, 200_000)
    numbers = {
        "track_width": drawn[:, 0],
        "unequal_wheel_radii": drawn[:, 2] / drawn[:, 1],
        "wheel_radius_scale": 0.5 * (drawn[:, 1] + drawn[:, 2]),
    }
    for name, values in numbers.items():
        assert std_as_effect(name, ROBOT, covariance) == pytest.approx(np.std(values), rel=0.02)
