# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a recording has of the wheels, in words."""

from __future__ import annotations

from collections.abc import Iterator

from werrimbi_odom.files.wheel_joints import WheelJoints, is_no_wheel
from werrimbi_odom.inference.recording_info import Held
from werrimbi_odom.report.numbers import listed

_GIVES = {
    "counts": "counters",
    "positions": "angles of the wheels",
    "velocities": "speeds of the wheels, which are integrated",
    "odometry": "the robot's own odometry, turned back into travel of its wheels",
}
_OF_WHEELS = ("wheel", "encoder", "tick", "motor", "odom", "joint")
WITHOUT_WHEELS = (
    "Record how the wheels turned as well: /joint_states with their angles, the driver's counters "
    "(docs/recordings.md lists the types that are read), or at least its /odom."
)


def wheels_words(held: Held) -> str:
    """The topic, what it gives, and the wheels on each side."""
    wheels = held.wheels
    if wheels is None:
        return f"Wheels: nothing that is read in the bag tells how they turned.{_unread(held)}"
    joints, told = held.joints, ""
    if joints.left:
        told = f", on the left {listed(joints.left)}, on the right {listed(joints.right)}"
    elif wheels.joints:
        told = f"; no name says which joint is a wheel: {listed(wheels.joints)}"
    return f"Wheels: {wheels.name}, {_GIVES[wheels.gives]}{rate_words(held, wheels.name)}{told}."


def _unread(held: Held) -> str:
    """Topics that by their names may tell it, and that are of no type that is read."""
    assert held.contents is not None
    known = {each.name for each in held.contents.references}
    may = [
        f"{each.name} ({each.kind})"
        for each in held.contents.topics
        if each.name not in known and any(word in each.name.lower() for word in _OF_WHEELS)
    ]
    verb = "is" if len(may) == 1 else "are"
    return f" By name {listed(may)} may, but {verb} of no type that is read." if may else ""


def no_wheels_words(joints: WheelJoints) -> Iterator[str]:
    """Joints that are taken for no wheels, and why."""
    named = [name for name in joints.others if is_no_wheel(name)]
    rolled = [name for name in joints.rolled if name not in named]
    stayed = [name for name in joints.others if name not in (*named, *rolled)]
    if named:
        yield f"No wheels by their names: {listed(named)}."
    if stayed and (joints.left or rolled):
        yield f"Not taken for wheels, as nothing says that they are: {listed(stayed)}."
    if rolled:
        yield (
            f"Not taken for wheels, though they turned by more than a turn: {listed(rolled)}. If "
            "they are, name them in a robot file (left_wheel_names, right_wheel_names), and give "
            "it with --robot."
        )


def rate_words(held: Held, name: str) -> str:
    """How often a topic's messages come, after its name."""
    stamps = held.stamps.get(name.split(",")[0].partition(":")[0])
    return "" if stamps is None or name.startswith("/tf") else f" at {stamps.rate:.3g} Hz"
