# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One drive from beginning to end: a robot, what it is told, and what was recorded of it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import reduce
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from .chassis import chassis_of
from .engine import PERIOD, Pose, TruePath, drive
from .hidden.peculiarity import Peculiarity
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
    hidden: Sequence[Peculiarity] = (),
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
    hidden : sequence of Peculiarity
        What is odd about the robot, its floor or its recording; acts in this order.
    """
    robot = reduce(lambda so_far, odd: odd.robot(so_far), hidden, robot)
    chassis = reduce(lambda so_far, odd: odd.chassis(so_far), hidden, chassis_of(robot))
    sensor = reduce(
        lambda so_far, odd: odd.reference(so_far), hidden, reference or ReferenceSensor()
    )

    def rng_of(number: int) -> np.random.Generator:
        return _stream(seed, "hidden", number)

    shifters = [odd.shifter(robot, rng_of(i)) for i, odd in enumerate(hidden)]
    reshapers = [odd.reshaper(chassis, rng_of(i)) for i, odd in enumerate(hidden)]

    rng = _stream(seed, "start")
    anywhere = Pose(*rng.uniform((-1.0, -1.0, -math.pi), (1.0, 1.0, math.pi)))
    angles = rng.uniform(0.0, 2 * math.pi, 2)
    path = drive(
        chassis,
        wheel_speeds(robot, manoeuvre),
        start=anywhere if start is None else start,
        angles=(float(angles[0]), float(angles[1])),
        shifters=[
            wheel_noise(robot, _stream(seed, "wheel noise")),
            *(shifter for shifter in shifters if shifter),
        ],
        reshapers=[reshaper for reshaper in reshapers if reshaper],
    )
    recording = _sample(robot, manoeuvre.name, path, sensor, ticks_rate_hz, seed)
    for number, odd in enumerate(hidden):
        recording = odd.recording(recording, robot, rng_of(number))
    return recording


def _sample(
    robot: TrueRobot,
    name: str,
    path: TruePath,
    sensor: ReferenceSensor,
    ticks_rate_hz: float,
    seed: int,
) -> Recording:
    """What encoders and reference saw of the true path."""
    end = float(path.t_s[-1])
    t = sampling_times(ticks_rate_hz, end, _stream(seed, "encoders"))
    zeros = _stream(seed, "counters").integers(-100_000, 100_000, 2)
    if robot.counters_keep_zero:
        zeros = np.zeros_like(zeros)
    left, right = (
        count(path.t_s, angle, t, resolution, int(zero))
        for angle, resolution, zero in (
            (path.left_angle_rad, robot.left_ticks_per_revolution, zeros[0]),
            (path.right_angle_rad, robot.right_ticks_per_revolution, zeros[1]),
        )
    )
    rng = _stream(seed, "reference")
    reference_t = sensor.times(end, rng)
    x, y, yaw = sensor.measure(path, reference_t, rng)
    return Recording(
        name=name,
        t_s=t,
        left_ticks=left,
        right_ticks=right,
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


def _stream(seed: int, purpose: Purpose, number: int = 0) -> np.random.Generator:
    """Random numbers of one purpose in the run `seed`, always from their beginning."""
    return np.random.default_rng([seed, _PURPOSES.index(purpose), number])
