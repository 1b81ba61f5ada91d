# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel data in a bag: which topics, or values of them, may be the wheels' counters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from werrimbi_odom.files.bags.array_places import Sides, counting_sides
from werrimbi_odom.files.bags.bag import Bag, Topic
from werrimbi_odom.files.bags.driver_messages import DRIVERS
from werrimbi_odom.files.bags.frames import KINDS as TRANSFORMS
from werrimbi_odom.files.bags.frames import Edge, frame
from werrimbi_odom.files.bags.own_odometry import (
    ODOMETRY,
    is_filtered,
    is_odometry_frame,
    is_unfiltered,
    why_from_wheels,
)
from werrimbi_odom.files.run import Gives

JOINT_STATE = "sensor_msgs/msg/JointState"
INT32, INT64 = "std_msgs/msg/Int32", "std_msgs/msg/Int64"
PAIRS = {
    INT32: 32,
    INT64: 0,
    "std_msgs/msg/Int16": 16,
    "duckietown_msgs/msg/WheelEncoderStamped": 32,
    "std_msgs/msg/UInt16": 16,
    "std_msgs/msg/UInt32": 32,
    "std_msgs/msg/Float32": 0,
    "std_msgs/msg/Float64": 0,
}
"""Message types with the counter of one wheel, and its wrap width; 0: it never wraps."""
MULTI_ARRAY = "std_msgs/msg/Int64MultiArray"
ARRAYS = {
    MULTI_ARRAY: 0,
    "std_msgs/msg/Int32MultiArray": 32,
    "std_msgs/msg/Int16MultiArray": 16,
    "std_msgs/msg/UInt32MultiArray": 32,
    "std_msgs/msg/UInt16MultiArray": 16,
}
"""The same for both wheels, as values without names."""
_UNSIGNED = ("/UInt16", "/UInt32")
"""They may hold a power or a distance: read unasked if name or values are a counter's."""
_COUNTS = ("tick", "encoder", "count")
FLOATS = ("std_msgs/msg/Float64MultiArray", "std_msgs/msg/Float32MultiArray")
"""They may hold counters but usually hold commands; read on request only."""


@dataclass(frozen=True)
class Wheels:
    """A topic, or two, with wheel data."""

    name: str
    """Value for --ticks-topic: TOPIC, LEFT,RIGHT, TOPIC:LEFT:RIGHT with two places in an array, or
    /tf:PARENT:CHILD."""
    kind: str
    """Message type, as in `sensor_msgs/msg/JointState`."""
    messages: int
    gives: Gives
    joints: tuple[str, ...] = ()
    """Names of the joints in a JointState."""
    like: Sides = ((), ())
    """Places in an array of further counters that run with the left, and with the right one."""

    @property
    def topics(self) -> tuple[str, ...]:
        """Topics of its messages."""
        return tuple(each.partition(":")[0] for each in self.name.split(","))

    @property
    def of_array(self) -> bool:
        """Whether they are values of an array, which have no names."""
        return self.kind in (*ARRAYS, *FLOATS)

    @property
    def places(self) -> tuple[int, ...]:
        """Places of the two counters within an array, from 0, if it holds more."""
        return tuple(map(int, self.name.split(":")[1:])) if self.of_array else ()

    @property
    def exchanged(self) -> str:
        """The name with left and right exchanged; "" where no option does that."""
        if self.kind in PAIRS:
            return ",".join(reversed(self.name.split(",")))
        left, right = self.places or (0, 1)
        return f"{self.topics[0]}:{right}:{left}" if self.of_array else ""


def frame_of(message: Any) -> str:
    """The frame of a message's header; "" where it has none."""
    return frame(getattr(getattr(message, "header", None), "frame_id", ""))


def robots_of(bag: Bag, firsts: Mapping[str, Any]) -> set[str]:
    """First parts of the names of topics of wheels: the name of a robot, and of no sensor."""

    def of_wheels(topic: Topic) -> bool:
        joints = getattr(firsts.get(topic.name), "name", ()) if topic.kind == JOINT_STATE else ()
        return topic.kind in DRIVERS or any("wheel" in name for name in joints)

    found = {each.name.strip("/").partition("/")[0] for each in bag.topics if of_wheels(each)}
    return found - {"gazebo"}


def _may_count(topic: Topic) -> bool:
    """Whether a message of one value is read as a counter without being asked for."""
    if topic.kind.endswith(_UNSIGNED):
        return any(word in topic.name.lower() for word in _COUNTS)
    return "/Float" not in topic.kind


def wheels_of(
    bag: Bag, firsts: Mapping[str, Any], edges: Sequence[Edge], robots: set[str]
) -> list[Wheels]:
    """Sources of wheel data in a bag, the firmware's odometry last.

    `firsts`: the first message of each topic. `robots`: as `robots_of`.
    """
    found: list[Wheels] = []
    for topic in bag.topics:
        if topic.kind == JOINT_STATE:
            first = firsts.get(topic.name)
            joints = tuple(getattr(first, "name", ()))
            angles = len(getattr(first, "position", ())) > 0 or not joints
            gives: Gives = "positions" if angles else "velocities"
            found.append(Wheels(topic.name, topic.kind, topic.messages, gives, joints))
        elif topic.kind in DRIVERS:
            found.append(Wheels(topic.name, topic.kind, topic.messages, "counts"))
        elif topic.kind in (*ARRAYS, *FLOATS):
            values = len(getattr(firsts.get(topic.name), "data", ()))
            signed = topic.kind in ARRAYS and not any(each in topic.kind for each in _UNSIGNED)
            if values == 2 and signed:
                found.append(Wheels(topic.name, topic.kind, topic.messages, "counts"))
            elif values > 1 and (sides := counting_sides(bag, topic.name, values)) is not None:
                name = f"{topic.name}:{sides[0][0]}:{sides[1][0]}"
                like = (sides[0][1:], sides[1][1:])
                found.append(Wheels(name, topic.kind, topic.messages, "counts", like=like))
        elif topic.kind in PAIRS and _may_count(topic):
            mirrored = topic.name.replace("left", "right")
            for each in bag.topics if mirrored != topic.name else ():
                if each.name == mirrored and each.kind == topic.kind:
                    both = min(topic.messages, each.messages)
                    name = f"{topic.name},{mirrored}"
                    found.append(Wheels(name, topic.kind, both, "counts"))
    for topic in sorted(bag.topics, key=lambda each: not is_unfiltered(each.name)):
        if topic.kind == ODOMETRY:
            reason = why_from_wheels(
                topic.name,
                topic.kind,
                frame_of(firsts.get(topic.name)),
                frame(getattr(firsts.get(topic.name), "child_frame_id", "")),
                robots,
            )
            if reason and not is_filtered(topic.name):
                found.append(Wheels(topic.name, topic.kind, topic.messages, "odometry"))
    if not any(each.gives == "odometry" for each in found):
        # Bags for a SLAM hold scans and transforms alone.
        found += [
            Wheels(
                f"{edge.topic}:{edge.parent}:{edge.child}", TRANSFORMS[0], edge.messages, "odometry"
            )
            for edge in edges
            if edge.changes and is_odometry_frame(edge.parent) and edge.made_from_wheels
        ]
    return found
