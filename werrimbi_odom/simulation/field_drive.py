# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings without motion capture: counters, gyro, lidar, and poses of a localiser.

The drive comes from the engine. During it, somebody holds the robot while its wheels turn, and
later carries it while it stands. The result is measured with the sensors of an ordinary robot.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from .bag import EPOCH
from .engine import AxlePose, Floats
from .held_and_carried import TURN, carried_in, held_in, later
from .hidden.hidden_effect import Peculiarity
from .lidar import Lidar, Sweeps, scanned
from .recording import Happened, Recording
from .robot import TrueRobot
from .rooms import around
from .sensors import ReferenceSensor, counters, sampling_times

BEHIND = Lidar(mount=AxlePose(-0.032, 0.0, 0.0))
"""A lidar with 218 beams slightly behind the axle, as on a TurtleBot3."""


@dataclass(frozen=True)
class FieldSensors:
    """Sensors on board, and their errors."""

    wheels_hz: float = 20.0
    imu_hz: float = 50.0
    localiser_hz: float = 10.0
    """Message rates of wheel angles, gyro, and localiser [Hz]."""
    stamp_jitter: float = 4e-3
    """Standard deviation of header stamps about the time of measurement [s]."""
    latency: float = 8e-3
    """Mean delay from the stamp to the reception of a message [s], exponentially distributed."""
    gyro_noise: float = 3e-3
    """Standard deviation of a reading [rad/s]."""
    gyro_bias: float = 5e-3
    gyro_scale: float = 0.02
    """Ranges of the bias [rad/s] and of the scale error, drawn once for each robot."""
    wander_xy: float = 0.03
    wander_yaw: float = 0.015
    wander_time: float = 15.0
    """Standard deviations of the localiser's error [m, rad], and its time constant [s]."""
    jumps: int = 2
    jump_xy: float = 0.15
    jump_yaw: float = 0.08
    """Number of jumps in a drive, and their standard deviations [m, rad]."""
    lidar: Lidar = BEHIND
    """The lidar, in a furnished room around the drive."""


@dataclass(frozen=True)
class FieldDrive:
    """One drive as measured by ordinary sensors; times [s] in the simulation's clock."""

    name: str
    wheels: Floats
    imu: Floats
    localiser: Floats
    """Header stamp, time of reception, and: angles of both wheels [rad]; yaw rate [rad/s]; x, y [m]
    and yaw [rad] of base_link in the map."""
    odometry: Floats
    """The robot's own dead reckoning x, y [m] and yaw [rad] with nominal sizes, per row of
    `wheels`, shape (n, 3)."""
    lidar: Lidar
    scans: Sweeps
    """The lidar and its scans; `scans.time` has the header stamps."""
    scans_received: Floats
    """Times of their reception, shape (n,)."""
    truth: dict[str, object] = field(default_factory=dict)
    """Ground truth for truth.json, which is not in the bag; times in the clock of the bag."""
    happened: tuple[Happened, ...] = ()
    """Events, in the same clock; part of the truth."""


@dataclass(frozen=True)
class Gyro:
    """Gyro of one robot: bias and noise of a reading [rad/s], and its scale."""

    bias: float
    scale: float
    noise: float


def gyro_of(sensors: FieldSensors, *, robot_seed: int) -> Gyro:
    """The gyro of a robot, the same in all its drives."""
    own = np.random.default_rng([robot_seed, 78])
    bias = float(own.uniform(-1.0, 1.0) * sensors.gyro_bias)
    scale = float(1.0 + own.uniform(-1.0, 1.0) * sensors.gyro_scale)
    return Gyro(bias, scale, sensors.gyro_noise)


