# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Peculiarities of the robot outside the library; for those of the floor see `floor`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..chassis import Chassis, WheelPlan
from ..engine import Engine, Floats, Reshaper, Shift, Shifter, Stride
from ..recording import Recording
from ..robot import TrueRobot
from .hidden_effect import Peculiarity, Rng, resized
from .tyres import course, payloads, weighed, with_channel
from .wheels import Side


@dataclass(frozen=True)
class OneTyreByPressure(Peculiarity):
    """The pressure of one tyre varies, by a leak and a pump; it is measured (SIDE_tyre_kpa)."""

    side: Side
    per_kpa: float
    """Relative increase of that wheel's radius per kilopascal above 180 [1/kPa]."""

    def _pressure(self, rng: Rng) -> tuple[Floats, Floats]:
        """Times [s] and pressures [kPa] of a run."""
        return course((6.0, 18.0), 60, (160.0, 200.0), rng)

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radius of the wheel with the pressure."""
        pressures = self._pressure(rng)

        def factor(stride: Stride) -> float:
            return 1 + self.per_kpa * (float(np.interp(stride.time, *pressures)) - 180.0)

        return resized([getattr(chassis, self.side)], factor)

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the column of the pressure gauge."""
        pressure = np.interp(recording.t_s, *self._pressure(rng))
        return with_channel(recording, f"{self.side}_tyre_kpa", pressure, 0.3, rng)


@dataclass(frozen=True)
class BaseByPayload(Peculiarity):
    """A payload widens the contact patches of the tyres, which increases the effective wheel base.

    The payload is weighed (`payload_kg`, with a noise of 50 g).
    """

    broadening: float
    """Relative increase of the base per kilogram [1/kg]."""

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Subtract the part of the turn that the wider base does not make."""
        times, loads = payloads(rng)

        def shift(stride: Stride) -> Shift:
            load = float(np.interp(stride.time, times, loads))
            turn = (stride.right - stride.left) / robot.wheel_separation
            return Shift(0.0, 0.0, turn * (1 / (1 + self.broadening * load) - 1))

        return shift

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the column of the scale."""
        return weighed(recording, np.interp(recording.t_s, *payloads(rng)), rng)


@dataclass(frozen=True)
class OneTyreBackwards(Peculiarity):
    """One tyre is mounted against its tread, and its tread blocks bend when it rolls backwards."""

    side: Side
    loss: float
    """Relative decrease of its radius while it rolls backwards."""

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radius of the wheel with its direction of rolling."""
        wheel: WheelPlan = getattr(chassis, self.side)

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

    def _measured(self, rng: Rng) -> tuple[tuple[Floats, Floats], ...]:
        """Times [s] and payloads [kg]; times [s] and tilts [rad] of a run."""
        return payloads(rng), course((2.0, 8.0), 120, (-0.12, 0.12), rng)

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """Creep to the right along the whole path."""
        loads, tilts = self._measured(rng)

        def shift(stride: Stride) -> Shift:
            lean = float(np.interp(stride.time, *tilts) * np.interp(stride.time, *loads))
            return Shift(0.0, -self.creep * lean * abs(stride.left + stride.right) / 2, 0.0)

        return shift

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the columns of scale and inclinometer."""
        loads, tilts = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        tilt = np.interp(recording.t_s, *tilts)
        return with_channel(weighed_too, "tilt_rad", tilt, 1e-3, rng)


@dataclass(frozen=True)
class OneTyreByLoadOverPressure(Peculiarity):
    """One tyre flattens under a payload, the more the lower its pressure.

    Both are measured (`payload_kg`, with a noise of 50 g; `SIDE_tyre_kpa`).
    """

    side: Side
    flattening: float
    """Relative decrease of that wheel's radius per payload over pressure [kPa/kg]."""

    def _measured(self, rng: Rng) -> tuple[tuple[Floats, Floats], ...]:
        """Times [s] and payloads [kg]; times [s] and pressures [kPa] of a run."""
        return payloads(rng), course((6.0, 18.0), 60, (60.0, 240.0), rng)

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper:
        """Change the radius of the wheel with payload and pressure."""
        loads, pressures = self._measured(rng)

        def factor(stride: Stride) -> float:
            pressed = np.interp(stride.time, *loads) / np.interp(stride.time, *pressures)
            return 1 - self.flattening * float(pressed)

        return resized([getattr(chassis, self.side)], factor)

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """Add the columns of scale and pressure gauge."""
        loads, pressures = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        pressure = np.interp(recording.t_s, *pressures)
        return with_channel(weighed_too, f"{self.side}_tyre_kpa", pressure, 0.3, rng)
