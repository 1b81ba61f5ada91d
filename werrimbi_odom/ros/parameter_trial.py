# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tests parameter values on an imaginary drive, before real counters are used."""

from __future__ import annotations

import math

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.odometer import Estimate, Odometer
from werrimbi_odom.model.pieces_online import PieceTolerance
from werrimbi_odom.model.robot import Robot

_TURNS = ((0.0, 0.0), (1.0, 1.0), (1.0, -1.0), (0.5, 2.0), (-1.0, -1.0), (100.0, 100.0))
"""Turns of the left and right wheel in one second: rest, line, spin, arc, reversal, a fast line."""


def rehearse(robot: Robot, tolerance: PieceTolerance) -> None:
    """Simulate a robot on every kind of piece.

    Raises
    ------
    InputError
        If pose, twist or a covariance is not finite.
    """
    odometer = Odometer(robot, tolerance)
    left = right = time = 0.0
    for turns_left, turns_right in (_TURNS[0], *_TURNS):
        left += turns_left * robot.left_ticks_per_revolution
        right += turns_right * robot.right_ticks_per_revolution
        time += 1.0
        try:
            estimate = odometer.update(time, left, right)
        except ArithmeticError:
            estimate = None
            lost = True
        else:
            lost = estimate is not None and not is_finite(estimate)
        if lost:
            raise InputError(
                "with these values odometry is beyond all numbers (tried on a line, a spin, an arc "
                f"and a reversal of a wheel's turn or two; track {robot.track:g} m, "
                f"{robot.left_tick:g} and {robot.right_tick:g} m for a count)"
            )


def is_finite(estimate: Estimate) -> bool:
    """Whether all numbers of an estimate are finite."""
    return math.isfinite(
        sum((*estimate.pose, *estimate.covariance, *estimate.twist, *estimate.twist_covariance))
    )
