# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A first robot file from a robot's own description: its URDF or its controller's parameters."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.drivers import DRIVERS
from werrimbi_odom.files.wheel_joints import SIDES, TURN, is_no_wheel
from werrimbi_odom.model.pose import Floats

_LONGEST = 10_000_000
"""Largest size of a URDF [characters], a hundred times that of robots with all their sensors."""
_UNKNOWN_TICKS = 4096.0
_OFTEN, _BY_ONE, _NEIGHBOURS = 0.05, 0.1, 5
"""Angles are quantised if the number of counts differs between successive messages in at least this
share of them, and by one in this share of those; or if this many numbers of counts differ by
one."""
_AXLE = 0.9
"""Cosine between a wheel's axis and the robot's y axis, above which it rolls forwards."""


@dataclass(frozen=True)
class FirstRobot:
    """Parameters of a robot's wheels; None if unknown."""

    radius: float | None = None
    """[m]"""
    separation: float | None = None
    """[m]"""
    left: tuple[str, ...] = ()
    """Joints of the left wheels."""
    right: tuple[str, ...] = ()
    ticks: float | None = None
    """Steps of a wheel's angle, or counts, per turn."""
    bits: int = 0
    """Width at which the counters wrap; 0: they do not wrap."""
    more: Mapping[str, float] | None = None
    """Multipliers of a controller."""
    reversed: tuple[str, ...] = ()
    """Sides whose counters run backwards, from a controller's negative multiplier."""
    told: Mapping[str, str] | None = None
    """Source of each value, in words."""

    @property
    def has_sizes(self) -> bool:
        """Whether the sizes needed for a robot file are known."""
        return self.radius is not None and self.separation is not None

    def text(self, title: str) -> str:
        """Text of the robot file, with placeholders for unknown sizes."""
        told = self.told or {}

        def line(name: str, value: object, word: str) -> str:
            return f"    {name}: {value}" + (f"  # {told[word]}" if word in told else "")

        lines = [
            f"# {title}",
            "odom_node:",
            "  ros__parameters:",
            line("wheel_separation", _number(self.separation or 0.3), "separation"),
            line("wheel_radius", _number(self.radius or 0.05), "radius"),
        ]
        for side in SIDES:
            ticks = _number(self.ticks or _UNKNOWN_TICKS)
            lines.append(line(f"{side}_ticks_per_revolution", ticks, "ticks"))
        if self.bits:
            lines.append(line("encoder_bits", self.bits, "bits"))
        for name, value in (self.more or {}).items():
            lines.append(line(name, _number(value), "more"))
        for side, joints in zip(SIDES, (self.left, self.right), strict=True):
            if joints:
                quoted = ", ".join(f'"{name}"' for name in joints)
                lines.append(line(f"{side}_wheel_names", f"[{quoted}]", "joints"))
        if self.reversed:
            effects = ", ".join(f"{side}_wheel_reversed" for side in self.reversed)
            lines.append(line("effects", f"[{effects}]", "reversed"))
        return "\n".join(lines) + "\n"


def _number(value: float) -> str:
    return repr(float(value)) if abs(value) < 1e6 else f"{value:.1f}"


def of_urdf(text: str, joints: Sequence[str] = ()) -> FirstRobot:
    """Radius, separation and joints of the driven wheels in a URDF.

    Parameters
    ----------
    joints
        Names of the recorded joints; other wheels are ignored.
    """
    if len(text) > _LONGEST or "<!ENTITY" in text:
        return FirstRobot()
    try:
        robot = ElementTree.fromstring(text)  # without entities, as checked above
        wheels = [each for each in _wheels(robot) if not joints or each.joint in joints]
    except (ElementTree.ParseError, ValueError, KeyError, RecursionError):
        return FirstRobot()
    if not wheels:
        return FirstRobot()
    middle = float(np.mean([each.place[1] for each in wheels]))
    left = [each for each in wheels if each.place[1] > middle]
    right = [each for each in wheels if each.place[1] < middle]
    if not left or not right:
        return FirstRobot()
    apart = float(
        np.mean([each.place[1] for each in left]) - np.mean([each.place[1] for each in right])
    )
    radii = [each.radius for each in wheels if each.radius is not None]
    names = tuple(each.joint for each in left), tuple(each.joint for each in right)
    told = {"separation": "URDF: between the wheels' joints", "joints": "URDF"}
    if radii:
        told["radius"] = "URDF: of the wheels' cylinders"
    return FirstRobot(
        round(float(np.median(radii)), 6) if radii else None, round(apart, 6), *names, told=told
    )


