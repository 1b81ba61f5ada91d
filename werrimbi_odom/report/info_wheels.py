# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a recording has of the wheels, in words."""

from __future__ import annotations

from collections.abc import Iterator

from werrimbi_odom.files.bag import topic_in_words
from werrimbi_odom.files.bag_contents import FLOATS
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
    """Topics that by their names may tell it, and that are read where asked for or not at all."""
    assert held.contents is not None
    known = {each.name for each in held.contents.references}
    may = [
        each
        for each in held.contents.topics
        if each.name not in known and any(word in each.name.lower() for word in _OF_WHEELS)
    ]
    words = [
        f" By name {topic_in_words(each)} may: if its two values count both wheels, --ticks-topic "
        f"{each.name} reads them."
        for each in may
        if each.kind in FLOATS
    ]
    others = [topic_in_words(each) for each in may if each.kind not in FLOATS]
    if others:
        verb = "is" if len(others) == 1 else "are"
        words.append(f" By name {listed(others)} may, but {verb} of no type that is read.")
    return "".join(words)


def other_wheels_words(held: Held) -> Iterator[str]:
    """What else in the bag may tell of wheels: of another robot, or of this one once more."""
    assert held.contents is not None
    taken = held.wheels.name if held.wheels is not None else ""
    others = [each.name for each in held.contents.wheels if each.gives != "odometry"]
    others = [name for name in others if name != taken]
    if others and taken:
        told = f"Not looked at, but may tell of wheels: {listed(others)}"
        yield f"{told}; --ticks-topic takes {'that' if len(others) == 1 else 'one'}."


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
