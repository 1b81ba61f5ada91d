# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Peculiarities of the robot outside the library; for those of the floor see `floor`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..chassis import Chassis
from ..engine import Engine, Reshaper, Shift, Shifter, Stride
from ..recording import Recording
from ..robot import TrueRobot
from .hidden_effect import Peculiarity
from .tyres import payloads, weighed, with_channel
from .wheels import Side

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class OneTyreByPressure(Peculiarity):
    """The pressure of one tyre varies, by a leak and a pump; it is measured (SIDE_tyre_kpa)."""

    side: Side
    per_kpa: float
    """Relative increase of that wheel's radius per kilopascal above 180 [1/kPa]."""

    def _pressure(self, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Times [s] and pressures [kPa] of a run, to be interpolated linearly."""
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(6.0, 18.0, 60))))
        return times, rng.uniform(160.0, 200.0, len(times))

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Change the radius of the wheel with the pressure."""
        times, pressures = self._pressure(rng)
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            beyond = float(np.interp(stride.time, times, pressures)) - 180.0
            engine.set_radius(self.side, wheel.radius * (1 + self.per_kpa * beyond))

        return reshape

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Add the column of the pressure gauge."""
        measured = np.interp(recording.t_s, *self._pressure(rng))
        measured = measured + 0.3 * rng.standard_normal(len(measured))
        return with_channel(recording, f"{self.side}_tyre_kpa", measured)


@dataclass(frozen=True)
class BaseByPayload(Peculiarity):
    """A payload widens the contact patches of the tyres, which increases the effective wheel base.

    The payload is weighed (`payload_kg`, with a noise of 50 g).
    """

    broadening: float
    """Relative increase of the base per kilogram [1/kg]."""

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Subtract the part of the turn that the wider base does not make."""
        times, loads = payloads(rng)

        def shift(stride: Stride) -> Shift:
            load = float(np.interp(stride.time, times, loads))
            turn = (stride.right - stride.left) / robot.wheel_separation
            return Shift(0.0, 0.0, turn * (1 / (1 + self.broadening * load) - 1))

        return shift

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Add the column of the scale."""
        return weighed(recording, np.interp(recording.t_s, *payloads(rng)), rng)


@dataclass(frozen=True)
class OneTyreBackwards(Peculiarity):
    """One tyre is mounted against its tread, and its tread blocks bend when it rolls backwards."""

    side: Side
    loss: float
    """Relative decrease of its radius while it rolls backwards."""

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Change the radius of the wheel with its direction of rolling."""
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            travel = stride.left if self.side == "left" else stride.right
            if abs(travel) > 1e-6:
                engine.set_radius(self.side, wheel.radius * (1 - self.loss * (travel < 0.0)))

        return reshape


@dataclass(frozen=True)
class SlideByTiltAndPayload(Peculiarity):
    """On a tilted floor the tyres creep downhill, in proportion to the payload.

    The tilt is measured by an inclinometer (`tilt_rad`, positive with the left side up, with a
    noise of 1 mrad), the payload is weighed (`payload_kg`, with a noise of 50 g).
    """

    creep: float
    """Creep to the right per metre driven, per radian of tilt and kilogram [1/(rad kg)]."""

    def _measured(self, rng: np.random.Generator) -> tuple[tuple[Floats, Floats], ...]:
        """Times [s] and payloads [kg]; times [s] and tilts [rad]; to be interpolated."""
        loads = payloads(rng)
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(2.0, 8.0, 120))))
        return loads, (times, rng.uniform(-0.12, 0.12, len(times)))

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Creep to the right along the whole path."""
        loads, tilts = self._measured(rng)

        def shift(stride: Stride) -> Shift:
            lean = float(np.interp(stride.time, *tilts) * np.interp(stride.time, *loads))
            return Shift(0.0, -self.creep * lean * abs(stride.left + stride.right) / 2, 0.0)

        return shift

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Add the columns of scale and inclinometer."""
        loads, (times, tilts) = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        measured = np.interp(recording.t_s, times, tilts)
        measured = measured + 1e-3 * rng.standard_normal(len(measured))
        return with_channel(weighed_too, "tilt_rad", measured)


@dataclass(frozen=True)
class OneTyreByLoadOverPressure(Peculiarity):
    """One tyre flattens under a payload, the more the lower its pressure.

    Both are measured (`payload_kg`, with a noise of 50 g; `SIDE_tyre_kpa`).
    """

    side: Side
    flattening: float
    """Relative decrease of that wheel's radius per payload over pressure [kPa/kg]."""

    def _measured(self, rng: np.random.Generator) -> tuple[tuple[Floats, Floats], ...]:
        """Times [s] and payloads [kg]; times [s] and pressures [kPa] of a run."""
        loads = payloads(rng)
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(6.0, 18.0, 60))))
        return loads, (times, rng.uniform(60.0, 240.0, len(times)))

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Change the radius of the wheel with payload and pressure."""
        loads, pressures = self._measured(rng)
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            pressed = float(np.interp(stride.time, *loads) / np.interp(stride.time, *pressures))
            engine.set_radius(self.side, wheel.radius * (1 - self.flattening * pressed))

        return reshape

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Add the columns of scale and pressure gauge."""
        loads, (times, pressures) = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        measured = np.interp(recording.t_s, times, pressures)
        measured = measured + 0.3 * rng.standard_normal(len(measured))
        return with_channel(weighed_too, f"{self.side}_tyre_kpa", measured)
