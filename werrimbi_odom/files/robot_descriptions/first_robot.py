# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A first robot file from a robot's own description: its URDF or its controller's parameters."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.bags.driver_messages import DRIVERS
from werrimbi_odom.files.robot_descriptions.wheel_joints import SIDES
from werrimbi_odom.files.robot_files.robot_file import RobotFile, robot_file_of_text
from werrimbi_odom.files.run import Ticks
from werrimbi_odom.files.tables.counter_columns import bits_of_wraps
from werrimbi_odom.model.pose import Floats

PLACEHOLDER_TICKS = 4096.0
"""Counts of a turn that are written where nothing tells them."""
_OFTEN, _BY_ONE, _NEIGHBOURS = 0.05, 0.1, 5
"""Angles are quantised if the number of counts differs between successive messages in at least this
share of them, and by one in this share of those; or if this many numbers of counts differ by
one."""


@dataclass(frozen=True)
class FirstRobot:
    """Parameters of a robot's wheels; None if unknown."""

    radius: float | None = None
    """[m]"""
    separation: float | None = None
    """[m]"""
    left: tuple[str, ...] = ()
    """Joints of the left wheels."""
    right: tuple[str, ...] = ()
    ticks: float | None = None
    """Steps of a wheel's angle, or counts, per turn."""
    counted: bool = False
    """Whether the wheels are counters, so that all distances depend on `ticks`."""
    input_type: str = ""
    """Kind of the node's input messages; empty for its default."""
    bits: int = 0
    """Width at which the counters wrap; 0: they do not wrap."""
    more: Mapping[str, float] | None = None
    """Multipliers of a controller."""
    reversed: tuple[str, ...] = ()
    """Sides whose counters run backwards, from a controller's negative multiplier."""
    told: Mapping[str, str] | None = None
    """Source of each value, in words."""

    @property
    def has_sizes(self) -> bool:
        """Whether the sizes needed for a robot file are known."""
        return self.radius is not None and self.separation is not None

    @property
    def lacks_ticks(self) -> bool:
        """Whether a placeholder stands for the counts of a turn, and distances are not known."""
        return self.counted and self.ticks is None

    @property
    def tells_distances(self) -> bool:
        """Whether it turns what the wheels counted into metres."""
        return self.has_sizes and not self.lacks_ticks

    @property
    def file(self) -> RobotFile:
        """Robot file from what is known, with placeholders for unknown sizes."""
        return robot_file_of_text(self.text("what is known"), Path("robot.yaml"))

    def text(self, title: str) -> str:
        """Text of the robot file, with placeholders for unknown sizes."""
        told = dict(self.told or {})
        if self.lacks_ticks:
            told["ticks"] = "a placeholder: enter the counts of a turn of a wheel"

        def line(name: str, value: object, word: str) -> str:
            return f"    {name}: {value}" + (f"  # {told[word]}" if word in told else "")

        lines = [
            f"# {title}",
            "odom_node:",
            "  ros__parameters:",
            line("wheel_separation", _number(self.separation or 0.3), "separation"),
            line("wheel_radius", _number(self.radius or 0.05), "radius"),
        ]
        for side in SIDES:
            ticks = _number(self.ticks or PLACEHOLDER_TICKS)
            lines.append(line(f"{side}_ticks_per_revolution", ticks, "ticks"))
        if self.input_type:
            lines.append(line("input_type", self.input_type, "input"))
        if self.bits:
            lines.append(line("encoder_bits", self.bits, "bits"))
        for name, value in (self.more or {}).items():
            lines.append(line(name, _number(value), "more"))
        for side, joints in zip(SIDES, (self.left, self.right), strict=True):
            if joints:
                quoted = ", ".join(f'"{name}"' for name in joints)
                lines.append(line(f"{side}_wheel_names", f"[{quoted}]", "joints"))
        if self.reversed:
            effects = ", ".join(f"{side}_wheel_reversed" for side in self.reversed)
            lines.append(line("effects", f"[{effects}]", "reversed"))
        return "\n".join(lines) + "\n"


def _number(value: float) -> str:
    return repr(float(value)) if abs(value) < 1e6 else f"{value:.1f}"


def with_driver(first: FirstRobot, kind: str) -> FirstRobot:
    """Add what the message type of a driver determines."""
    driver = DRIVERS.get(kind)
    if driver is None:
        return first
    told = {**(first.told or {}), "ticks": f"of every robot that sends {kind}"}
    return replace(first, ticks=driver.ticks, bits=driver.narrow, told=told)


def with_wraps(first: FirstRobot, ticks: Ticks) -> FirstRobot:
    """Add the width at which the counters wrap, if they are seen to."""
    bits = 0 if first.bits else bits_of_wraps(ticks)
    if not bits:
        return first
    words = "there the counters begin anew"
    return replace(first, bits=bits, told={**(first.told or {}), "bits": words})


def with_steps(first: FirstRobot, angles: Sequence[Floats]) -> FirstRobot:
    """Add the steps of the wheels' angles per turn, if they are visible.

    `angles`: angles of the left and the right wheel, shape (n,) each [rad].
    """
    moved = [np.diff(each) for each in angles]
    steps = _steps_of_a_turn(np.abs(np.concatenate(moved)))
    if steps is not None and not _is_counted(moved, 2.0 * math.pi / steps):
        steps = None
    words = (
        "from the steps in which the joint angles come"
        if steps
        else "joint angles come without steps: so many are assumed"
    )
    return replace(first, ticks=steps, told={**(first.told or {}), "ticks": words})


def _is_counted(moved: Sequence[Floats], quantum: float) -> bool:
    """Whether steps come from a counter, and not from a few constant speeds of a simulator.

    At constant speed, the counts per message vary by one. Over many speeds, all numbers of counts
    occur.
    """
    counts = [np.rint(each[np.isfinite(each)] / quantum) for each in moved]
    changes = np.concatenate([np.abs(np.diff(each)) for each in counts])
    changed = changes[changes > 0.0]
    by_one = float(np.mean(changed == 1.0)) if changed.size else 0.0
    neighbours = np.diff(np.unique(np.abs(np.concatenate(counts)))) == 1.0
    often = changed.size > _OFTEN * changes.size
    return (often and by_one > _BY_ONE) or int(neighbours.sum()) >= _NEIGHBOURS


def _steps_of_a_turn(steps: NDArray[np.float64]) -> float | None:
    steps = steps[np.isfinite(steps) & (steps > 1e-6)]
    if steps.size < 20:
        return None
    apart = np.diff(np.unique(np.concatenate([[0.0], np.round(steps, 7)])))
    apart = apart[apart > 1e-6]
    if apart.size == 0:
        return None
    quantum = float(np.median(apart[apart < 1.5 * float(np.quantile(apart, 0.1))]))
    some = np.sort(steps)[: max(20, steps.size // 4)]
    for _ in range(2):
        whole = np.rint(some / quantum)
        quantum = float((whole * some).sum() / max((whole * whole).sum(), 1.0))
    if quantum <= 0.0 or np.median(np.abs(some / quantum - np.rint(some / quantum))) > 0.05:
        return None
    return float(round(2.0 * math.pi / quantum)) if quantum < 1.0 else None
