# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The noise of legs, and their path, by arrays, step by step, and as machine code: one sum."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest

from test.inference.driven import runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.inference.fitting import leg_noise
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.leg_noise import noise_of_legs
from werrimbi_odom.inference.fitting.prediction import extrinsics_of, path_of
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model import recorded_propagation
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.scalar_loop import follow

EFFECTS = (
    find("sideways_drift").using(angle=0.02),
    find("reference_lever_arm").using(x=0.1, y=-0.2),
)


@pytest.fixture(scope="module")
def legs() -> tuple[Model, Concatenated]:
    runs = runs_of(ROBOT, [1, 2], seconds=20)
    robot = replace(ROBOT, effects=EFFECTS)
    return Model(robot, ({}, {})), concatenated(match_for_fit(runs, robot, 0.5))


@pytest.mark.parametrize("way", [leg_noise.step_by_step, compiled(leg_noise.step_by_step)])
def test_the_noise_of_legs_is_one_sum(
    legs: tuple[Model, Concatenated], way: Callable[..., None] | None
) -> None:
    model, runs = legs
    given = path_of(model, runs), runs, model.robot.track, extrinsics_of(model, runs)
    with patch.object(leg_noise, "compiled", lambda function: None):
        arrays = noise_of_legs(*given)
    with patch.object(leg_noise, "compiled", lambda function: way):
        numbers = noise_of_legs(*given)
    for one, other in zip(numbers, arrays, strict=True):
        size = np.sqrt(np.einsum("mii->mi", other))
        assert size.min() > 0.0
        scale = size[:, :, None] * size[:, None, :]
        np.testing.assert_allclose(one / scale, other / scale, atol=1e-9)


@pytest.mark.parametrize("way", [follow, compiled(follow)])
def test_machine_code_follows_the_steps_as_arrays_do(
    legs: tuple[Model, Concatenated], way: Callable[..., None] | None
) -> None:
    model, runs = legs
    motion = path_of(model, runs).motion
    with patch.object(recorded_propagation, "compiled", lambda function: None):
        position, yaw = recorded_propagation.followed(motion)
    with patch.object(recorded_propagation, "compiled", lambda function: way):
        its_position, its_yaw = recorded_propagation.followed(motion)
    assert np.ptp(yaw) > 1.0
    np.testing.assert_allclose(its_position, position, rtol=0.0, atol=1e-12)
    np.testing.assert_array_equal(its_yaw, yaw)


@pytest.mark.parametrize("most", [0.01, 0.3, 4.0])
def test_steps_are_followed_to_the_last_digits_however_far_they_turn(most: float) -> None:
    random = np.random.default_rng(3)
    motion = BodyMotion(*(size * random.uniform(-1.0, 1.0, 1000) for size in (0.02, 0.01, most)))
    places, yaw = np.zeros((1001, 2)), np.zeros(1001)
    follow(motion, places, yaw)
    x, y, heading = recorded_propagation.integrated(Pose(), motion)
    np.testing.assert_allclose(places, np.stack([x, y], axis=-1), rtol=0.0, atol=1e-14)
    np.testing.assert_array_equal(yaw, heading)
