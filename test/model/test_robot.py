# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that cannot be is refused, with the name of the value that makes it so."""

from __future__ import annotations

import math
from dataclasses import FrozenInstanceError, replace

import pytest

from werrimbi_odom.model.robot import Robot

ROBOT = Robot(
    wheel_separation=0.35,
    wheel_radius=0.05,
    left_ticks_per_revolution=2000.0,
    right_ticks_per_revolution=1000.0,
)
POSITIVE = (
    "wheel_separation",
    "wheel_radius",
    "left_ticks_per_revolution",
    "right_ticks_per_revolution",
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)
NOISE = ("left_wheel_noise", "right_wheel_noise")


@pytest.mark.parametrize("field", POSITIVE)
@pytest.mark.parametrize("value", [0.0, -0.1])
def test_sizes_and_multipliers_are_greater_than_zero(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"^{field} must be greater than zero, it is {value}$"):
        replace(ROBOT, **{field: value})


@pytest.mark.parametrize("field", [*POSITIVE, *NOISE])
@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_every_value_is_a_finite_number(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=f"^{field} must be a finite number, not {value}$"):
        replace(ROBOT, **{field: value})


@pytest.mark.parametrize("field", NOISE)
def test_noise_may_be_zero_but_not_negative(field: str) -> None:
    assert getattr(replace(ROBOT, **{field: 0.0}), field) == 0.0
    with pytest.raises(ValueError, match=f"^{field} must not be negative, it is -0.001$"):
        replace(ROBOT, **{field: -1e-3})


@pytest.mark.parametrize("bits", [0, 2, 8, 16, 32, 64])
def test_counters_of_all_usual_widths(bits: int) -> None:
    assert replace(ROBOT, encoder_bits=bits).encoder_bits == bits


@pytest.mark.parametrize("bits", [1, -8, 65])
def test_counters_of_no_width_there_is(bits: int) -> None:
    with pytest.raises(ValueError, match=rf"^encoder_bits must be 0 .* from 2 to 64, it is {bits}"):
        replace(ROBOT, encoder_bits=bits)


def test_the_order_of_the_covariance_is_one_of_two() -> None:
    with pytest.raises(ValueError, match=r"^covariance_order must be first or exact, it is second"):
        replace(ROBOT, covariance_order="second")


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        (
            {"wheel_separation": 1e-300},
            "wheel_separation times wheel_separation_multiplier must be",
        ),
        ({"wheel_separation": 1e300}, "wheel_separation times wheel_separation_multiplier must be"),
        ({"wheel_separation": 1e-5, "wheel_separation_multiplier": 1e-5}, "wheel_separation times"),
        ({"wheel_separation_multiplier": 5e-324}, "wheel_separation times"),
        ({"wheel_radius": 1e155}, "wheel_radius times left_wheel_radius_multiplier must be from"),
        ({"right_wheel_radius_multiplier": 1e308}, "wheel_radius times right_wheel_radius_mult"),
        (
            {"left_ticks_per_revolution": 5e-324},
            "travel for one count .* left_ticks_per_revolution",
        ),
        ({"right_ticks_per_revolution": 1e300}, "travel for one count .* must be from 1e-15 to"),
        ({"left_wheel_noise": 1e160}, "left_wheel_noise must be at most 1000 m"),
    ],
)
def test_what_values_make_together_is_of_this_world(changes: dict[str, float], said: str) -> None:
    with pytest.raises(ValueError, match=f"^{said}"):
        replace(ROBOT, **changes)


def test_the_track_and_the_counts_carry_the_calibration() -> None:
    robot = replace(
        ROBOT,
        wheel_separation_multiplier=1.01,
        left_wheel_radius_multiplier=0.99,
        right_wheel_radius_multiplier=1.02,
    )
    assert robot.track == pytest.approx(0.35 * 1.01)
    assert robot.left_tick == pytest.approx(2.0 * math.pi * 0.05 * 0.99 / 2000)
    assert robot.right_tick == pytest.approx(2.0 * math.pi * 0.05 * 1.02 / 1000)


def test_without_words_a_robot_has_the_noise_of_the_papers() -> None:
    assert (ROBOT.left_wheel_noise, ROBOT.right_wheel_noise) == (0.00040, 0.00058)


def test_a_robot_does_not_change() -> None:
    with pytest.raises(FrozenInstanceError):
        ROBOT.wheel_radius = 0.06  # type: ignore[misc]
