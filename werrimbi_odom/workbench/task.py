# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tasks for another process."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True)
class Diagnose:
    """Diagnose what a robot's model is missing."""

    robot: Robot


@dataclass(frozen=True)
class Add:
    """Fit additional effects together, and compare."""

    effects: tuple[str, ...]
    robot: Robot


@dataclass(frozen=True)
class Open:
    """Cut the drives into legs, and compare the robot as given."""


Task = Diagnose | Add | Open
