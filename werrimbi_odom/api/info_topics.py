# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Topics of a bag that `info` proposes: of the wheels, the reference, and a gyro beside it."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import Bag, opened_bag
from werrimbi_odom.files.bags.bag_contents import Contents, contents_of
from werrimbi_odom.files.bags.bag_reference import LOCALISED
from werrimbi_odom.files.bags.bag_ticks import KINDS
from werrimbi_odom.files.bags.bag_wheels import Wheels
from werrimbi_odom.files.bags.measured_topic import Measured, preference
from werrimbi_odom.files.bags.reference_choice import choose_reference
from werrimbi_odom.files.bags.stamps import stamps_of
from werrimbi_odom.files.read_run import bag_at
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot, with_driver
from werrimbi_odom.files.robot_descriptions.urdf_wheels import of_urdf
from werrimbi_odom.files.robot_descriptions.wheel_joints import (
    chosen_wheels,
    joints_told_apart,
    of_another_robot,
)
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run_folder import REFERENCE
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.recording_info import Held

DESCRIPTION = "/robot_description"


def chosen_topics(
    path: Path,
    bag: Path,
    source: RobotFile | None,
    first: FirstRobot,
    ticks_topic: str | None,
    reference_topic: str | None,
) -> tuple[Held, FirstRobot]:
    """Contents of a bag, and what it says about the robot."""
    with opened_bag(bag) as opened:
        base = "" if source is None else str(source.values["base_frame_id"])
        contents = contents_of(opened, base, wished=[reference_topic or ""])
        wheels, joints = chosen_wheels(opened, contents, ticks_topic, source)
        if source is None and not first.has_sizes:
            first = of_urdf(_description(opened, wheels), tuple(joints.turned or ()))
        if source is None and wheels:
            first = with_driver(replace(first, counted=wheels.gives == "counts"), wheels.kind)
            if first.counted and not wheels.places:
                named = (name for name, kind in KINDS.items() if kind == wheels.kind)
                first = replace(first, input_type=next(named, ""))
        if source is None and joints.turned:
            known = (first.left, first.right)
            joints = joints_told_apart(tuple(joints.turned), joints.turned, known)
            told = dict(first.told or {})
            if (joints.left, joints.right) != known and "joints" in told:
                told["joints"] = "the bag's joints, by their names"
            first = replace(first, left=joints.left, right=joints.right, told=told)
        others = of_another_robot(contents, wheels) if reference_topic is None else set()
        if wheels is not None:  # odometry that is asked for as the wheels measures nothing more
            others = {*others, wheels.name}
        ours = [each for each in contents.references if each.name not in others]
        reference = _best(ours, reference_topic) or _asked_for(contents, wheels, reference_topic)
        if reference is not None and reference not in contents.references:
            contents = replace(contents, references=(reference, *contents.references))
        beside = None if reference_topic else _gyro(ours, reference)
        listed = [wheels, *contents.references]
        topics = {name for each in listed if each for name in _topics(each)}
        stamps = stamps_of(opened, sorted(topics))
    held = Held(path, contents, wheels, reference, stamps, None, "", joints, beside=beside)
    return held, first


def separate_reference(other: Path, source: RobotFile | None, wish: str | None) -> Measured | None:
    """The reference in a recording of its own; None for a folder with reference.csv."""
    bag = bag_at(other, REFERENCE)
    if bag is None:
        return None
    base = "" if source is None else str(source.values["base_frame_id"])
    with opened_bag(bag) as opened:
        return _best(contents_of(opened, base, wished=[wish or ""]).references, wish)


def _description(bag: Bag, wheels: Wheels | None) -> str:
    """The URDF of the namespace of the wheels, or else the first one; "" without one."""
    spaces = [
        each.name.removesuffix(DESCRIPTION)
        for each in bag.topics
        if each.name.endswith(DESCRIPTION)
    ]
    ours = "" if wheels is None else wheels.name
    spaces.sort(key=lambda space: (not ours.startswith(f"{space}/"), -len(space)))
    named = [f"{space}{DESCRIPTION}" for space in spaces]
    found = bag.firsts(named[:1])
    return next((getattr(each, "data", "") for each in found.values()), "")


def _topics(each: Wheels | Measured) -> list[str]:
    return [name.partition(":")[0] for name in each.name.split(",")]


def _best(references: Sequence[Measured], wish: str | None) -> Measured | None:
    """The requested reference, or the independent one that measures most."""
    if wish is not None:
        return next((each for each in references if each.name == wish), None)
    usable = [each for each in references if each.independent and each.messages >= rules.FEW_POSES]
    usable = usable or [each for each in references if each.independent]
    return min(usable, key=preference, default=None)


def _asked_for(contents: Contents, wheels: Wheels | None, wish: str | None) -> Measured | None:
    """The reference that is asked for in other words than it is listed; None if there is none."""
    if wish is None:
        return None
    with suppress(InputError):  # said when the drive is read
        chosen = choose_reference(contents, wheels or Wheels("", "", 0, "counts"), wish, False)
        if chosen is not None:
            child = f":{chosen.child}" if chosen.child else ""
            return replace(chosen.source, name=f"{chosen.source.name}{child}")
    return None


def _gyro(references: Sequence[Measured], reference: Measured | None) -> Measured | None:
    """A gyro that may give the headings beside a localiser's poses, or beside positions."""
    if reference is None or reference.measures == "yaw":
        return None
    localised = reference.chain is not None or reference.kind == LOCALISED
    if reference.measures == "poses" and not localised:  # motion capture, scans
        return None
    return _best([each for each in references if each.measures == "yaw"], None)
