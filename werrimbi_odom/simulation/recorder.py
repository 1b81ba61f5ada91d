# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Record one drive: a robot, its commands, and the measurements."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import reduce
from typing import Literal, get_args, overload

import numpy as np

from .chassis import Chassis, chassis_of
from .engine import PERIOD, AxlePose, Floats, Reshaper, Shift, Shifter, Stride, TruePath, drive
from .hidden.hidden_effect import Peculiarity
from .manoeuvres import Manoeuvre
from .recording import Happened, Recording
from .robot import TrueRobot
from .sensors import ReferenceSensor, counters, sampling_times


def wheel_noise(robot: TrueRobot, rng: np.random.Generator) -> Shifter:
    """Travel noise of both wheels.

    Over a stride of path length s the left wheel errs by N(0, k_L^2 s), the right one by N(0,
    k_R^2 s), independently (section 4 of the paper). The noise has no force, so the body is moved
    after the step; the encoders see only the rolling.
    """

    def shift(stride: Stride) -> Shift:
        a, b = rng.standard_normal(2)
        left = robot.left_wheel_noise * math.sqrt(abs(stride.left)) * a
        right = robot.right_wheel_noise * math.sqrt(abs(stride.right)) * b
        return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)

    return shift


REST = 0.6
"""Rest before and after the manoeuvre [s]."""


def record(
    robot: TrueRobot,
    manoeuvre: Manoeuvre,
    *,
    seed: int,
    reference: ReferenceSensor | None = None,
    ticks_rate_hz: float = 50.0,
    start: AxlePose | None = None,
    hidden: Sequence[Peculiarity] = (),
) -> Recording:
    """Drive `robot` through `manoeuvre` in the physics engine and record it.

    The seed is of all random numbers of this run: noises, start pose, wheel angles, counters,
    sampling times. Each has its own stream, so that switching one off does not change the others.
    By default the reference is motion capture at 20 Hz with 1 mm and 2 mrad of noise, and the start
    is random within a metre. Peculiarities of the robot, its floor or its recording are applied in
    their order.
    """
    ready = prepared(robot, seed=seed, reference=reference, start=start, hidden=hidden)
    robot = ready.robot
    path = drive(
        ready.chassis,
        wheel_speeds(robot, manoeuvre),
        start=ready.start,
        angles=ready.angles,
        shifters=ready.shifters,
        reshapers=ready.reshapers,
    )
    recording = _sample(robot, manoeuvre.name, path, ready.sensor, ticks_rate_hz, seed)
    happened: list[Happened] = []
    for number, odd in enumerate(hidden):
        recording = odd.recording(recording, robot, stream(seed, "hidden", number))
        end = float(recording.t_s[-1])
        happened += odd.happened(end, robot, stream(seed, "hidden", number))
    return replace(recording, happened=tuple(happened)) if happened else recording


@dataclass(frozen=True)
class ReadyRobot:
    """A robot ready to drive with its peculiarities, as arguments of `drive`."""

    robot: TrueRobot
    sensor: ReferenceSensor
    chassis: Chassis
    start: AxlePose
    angles: tuple[float, float]
    shifters: Sequence[Shifter]
    reshapers: Sequence[Reshaper]


def prepared(
    robot: TrueRobot,
    *,
    seed: int,
    reference: ReferenceSensor | None = None,
    start: AxlePose | None = None,
    hidden: Sequence[Peculiarity] = (),
) -> ReadyRobot:
    """Apply all peculiarities and draw the start; parameters as in `record`."""
    robot = reduce(lambda so_far, odd: odd.robot(so_far), hidden, robot)
    chassis = reduce(lambda so_far, odd: odd.chassis(so_far), hidden, chassis_of(robot))
    sensor = reduce(
        lambda so_far, odd: odd.reference(so_far), hidden, reference or ReferenceSensor()
    )

    def rng_of(number: int) -> np.random.Generator:
        return stream(seed, "hidden", number)

    shifters = [odd.shifter(robot, rng_of(i)) for i, odd in enumerate(hidden)]
    reshapers = [odd.reshaper(chassis, rng_of(i)) for i, odd in enumerate(hidden)]

    rng = stream(seed, "start")
    anywhere = AxlePose(*rng.uniform((-1.0, -1.0, -math.pi), (1.0, 1.0, math.pi)))
    angles = rng.uniform(0.0, 2 * math.pi, 2)
    return ReadyRobot(
        robot,
        sensor,
        chassis,
        start=anywhere if start is None else start,
        angles=(float(angles[0]), float(angles[1])),
        shifters=[
            wheel_noise(robot, stream(seed, "wheel noise")),
            *(shifter for shifter in shifters if shifter),
        ],
        reshapers=[reshaper for reshaper in reshapers if reshaper],
    )


def counter_zeros(robot: TrueRobot, seed: int) -> tuple[int, int]:
    """Counter values, left and right, at zero shaft angle."""
    if robot.counters_keep_zero:
        return 0, 0
    left, right = stream(seed, "counters").integers(-100_000, 100_000, 2)
    return int(left), int(right)


def _sample(
    robot: TrueRobot,
    name: str,
    path: TruePath,
    sensor: ReferenceSensor,
    ticks_rate_hz: float,
    seed: int,
) -> Recording:
    """Measurements of encoders and reference along the true path."""
    end = float(path.t_s[-1])
    t = sampling_times(ticks_rate_hz, end, stream(seed, "encoders"))
    left, right = counters(path, robot, t, counter_zeros(robot, seed))
    rng = stream(seed, "reference")
    reference_t = sampling_times(sensor.rate_hz, end, rng)
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


def wheel_speeds(robot: TrueRobot, manoeuvre: Manoeuvre) -> Floats:
    """Motor speeds commanded by the robot's own controller with its nominal geometry.

    Left and right [rad/s] in each PERIOD, with REST before and after, shape (n, 2).
    """
    periods = math.ceil((manoeuvre.duration + 2 * REST) / PERIOD)
    times = PERIOD * np.arange(periods + 1, dtype=np.float64) - REST
    speed, yaw_rate = manoeuvre.commands(times)
    return np.column_stack(motor_speeds(robot, speed, yaw_rate))


@overload
def motor_speeds(robot: TrueRobot, speed: float, yaw_rate: float) -> tuple[float, float]: ...
@overload
def motor_speeds(robot: TrueRobot, speed: Floats, yaw_rate: Floats) -> tuple[Floats, Floats]: ...
def motor_speeds(
    robot: TrueRobot, speed: float | Floats, yaw_rate: float | Floats
) -> tuple[float | Floats, float | Floats]:
    """Speeds of the left and right motor [rad/s], by the nominal geometry."""
    half, radius = robot.nominal.wheel_separation / 2, robot.nominal.wheel_radius
    return (speed - half * yaw_rate) / radius, (speed + half * yaw_rate) / radius


Purpose = Literal["start", "wheel noise", "encoders", "counters", "reference", "hidden"]


def stream(seed: int, purpose: Purpose, number: int = 0) -> np.random.Generator:
    """A new random generator for one purpose in the run `seed`."""
    return np.random.default_rng([seed, get_args(Purpose).index(purpose), number])
