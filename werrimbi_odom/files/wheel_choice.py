# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which topic of a bag is looked at as the wheels, where nobody has said which."""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.files.bag import Bag
from werrimbi_odom.files.bag_contents import JOINT_STATE, Contents, Wheels
from werrimbi_odom.files.bag_joints import wheel_names
from werrimbi_odom.files.bag_ticks import wished_ticks
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.wheel_joints import SIDES, WheelJoints, joints_told_apart, turned_joints


def chosen_wheels(
    bag: Bag, contents: Contents, wish: str | None, source: RobotFile | None
) -> tuple[Wheels | None, WheelJoints]:
    """What tells how the wheels turned, and the joints of it; the firmware's odometry last.

    Raises
    ------
    InputError
        When there are no ticks in what is wished for.
    """
    known = ((), ()) if source is None else tuple(wheel_names(source, side) for side in SIDES)
    able = sorted(contents.wheels, key=lambda each: each.gives == "odometry")
    able = able if wish is None else [wished_ticks(contents, wish)]
    found: list[tuple[Wheels, WheelJoints]] = []
    for each in able:
        joints = WheelJoints()
        if each.kind == JOINT_STATE:
            turned = turned_joints(bag, each.name)
            joints = joints_told_apart(tuple(turned), turned, (known[0], known[1]))
            each = replace(each, joints=tuple(turned))
        found.append((each, joints))
        if each.kind != JOINT_STATE or joints.left:
            break
    return min(found, key=_rank, default=(None, WheelJoints()))


def _rank(found: tuple[Wheels, WheelJoints]) -> int:
    """Wheels by name or message first, then joints that roll, then odometry, then others."""
    wheels, joints = found
    if wheels.gives == "odometry":
        return 2
    if wheels.joints and not joints.left:
        return 1 if joints.rolled else 3
    return 0


def of_another_robot(contents: Contents, wheels: Wheels | None) -> set[str]:
    """References in the namespace of wheels that are not those looked at."""
    ours = _space(wheels.name) if wheels is not None else ""
    spaces = {_space(each.name) for each in contents.wheels} - {ours, ""}
    return {each.name for each in contents.references if _space(each.name) in spaces}


def _space(topic: str) -> str:
    """First name of a topic's namespace; "" where it has none."""
    first, _, rest = topic.strip("/").partition("/")
    return first if rest else ""
