# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What can be odd about a robot, its floor or its recording, and where in a drive it acts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..chassis import Chassis
from ..engine import Reshaper, Shifter
from ..recording import Happened, Recording
from ..robot import TrueRobot
from ..sensors import ReferenceSensor

Counted = Callable[[float, float, float], tuple[float, float]]
"""Takes time and both shafts' angles, period by period; gives the angles that are counted."""


@dataclass(frozen=True)
class Peculiarity:
    """A hidden effect. Each stage of a drive passes through it; by default it changes nothing.

    A subclass overrides the stage at which its physics acts. `rng` is the run's own, and begins
    anew in each stage: what differs from run to run is drawn from it, alike in every stage.
    """

    def robot(self, robot: TrueRobot) -> TrueRobot:
        """The robot as it truly is, against what its maker believes."""
        return robot

    def written(self, robot: TrueRobot) -> TrueRobot:
        """The robot as its user writes it into the robot file, by mistake."""
        return robot

    def chassis(self, chassis: Chassis) -> Chassis:
        """The body in the engine."""
        return chassis

    def shifter(self, robot: TrueRobot, rng: np.random.Generator) -> Shifter | None:
        """Motion besides rolling, for which no force stands."""
        return None

    def reshaper(self, chassis: Chassis, rng: np.random.Generator) -> Reshaper | None:
        """Changes of the body while it drives."""
        return None

    def reference(self, sensor: ReferenceSensor) -> ReferenceSensor:
        """What measures the robot from outside."""
        return sensor

    def counted(self, robot: TrueRobot) -> Counted | None:
        """What counters make of their shafts' angles, where that depends on what was before.

        For a robot that is seen live, of which no more than the last second is kept.
        """
        return None

    @property
    def ahead(self) -> float:
        """How far a record looks ahead of its own stamp [s]."""
        return 0.0

    def recording(
        self, recording: Recording, robot: TrueRobot, rng: np.random.Generator
    ) -> Recording:
        """What was recorded."""
        return recording

    def happened(
        self, until: float, robot: TrueRobot, rng: np.random.Generator
    ) -> tuple[Happened, ...]:
        """What it did to a drive at single instants up to `until` [s], for truth.json."""
        return ()
