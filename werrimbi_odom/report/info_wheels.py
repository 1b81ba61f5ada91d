# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What werrimbi info says of what stands for the wheels."""

from __future__ import annotations

from collections.abc import Iterator

from werrimbi_odom.files.bags.bag import Topic, topic_in_words
from werrimbi_odom.files.bags.bag_wheels import ARRAYS, FLOATS, PAIRS
from werrimbi_odom.files.bags.own_odometry import ODOMETRY, is_filtered, names_a_sensor
from werrimbi_odom.files.robot_descriptions.wheel_joints import WheelJoints, is_no_wheel
from werrimbi_odom.inference.recording_info import Held
from werrimbi_odom.report.number_format import listed

_GIVES = {
    "counts": "counters",
    "positions": "angles of the wheels",
    "velocities": "speeds of the wheels, which are integrated",
    "odometry": "the robot's own odometry, turned back into travel of its wheels",
}
_OF_FILTER = "a filter's poses, turned back into travel of wheels, and of all that it fuses"
_OF_WHEELS = ("wheel", "encoder", "tick", "motor", "odom", "joint")
WITHOUT_WHEELS = (
    "Record how the wheels turned as well: /joint_states with their angles, the driver's counters "
    "(docs/recordings.md lists the types that are read), or at least its /odom."
)


def wheels_words(held: Held) -> str:
    """The topic of the wheels, its kind of data, and the wheels on each side."""
    wheels = held.wheels
    if wheels is None:
        return f"Wheels: nothing that is read in the bag tells how they turned.{_unread(held)}"
    joints, told = held.joints, ""
    if joints.left:
        told = f", on the left {listed(joints.left)}, on the right {listed(joints.right)}"
    elif wheels.joints:
        told = f"; no name says which joint is a wheel: {listed(wheels.joints)}"
    if wheels.of_array:
        places = zip(wheels.places or (0, 1), wheels.like, strict=True)
        left, right = (
            f"number {place}" + (f" ({listed(tuple(map(str, like)))} alike)" if like else "")
            for place, like in places
        )
        told = (
            f": of its values, counted from 0, {left} as the left wheel's and {right} as the "
            f"right one's, {_which_is_left(held)}; "
            f"--ticks-topic {wheels.topics[0]}:LEFT:RIGHT takes others"
        )
    found = wheels.gives if held.run is None else held.run.wheels_from  # angles may stay at zero
    gives = _OF_FILTER if is_filtered(wheels.name) else _GIVES[found]
    return f"Wheels: {wheels.name}, {gives}{rate_words(held, wheels.name)}{told}."


def _which_is_left(held: Held) -> str:
    if held.mistakes:
        return "in their order"
    if held.confirmed:
        return "which the reference's turns confirm"
    return "in their order, as nothing shows which is left"


def wheels_to_try(held: Held) -> str:
    """What may tell of wheels, though nothing says so; "" for nothing."""
    assert held.contents is not None
    odometry = (
        each.name
        for each in held.contents.topics
        if each.kind == ODOMETRY and not (is_filtered(each.name) or names_a_sensor(each.name))
    )
    return pair_of_counters(held) or next(odometry, "")


def pair_of_counters(held: Held) -> str:
    """LEFT,RIGHT if just two topics may be the wheels' counters, as /lwheel and /rwheel."""
    found = sorted(each for each in _may_tell(held) if each.kind in PAIRS)
    if len(found) != 2 or found[0].kind != found[1].kind:
        return ""
    return ",".join(each.name for each in found)


def _may_tell(held: Held) -> list[Topic]:
    """Topics with names that suggest wheel data."""
    assert held.contents is not None
    known = {each.name for each in held.contents.references}
    return [
        each
        for each in held.contents.topics
        if each.name not in known and any(word in each.name.lower() for word in _OF_WHEELS)
    ]


def _unread(held: Held) -> str:
    """Topics with names that suggest wheel data, but that are not read by default."""
    assert held.contents is not None
    may = _may_tell(held)
    words = [
        f" By name {topic_in_words(each)} may: if two of its values count the wheels, "
        f"--ticks-topic {each.name}:0:1 reads the first two, and other numbers others."
        for each in may
        if each.kind in (*ARRAYS, *FLOATS)
    ]
    pair = pair_of_counters(held)
    if named := [topic_in_words(each) for each in may if each.kind in PAIRS]:
        words.append(
            f" By name {listed(named)} may: if they count the left and the right wheel, "
            f"--ticks-topic {pair} reads them."
            if pair
            else f" By name {listed(named)} may, but such a type is read only where each wheel has "
            "a topic (--ticks-topic LEFT,RIGHT)."
        )
    for each in held.contents.topics:
        if each.kind == ODOMETRY and is_filtered(each.name):
            words.append(
                f" --ticks-topic {each.name} takes a filter's poses in their stead, and judges "
                "all that it fuses with the wheels."
            )
    read = (*ARRAYS, *FLOATS, *PAIRS)
    others = [topic_in_words(each) for each in may if each.kind not in read]
    if others:
        verb = "is" if len(others) == 1 else "are"
        words.append(f" By name {listed(others)} may, but {verb} of no type that is read.")
    return "".join(words)


def other_wheels_words(held: Held) -> Iterator[str]:
    """Other topics with wheel data, perhaps of another robot."""
    assert held.contents is not None
    taken = held.wheels.name if held.wheels is not None else ""
    others = [each.name for each in held.contents.wheels if each.gives != "odometry"]
    others = [name for name in others if name != taken]
    if others and taken:
        told = f"Not looked at, but may tell of wheels: {listed(others)}"
        yield f"{told}; --ticks-topic takes {'that' if len(others) == 1 else 'one'}."


def no_wheels_words(joints: WheelJoints) -> Iterator[str]:
    """Joints that are not taken for wheels, and why."""
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
    """Message rate of a topic, as a suffix of its name."""
    stamps = held.stamps.get(name.split(",")[0].partition(":")[0])
    return "" if stamps is None or name.startswith("/tf") else f" at {stamps.rate:.3g} Hz"
