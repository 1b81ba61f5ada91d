# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels of a robot by the parameters of its diff_drive_controller, or of TurtleBot3's driver."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot
from werrimbi_odom.files.robot_descriptions.wheel_joints import SIDES
from werrimbi_odom.files.robot_files.other_drivers_parameters import translated
from werrimbi_odom.files.robot_files.yaml_text import ERRORS_OF_SCALARS, BlocksInParts

_SIZES = ("wheel_separation", "wheel_radius")
_MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)
_OF_BOTH = "wheel_radius_multiplier"
"""Of the controller of ROS 1, for both sides."""


def of_controller(path: Path) -> FirstRobot:
    """Wheels as a driver's parameter file has them, which may contain other nodes too.

    InputError if the file is unreadable, or no node has a wheel separation and a radius.
    """
    from ruamel.yaml import YAML
    from ruamel.yaml.error import YAMLError

    yaml = YAML(typ="safe", pure=True)
    yaml.Composer = BlocksInParts
    try:
        content = yaml.load(path.read_text(encoding="utf-8"))
    except (OSError, YAMLError, RecursionError, *ERRORS_OF_SCALARS) as error:
        raise InputError(f"{path} cannot be read: {' '.join(str(error).split())[:200]}") from error
    wrong = ""
    for found in _blocks(content):
        block = {**_of_ros_1(found), **found, **translated(found)}
        if not all(name in block for name in _SIZES):
            continue
        told = [_not_a_size(name, block[name]) for name in _SIZES]
        told += [_no_number(name, block.get(name, 1.0)) for name in (_OF_BOTH, *_MULTIPLIERS)]
        if any(told):
            wrong = wrong or next(filter(None, told))
            continue
        return _first_robot(path, block)
    raise InputError(
        f"{path}: {wrong}"
        if wrong
        else f"{path}: no node in it has wheel_separation and wheel_radius, as a robot file or a "
        "diff_drive_controller has"
    )


def _first_robot(path: Path, block: Mapping[str, Any]) -> FirstRobot:
    given = {name: float(block[name]) for name in _MULTIPLIERS if block.get(name)}
    told = dict.fromkeys(("separation", "radius", "more", "joints"), f"of {path.name}")
    told["reversed"] = f"of {path.name}: a negative multiplier"
    return FirstRobot(
        float(block["wheel_radius"]),
        float(block["wheel_separation"]),
        _names(block.get("left_wheel_names")),
        _names(block.get("right_wheel_names")),
        more={name: abs(value) for name, value in given.items() if abs(value) != 1.0},
        reversed=tuple(
            side for side in SIDES if given.get(f"{side}_wheel_radius_multiplier", 1.0) < 0.0
        ),
        told=told,
    )


def _of_ros_1(block: Mapping[str, Any]) -> dict[str, Any]:
    """What the controller of ROS 1 calls otherwise, under our names."""
    found = {
        f"{side}_wheel_names": block[name] for side in SIDES if (name := f"{side}_wheel") in block
    }
    if _OF_BOTH in block:
        found |= dict.fromkeys(_MULTIPLIERS[1:], block[_OF_BOTH])
    return found


def _no_number(name: str, value: Any) -> str:
    """What is wrong with a number; "" if nothing is, or if it is left empty."""
    if value is None:
        return ""
    known = isinstance(value, int | float) and not isinstance(value, bool)
    if known and math.isfinite(value):
        return ""
    return f"{name} must be a number, not {value!r}"


def _not_a_size(name: str, value: Any) -> str:
    if value is not None and not _no_number(name, value) and value > 0.0:
        return ""
    return f"{name} must be a number greater than 0 (m), not {value!r}"


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
