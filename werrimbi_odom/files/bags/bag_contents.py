# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a bag contains: wheel data, and references, independent of the wheels or not.

`contents_of(bag)` reads a bag once and returns `Contents`: `wheels` (each a `Wheels`: a possible
--ticks-topic) and `references` (each a `Measured`: a possible --reference-topic, with what it
measures, its frames, whether it is independent of the wheels, and why). Nothing is decided from
numerical values here; whether poses follow the wheels too closely to be measurements is tested
where they are compared.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from werrimbi_odom.files.bags.bag import Bag, Topic
from werrimbi_odom.files.bags.bag_wheels import (
    ARRAYS,
    FLOATS,
    JOINT_STATE,
    Wheels,
    frame_of,
    robots_of,
    wheels_of,
)
from werrimbi_odom.files.bags.derived_references import copies, second_hand
from werrimbi_odom.files.bags.frames import KINDS as TRANSFORMS
from werrimbi_odom.files.bags.frames import Edge, EdgeCollector, chains_to_base, frame
from werrimbi_odom.files.bags.measured_topic import Measured, Measures, preference
from werrimbi_odom.files.bags.own_odometry import (
    FUSED,
    ODOMETRY,
    is_asked_for,
    is_base,
    is_map,
    is_odometry_frame,
    why_from_wheels,
)

IMU = "sensor_msgs/msg/Imu"
SCAN = "sensor_msgs/msg/LaserScan"
FIX = "sensor_msgs/msg/NavSatFix"
CLOUDS = {
    "sensor_msgs/msg/PointCloud2": "clouds of points; scans of one level plane are matched "
    "(sensor_msgs/LaserScan): pointcloud_to_laserscan makes them of it",
    "sensor_msgs/msg/MultiEchoLaserScan": "several echoes a beam; laser_proc makes a "
    "sensor_msgs/LaserScan of the first or the strongest, which can be matched",
}
"""Lidar message types that are not matched, and how to convert them."""
POINT = "geometry_msgs/msg/PointStamped"
POSES = {
    ODOMETRY: "poses",
    "geometry_msgs/msg/PoseStamped": "poses",
    "geometry_msgs/msg/PoseWithCovarianceStamped": "poses",
    "geometry_msgs/msg/TransformStamped": "poses",
    "geometry_msgs/msg/Pose2D": "poses",
    POINT: "positions",
    FIX: "positions",
    IMU: "yaw",
    SCAN: "poses",
}
"""Message types that measure the robot, except transforms of many frames."""


@dataclass(frozen=True)
class Contents:
    """Contents of a bag."""

    path: Path
    topics: tuple[Topic, ...]
    """All topics with messages."""
    wheels: tuple[Wheels, ...]
    """Sources of wheel data; the firmware's odometry last."""
    references: tuple[Measured, ...]
    """References, real or apparent; independent ones first."""
    edges: tuple[Edge, ...]
    """All transforms between frames."""
    moved: Mapping[str, str] = field(default_factory=dict)
    """Clouds of points that are given in a frame of the room, and that frame, by topic."""

    @property
    def independent(self) -> tuple[Measured, ...]:
        """References that are independent of the wheels."""
        return tuple(each for each in self.references if each.independent)

    @property
    def preferred(self) -> tuple[Measured, ...]:
        """Those that are independent of the wheels; the one that measures most first."""
        return tuple(sorted(self.independent, key=preference))


def contents_of(
    bag: Bag, base: str = "", *, choosing: bool = True, wished: Sequence[str] = ()
) -> Contents:
    """Analyse an open bag.

    `base`: the robot's frame, as `base_frame_id` of its file; "" to detect it by name. `choosing`:
    whether a reference still has to be chosen. References that contain odometry are then placed
    last; detecting them takes another pass over their messages. `wished`: references that are asked
    for, and so are listed even if their names are of goals or commands.
    """
    named = {"/" + wish.partition(":")[0].strip().strip("/") for wish in wished}
    edges = EdgeCollector()
    names = [each.name for each in bag.topics if each.kind in TRANSFORMS]
    for message in bag.messages(names) if names else ():
        edges.take(message.topic, message.content.transforms)
    found = edges.edges()
    kinds = (JOINT_STATE, *ARRAYS, *FLOATS, *POSES, *CLOUDS)
    looked_at = [each.name for each in bag.topics if each.kind in kinds]
    firsts = bag.firsts(looked_at)
    robots = robots_of(bag, firsts)
    references = [
        *_chains(found, base),
        *(
            _measured(each, firsts.get(each.name), robots)
            for each in bag.topics
            if each.kind in POSES
        ),
    ]
    references = [each for each in references if each.name in named or not is_asked_for(each.name)]
    on_robot = _frames_on_the_robot(found, references)
    references = [_aboard(each) if each.parent in on_robot else each for each in references]
    whys = {each.name: each.why for each in references}
    for name, odometry in copies(bag, references).items():
        whys[name] = f"the same poses as {odometry}, and {whys[odometry]}"
    references = [
        replace(each, independent=False, why=whys[each.name])
        if whys[each.name] != each.why
        else each
        for each in references
    ]
    made_of = second_hand(bag, references) if choosing else {}
    references = [_with_origin(each, made_of.get(each.name, "")) for each in references]
    # Scans last, since a localiser may have made poses of them; before them points without a frame,
    # which may be speeds. The sort is stable: otherwise the bag's order.
    references.sort(
        key=lambda each: (
            not each.independent,
            each.aboard,
            each.kind == POINT and not each.parent,
            each.kind == SCAN,
            each.name in made_of,
        )
    )
    moved = {
        each.name: where
        for each in bag.topics
        if each.kind in CLOUDS and _is_of_room(where := frame_of(firsts.get(each.name)))
    }
    wheels = tuple(wheels_of(bag, firsts, found, robots))
    return Contents(bag.path, bag.topics, wheels, tuple(references), found, moved)


