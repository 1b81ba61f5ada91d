# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A topic of a bag that measures the robot, and which of several is preferred."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from werrimbi_odom.files.bags.frames import Chain
from werrimbi_odom.files.bags.own_odometry import is_map

Measures = Literal["poses", "positions", "yaw"]


@dataclass(frozen=True)
class Measured:
    """A topic or chain of transforms that measures the robot, or seems to."""

    name: str
    """Value for --reference-topic: TOPIC, or /tf:PARENT:CHILD."""
    kind: str
    messages: int
    """For a chain of transforms, the number of messages of the measured transform."""
    measures: Measures
    parent: str
    """Frame in which it is given; "" if not stated."""
    child: str
    """Frame that it describes; "" if not stated."""
    independent: bool
    """Whether it is independent of the wheels, by name and frames."""
    why: str
    """Reason for `independent`: the end of a sentence."""
    chain: Chain | None = None
    """Transforms to compose."""
    aboard: bool = False
    """Whether it is given in a frame on the robot, and so rather of something that it sees."""

    @property
    def is_scan(self) -> bool:
        """Whether poses are yet to be matched from scans."""
        return self.kind.endswith("/LaserScan")

    @property
    def through_wheels(self) -> bool:
        """Whether it is composed of a measured transform and the robot's own odometry."""
        return self.chain is not None and any(step.made_from_wheels for step in self.chain.steps)


TRACKED = tuple(f"geometry_msgs/msg/{name}" for name in ("PoseStamped", "TransformStamped"))
"""Types in which motion capture sends its poses."""


def preference(each: Measured) -> tuple[bool, int, bool, bool, bool]:
    """Sort key of references: what measures more comes first, and what the robot sees last.

    Poses come before scans, which are yet to be matched. Poses of a localiser come before its
    transforms: AMCL stamps these ahead of the scan (by its `transform_tolerance`, a second as a
    rule), and the odometry of that time is in what they make. A tracker's come before both: its
    errors are new in each pose, where those on a map wander.
    """
    measures = ("poses", "positions", "yaw").index(each.measures)
    tracked = each.kind in TRACKED and each.parent != "" and not is_map(each.parent)
    return each.aboard, measures, each.is_scan, each.through_wheels, not tracked
