# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels of a robot by its URDF."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot
from werrimbi_odom.files.robot_descriptions.wheel_joints import TURN, is_no_wheel
from werrimbi_odom.model.pose import Floats

_LONGEST = 10_000_000
"""Largest size of a URDF [characters], a hundred times that of robots with all their sensors."""


_AXLE = 0.9
"""Cosine between a wheel's axis and the robot's y axis, above which it rolls forwards."""


_MIDDLE = 0.25
"""Share of the half base within which a wheel stands in the middle and drives neither side."""


def of_urdf(text: str, joints: Sequence[str] = ()) -> FirstRobot:
    """Radius, separation and joints of the driven wheels in a URDF.

    `joints`: names of the recorded joints; other wheels are ignored.
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
    across = [float(each.place[1]) for each in wheels]
    middle, half = 0.5 * (max(across) + min(across)), 0.5 * (max(across) - min(across))
    left = [each for each in wheels if each.place[1] - middle > _MIDDLE * half]
    right = [each for each in wheels if middle - each.place[1] > _MIDDLE * half]
    if not left or not right:
        return FirstRobot()
    apart = float(
        np.mean([each.place[1] for each in left]) - np.mean([each.place[1] for each in right])
    )
    radii = [each.radius for each in (*left, *right) if each.radius is not None]
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
