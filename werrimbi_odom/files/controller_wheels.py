# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels of a robot by the parameters of its diff_drive_controller, or of TurtleBot3's driver."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.first_robot import FirstRobot
from werrimbi_odom.files.other_drivers_parameters import translated
from werrimbi_odom.files.wheel_joints import SIDES
from werrimbi_odom.files.yaml_text import ERRORS_OF_SCALARS, BlocksInParts

_SIZES = ("wheel_separation", "wheel_radius")
_MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)


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
    for found in _blocks(content):
        block = {**found, **translated(found)}
        sizes = [block.get(name) for name in _SIZES]
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