@dataclass(frozen=True)
class _UrdfWheel:
    joint: str
    place: Floats
    """In the frame of the robot's root, shape (3,) [m]."""
    radius: float | None


def _wheels(robot: ElementTree.Element) -> Iterator[_UrdfWheel]:
    joints = {each.find("child").get("link"): each for each in robot.iter("joint") if _whole(each)}  # type: ignore[union-attr]
    links = {each.get("name"): each for each in robot.iter("link")}
    for child, joint in joints.items():
        name = joint.get("name", "")
        if joint.get("type") not in ("continuous", "revolute") or is_no_wheel(name):
            continue
        if _has_stops(joint):
            continue
        place = _pose_of(child, joints)
        axis_of = joint.find("axis")
        axis = _three(axis_of.get("xyz") if axis_of is not None else None, (1.0, 0.0, 0.0))
        if abs(float((place[:3, :3] @ axis)[1])) < _AXLE * float(np.linalg.norm(axis)):
            continue
        yield _UrdfWheel(name, place[:3, 3], _radius(links.get(child)))


def _has_stops(joint: ElementTree.Element) -> bool:
    """Whether a joint's range is at most two turns: that of an arm, not of a wheel."""
    limit = joint.find("limit")
    if joint.get("type") != "revolute" or limit is None:
        return False
    if not {"lower", "upper"} & set(limit.keys()):
        return False
    return float(limit.get("upper", "0")) - float(limit.get("lower", "0")) <= 2.0 * TURN


def _whole(joint: ElementTree.Element) -> bool:
    return joint.find("child") is not None and joint.find("parent") is not None


def _pose_of(link: str | None, joints: Mapping[str | None, ElementTree.Element]) -> Floats:
    """Pose of a link in the root's frame, (4, 4), with all joints at zero."""
    pose = np.eye(4)
    seen: set[str | None] = set()
    while link in joints and link not in seen:
        seen.add(link)
        joint = joints[link]
        pose = _origin(joint.find("origin")) @ pose
        parent = joint.find("parent")
        link = parent.get("link") if parent is not None else None
    return pose


def _origin(element: ElementTree.Element | None) -> Floats:
    from scipy.spatial.transform import Rotation

    pose = np.eye(4)
    if element is not None:
        pose[:3, 3] = _three(element.get("xyz"), (0.0, 0.0, 0.0))
        angles = _three(element.get("rpy"), (0.0, 0.0, 0.0))  # roll, pitch, yaw about fixed axes
        pose[:3, :3] = Rotation.from_euler("xyz", angles).as_matrix()
    return pose


def _three(text: str | None, usual: tuple[float, float, float]) -> Floats:
    values = np.array([float(part) for part in text.split()] if text else usual)
    if values.shape != (3,) or not np.isfinite(values).all():
        raise ValueError("not three numbers")
    return values


def _radius(link: ElementTree.Element | None) -> float | None:
    """Radius of the link's cylinder or sphere; None if it is only a mesh."""
    for part in ("collision", "visual"):
        for shape in ("cylinder", "sphere"):
            for found in link.iterfind(f"{part}/geometry/{shape}") if link is not None else ():
                value = float(found.get("radius", "nan"))
                if math.isfinite(value) and value > 0.0:
                    return value
    return None


_OF_CONTROLLER = {"wheel_separation": "separation", "wheel_radius": "radius"}
_MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)


