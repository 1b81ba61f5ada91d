# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One drive from beginning to end: a robot, what it is told, and what was recorded of it."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .chassis import chassis_of
from .engine import PERIOD, Pose, drive
from .manoeuvre import Manoeuvre
from .recording import Recording
from .robot import TrueRobot
from .sensors import ReferenceSensor, count, sampling_times
from .wheel_noise import wheel_noise

REST = 0.6
"""Standstill before and after the manoeuvre [s]."""


def record(
    robot: TrueRobot,
    manoeuvre: Manoeuvre,
    *,
    seed: int,
    reference: ReferenceSensor | None = None,
    ticks_rate_hz: float = 50.0,
    start: Pose | None = None,
) -> Recording:
    """Drive `robot` through `manoeuvre` in the physics engine and record it.

    Parameters
    ----------
    robot : TrueRobot
    manoeuvre : Manoeuvre
    seed : int
        Of everything random in this run: noises, start pose, wheel angles, counters, time grids.
        Each has its own stream, so switching one off leaves the others as they were.
    reference : ReferenceSensor, optional
        By default a motion capture system at 20 Hz with 1 mm and 2 mrad of noise.
    ticks_rate_hz : float
        How often the counters are read.
    start : Pose, optional
        Where the robot begins, in the world; by default anywhere within a metre, facing anywhere.
    """
    reference = reference or ReferenceSensor()
    rng = _stream(seed, "start")
    anywhere = Pose(*rng.uniform((-1.0, -1.0, -math.pi), (1.0, 1.0, math.pi)))
    angles = rng.uniform(0.0, 2 * math.pi, 2)
    path = drive(
        chassis_of(robot),
        wheel_speeds(robot, manoeuvre),
        start=anywhere if start is None else start,
        angles=(float(angles[0]), float(angles[1])),
        shifters=[wheel_noise(robot, _stream(seed, "wheel noise"))],
    )
    end = float(path.t_s[-1])
    t = sampling_times(ticks_rate_hz, end, _stream(seed, "encoders"))
    zeros = _stream(seed, "counters").integers(-100_000, 100_000, 2)
    if robot.counters_keep_zero:
        zeros = np.zeros_like(zeros)
    rng = _stream(seed, "reference")
    reference_t = reference.times(end, rng)
    x, y, yaw = reference.measure(path, reference_t, rng)
    return Recording(
        name=manoeuvre.name,
        t_s=t,
        left_ticks=count(
            path.t_s, path.left_angle_rad, t, robot.left_ticks_per_revolution, int(zeros[0])
        ),
        right_ticks=count(
            path.t_s, path.right_angle_rad, t, robot.right_ticks_per_revolution, int(zeros[1])
        ),
        reference_t_s=reference_t,
        reference_x_m=x,
        reference_y_m=y,
        reference_yaw_rad=yaw,
        true_path=path,
    )


def wheel_speeds(robot: TrueRobot, manoeuvre: Manoeuvre) -> NDArray[np.float64]:
    """Motor speeds that the robot's own controller, believing the nominal geometry, asks for.

    Returns
    -------
    ndarray, shape (n, 2)
        Left and right [rad/s] in each PERIOD, with REST before and after.
    """
    periods = math.ceil((manoeuvre.duration + 2 * REST) / PERIOD)
    times = PERIOD * np.arange(periods + 1, dtype=np.float64) - REST
    speed, yaw_rate = manoeuvre.commands(times)
    half, radius = robot.nominal.wheel_separation / 2, robot.nominal.wheel_radius
    return np.column_stack((speed - half * yaw_rate, speed + half * yaw_rate)) / radius


Purpose = Literal["start", "wheel noise", "encoders", "counters", "reference", "hidden"]
_PURPOSES: tuple[Purpose, ...] = (
    "start",
    "wheel noise",
    "encoders",
    "counters",
    "reference",
    "hidden",
)


def _stream(seed: int, purpose: Purpose) -> np.random.Generator:
    """Random numbers of one purpose in the run `seed`."""
    return np.random.default_rng([seed, _PURPOSES.index(purpose)])
