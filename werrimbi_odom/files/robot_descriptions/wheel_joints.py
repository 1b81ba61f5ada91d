# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Identifies the driven wheels among the joints of a JointState, by name and rotation.

One topic often contains all joints of a robot: wheels, an arm, a gripper, a camera's pan and tilt.
A gripper also has a left and a right finger, but these stay within a turn, unlike wheels.
"""

from __future__ import annotations

import math
import re
from array import array
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import Bag, stamp_of
from werrimbi_odom.files.bags.bag_contents import Contents
from werrimbi_odom.files.bags.bag_joints import wheel_names
from werrimbi_odom.files.bags.bag_ticks import wished_ticks
from werrimbi_odom.files.bags.bag_wheels import JOINT_STATE, Wheels
from werrimbi_odom.files.bags.own_odometry import ODOMETRY
from werrimbi_odom.files.bags.unstamped import with_stamps
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import integrated
from werrimbi_odom.model.pose import Floats

_NO_WHEELS = """
ankle arm blade brush camera cutter door elbow finger flipper foot forearm gimbal grip gripper hand
head hip jaw knee knuckle leg lift mower neck pan pantilt propeller rotor shoulder thumb tilt torso
trunk waist wrist
"""
NO_WHEELS = frozenset(_NO_WHEELS.split())
"""Words in the names of joints that are not wheels."""

UNDRIVEN = ("cast", "steer", "swivel", "suspension", "rocker", "bogie")
"""Parts of the names of joints near a wheel that are not driven or do not roll."""

SIDES = ("left", "right")
ALONG = ("f", "b", "m", "c")
"""Letters for front, back, middle and centre in the names of joints."""
TURN = 2.0 * math.pi
_ROUNDING = 1e-3  # [rad], for angles that restart at each turn and so stay within one


@dataclass(frozen=True)
class WheelJoints:
    """The joints of a recording, classified."""

    left: tuple[str, ...] = ()
    right: tuple[str, ...] = ()
    others: tuple[str, ...] = ()
    """Joints that are not identified as wheels."""
    turned: Mapping[str, float] | None = None
    """Range of each joint's angle [rad]; None if not determined."""

    @property
    def rolled(self) -> tuple[str, ...]:
        """Other joints with a range of more than one turn, as wheels have."""
        return tuple(name for name in self.others if (self.turned or {}).get(name, 0.0) > TURN)


def is_no_wheel(name: str) -> bool:
    """Whether a joint's name excludes a driven wheel."""
    low = name.lower()
    if any(part in low for part in UNDRIVEN):
        return True
    return "wheel" not in low and bool(_words(name) & NO_WHEELS)


def joints_told_apart(
    joints: Sequence[str],
    turned: Mapping[str, float],
    known: tuple[Sequence[str], Sequence[str]] = ((), ()),
) -> WheelJoints:
    """Classify joints as left wheels, right wheels, and others.

    `joints`: names of all joints. `turned`: range of each joint's angle [rad]. `known`: wheels of
    both sides named in a URDF or a robot file; these take precedence.
    """
    if all(known) and {*known[0], *known[1]} <= set(joints):
        left, right = tuple(known[0]), tuple(known[1])
    else:
        left, right = _by_names(joints, turned)
    taken = {*left, *right}
    others = tuple(name for name in joints if name not in taken)
    return WheelJoints(left, right, others, turned)


def _by_names(
    joints: Sequence[str], turned: Mapping[str, float]
) -> tuple[tuple[str, ...], tuple[str, ...]]:
    able = [name for name in joints if not is_no_wheel(name)]
    for named in ([name for name in able if "wheel" in name.lower()], able):
        left, right = (tuple(name for name in named if is_of(name, side, named)) for side in SIDES)
        if left and right:
            rolled = [
                tuple(name for name in side if turned.get(name, 0.0) > TURN)
                for side in (left, right)
            ]
            # If wheels on both sides roll, one that stays within a turn is not a wheel. If the
            # robot hardly moved, none rolls, and only the names remain.
            return (rolled[0], rolled[1]) if all(rolled) else (left, right)
    return (), ()


def is_of(name: str, side: str, among: Collection[str] = ()) -> bool:
    """Whether a joint's name contains this side.

    The letter r may mean rear. A name of both sides goes by its word, else by two letters as in fl,
    else by its last letter that is not along the robot: `among`, all joints, tells, as where
    another has f (wheel_f_l beside wheel_r_l, or wheel_l_f beside wheel_l_r).
    """
    told = {each: _told_by(name, each) for each in SIDES}
    if not all(told.values()):
        return bool(told[side])
    first = min(map(min, told.values()))
    ranked = [each for each in SIDES if first in told[each]]
    if len(ranked) == 1:
        return side in ranked
    if first < 2:
        return True
    parts, others = _parts(name), [_parts(each) for each in among]
    alike = [each for each in others if len(each) == len(parts)]
    letters = [
        part
        for place, part in enumerate(parts)
        if part in ("l", "r") and not any(each[place] in ALONG for each in alike)
    ]
    return not letters or letters[-1] == side[0]