def of_controller(path: Path) -> FirstRobot:
    """Wheels of a diff_drive_controller, from a parameter file that may contain other nodes too.

    Raises
    ------
    InputError
        If the file is unreadable, or no node has a wheel separation and a radius.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    try:
        content = YAML(typ="safe", pure=True).load(path.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, YAMLError, RecursionError) as error:
        raise InputError(f"{path} cannot be read: {' '.join(str(error).split())[:200]}") from error
    for block in _blocks(content):
        sizes = [block.get(name) for name in _OF_CONTROLLER]
        if all(isinstance(size, int | float) and size > 0.0 for size in sizes):
            given = {
                name: float(block[name])
                for name in _MULTIPLIERS
                if isinstance(block.get(name), int | float) and block[name] != 0.0
            }
            more = {name: abs(value) for name, value in given.items() if abs(value) != 1.0}
            told = dict.fromkeys(("separation", "radius", "more", "joints"), f"of {path.name}")
            told["reversed"] = f"of {path.name}: a negative multiplier"
            return FirstRobot(
                float(block["wheel_radius"]),
                float(block["wheel_separation"]),
                _names(block.get("left_wheel_names")),
                _names(block.get("right_wheel_names")),
                more=more,
                reversed=tuple(
                    side
                    for side in SIDES
                    if given.get(f"{side}_wheel_radius_multiplier", 1.0) < 0.0
                ),
                told=told,
            )
    raise InputError(
        f"{path}: no node in it has wheel_separation and wheel_radius, as a robot file or a "
        "diff_drive_controller has"
    )


def _blocks(content: Any) -> Iterator[Mapping[str, Any]]:
    if isinstance(content, Mapping):
        yield content
        for value in content.values():
            yield from _blocks(value)


def _names(value: Any) -> tuple[str, ...]:
    if isinstance(value, str):
        return (value,)
    texts = isinstance(value, list) and all(isinstance(each, str) for each in value)
    return tuple(value) if texts else ()


def with_driver(first: FirstRobot, kind: str) -> FirstRobot:
    """Add what the message type of a driver determines."""
    driver = DRIVERS.get(kind)
    if driver is None:
        return first
    told = {**(first.told or {}), "ticks": f"of every robot that sends {kind}"}
    return replace(first, ticks=driver.ticks, bits=driver.narrow, told=told)


def with_steps(first: FirstRobot, angles: Sequence[Floats]) -> FirstRobot:
    """Add the steps of the wheels' angles per turn, if they are visible.

    Parameters
    ----------
    angles
        Angles of the left and the right wheel, shape (n,) each [rad].
    """
    moved = [np.diff(each) for each in angles]
    steps = _steps_of_a_turn(np.abs(np.concatenate(moved)))
    if steps is not None and not _is_counted(moved, 2.0 * math.pi / steps):
        steps = None
    words = (
        "from the steps in which the joint angles come"
        if steps
        else "joint angles come without steps: so many are assumed"
    )
    return replace(first, ticks=steps, told={**(first.told or {}), "ticks": words})


def _is_counted(moved: Sequence[Floats], quantum: float) -> bool:
    """Whether steps come from a counter, and not from a few constant speeds of a simulator.

    At constant speed, the counts per message vary by one. Over many speeds, all numbers of counts
    occur.
    """
    counts = [np.rint(each[np.isfinite(each)] / quantum) for each in moved]
    changes = np.concatenate([np.abs(np.diff(each)) for each in counts])
    changed = changes[changes > 0.0]
    by_one = float(np.mean(changed == 1.0)) if changed.size else 0.0
    neighbours = np.diff(np.unique(np.abs(np.concatenate(counts)))) == 1.0
    often = changed.size > _OFTEN * changes.size
    return (often and by_one > _BY_ONE) or int(neighbours.sum()) >= _NEIGHBOURS


def _steps_of_a_turn(steps: NDArray[np.float64]) -> float | None:
    steps = steps[np.isfinite(steps) & (steps > 1e-6)]
    if steps.size < 20:
        return None
    apart = np.diff(np.unique(np.concatenate([[0.0], np.round(steps, 7)])))
    apart = apart[apart > 1e-6]
    if apart.size == 0:
        return None
    quantum = float(np.median(apart[apart < 1.5 * float(np.quantile(apart, 0.1))]))
    some = np.sort(steps)[: max(20, steps.size // 4)]
    for _ in range(2):
        whole = np.rint(some / quantum)
        quantum = float((whole * some).sum() / max((whole * whole).sum(), 1.0))
    if quantum <= 0.0 or np.median(np.abs(some / quantum - np.rint(some / quantum))) > 0.05:
        return None
    return float(round(2.0 * math.pi / quantum)) if quantum < 1.0 else None
