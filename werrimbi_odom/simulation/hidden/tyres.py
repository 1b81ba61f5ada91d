# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tyres with a radius that depends on temperature, payload, speed or load."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..chassis import Chassis
from ..engine import Engine, Floats, Reshaper, Shift, Shifter, Stride
from ..recording import Recording
from ..robot import TrueRobot
from .hidden_effect import Peculiarity, Rng, resized

GRAVITY = 9.81
"""Acceleration of gravity [m/s^2]."""


def with_channel(
    recording: Recording, name: str, values: Floats, noise: float, rng: Rng
) -> Recording:
    """The recording with a column that is measured with white noise of this size."""
    measured = values + noise * rng.standard_normal(len(values))
    return replace(recording, channels={**recording.channels, name: measured})


def course(
    every: tuple[float, float], count: int, among: tuple[float, float], rng: Rng
) -> tuple[Floats, Floats]:
    """Random times [s], so far apart, and values of a run, to be interpolated linearly."""
    times = np.concatenate(([0.0], np.cumsum(rng.uniform(*every, count))))
    return times, rng.uniform(*among, len(times))


def payloads(rng: Rng) -> tuple[Floats, Floats]:
    """Times [s] and payloads [kg] of a run."""
    return course((8.0, 20.0), 60, (0.0, 10.0), rng)


def weighed(recording: Recording, loads: Floats, rng: Rng) -> Recording:
    """The recording with the column of a scale that has a noise of 50 g."""
    return with_channel(recording, "payload_kg", loads, 0.05, rng)


@dataclass(frozen=True)
class RadiusFollowsTemperature(Peculiarity):
    """Both wheels expand with temperature (`wheel_temperature_c`, with a noise of 0.1 K)."""

    expansion: float
    """Relative increase per kelvin above 20 degrees Celsius [1/K]."""

    def _temperature(self, rng: Rng) -> tuple[float, float, float, float]:
        """Temperature of a run: mean [C], swing [K], angular frequency [rad/s], phase [rad]."""
        mean, swing, period, phase = rng.uniform(
            (16.0, 3.0, 20.0, 0.0), (30.0, 9.0, 60.0, 2 * np.pi)
        )
        return float(mean), float(swing), float(2 * np.pi / period), float(phase)

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radii with the temperature."""
        mean, swing, frequency, phase = self._temperature(rng)

        def factor(stride: Stride) -> float:
            warmth = mean + swing * np.sin(frequency * stride.time + phase) - 20.0
            return float(1 + self.expansion * warmth)

        return resized(chassis.wheels, factor)

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the column of the thermometer."""
        mean, swing, frequency, phase = self._temperature(rng)
        warmth = mean + swing * np.sin(frequency * recording.t_s + phase)
        return with_channel(recording, "wheel_temperature_c", warmth, 0.1, rng)


@dataclass(frozen=True)
class RadiusFollowsPayload(Peculiarity):
    """Both tyres deflect under a payload, which is weighed (`payload_kg`, with a noise of 50 g)."""

    yielding: float
    """Relative decrease of the radius per kilogram [1/kg]."""

    @staticmethod
    def _load(at: Floats | float, times: Floats, loads: Floats) -> Floats:
        """Payload at given times [kg]; each change takes a second."""
        knots = np.column_stack((times[1:], times[1:] + 1.0)).ravel()
        values = np.column_stack((loads[:-1], loads[1:])).ravel()
        return np.asarray(np.interp(at, knots, values))

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radii with the payload."""
        loads = payloads(rng)
        return resized(
            chassis.wheels,
            lambda stride: 1 - self.yielding * float(self._load(stride.time, *loads)),
        )

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the column of the scale."""
        return weighed(recording, self._load(recording.t_s, *payloads(rng)), rng)


@dataclass(frozen=True)
class TyreSquash(Peculiarity):
    """The radius of a soft tyre changes with the square of its speed."""

    loss: float
    """Relative decrease of the radius at the angular speed of a wheel of the initial radius at 1
    m/s; negative for an increase. Centrifugal force and relaxation depend on angular speed."""

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radius of each wheel with its own speed."""

        def reshape(engine: Engine, stride: Stride) -> None:
            for wheel, travel in zip(chassis.wheels, (stride.left, stride.right), strict=True):
                turning = travel / engine.radius(wheel.side) / stride.period
                loss = self.loss * (turning * wheel.radius) ** 2
                engine.set_radius(wheel.side, wheel.radius * (1 - loss))

        return reshape


@dataclass(frozen=True)
class LoadTransfer(Peculiarity):
    """Elastic tyres under a raised centre of mass: load moves between them, and their radii change.

    By the balance of torques the moved load is the mass times the acceleration of the axle's middle
    times the height, over the distance between the tyres (or between axle and skid). Half the
    robot's weight on one tyre compresses its radius by the share `softness`.
    """

    softness: float
    """Relative decrease of a radius under half the robot's weight."""
    height: float
    """Height of the centre of mass over half the base, for the lateral part."""
    length: float
    """The same height over the distance from axle to skid, for the longitudinal part; negative if
    the driven wheels are unloaded as the robot accelerates; 0 for none."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Each wheel travels less or more by the change of its radius."""
        before = 0.0

        def shift(stride: Stride) -> Shift:
            nonlocal before
            speed = (stride.left + stride.right) / 2 / stride.period
            turning = (stride.right - stride.left) / robot.wheel_separation / stride.period
            ahead, before = (speed - before) / stride.period, speed
            to_the_rear = self.length * ahead / GRAVITY
            to_the_right = self.height * speed * turning / GRAVITY
            left = -self.softness * (to_the_rear - to_the_right) * stride.left
            right = -self.softness * (to_the_rear + to_the_right) * stride.right
            return Shift((left + right) / 2, 0.0, (right - left) / robot.wheel_separation)

        return shift
