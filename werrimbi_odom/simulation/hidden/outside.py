# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is odd about a robot and lies outside the library; of the floor's, see `floor`."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..chassis import Chassis
from ..engine import Engine, Reshaper, Shift, Shifter, Stride
from ..recording import Recording
from ..robot import TrueRobot
from .peculiarity import Peculiarity
from .tyres import payloads, weighed, with_channel
from .wheels import Side

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class OneTyreByPressure(Peculiarity):
    """One tyre leaks and is pumped up by its valve; its pressure is measured (SIDE_tyre_kpa).

    Parameters
    ----------
    side : "left" or "right"
    per_kpa : float
        Relative growth of that wheel's radius per kilopascal above 180 [1/kPa].
    """

    side: Side
    per_kpa: float

    def _pressure(self, rng: np.random.Generator) -> tuple[Floats, Floats]:
        """Of a run: times [s] and pressures [kPa], straight in between."""
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(6.0, 18.0, 60))))
        return times, rng.uniform(160.0, 200.0, len(times))

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Resize the one wheel as the pressure says."""
        times, pressures = self._pressure(rng)
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            beyond = float(np.interp(stride.time, times, pressures)) - 180.0
            engine.set_radius(self.side, wheel.radius * (1 + self.per_kpa * beyond))

        return reshape

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Write the gauge's column."""
        measured = np.interp(recording.t_s, *self._pressure(rng))
        measured = measured + 0.3 * rng.standard_normal(len(measured))
        return with_channel(recording, f"{self.side}_tyre_kpa", measured)


@dataclass(frozen=True)
class BaseByPayload(Peculiarity):
    """A payload presses the tyres broad, so that the robot turns as on a wider base.

    It is weighed (`payload_kg`, to 50 g).

    Parameters
    ----------
    broadening : float
        Relative growth of the base per kilogram [1/kg].
    """

    broadening: float

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """Take back the turning that the wider base does not make."""
        times, loads = payloads(rng)

        def shift(stride: Stride) -> Shift:
            load = float(np.interp(stride.time, times, loads))
            turn = (stride.right - stride.left) / robot.wheel_separation
            return Shift(0.0, 0.0, turn * (1 / (1 + self.broadening * load) - 1))

        return shift

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Write the scale's column."""
        return weighed(recording, np.interp(recording.t_s, *payloads(rng)), rng)


@dataclass(frozen=True)
class OneTyreBackwards(Peculiarity):
    """One tyre is mounted against its tread, whose blocks lie down when it rolls backwards.

    Parameters
    ----------
    side : "left" or "right"
    loss : float
        Share of its radius that is lost while it rolls backwards.
    """

    side: Side
    loss: float

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Resize the one wheel by the sense in which it rolls."""
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            travel = stride.left if self.side == "left" else stride.right
            if abs(travel) > 1e-6:
                engine.set_radius(self.side, wheel.radius * (1 - self.loss * (travel < 0.0)))

        return reshape


@dataclass(frozen=True)
class SlideByTiltAndPayload(Peculiarity):
    """On a floor that leans the tyres creep downhill, the more the heavier the robot is loaded.

    The tilt is measured by an inclinometer (`tilt_rad`, positive with the left side up, to 1 mrad),
    the payload weighed (`payload_kg`, to 50 g).

    Parameters
    ----------
    creep : float
        Way to the right per way driven, per radian of tilt and kilogram of payload [1/(rad kg)].
    """

    creep: float

    def _measured(self, rng: np.random.Generator) -> tuple[tuple[Floats, Floats], ...]:
        """Of a run: times and payloads [s, kg]; times and tilts [s, rad]. Straight in between."""
        loads = payloads(rng)
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(2.0, 8.0, 120))))
        return loads, (times, rng.uniform(-0.12, 0.12, len(times)))

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter:
        """To the right, for all the way that is driven."""
        loads, tilts = self._measured(rng)

        def shift(stride: Stride) -> Shift:
            lean = float(np.interp(stride.time, *tilts) * np.interp(stride.time, *loads))
            return Shift(0.0, -self.creep * lean * abs(stride.left + stride.right) / 2, 0.0)

        return shift

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Write the columns of scale and inclinometer."""
        loads, (times, tilts) = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        measured = np.interp(recording.t_s, times, tilts)
        measured = measured + 1e-3 * rng.standard_normal(len(measured))
        return with_channel(weighed_too, "tilt_rad", measured)


@dataclass(frozen=True)
class OneTyreByLoadOverPressure(Peculiarity):
    """One tyre leaks and flattens under a payload, the more the less pressure it has.

    Both are measured (`payload_kg`, to 50 g; `SIDE_tyre_kpa`).

    Parameters
    ----------
    side : "left" or "right"
    flattening : float
        Share of that wheel's radius that is lost per kilogram over kilopascal [kPa/kg].
    """

    side: Side
    flattening: float

    def _measured(self, rng: np.random.Generator) -> tuple[tuple[Floats, Floats], ...]:
        """Of a run: times and payloads [s, kg]; times and pressures [s, kPa]."""
        loads = payloads(rng)
        times = np.concatenate(([0.0], np.cumsum(rng.uniform(6.0, 18.0, 60))))
        return loads, (times, rng.uniform(60.0, 240.0, len(times)))

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper:
        """Resize the one wheel as load and pressure say."""
        loads, pressures = self._measured(rng)
        wheel = chassis.left if self.side == "left" else chassis.right

        def reshape(engine: Engine, stride: Stride) -> None:
            pressed = float(np.interp(stride.time, *loads) / np.interp(stride.time, *pressures))
            engine.set_radius(self.side, wheel.radius * (1 - self.flattening * pressed))

        return reshape

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """Write the columns of scale and gauge."""
        loads, (times, pressures) = self._measured(rng)
        weighed_too = weighed(recording, np.interp(recording.t_s, *loads), rng)
        measured = np.interp(recording.t_s, times, pressures)
        measured = measured + 0.3 * rng.standard_normal(len(measured))
        return with_channel(weighed_too, f"{self.side}_tyre_kpa", measured)
