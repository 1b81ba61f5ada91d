# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Chooses a bag's reference topic: the requested one, or the only independent one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag_contents import CLOUDS, SCAN, Contents, moved_words
from werrimbi_odom.files.bags.bag_wheels import Wheels
from werrimbi_odom.files.bags.frames import KINDS as TRANSFORMS
from werrimbi_odom.files.bags.frames import Chain, chain, frame, is_static
from werrimbi_odom.files.bags.measured_topic import Measured
from werrimbi_odom.files.bags.own_odometry import is_odometry_frame

NONE = "none"
"""Value in place of a topic: use no reference."""


class Chosen(NamedTuple):
    """The reference of a run."""

    source: Measured
    child: str = ""
    """Requested frame, for messages with several; "" if none."""


def choose_reference(
    held: Contents, wheels: Wheels, wish: str | None, force: bool
) -> Chosen | None:
    """Choose the requested reference, or the only independent one; None if there is none.

    A reference computed from the wheels is used if requested, or if there is no other. Whether it
    is acceptable is also tested on its values; see `Measured.independent`. `wheels`: source of
    wheel data, which is not a reference. `wish`: TOPIC, TOPIC:CHILD_FRAME, /tf:PARENT:CHILD, or
    `none`. `force`: accept a localiser's correction as poses of the robot. InputError if the
    requested topic does not exist, or there are several; the message lists them.
    """
    if wish == NONE:
        return None
    topics = wheels.name.split(",")
    there = [each for each in held.references if each.name not in topics]
    if wish is not None:
        return _wished(held, there, wish, force)
    independent = [each for each in there if each.independent]
    independent = [each for each in independent if not each.aboard] or independent
    # Scans are matched if requested, or if nothing else measures the robot.
    independent = [each for each in independent if each.kind != SCAN] or independent
    if len(independent) > 1:
        raise InputError(
            f"{held.path}: choose with --reference-topic ({NONE} for no reference); "
            f"candidates are: {listed(independent)}{_not_independent(there)}"
        )
    if wheels.gives == "odometry":
        return Chosen(independent[0]) if independent else None
    # Odometry by its name may be a simulator's ground truth; its values will show.
    chosen = independent or [each for each in there if each.chain is None] or there
    return Chosen(chosen[0]) if chosen else None


def listed(found: Sequence[Measured]) -> str:
    """Names and types, as a list."""
    return ", ".join(f"{each.name} ({each.kind})" for each in found) or "none"


def other_scans(held: Contents) -> list[tuple[str, str]]:
    """Lidar topics that are not matched, each with its content in words."""
    return [
        (each.name, moved_words(held.moved[each.name]) if each.name in held.moved else told)
        for each in held.topics
        if (told := CLOUDS.get(each.kind))
    ]


def _not_independent(found: Sequence[Measured]) -> str:
    names = ", ".join(each.name for each in found if not each.independent)
    return f"; made from the wheels, and so no reference: {names}" if names else ""


def _wished(held: Contents, there: Sequence[Measured], wish: str, force: bool) -> Chosen:
    name, *parts = wish.split(":")
    name = "/" + name.strip().strip("/")
    frames = _frames(held, parts)
    if any(each.kind in TRANSFORMS for each in held.topics if each.name == name):
        return Chosen(_transforms(held, name, frames, force))
    for each in there:
        if each.name == name and len(frames) <= 1:
            return Chosen(each, frames[0] if frames else "")
    for other, what in other_scans(held):
        if other == name:
            raise InputError(f"{held.path}: {name} is no reference as it is: {what}")
    candidates = [each for each in there if each.independent]
    raise InputError(
        f"{held.path}: there is no reference in {name}; candidates are: "
        f"{listed(candidates)}{_not_independent(there)}"
    )


def _frames(held: Contents, parts: Sequence[str]) -> list[str]:
    """Frames in PARENT:CHILD, or in CHILD; their names may hold colons (tag36h11:5)."""
    known = {each for edge in held.edges for each in (edge.parent, edge.child)}
    for place in range(len(parts)):
        both = [frame(":".join(each)) for each in (parts[:place], parts[place:]) if each]
        if known.issuperset(both):
            return both
    return [frame(each) for each in parts]


def _transforms(held: Contents, topic: str, frames: Sequence[str], force: bool) -> Measured:
    """A chain of transforms, by both ends, by its last frame alone, or the only one."""
    space = topic.rpartition("/")[0]
    edges = [
        each
        for each in held.edges
        if each.topic == topic or (is_static(each.topic) and each.topic.rpartition("/")[0] == space)
    ] or list(held.edges)
    chains = [each for each in held.references if each.chain and each.chain.topic == topic]
    if len(frames) == 2:
        found = chain(edges, *frames)
        if found is None:
            told = ", ".join(f"{each.parent} -> {each.child}" for each in edges) or "none"
            raise InputError(
                f"{held.path}: {topic}: no transforms lead from {frames[0]} to {frames[1]}; "
                f"it has: {told}"
            )
        return _measured(topic, found)
    if frames:
        direct = [edge for edge in edges if edge.child == frames[0] and not edge.static]
        if len(direct) == 1:
            _refuse_correction(held, topic, frames[0], chains, force)
            edge = direct[0]
            return _measured(topic, Chain((edge,), (False,), edge.parent, edge.child))
        above = [each for each in chains if each.child == frames[0]]
        chains = above
    several = [each for each in chains if each.independent] or chains
    if len(several) == 1 or (several and not several[0].independent):
        return several[0]
    moving = [edge for edge in edges if not edge.static]
    told = ", ".join(f"{each.parent} -> {each.child}" for each in moving) or "none"
    raise InputError(
        f"{held.path}: {topic}: name the frames with --reference-topic {topic}:PARENT:CHILD; "
        f"it has: {told}"
    )


def _refuse_correction(
    held: Contents, topic: str, child: str, chains: Sequence[Measured], force: bool
) -> None:
    """Raise on the odometry's origin on a map, which is not a pose of the robot."""
    whole = [each for each in chains if each.chain and len(each.chain.steps) > 1]
    through = [
        each
        for each in whole
        if each.chain and any(step.child == child for step in each.chain.steps[:-1])
    ]
    if through and is_odometry_frame(child) and not force:
        raise InputError(
            f"{held.path}: {topic}:{child} is where the odometry starts, as a localiser corrects "
            f"it, and no pose of the robot; its poses are --reference-topic {through[0].name} "
            "(--force takes it all the same)"
        )


def _measured(topic: str, found: Chain) -> Measured:
    reason = found.made_from_wheels
    return Measured(
        f"{topic}:{found.parent}:{found.child}",
        TRANSFORMS[0],
        min(each.messages for each in found.steps),
        "poses",
        found.parent,
        found.child,
        not reason,
        reason or f"{found.in_words()} comes from a sensor or a localiser",
        found,
    )
