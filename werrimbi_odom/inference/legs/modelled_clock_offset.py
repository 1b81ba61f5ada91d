# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Offset between the clocks of reference and wheels, for cutting a run on one clock."""

from __future__ import annotations

from werrimbi_odom.inference import rules
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.robot import Robot


def clock_offset(robot: Robot) -> float:
    """Delay of the reference by the robot model if its clock is apart [s]; zero for less.

    Legs of a reference that is only late, by its transport, are cut by its stamps; fits move them.
    """
    delay = view_of(robot.effects).delay
    return delay if abs(delay) >= rules.DELAY_SHORTEST else 0.0