def as_in_the_field(
    recording: Recording,
    robot: TrueRobot,
    *,
    seed: int,
    robot_seed: int = 0,
    hidden: Sequence[Peculiarity] = (),
) -> FieldDrive:
    """Measure a drive with ordinary sensors, after somebody held and carried the robot in it.

    `robot_seed` is of what all drives of the robot have in common (the gyro). The drive was
    recorded with the `hidden` peculiarities. Those of counters change the wheels' angles. Those of
    a reference change the localiser; the gyro, if they delay a heading; and the lidar, in its mount
    and its delay. What happened has the times at which it did between holding and carrying.
    """
    sensors = FieldSensors()
    rng = np.random.default_rng([seed, 77])
    gyro = gyro_of(sensors, robot_seed=robot_seed)
    path, held = held_in(recording.true_path, rng)
    path, carried = carried_in(path, rng)
    end = float(path.t_s[-1])

    read_at = sampling_times(sensors.wheels_hz, end, rng)
    zeros = rng.integers(-100_000, 100_000, 2) * (not robot.counters_keep_zero)
    read_stamps = _stamped(read_at, sensors, rng)

    at = sampling_times(sensors.imu_hz, end, rng)
    exact = ReferenceSensor(sigma_xy=0.0, sigma_yaw=0.0)
    for odd in hidden:
        exact = odd.reference(exact)
    felt = at - exact.delay - exact.heading_delay
    rate = np.interp(felt, path.t_s, np.gradient(path.yaw_rad, path.t_s))
    rate = gyro.scale * rate + gyro.bias + gyro.noise * rng.standard_normal(at.size)
    imu = np.column_stack([*_stamped(at, sensors, rng), rate])

    at = sampling_times(sensors.localiser_hz, end, rng)
    errors, jumped = _wandering(at.size, sensors, rng)
    x, y, yaw = exact.measure(path, at, rng)
    stamps, received = _stamped(at, sensors, rng)

    counts = counters(path, robot, read_at, zeros.tolist())
    seen = Recording(recording.name, read_at, *counts, at, x, y, yaw, path)
    jumps: list[Happened] = []
    for number, odd in enumerate(hidden):
        seen = odd.recording(seen, robot, np.random.default_rng([seed, 79, number]))
        jumps += odd.happened(float(seen.t_s[-1]), robot, np.random.default_rng([seed, 79, number]))
    poses = np.column_stack([seen.reference_x_m, seen.reference_y_m, seen.reference_yaw_rad])
    localiser = np.column_stack([stamps + (seen.reference_t_s - at), received, poses + errors])
    left = np.asarray(seen.left_ticks * (TURN / robot.left_ticks_per_revolution), float)
    right = np.asarray(seen.right_ticks * (TURN / robot.right_ticks_per_revolution), float)
    wheels = np.column_stack([*read_stamps, left, right])
    happened = [
        *(each for each in jumps if each.of == "reference_jump"),
        *(later(each, held, carried) for each in recording.happened if each.of != "reference_jump"),
    ]
    truth: dict[str, object] = {
        "held": [_by_the_bag(held)],
        "carried": [_by_the_bag(carried)],
        "localiser_jumps": _by_the_bag(at[jumped].tolist()),
        "gyro": {"bias_rad_per_s": gyro.bias, "scale": gyro.scale},
    }
    odometry = _dead_reckoned(left, right, robot)
    room = around(path.x_m, path.y_m, robot_seed)
    scans = scanned(path, room, _as_it_sits(sensors.lidar, exact.mount), seed)
    whole = scans.time + 1.0 / sensors.lidar.rate_hz
    scans = replace(scans, time=scans.time + exact.delay)
    return FieldDrive(
        recording.name,
        wheels,
        imu,
        localiser,
        odometry,
        sensors.lidar,
        scans,
        _received(scans.time, whole, sensors, rng),
        truth,
        tuple(replace(each, t_s=_by_the_bag([each.t_s])[0]) for each in happened),
    )


def _as_it_sits(lidar: Lidar, beside: AxlePose) -> Lidar:
    """The lidar if its transform is relative to a base displaced by `beside`."""
    cos, sin = math.cos(beside.yaw), math.sin(beside.yaw)
    x, y, yaw = lidar.mount
    there = AxlePose(beside.x + cos * x - sin * y, beside.y + sin * x + cos * y, beside.yaw + yaw)
    return replace(lidar, mount=there)


def _by_the_bag(times: Sequence[float]) -> list[float]:
    """Times in the clock of the bag [s], rounded to milliseconds."""
    return [round(EPOCH + time, 3) for time in times]


def _stamped(at: Floats, sensors: FieldSensors, rng: np.random.Generator) -> tuple[Floats, Floats]:
    """Header stamps, sorted, and times of reception."""
    stamps = np.sort(at + sensors.stamp_jitter * rng.standard_normal(at.size))
    return stamps, _received(stamps, at, sensors, rng)


def _received(
    stamps: Floats, known: Floats, sensors: FieldSensors, rng: np.random.Generator
) -> Floats:
    """Times of reception, in the order sent, of what was measured by `known`."""
    received = np.maximum(stamps, known) + rng.exponential(sensors.latency, stamps.size)
    return np.asarray(np.maximum.accumulate(received))


def _wandering(
    count: int, sensors: FieldSensors, rng: np.random.Generator
) -> tuple[Floats, NDArray[np.intp]]:
    """Errors of a localiser's poses, shape (k, 3) [m, m, rad], and the rows at which it jumps."""
    sizes = np.array([sensors.wander_xy, sensors.wander_xy, sensors.wander_yaw])
    kept = math.exp(-1.0 / (sensors.localiser_hz * sensors.wander_time))
    steps = rng.standard_normal((count, 3)) * sizes * math.sqrt(1.0 - kept * kept)
    rows = np.sort(rng.choice(np.arange(count // 10, count), sensors.jumps, replace=False))
    jump = np.array([sensors.jump_xy, sensors.jump_xy, sensors.jump_yaw])
    error, errors = sizes * rng.standard_normal(3), []
    for row in range(count):
        error = kept * error + steps[row]
        if row in rows:
            error = jump * rng.standard_normal(3)  # relocalised, or lost
        errors.append(error)
    return np.array(errors), rows


def _dead_reckoned(left: Floats, right: Floats, robot: TrueRobot) -> Floats:
    """Dead reckoning of the robot's own driver from zero, shape (n, 3) [m, m, rad]."""
    radius, base = robot.nominal.wheel_radius, robot.nominal.wheel_separation
    gone, turned = (radius * np.diff(each) for each in (0.5 * (left + right), right - left))
    yaw = np.concatenate([[0.0], np.cumsum(turned / base)])
    middle = 0.5 * (yaw[1:] + yaw[:-1])
    x, y = (np.concatenate([[0.0], np.cumsum(gone * f(middle))]) for f in (np.cos, np.sin))
    return np.column_stack([x, y, yaw])
