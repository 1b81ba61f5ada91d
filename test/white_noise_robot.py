# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot whose wheels err with white noise, in small steps; shares no formula with us."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.robot import Robot

RATE = 50.0


@dataclass(frozen=True)
class WhiteNoiseRobot:
    separation: float = 0.353
    left_radius: float = 0.0502
    right_radius: float = 0.0499
    left_noise: float = 1.0e-3
    right_noise: float = 2.0e-3
    ticks_per_revolution: float = 2000.0

    def entered(self, radius: float = 1.0, noise: float = 1.0) -> Robot:
        """As its robot file would have it: sizes by multipliers, `noise` times the wheels' own."""
        return Robot(
            self.separation,
            radius,
            self.ticks_per_revolution,
            self.ticks_per_revolution,
            left_wheel_radius_multiplier=self.left_radius / radius,
            right_wheel_radius_multiplier=self.right_radius / radius,
            left_wheel_noise=noise * self.left_noise,
            right_wheel_noise=noise * self.right_noise,
        )


def wandering(
    random: np.random.Generator, seconds: float, rate: float = RATE
) -> tuple[np.ndarray, np.ndarray]:
    """Speeds and yaw rates of a drive with lines, curves both ways, spins, stops, reversing."""
    knots = int(seconds / 2.0) + 2
    kind = random.choice(5, size=knots, p=[0.3, 0.35, 0.15, 0.1, 0.1])
    speed = np.choose(
        kind,
        [
            random.uniform(0.2, 0.6, knots),
            random.uniform(0.2, 0.5, knots),
            np.zeros(knots),
            np.zeros(knots),
            random.uniform(-0.4, -0.2, knots),
        ],
    )
    bend = random.choice([-1.0, 1.0], knots) * random.uniform(0.3, 1.2, knots)
    turning = np.choose(kind, [np.zeros(knots), bend, bend, np.zeros(knots), np.zeros(knots)])
    time = np.arange(int(seconds * rate)) / rate
    held = np.minimum((time / 2.0).astype(int), knots - 1)
    smooth = np.ones(int(0.3 * rate)) / int(0.3 * rate)
    return np.convolve(speed[held], smooth, "same"), np.convolve(turning[held], smooth, "same")


def square(side: float, sense: float) -> tuple[np.ndarray, np.ndarray]:
    """One lap of a square; sense +1 anticlockwise, -1 clockwise."""
    line, spin = int(side / 0.4 * RATE), int(0.5 * np.pi / 0.6 * RATE)
    speeds, rates = [], []
    for _ in range(4):
        speeds += [side / line * RATE] * line + [0.0] * spin
        rates += [0.0] * line + [sense * 0.5 * np.pi / spin * RATE] * spin
    return np.array(speeds), np.array(rates)


def drive(
    robot: WhiteNoiseRobot,
    commands: tuple[np.ndarray, np.ndarray],
    random: np.random.Generator,
    *,
    sigma_xy: float = 1e-3,
    sigma_yaw: float = 2e-3,
    every: int = 3,
    fine: int = 4,
    hertz: float = RATE,
) -> Run:
    """A recorded run: the encoders count the commanded travel, the robot's true travel errs.

    Each step is integrated in `fine` parts with noise of its own; the reference is a pose with
    Gaussian noise at every `every`-th message.
    """
    speed, rate = commands
    left = (speed - 0.5 * robot.separation * rate) / hertz
    right = (speed + 0.5 * robot.separation * rate) / hertz
    count = speed.size
    scale = np.sqrt(np.abs(np.stack([left, right])) / fine)[..., None]
    noise = scale * random.standard_normal((2, count, fine))
    noise *= np.array([robot.left_noise, robot.right_noise])[:, None, None]
    true_left = (left[:, None] / fine + noise[0]).ravel()
    true_right = (right[:, None] / fine + noise[1]).ravel()
    turn = (true_right - true_left) / robot.separation
    yaw = np.concatenate([[0.0], np.cumsum(turn)]) + random.uniform(-3.0, 3.0)
    step = 0.5 * (true_left + true_right) * np.sinc(0.5 * turn / np.pi)
    path = np.concatenate([[0j], np.cumsum(step * np.exp(1j * (yaw[:-1] + 0.5 * turn)))])
    time = np.arange(count + 1) / hertz
    counts = [
        np.floor(
            random.uniform(-5e4, 5e4)
            + np.concatenate([[0.0], np.cumsum(travel)])
            / (2.0 * np.pi * radius)
            * robot.ticks_per_revolution
        )
        for travel, radius in ((left, robot.left_radius), (right, robot.right_radius))
    ]
    rows = np.arange(0, count + 1, every)
    at = path[rows * fine]
    noise = [sigma * random.standard_normal(rows.size) for sigma in (sigma_xy, sigma_xy, sigma_yaw)]
    return Run(
        "simulated",
        Path("simulated"),
        Ticks(time, counts[0], counts[1]),
        Reference(time[rows], at.real + noise[0], at.imag + noise[1], yaw[rows * fine] + noise[2]),
    )
