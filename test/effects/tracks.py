# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives as odometry has them, and where the robot truly goes when effects act."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.driven_motion import features
from werrimbi_odom.model.effect import AppliedEffect, view_of
from werrimbi_odom.model.effects_over_run import driven
from werrimbi_odom.model.motion import WheelTravel, displacement
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

TRACK, RADIUS, TICKS = 0.35, 0.05, 2000.0


@dataclass(frozen=True)
class Plan:
    """Speed [m/s] and yaw rate [rad/s] by time: straight between the knots, shape (k,)."""

    time: Floats
    speed: Floats
    yaw_rate: Floats


@dataclass(frozen=True)
class Track:
    """Where the robot is; shape (n + 1,)."""

    time: Floats
    x: Floats
    y: Floats
    yaw: Floats
    left: Floats
    """Travel of the wheels so far [m]."""
    right: Floats
    """The same of the right wheel."""

    def at(self, time: float) -> tuple[float, float, float]:
        """Pose at a time."""
        return tuple(float(np.interp(time, self.time, v)) for v in (self.x, self.y, self.yaw))  # type: ignore[return-value]

    @property
    def end(self) -> tuple[float, float, float]:
        """Last pose."""
        return float(self.x[-1]), float(self.y[-1]), float(self.yaw[-1])


REST = (0.5, 0.0, 0.0)


def plan(*knots: tuple[float, float, float]) -> Plan:
    """From (seconds until then, speed then, yaw rate then), after half a second of rest."""
    table = np.array([(0.0, 0.0, 0.0), REST, *knots])
    return Plan(np.cumsum(table[:, 0]), table[:, 1], table[:, 2])


def line(distance: float, speed: float = 0.5) -> list[tuple[float, float, float]]:
    """Knots of a line and a rest; ramps of half a second."""
    signed = speed if distance > 0.0 else -speed
    return [(0.5, signed, 0.0), (abs(distance) / speed - 0.5, signed, 0.0), REST, REST]


def turn(angle: float, rate: float = 1.0) -> list[tuple[float, float, float]]:
    """Knots of a turn on the spot and a rest."""
    signed = rate if angle > 0.0 else -rate
    return [(0.5, 0.0, signed), (abs(angle) / rate - 0.5, 0.0, signed), REST, REST]


def wheels_of(plan: Plan, rate: float) -> tuple[Floats, WheelTravel[Floats]]:
    """Durations of the steps and what the encoders count in them."""
    end = plan.time[-1]
    fine = np.union1d(np.linspace(0.0, end, round(end * 2000.0) + 1), plan.time)
    speed, yaw_rate = (np.interp(fine, plan.time, v) for v in (plan.speed, plan.yaw_rate))
    half = 0.5 * TRACK * yaw_rate

    def summed(values: Floats) -> Floats:
        steps = 0.5 * (values[1:] + values[:-1]) * np.diff(fine)
        return np.concatenate([[0.0], np.cumsum(steps)])

    time = np.append(np.arange(0.0, end - 0.5 / rate, 1.0 / rate), end)
    left, right = (np.interp(time, fine, summed(v)) for v in (speed - half, speed + half))
    return np.diff(time), WheelTravel(np.diff(left), np.diff(right))


def track(
    plan: Plan,
    *effects: AppliedEffect,
    rate: float = 50.0,
    start_yaw: float = 0.0,
    first_counts: tuple[float, float] = (0.0, 0.0),
) -> Track:
    """Where the robot goes when its encoders count as planned and the effects act."""
    duration, raw = wheels_of(plan, rate)
    return gone(duration, raw, effects, start_yaw, first_counts)


def gone(
    duration: Floats,
    raw: WheelTravel[Floats],
    effects: tuple[AppliedEffect, ...],
    start_yaw: float = 0.0,
    first_counts: tuple[float, float] = (0.0, 0.0),
    channels: Mapping[str, Span[Floats]] | None = None,
) -> Track:
    """The same from counted travel."""
    robot = Robot(TRACK, RADIUS, TICKS, TICKS, effects=effects)
    drive = features(robot, duration, raw, first_counts, channels)
    travel, motion = driven(robot, raw, drive, Pose(yaw=start_yaw))

    def summed(first: float, steps: Floats) -> Floats:
        return np.cumsum(np.concatenate([[first], steps]))

    yaw = summed(start_yaw, motion.turn)
    dx, dy = displacement(motion, yaw[:-1])
    return Track(
        summed(0.0, duration),
        summed(0.0, dx),
        summed(0.0, dy),
        yaw,
        summed(0.0, travel.left),
        summed(0.0, travel.right),
    )


def shown(track: Track, effects: tuple[AppliedEffect, ...], at: Floats) -> tuple[Floats, Floats]:
    """What a reference shows at times `at`: positions as x + iy [m], headings [rad]."""
    view = view_of(effects)
    seen = at - view.late(at)
    position = np.interp(seen, track.time, track.x) + 1j * np.interp(seen, track.time, track.y)
    position = position + np.exp(1j * np.interp(seen, track.time, track.yaw)) * complex(
        view.ahead, view.left
    )
    yaw = np.interp(seen - view.heading_delay, track.time, track.yaw) + view.yaw
    yaw = yaw + 0.5 * view.wander * at**2
    position = view.scale * position
    return (np.conj(position), -yaw) if view.mirrored else (position, yaw)


def relative(position: Floats, yaw: Floats) -> Floats:
    """Each pose as seen from the one before, shape (n - 1, 3): what does not know the frame."""
    moved = np.exp(-1j * yaw[:-1]) * np.diff(position)
    return np.stack([moved.real, moved.imag, np.diff(yaw)], axis=-1)
