# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where a sensor sits on the robot, by the transforms of a bag that do not change."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message
from werrimbi_odom.files.frames import Chain, Edge, chain, frame
from werrimbi_odom.files.made_from_wheels import is_base

LEVEL = 0.985
"""Cosine of 10 degrees. A lidar that is tilted by more sees walls 1.5 % too far away, and the floor
within 6 m if it sits 1 m high."""


class Mount(NamedTuple):
    """A level sensor on the robot's base: ahead, left [m], turned [rad]."""

    x: float
    y: float
    yaw: float
    inverted: bool
    """It hangs upside down: what it sees to its left is to the right."""


def mounting_chain(edges: Sequence[Edge], base: str, sensor: str) -> Chain | None:
    """Fixed transforms from the robot's base to a sensor's frame; None where none lead there."""
    fixed = [edge for edge in edges if edge.static or not edge.changes]
    frames = dict.fromkeys([base, *(f for edge in fixed for f in (edge.parent, edge.child))])
    bases = [each for each in frames if each == base or is_base(each)]
    for each in bases:
        found = chain(fixed, each, sensor)
        if found is not None:
            return found
    return None


class MountingCollector:
    """Takes messages with transforms, and gives where the sensor sits at the end."""

    def __init__(self, steps: Chain) -> None:
        self._chain = steps
        self._found: dict[tuple[str, str], Any] = {}
        self.topics = tuple(dict.fromkeys(edge.topic for edge in steps.steps))

    def take(self, message: Message) -> None:
        """Take a message of one of the topics."""
        for each in message.content.transforms:
            key = frame(each.header.frame_id), frame(each.child_frame_id)
            self._found[key] = each.transform

    def mount(self, place: str) -> Mount:
        """Where the sensor sits.

        Raises
        ------
        InputError
            When it does not lie level, or a transform is none.
        """
        import numpy as np
        from scipy.spatial.transform import Rotation

        where, turn = np.zeros(3), Rotation.identity()
        for edge, back in zip(self._chain.steps, self._chain.backwards, strict=True):
            found = self._found[edge.parent, edge.child]
            quaternion = [getattr(found.rotation, part) for part in "xyzw"]
            if not 0.5 < float(np.square(quaternion).sum()) < 2.0:
                raise InputError(f"{place}: {edge.parent} -> {edge.child} is never a transform")
            step = np.array([getattr(found.translation, part) for part in "xyz"])
            rotated = Rotation.from_quat(quaternion)
            if back:
                rotated = rotated.inv()
                step = -rotated.apply(step)
            where, turn = where + turn.apply(step), turn * rotated
        up = float(turn.apply([0.0, 0.0, 1.0])[2])
        if abs(up) < LEVEL:
            raise InputError(
                f"{place}: by its transforms ({self._chain.in_words()}) the lidar is tilted by "
                f"{np.degrees(np.arccos(abs(up))):.0f}°: its scans are no plan of the floor; give "
                "one that lies level, or mend the transforms"
            )
        ahead = turn.apply([1.0, 0.0, 0.0])
        yaw = float(np.arctan2(ahead[1], ahead[0]))
        return Mount(float(where[0]), float(where[1]), yaw, up < 0.0)
