# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References that the odometry has a hand in, where the bag holds what they were made of.

A marker or a map is seen now and then, and nodes carry the pose on by the wheels in between, a
message for each of the odometry; or move the points of a scan by it. Both are measured in part and
cannot be refused; what was measured itself is the better reference.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.files.made_from_wheels import ODOMETRY

if TYPE_CHECKING:
    from werrimbi_odom.files.bag import Bag
    from werrimbi_odom.files.bag_contents import Measured

_MOSTLY = 0.9  # of the stamps; a sensor's own never are another node's to the nanosecond
_FEWEST = 10


def second_hand(bag: Bag, references: Sequence[Measured]) -> dict[str, str]:
    """Of which references the odometry is a part, by name, and why: the end of a sentence."""
    return _moved_scans(references) | _carried_on(bag, references)


def _carried_on(bag: Bag, references: Sequence[Measured]) -> dict[str, str]:
    poses = [
        each.name
        for each in references
        if each.independent and each.measures == "poses" and not _is_scan(each) and not each.chain
    ]
    own = [each.name for each in references if each.kind == ODOMETRY and not each.independent]
    if len(poses) < 2 or not own:
        return {}
    stamps: dict[str, set[tuple[int, int]]] = {name: set() for name in (*poses, *own)}
    for message in bag.messages([*poses, *own]):
        stamp = message.content.header.stamp
        stamps[message.topic].add((stamp.sec, stamp.nanosec))
    found = {}
    for name in poses:
        for odometry in own:
            shared = len(stamps[name] & stamps[odometry])
            if shared >= max(_FEWEST, _MOSTLY * len(stamps[name])):
                found[name] = (
                    f"stamped as {odometry} message by message, so the wheels carry it on between "
                    "its own measurements"
                )
    return found


def _moved_scans(references: Sequence[Measured]) -> dict[str, str]:
    scans = [each.name for each in references if _is_scan(each)]
    found = {}
    for name in scans:
        tail = name.rpartition("/")[2]
        for other in scans:
            made_of = other.rpartition("/")[2]
            longer = tail.startswith(f"{made_of}_") or tail.endswith(f"_{made_of}")
            if longer and "filter" not in tail:  # which leaves points out, and moves none
                found[name] = f"made of {other} by its name, and perhaps moved by the odometry"
    return found


def _is_scan(each: Measured) -> bool:
    return each.kind.endswith("/LaserScan")
