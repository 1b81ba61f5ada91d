# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of recorded transforms, and the chains of transforms to the robot's base."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from werrimbi_odom.files.bags.own_odometry import is_base, why_from_wheels

KINDS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
"""Message types with transforms, of ROS 2 and of older bags."""

MOVED = 1e-9
"""Smallest change of a transform that is not rounding [m, and of a unit quaternion]."""


@dataclass(frozen=True, slots=True)
class Edge:
    """A published transform from a parent frame to a child frame."""

    parent: str
    child: str
    topic: str
    messages: int
    static: bool
    """Published once, constant."""
    changes: bool
    """Whether it ever changed."""
    shifts: bool = True
    """Whether its translation ever changed; that of a rotating joint does not."""

    @property
    def made_from_wheels(self) -> str:
        """Reason why it does not measure the robot's motion; "" if it may."""
        if self.static:
            return ""
        if is_base(self.parent) and is_base(self.child):
            return f"{self.parent} -> {self.child} is within the robot, and no sensor's"
        return why_from_wheels("", "", self.parent, self.child)


@dataclass(frozen=True, slots=True)
class Chain:
    """Consecutive transforms from one frame to another."""

    steps: tuple[Edge, ...]
    backwards: tuple[bool, ...]
    """Which of them are traversed from child to parent."""
    parent: str
    child: str

    @property
    def topic(self) -> str:
        """Topic of its moving transforms."""
        moving = [each for each in self.steps if not each.static]
        return (moving or list(self.steps))[0].topic

    @property
    def measures(self) -> tuple[Edge, ...]:
        """Transforms that change and are not odometry: measurements."""
        return tuple(
            each
            for each in self.steps
            if each.changes and not each.static and not each.made_from_wheels
        )

    @property
    def made_from_wheels(self) -> str:
        """Reason why it contains only the robot's own odometry; "" if it measures something."""
        reasons = [each.made_from_wheels for each in self.steps if each.made_from_wheels]
        if self.measures or not reasons:
            return ""
        idle = [each for each in self.steps if not each.static and not each.made_from_wheels]
        if idle:
            return f"{reasons[0]}, and {idle[0].parent} -> {idle[0].child} never changes"
        return reasons[0]

    def in_words(self) -> str:
        """Its frames in order."""
        names = [self.parent]
        for step, back in zip(self.steps, self.backwards, strict=True):
            names.append(step.parent if back else step.child)
        return " -> ".join(names)


class EdgeCollector:
    """Collects transforms, and returns the edges."""

    def __init__(self) -> None:
        self._first: dict[tuple[str, str, str], tuple[float, ...]] = {}
        self._count: dict[tuple[str, str, str], int] = {}
        self._changed: set[tuple[str, str, str]] = set()
        self._shifted: set[tuple[str, str, str]] = set()

    def take(self, topic: str, transforms: Sequence[Any]) -> None:
        """Add the transforms of a message."""
        for each in transforms:
            parent, child = frame(each.header.frame_id), frame(each.child_frame_id)
            key = (parent, child, topic)
            self._count[key] = self._count.get(key, 0) + 1
            if key in self._shifted:
                continue
            where, turn = each.transform.translation, each.transform.rotation
            values = (where.x, where.y, turn.x, turn.y, turn.z, turn.w)
            first = self._first.setdefault(key, values)
            differ = [abs(a - b) > MOVED for a, b in zip(first, values, strict=True)]
            if any(differ):
                self._changed.add(key)
            if any(differ[:2]):
                self._shifted.add(key)

    def edges(self) -> tuple[Edge, ...]:
        """All edges."""
        return tuple(
            Edge(*key, count, is_static(key[2]), key in self._changed, key in self._shifted)
            for key, count in self._count.items()
        )


def frame(name: str) -> str:
    """Frame name without the leading slash of older ROS."""
    return str(name).strip("/")


def is_static(topic: str) -> bool:
    """Whether a topic contains constant transforms."""
    return topic.rstrip("/").endswith("tf_static")


def chain(edges: Sequence[Edge], parent: str, child: str) -> Chain | None:
    """Shortest chain from one frame to another, in either direction; None if there is none."""
    reached: dict[str, tuple[str, Edge, bool] | None] = {parent: None}
    waiting = deque([parent])
    while waiting and child not in reached:
        here = waiting.popleft()
        for edge in edges:
            for start, end, back in (
                (edge.parent, edge.child, False),
                (edge.child, edge.parent, True),
            ):
                if start == here and end not in reached:
                    reached[end] = (here, edge, back)
                    waiting.append(end)
    if child not in reached or child == parent:
        return None
    steps: list[tuple[Edge, bool]] = []
    at = child
    while (came := reached[at]) is not None:
        at, edge, back = came
        steps.insert(0, (edge, back))
    return Chain(tuple(s for s, _ in steps), tuple(b for _, b in steps), parent, child)


def chains_to_base(edges: Sequence[Edge], base: str) -> list[Chain]:
    """Chains from a fixed frame to the robot's base, the longest first.

    `base`: frame of the robot; "" for the usual names (base_link, base_footprint). Result: one from
    every frame above the base, with at least one transform that is not static. If no frame has the
    name of a base: each moving transform, from the frame of the room to which its own is fixed (a
    camera's), except the robot's own joints from robot_state_publisher, which hang from its base or
    only rotate.
    """
    children = {edge.child for edge in edges}
    bases = [base] if base in children else sorted(filter(is_base, children))
    bases.sort(key=lambda name: not name.endswith("base_link"))
    found: list[Chain] = []
    fixed = [edge for edge in edges if edge.static]
    for name in bases:
        if any(chain(fixed, each.child, name) for each in found):
            continue  # fixed to a base that already has chains
        above = [each for each in _above(edges, name) if not is_base(each)]
        chains = [chain(edges, parent, name) for parent in above]
        moving = [each for each in chains if each and not all(s.static for s in each.steps)]
        found += sorted(moving, key=lambda each: -len(each.steps))
    if found:
        return found
    own = {edge.parent for edge in edges if _on_the_robot(edges, edge.parent)}
    free = [edge for edge in edges if not edge.static and edge.shifts and edge.parent not in own]
    rooms = ((_above(fixed, edge.parent) or [edge.parent])[-1] for edge in free)
    return [
        chain([*fixed, edge], room, edge.child) or Chain((edge,), (False,), edge.parent, edge.child)
        for room, edge in zip(rooms, free, strict=True)
    ]


def _on_the_robot(edges: Sequence[Edge], name: str) -> bool:
    """Whether a frame is the robot's base, or hangs from it."""
    return any(is_base(each) for each in (name, *_above(edges, name)))


def _above(edges: Sequence[Edge], name: str) -> list[str]:
    """Ancestors of a frame, nearest first."""
    found: list[str] = []
    waiting = [name]
    while waiting:
        here = waiting.pop(0)
        for edge in edges:
            if edge.child == here and edge.parent not in (name, *found):
                found.append(edge.parent)
                waiting.append(edge.parent)
    return found
