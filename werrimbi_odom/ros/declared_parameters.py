# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Declares the parameters of the other nodes; entries of a robot file are ignored."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from typing import Any

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files import parameters as robot_file
from werrimbi_odom.files.robot_files.effect_parameters import EFFECTS
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value

NONE = "none"
"""An empty text, in a launch file or on a command line: those cannot say one."""


def above_zero(name: str, default: float, unit: str, maximum: float, says: str) -> NodeParameter:
    """A number above zero."""
    return NodeParameter(name, default, says, unit=unit, above=0.0, maximum=maximum)


def within(
    name: str, default: float, unit: str, minimum: float, maximum: float, says: str
) -> NodeParameter:
    """A number in a range."""
    return NodeParameter(name, default, says, unit=unit, minimum=minimum, maximum=maximum)


def given_to(node: Node) -> dict[str, Any]:
    """Values that a node was started with, by parameter."""
    with node.handle:
        return {name: item.value for name, item in node.handle.get_parameters(Parameter).items()}


def declared(node: Node, parameters: Sequence[NodeParameter]) -> dict[str, Value]:
    """Declare every parameter, with the values that the node was started with.

    InputError if any is unknown or invalid; the message names all of them.
    """
    given = given_to(node)
    known = {item.name: item for item in parameters}
    wrong = [
        _unknown(name, list(known))
        for name in given
        if name not in known and not _is_for_others(node, name)
    ]
    values: dict[str, Value] = {}
    for item in parameters:
        assert item.default is not None
        try:
            value = given.get(item.name, item.default)
            empty = value == NONE and item.default == ""
            values[item.name] = item.checked("" if empty else value)
        except InputError as error:
            wrong.append(str(error))
    if wrong:
        raise InputError(". ".join(wrong))
    for name, value in values.items():
        unit = f" [{known[name].unit}]" if known[name].unit else ""
        description = ParameterDescriptor(description=known[name].says + unit, read_only=True)
        node.declare_parameter(name, value, description, ignore_override=True)
    return values


def _is_for_others(node: Node, name: str) -> bool:
    """Whether the parameter is ROS's own, or comes from a robot file with the top key /**."""
    if name.startswith("qos_overrides.") or node.has_parameter(name):
        return True
    return "." in name or name in {EFFECTS, *(item.name for item in robot_file.PARAMETERS)}


def _unknown(name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, 1, 0.5)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
    return f"unknown parameter {name}: {hint}"


def told(default: Value | None) -> str:
    """A default value in YAML notation."""
    if isinstance(default, tuple):
        return f"[{', '.join(default)}]"
    return str(default).lower() if isinstance(default, bool) else str(default)


def table(parameters: Sequence[NodeParameter]) -> str:
    """Table of the parameters in Markdown, for the docs."""
    lines = ["| parameter | type | default | unit | what it is |", "|---|---|---|---|---|"]
    for item in parameters:
        says = item.says
        if item.choices:
            says += f" One of {', '.join(f'`{each}`' for each in item.choices)}."
        default = f"`{told(item.default)}`" if item.default != "" else "empty"
        start = f"| `{item.name}` | {item.kind} | {default}"
        lines.append(f"{start} | {item.unit} | {says} |")
    return "\n".join(lines) + "\n"
