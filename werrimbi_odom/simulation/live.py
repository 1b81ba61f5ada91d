# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that is driven live: takes commands, returns sensor readings, in bounded memory."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .engine import PERIOD, AxlePose, DrivenRobot, Floats, TruePath
from .field_drive import FieldSensors, gyro_of
from .hidden.hidden_effect import Peculiarity
from .lidar import Room, sweeps_at
from .recorder import counter_zeros, motor_speeds, prepared, stream
from .recording import Recording
from .robot import TrueRobot
from .sensors import ReferenceSensor, counters

ACCELERATION, YAW_ACCELERATION = 3.0, 12.0
"""Largest accelerations by the robot's own controller [m/s^2, rad/s^2]: above those of all drives
of `sessions`, and within the grip of the tyres."""

CHECKED_EVERY = 20
"""Periods between two checks for engine warnings, each of which costs more than a period."""

KEPT = 400
"""Rows of the true path that are kept, 2 s, and those of the reference's delay."""


class LiveRobot:
    """A robot in the engine, driven period by period by commands as they arrive.

    Seed, start and peculiarities are as in `record`; extra channels of the latter are not available
    live, and ValueError refuses peculiarities that are made in a whole record. A `room` is for the
    lidar only: in the engine the robot drives through the walls.
    """

    def __init__(
        self,
        robot: TrueRobot,
        *,
        seed: int,
        reference: ReferenceSensor | None = None,
        start: AxlePose = AxlePose(0.0, 0.0, 0.0),  # noqa: B008 (immutable)
        hidden: Sequence[Peculiarity] = (),
        room: Room | None = None,
    ) -> None:
        for odd in hidden:
            if not odd.live:
                raise ValueError(
                    f"{type(odd).__name__} is made in a whole record: a robot that is driven live "
                    "cannot have it"
                )
        ready = prepared(robot, seed=seed, reference=reference, start=start, hidden=hidden)
        self._robot, self._sensor, self._hidden = ready.robot, ready.sensor, tuple(hidden)
        self._driven = DrivenRobot(
            ready.chassis, ready.start, ready.angles, ready.shifters, ready.reshapers
        )
        self._zeros = counter_zeros(ready.robot, seed)
        self._noise = stream(seed, "reference")
        self._rngs = [np.random.default_rng([seed, 79, number]) for number in range(len(hidden))]
        self._counted = [one for one in (odd.counted(ready.robot) for odd in hidden) if one]
        sensors = FieldSensors()
        self.lidar, self._room = sensors.lidar, room
        self._lidar_noise = np.random.default_rng([seed, 81])
        self._gyro = gyro_of(sensors, robot_seed=seed)
        self._gyro_noise = np.random.default_rng([seed, 80])
        self._count = self._unchecked = 0
        self._wanted = self._speeds = (0.0, 0.0)
        self.counters_lag = max((odd.ahead for odd in hidden), default=0.0)
        """Delay from the stamp of a counter reading until it is available [s]."""
        delays = (self._sensor.delay, self._sensor.delay + self._sensor.heading_delay)
        self._kept = KEPT + round(max(0.0, *delays) / PERIOD)
        self._rows = np.empty((2 * self._kept, 8))
        self.reference_lag = max(0.0, *(-delay for delay in delays))
        """The same for the reference [s]."""
        self._keep()

    @property
    def time(self) -> float:
        """Time since the start [s]."""
        return self._driven.row[0]

    @property
    def pose(self) -> AxlePose:
        """True pose of the robot."""
        return AxlePose(*self._driven.row[1:4])

    def command(self, speed: float, yaw_rate: float) -> None:
        """Set the commanded speed [m/s] and yaw rate [rad/s]."""
        self._wanted = speed, yaw_rate

    def advance(self) -> None:
        """Drive for one PERIOD; UnstableError if the engine became unstable."""
        most = ACCELERATION * PERIOD, YAW_ACCELERATION * PERIOD
        self._speeds = (
            _towards(self._speeds[0], self._wanted[0], most[0]),
            _towards(self._speeds[1], self._wanted[1], most[1]),
        )
        self._driven.advance(*motor_speeds(self._robot, *self._speeds))
        self._keep()
        self._unchecked += 1
        if self._unchecked == CHECKED_EVERY:
            self._unchecked = 0
            self._driven.check()

    def counters(self, time: float) -> tuple[int, int]:
        """Readings of the counters, left and right, at a time within the last second [s]."""
        path, at, none = self._path(), np.array([time]), np.empty(0)
        angles = np.ascontiguousarray(self._rows[: self._count, 6:].T)
        counted = replace(path, left_angle_rad=angles[0], right_angle_rad=angles[1])
        left, right = counters(counted, self._robot, at, self._zeros)
        seen = Recording("live", at, left, right, none, none, none, none, path)
        for odd, rng in zip(self._hidden, self._rngs, strict=True):
            if odd.counted(self._robot) is None:
                seen = odd.recording(seen, self._robot, rng)
        return int(seen.left_ticks[0]), int(seen.right_ticks[0])

    def reference(self, time: float) -> AxlePose:
        """Measurement of the reference at a time within the last second [s]."""
        measured = self._sensor.measure(self._path(), np.array([time]), self._noise)
        return AxlePose(*(float(each[0]) for each in measured))

    def gyro(self, since: float, until: float) -> float:
        """Mean yaw rate of the gyro [rad/s] between two times [s]; of the last second at most."""
        path, since = self._path(), max(since, until - 1.0)
        before, after = np.interp([since, until], path.t_s, path.yaw_rad)
        rate = (after - before) / (until - since)
        noise = self._gyro.noise * self._gyro_noise.standard_normal()
        return float(self._gyro.scale * rate + self._gyro.bias + noise)

    def sweep(self, start: float) -> Floats:
        """Ranges [m] of the turn of the lidar that began at `start` [s]; it must have ended."""
        assert self._room is not None
        at = np.array([start])
        seen = sweeps_at(self._path(), self._room, self.lidar, at, self._lidar_noise)
        return np.asarray(seen.ranges[0])

    def _keep(self) -> None:
        """Append the current row; when the buffer is full, discard its older half."""
        if self._count == len(self._rows):
            self._rows[: self._kept] = self._rows[self._kept :]
            self._count = self._kept
        row = self._driven.row
        angles = row[4], row[5]
        for one in self._counted:
            angles = one(row[0], *angles)
        self._rows[self._count] = (*row, *angles)
        self._count += 1

    def _path(self) -> TruePath:
        return TruePath(*np.ascontiguousarray(self._rows[: self._count, :6].T))


def _towards(value: float, wanted: float, most: float) -> float:
    return value + math.copysign(min(abs(wanted - value), most), wanted - value)
