# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ideal records of simple manoeuvres, computed from kinematics alone.

They are what a robot without faults would record, to predict what an effect would change in them.
There is no physics engine: that is for tests.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.manoeuvres.library import Ideal
from werrimbi_odom.model.effect import view_of, wiring_of
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.wiring import Wiring

REST = 0.6
"""Standstill before and after [s]."""

FINE = 0.005
"""Time step of the ideal path [s]."""


@dataclass(frozen=True, slots=True)
class DrivingLimits:
    """Speeds that a robot can reach, taken from its recorded drives; at pace 1."""

    speed: float
    """In [m/s]."""
    acceleration: float
    """At hard starts and stops [m/s^2]."""
    base: float
    """Distance between the wheels [m]."""

    @property
    def size(self) -> float:
        """Unit of length for a robot of this size [m]: 1 m for wheels 35 cm apart."""
        return self.base / 0.35

    @property
    def yaw_rate(self) -> float:
        """Yaw rate of a spin with the wheels at 0.6 of their speed [rad/s]."""
        return 1.2 * self.speed / self.base


def pace_of(runs: Concatenated, robot: Robot) -> DrivingLimits:
    """The pace of the recorded drives."""
    travel, drive = runs.raw(robot), runs.drive(robot)
    duration = np.maximum(drive.duration, 1e-6)
    rims = np.concatenate([np.abs(travel.left), np.abs(travel.right)]) / np.tile(duration, 2)
    speed = float(np.quantile(rims[rims > 0.0], 0.95)) if (rims > 0.0).any() else rules.PACE_UNKNOWN
    speed = min(max(speed, rules.SLOWEST_PACE), rules.FASTEST_PACE)
    return DrivingLimits(speed, rules.HARD_START * speed, robot.track)


def rates_of(runs: Concatenated) -> tuple[float, float]:
    """Median time between two messages of the ticks, and between two poses of the reference [s].

    Infinite for a reference with two to four poses in a drive (`TAPED_INTERVALS`).
    """
    ticks = np.concatenate([np.diff(run.counters.time) for run in runs.runs])
    poses = [
        np.diff(run.measured.time) / np.maximum(run.intervals, 1.0)
        for run in runs.runs
        if run.intervals.sum() > rules.TAPED_INTERVALS
    ]
    every = float(np.median(np.concatenate(poses))) if poses else math.inf
    return float(np.median(ticks)), every


def ideal_run(
    ideal: Ideal,
    robot: Robot,
    pace: DrivingLimits,
    *,
    ticks: float,
    poses: float,
    measures: tuple[bool, bool],
    channels: dict[str, tuple[float, float]] | None = None,
) -> Run:
    """The record of a manoeuvre by a robot that is exactly as the model, without noise.

    `ideal`: the manoeuvre. `robot`: the model. `pace`: speeds of the robot. `ticks`, `poses`: time
    between two messages, and between two poses of the reference [s]. `measures`: whether the
    reference measures positions, and headings. `channels`: extra channels, each with the range of
    its recorded values; here they rise along it.
    """
    time, along, turn = _path(ideal, pace)
    yaw = np.concatenate([[0.0], np.cumsum(turn)])
    motion = BodyMotion(along, np.zeros_like(along), turn)
    steps = displacement(motion, yaw[:-1])
    x, y = (np.concatenate([[0.0], np.cumsum(step)]) for step in steps)
    at = np.arange(0.0, time[-1], min(ticks, 0.2))
    half = 0.5 * robot.track * turn
    left, right = (
        np.interp(at, time, np.concatenate([[0.0], np.cumsum(travel)]))
        for travel in (along - half, along + half)
    )
    left, right = _recorded(
        wiring_of(robot.effects), left / robot.left_tick, right / robot.right_tick
    )
    seen = (
        np.arange(0.5 * poses, at[-1], poses)
        if poses < at[-1] / (rules.TAPED_INTERVALS + 1)
        else np.array([0.5 * REST, at[-1] - 0.2 * REST])
    )
    position, heading = measures
    view = view_of(robot.effects)
    mirror = -1.0 if view.mirrored else 1.0
    nothing = np.full(seen.size, np.nan)
    facing = np.interp(seen, time, yaw)
    reference = Reference(
        seen,
        np.interp(seen, time, x) if position else nothing,
        mirror * np.interp(seen, time, y) if position else nothing,
        mirror * (facing + view.yaw) if heading else nothing,
    )
    extra = {
        name: np.linspace(low, high, at.size) for name, (low, high) in (channels or {}).items()
    }
    return Run(ideal.name, Path(ideal.name), Ticks(at, left, right, extra), reference)


def _recorded(wiring: Wiring, left: Floats, right: Floats) -> tuple[Floats, Floats]:
    """Readings of the counters, with the wiring mistakes that the robot file states."""
    left, right = wiring.left_sign * left, wiring.right_sign * right
    return (right, left) if wiring.swapped else (left, right)


def _path(ideal: Ideal, pace: DrivingLimits) -> tuple[Floats, Floats, Floats]:
    """Times (n + 1,), and travel [m] and turn [rad] of each step (n,)."""
    corners: list[tuple[float, float, float]] = [(0.0, 0.0, 0.0), (REST, 0.0, 0.0)]
    for length, turn, share in ideal.moves(pace.size):
        start = corners[-1][0]
        if length == 0.0 and turn == 0.0:
            corners.append((start + share, 0.0, 0.0))
            continue
        ramp = pace.acceleration if ideal.hard else 0.4 * pace.acceleration
        rate, climb = (
            min(_ratio(full, length), _ratio(full * pace.yaw_rate / pace.speed, turn))
            for full in (share * pace.speed, ramp)
        )
        rate = min(rate, math.sqrt(climb))
        rise, cruise = rate / climb, 1.0 / rate - rate / climb
        for later, part in ((rise, 1.0), (rise + cruise, 1.0), (2.0 * rise + cruise, 0.0)):
            corners.append((start + later, part * rate * length, part * rate * turn))
        corners.append((corners[-1][0] + 0.3, 0.0, 0.0))
    corners.append((corners[-1][0] + REST, 0.0, 0.0))
    at, speed, rate_of_turn = (np.array(column) for column in zip(*corners, strict=True))
    time = np.union1d(np.arange(0.0, at[-1], FINE), at)
    middle = 0.5 * (time[1:] + time[:-1])
    step = np.diff(time)
    return time, step * np.interp(middle, at, speed), step * np.interp(middle, at, rate_of_turn)


def _ratio(limit: float, amount: float) -> float:
    return limit / abs(amount) if amount else math.inf