def _with_origin(reference: Measured, made_of: str) -> Measured:
    """With what it is made of; a scan that others were moved for is no measurement of its own."""
    if not made_of:
        return reference
    if reference.kind == SCAN:
        return replace(reference, independent=False, why=made_of)
    return replace(reference, why=f"{reference.why}; {made_of}")


def moved_words(where: str) -> str:
    """Why points that are given in a frame of the room are no measurement of their own."""
    by = "the odometry" if is_odometry_frame(where) else "a localiser, or the odometry"
    return f"its points are given in {where}, where {by} has moved them"


def _is_of_room(name: str) -> bool:
    """Whether it is a frame that does not move with the robot, by its name."""
    return is_odometry_frame(name) or is_map(name) or name == "world"


def _measured(topic: Topic, first: Any, robots: set[str]) -> Measured:
    kind = topic.kind
    parent = frame_of(first)
    child = frame(getattr(first, "child_frame_id", ""))
    measures: Measures = POSES[kind]  # type: ignore[assignment]
    if kind == IMU:
        parent, child, reason = "", parent, ""
        why = "a gyro of its own; its yaw rate is integrated"
    elif kind == SCAN:
        parent, child = "", parent
        reason = moved_words(child) if _is_of_room(child) else ""
        why = reason or "walls and furniture; its scans are matched with those of the last metres"
    elif kind == FIX:
        parent, child = "", parent
        reason = FUSED if "filtered" in topic.name.lower().replace("unfiltered", "") else ""
        why = reason or "satellites"
    else:
        reason = why_from_wheels(topic.name, kind, parent, child, robots)
        why = reason or f"poses in {parent or 'a frame of their own'}, of a sensor or a localiser"
        if kind == POINT and not parent:
            why = "points in no frame, which may be no positions at all"
    return Measured(topic.name, kind, topic.messages, measures, parent, child, not reason, why)


def _frames_on_the_robot(edges: Sequence[Edge], references: Sequence[Measured]) -> set[str]:
    """Frames of its base and of its sensors, and what hangs on them."""
    found = {each.child for each in references if each.kind in (IMU, SCAN) and each.child}
    named = [each.parent for each in references]
    named += [name for edge in edges for name in (edge.parent, edge.child)]
    found |= {name for name in named if is_base(name)}
    while more := {edge.child for edge in edges if edge.parent in found} - found:
        found |= more
    above = {"map", "world", "earth"}  # an IMU may be stamped so, and its plugin's default is
    above |= {edge.parent for edge in edges if is_base(edge.child)}
    while more := {edge.parent for edge in edges if edge.child in above} - above:
        above |= more
    return {
        name for name in found if is_base(name) or not (name in above or is_odometry_frame(name))
    }


def _aboard(reference: Measured) -> Measured:
    """A pose or a position in a frame on the robot; a chain of transforms is none."""
    if reference.chain is not None or reference.kind == ODOMETRY or not reference.independent:
        return reference
    why = (
        f"{reference.measures} in {reference.parent}, a frame on the robot: they rather tell where "
        "something is, as the robot sees it"
    )
    return replace(reference, aboard=True, why=why)


def _chains(edges: tuple[Edge, ...], base: str) -> list[Measured]:
    found = []
    for each in chains_to_base(edges, base):
        reason = each.made_from_wheels
        told = each.measures or tuple(step for step in each.steps if not step.static)
        words = " and ".join(f"{step.parent} -> {step.child}" for step in each.measures)
        why = reason or f"{words or each.in_words()} comes from a sensor or a localiser"
        count = min(step.messages for step in told)
        name = f"{each.topic}:{each.parent}:{each.child}"
        found.append(
            Measured(
                name, TRANSFORMS[0], count, "poses", each.parent, each.child, not reason, why, each
            )
        )
    return found
