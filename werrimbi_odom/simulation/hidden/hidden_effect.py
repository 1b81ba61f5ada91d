# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Base class of hidden effects of robot, floor or recording: where in a drive they can act."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from ..chassis import Chassis, WheelPlan
from ..engine import Engine, Reshaper, Shift, Shifter, Stride
from ..recording import Happened, Recording
from ..robot import TrueRobot
from ..sensors import ReferenceSensor

Rng = np.random.Generator

Counted = Callable[[float, float, float], tuple[float, float]]
"""Maps time and both shaft angles, period by period, to the angles that are counted."""


@dataclass(frozen=True)
class Peculiarity:
    """A hidden effect. Each stage of a drive passes through it; by default it changes nothing.

    A subclass overrides the stage at which its physics acts. Each stage gets a new `rng` with the
    same seed for a run, so values drawn per run are the same in all stages.
    """

    live: ClassVar[bool] = True
    """Whether a robot that is driven live can have it: not what is made in a whole record."""

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """The true robot, derived from its nominal one."""
        return robot

    def written(self, robot: TrueRobot) -> TrueRobot:
        """The robot as its user wrongly describes it in the robot file."""
        return robot

    def chassis(self, chassis: Chassis) -> Chassis:
        """The body in the engine."""
        return chassis

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter | None:
        """Motion in addition to rolling, without forces."""
        return None

    def reshaper(self, chassis: Chassis, rng: Rng) -> Reshaper | None:
        """Changes of the body during the drive."""
        return None

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """The external reference."""
        return sensor

    def counted(self, robot: TrueRobot) -> Counted | None:
        """Map from shaft angles to counted angles, for effects that depend on the past.

        Needed for live robots, which keep only the last second.
        """
        return None

    @property
    def ahead(self) -> float:
        """Largest time by which a record is later than its own stamp [s]."""
        return 0.0

    def recording(self, recording: Recording, robot: TrueRobot, rng: Rng) -> Recording:
        """The recording."""
        return recording

    def happened(self, until: float, robot: TrueRobot, rng: Rng) -> tuple[Happened, ...]:
        """Abrupt events of a drive up to `until` [s], for truth.json."""
        return ()


class MovesEachStride(Peculiarity):
    """A hidden effect that moves the robot in each stride, whatever came before."""

    def shift(self, stride: Stride, robot: TrueRobot) -> Shift:
        """Motion in addition to rolling."""
        raise NotImplementedError

    def shifter(self, robot: TrueRobot, rng: Rng) -> Shifter:
        """`shift` for this robot."""
        return lambda stride: self.shift(stride, robot)


def resized(wheels: Iterable[WheelPlan], factor: Callable[[Stride], float]) -> Reshaper:
    """Give wheels their first radius times a factor, which may change with each stride."""
    wheels = tuple(wheels)

    def reshape(engine: Engine, stride: Stride) -> None:
        by = factor(stride)
        for wheel in wheels:
            engine.set_radius(wheel.side, wheel.radius * by)

    return reshape
