# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Frames of a recording's transforms, and the chains of them that lead to the robot's base."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from werrimbi_odom.files.made_from_wheels import is_base, why_from_wheels

KINDS = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
"""Messages that hold transforms, of ROS 2 and of older bags."""

MOVED = 1e-9
"""By which a transform must differ from its first one to have changed at all [m, and of a unit
quaternion]: rounding."""


@dataclass(frozen=True, slots=True)
class Edge:
    """A transform that was published, from a parent frame to a child frame."""

    parent: str
    child: str
    topic: str
    messages: int
    static: bool
    """Published once, for good."""
    changes: bool
    """Whether it ever was another than its first."""
    shifts: bool = True
    """Whether the child ever was in another place than at first; a joint that turns never is."""

    @property
    def made_from_wheels(self) -> str:
        """Why it measures nothing of how the robot goes; "" where it may."""
        if self.static:
            return ""
        if is_base(self.parent) and is_base(self.child):
            return f"{self.parent} -> {self.child} is within the robot, and no sensor's"
        return why_from_wheels("", "", self.parent, self.child)


@dataclass(frozen=True, slots=True)
class Chain:
    """Transforms that lead from one frame to another, one after the other."""

    steps: tuple[Edge, ...]
    backwards: tuple[bool, ...]
    """Which of them are gone from child to parent."""
    parent: str
    child: str

    @property
    def topic(self) -> str:
        """Of its moving transforms."""
        moving = [each for each in self.steps if not each.static]
        return (moving or list(self.steps))[0].topic

    @property
    def measures(self) -> tuple[Edge, ...]:
        """Its transforms that are no odometry and that change: what was measured."""
        return tuple(
            each
            for each in self.steps
            if each.changes and not each.static and not each.made_from_wheels
        )

    @property
    def made_from_wheels(self) -> str:
        """Why nothing but the robot's own odometry is in it; "" where it measures something."""
        reasons = [each.made_from_wheels for each in self.steps if each.made_from_wheels]
        if self.measures or not reasons:
            return ""
        idle = [each for each in self.steps if not each.static and not each.made_from_wheels]
        if idle:
            return f"{reasons[0]}, and {idle[0].parent} -> {idle[0].child} never changes"
        return reasons[0]

    def in_words(self) -> str:
        """Its frames, from one to the next."""
        names = [self.parent]
        for step, back in zip(self.steps, self.backwards, strict=True):
            names.append(step.parent if back else step.child)
        return " -> ".join(names)


class EdgeCollector:
    """Takes the transforms of messages, one at a time, and gives the edges."""

    def __init__(self) -> None:
        self._first: dict[tuple[str, str, str], tuple[float, ...]] = {}
        self._count: dict[tuple[str, str, str], int] = {}
        self._changed: set[tuple[str, str, str]] = set()
        self._shifted: set[tuple[str, str, str]] = set()

    def take(self, topic: str, transforms: Sequence[Any]) -> None:
        """Take what a message holds."""
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
        """All that were seen."""
        return tuple(
            Edge(*key, count, is_static(key[2]), key in self._changed, key in self._shifted)
            for key, count in self._count.items()
        )


def frame(name: str) -> str:
    """A frame's name without the slash that older ROS put before it."""
    return str(name).strip("/")


def is_static(topic: str) -> bool:
    """Whether a topic holds transforms that do not change."""
    return topic.rstrip("/").endswith("tf_static")


def chain(edges: Sequence[Edge], parent: str, child: str) -> Chain | None:
    """The shortest chain from one frame to another, forwards or backwards; None where none is."""
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


def chains_to_base(edges: Sequence[Edge], base: str = "") -> list[Chain]:
    """Chains by which a robot's base is told from a fixed frame, the longest first.

    Parameters
    ----------
    base
        Frame of the robot; "" for those that are called so (base_link, base_footprint).

    Returns
    -------
    list of Chain
        From every frame above the base, with a transform on the way that is not static. Where no
        frame is called a base: the moving transforms, each by itself, but for the robot's own
        joints, which a robot_state_publisher tells: they hang from its base, or turn in one place.
    """
    children = {edge.child for edge in edges}
    bases = [base] if base in children else sorted(filter(is_base, children), key=_as_usual)
    found: list[Chain] = []
    fixed = [edge for edge in edges if edge.static]
    for name in bases:
        if any(chain(fixed, each.child, name) for each in found):
            continue  # fixed to a base that has its chains already
        above = [each for each in _above(edges, name) if not is_base(each)]
        chains = [chain(edges, parent, name) for parent in above]
        moving = [each for each in chains if each and not all(s.static for s in each.steps)]
        found += sorted(moving, key=lambda each: -len(each.steps))
    if found:
        return found
    own = {edge.parent for edge in edges if _on_the_robot(edges, edge.parent)}
    free = [edge for edge in edges if not edge.static and edge.shifts and edge.parent not in own]
    return [Chain((edge,), (False,), edge.parent, edge.child) for edge in free]


def _on_the_robot(edges: Sequence[Edge], name: str) -> bool:
    """Whether a frame is the robot's base, or hangs from it."""
    return any(is_base(each) for each in (name, *_above(edges, name)))


def _as_usual(name: str) -> tuple[bool, str]:
    """The usual name of a base first."""
    return not name.endswith("base_link"), name


def _above(edges: Sequence[Edge], name: str) -> list[str]:
    """Frames that a frame hangs from, parents before their parents."""
    found: list[str] = []
    waiting = [name]
    while waiting:
        here = waiting.pop(0)
        for edge in edges:
            if edge.child == here and edge.parent not in (name, *found):
                found.append(edge.parent)
                waiting.append(edge.parent)
    return found