def _told_by(name: str, side: str) -> set[int]:
    """What tells a side in a name: 0 its word, 1 two letters, 2 its letter."""
    parts = set(_parts(name))
    letter = side[0]
    told = (
        side in name.lower(),
        bool(parts & {f"f{letter}", f"r{letter}", f"{letter}f", f"{letter}r"}),
        letter in parts,
    )
    return {kind for kind, found in enumerate(told) if found}


def _parts(name: str) -> list[str]:
    return name.lower().replace("-", "_").split("_")


def turned_joints(bag: Bag, topic: str) -> dict[str, float]:
    """Range of each joint's angle in a topic [rad].

    All messages are read, up to one that is unreadable (reported later by the reader of the
    wheels): several nodes may publish different joints on one topic. Speeds are integrated where
    there are no angles.
    """
    angles: dict[str, array[float]] = {}
    speeds: dict[str, array[float]] = {}
    with suppress(InputError):
        for message in with_stamps(bag.messages([topic]), Counter()):
            content = message.content
            time = stamp_of(message)
            for found, values in ((angles, content.position), (speeds, content.velocity)):
                for name, value in zip(content.name, values, strict=False):
                    if math.isfinite(float(value)):
                        found.setdefault(name, array("d")).extend((time, float(value)))
            for name in content.name:
                angles.setdefault(name, array("d"))
    return {
        name: _range(np.array(rows[1::2])) or _rolled(np.array(speeds.get(name, ())))
        for name, rows in angles.items()
    }


def _range(angles: Floats) -> float:
    """Range of the angles, unwrapped if they restart at each turn."""
    if angles.size == 0:
        return 0.0
    within = float(np.ptp(angles))
    leaps = np.abs(np.diff(angles)) > 0.75 * TURN
    if within <= TURN + _ROUNDING and leaps.any():
        return float(np.ptp(np.unwrap(angles)))
    return within


def _rolled(speeds: Floats) -> float:
    """Way by speeds, each behind its time, (2 n,)."""
    return float(np.ptp(integrated(speeds[0::2], speeds[1::2])))


def _words(name: str) -> set[str]:
    parts = re.findall(r"[A-Z]?[a-z]+|[A-Z]+", name)
    return {part.lower() for part in parts}


def chosen_wheels(
    bag: Bag, contents: Contents, wish: str | None, source: RobotFile | None
) -> tuple[Wheels | None, WheelJoints]:
    """Choose the source of wheel data, and classify its joints; the firmware's odometry is last.

    Before it come arrays whose counters are found by their values alone. InputError if the
    requested topic contains no ticks.
    """
    known = ((), ()) if source is None else tuple(wheel_names(source, side) for side in SIDES)
    able = sorted(contents.wheels, key=lambda each: (each.gives == "odometry", bool(each.places)))
    able = able if wish is None else [wished_ticks(contents, wish)]
    found: list[tuple[Wheels, WheelJoints]] = []
    for each in able:
        joints = WheelJoints()
        if each.kind == JOINT_STATE:
            turned = turned_joints(bag, each.name)
            joints = joints_told_apart(tuple(turned), turned, (known[0], known[1]))
            each = replace(each, joints=tuple(turned))
        if each.kind == ODOMETRY and any(map(_stands, found)) and not _moves(bag, each.name):
            continue
        found.append((each, joints))
        if each.kind != JOINT_STATE or (joints.left and not _stands(found[-1])):
            break
    return min(found, key=_rank, default=(None, WheelJoints()))


def _rank(found: tuple[Wheels, WheelJoints]) -> int:
    """Rank: wheels by name or message, joints that roll, odometry, then others and what stands."""
    wheels, joints = found
    if wheels.gives == "odometry":
        return 2
    if wheels.joints and not joints.left:
        return 1 if joints.rolled else 3
    return 3 if _stands(found) else 0


def _stands(found: tuple[Wheels, WheelJoints]) -> bool:
    """Whether wheels that are known by name never turn, as where nothing measures them."""
    _, joints = found
    turned = joints.turned or {}
    return bool(joints.left) and not any(turned[name] for name in (*joints.left, *joints.right))


def _moves(bag: Bag, topic: str) -> bool:
    """Whether odometry moves."""
    with suppress(InputError):
        poses = (message.content.pose.pose for message in bag.sampled(topic, 1000))
        held = {(each.position.x, each.position.y, each.orientation.z) for each in poses}
        return len(held) > 1
    return False


def of_another_robot(contents: Contents, wheels: Wheels | None) -> set[str]:
    """References in the namespace of other wheels than the chosen ones.

    Beside wheels without a namespace, as `/joint_states`, another robot has the same topic in its
    own; a driver's further topics (`/mobile_base/odom`) are of the same robot.
    """
    ours = _space(wheels.name) if wheels is not None else ""
    others = [each.topics[0] for each in contents.wheels]
    if wheels is not None and not ours:
        others = [name for name in others if name.endswith(wheels.topics[0])]
    spaces = {_space(name) for name in others} - {ours, ""}
    return {each.name for each in contents.references if _space(each.name) in spaces}


def _space(topic: str) -> str:
    """First component of a topic's namespace; "" if it has none."""
    first, _, rest = topic.strip("/").partition("/")
    return first if rest else ""
