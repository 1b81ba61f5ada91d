# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives as wheel counters read at a fixed rate, made from speeds and yaw rates; no noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000, 2000)


class Ticks(NamedTuple):
    """A record: stamps [s] and cumulative counts; arrays of shape (n,)."""

    time: np.ndarray
    left: np.ndarray
    right: np.ndarray


def read(
    robot: Robot, rate: float, speed: np.ndarray, yaw_rate: np.ndarray, phase: float = 0.37
) -> Ticks:
    """Counters of wheels that keep a speed [m/s] and a yaw rate [rad/s] from sample to sample.

    `phase` is how far the wheels are past a count at the start.
    """
    half = 0.5 * robot.track
    left, right = ((speed - half * yaw_rate) / rate, (speed + half * yaw_rate) / rate)
    return rolled(
        robot, rate, np.cumsum(np.append(0.0, left)), np.cumsum(np.append(0.0, right)), phase
    )


def rolled(
    robot: Robot, rate: float, left: np.ndarray, right: np.ndarray, phase: float = 0.37
) -> Ticks:
    """Counters of wheels that have rolled so far [m] at each sample."""
    return Ticks(
        np.arange(left.size) / rate,
        np.floor(left / robot.left_tick + phase).astype(np.int64),
        np.floor(right / robot.right_tick + phase).astype(np.int64),
    )


def square(robot: Robot = ROBOT, rate: float = 50.0, side: float = 4.0, laps: int = 1) -> Ticks:
    """Lines and turns on the spot, started and stopped at 0.5 m/s² of the wheels' rims."""
    line = speeded_up(side, 0.5, rate)
    spin = speeded_up(0.25 * np.pi * robot.track, 0.2, rate) / (0.5 * robot.track)
    speed = np.concatenate([line, np.zeros(spin.size)])
    yaw_rate = np.concatenate([np.zeros(line.size), spin])
    return read(robot, rate, np.tile(speed, 4 * laps), np.tile(yaw_rate, 4 * laps))


def speeded_up(distance: float, top: float, rate: float) -> np.ndarray:
    """Speeds that cover a distance from rest to rest, at 0.5 m/s²."""
    acceleration = 0.5
    duration = distance / top + top / acceleration
    time = (np.arange(int(duration * rate)) + 0.5) / rate
    speed = np.minimum(np.minimum(time, duration - time) * acceleration, top)
    return speed * distance / (speed.sum() / rate)


def figure_eight(robot: Robot = ROBOT, rate: float = 50.0, laps: int = 3) -> Ticks:
    """Curvature that swings from left to right and back all the time; loops of about 2 m."""
    time = np.arange(int(20.0 * laps * rate)) / rate
    return read(robot, rate, np.full(time.size, 0.4), 0.75 * np.sin(2.0 * np.pi * time / 20.0))


def random_drive(
    seed: int, robot: Robot = ROBOT, rate: float = 50.0, duration: float = 120.0
) -> Ticks:
    """Speed and yaw rate wander without rest, reversing now and then."""
    random = np.random.default_rng(seed)
    knots = int(duration) + 2
    time = np.arange(int(duration * rate)) / rate
    speed = np.clip(random.normal(0.3, 0.3, knots), -0.5, 0.8)
    yaw_rate = random.normal(0.0, 0.6, knots)
    at = np.arange(knots)
    return read(robot, rate, np.interp(time, at, speed), np.interp(time, at, yaw_rate))


def then(first: Ticks, second: Ticks) -> Ticks:
    """One record after the other, the robot standing still for one sample between."""
    gap = first.time[1] - first.time[0]
    return Ticks(
        np.append(first.time, first.time[-1] + gap + second.time - second.time[0]),
        np.append(first.left, first.left[-1] + second.left - second.left[0]),
        np.append(first.right, first.right[-1] + second.right - second.right[0]),
    )
