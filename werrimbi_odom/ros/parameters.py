# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot file as ROS parameters: refused whole when anything in it is wrong.

Types, ranges and words come from `werrimbi_odom.files.parameters`; here they are only handed on.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping, Sequence

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from werrimbi_odom.errors import InputError
from werrimbi_odom.files import parameters as table
from werrimbi_odom.files.parameters import Value

CHANGEABLE = frozenset(
    {
        "wheel_separation",
        "wheel_radius",
        "wheel_separation_multiplier",
        "left_wheel_radius_multiplier",
        "right_wheel_radius_multiplier",
        "left_wheel_noise",
        "right_wheel_noise",
        "piece_path_tolerance",
        "piece_heading_tolerance",
        "max_wheel_speed",
        "gap_duration",
    }
)
"""What is believed of the robot may be mended while it drives; how it is wired may not."""

VIRTUAL_TICKS_PER_REVOLUTION = 2.0e6 * math.pi
"""Counts of a microradian, for wheel angles whose encoder is not known: no quantisation."""

_TICKS = ("left_ticks_per_revolution", "right_ticks_per_revolution")
_FLOATS = frozenset(item.name for item in table.PARAMETERS if item.kind == "float")
_QOS = "qos_overrides."


def declared(node: Node) -> dict[str, Value]:
    """Declare every parameter on a node, with the values it was started with.

    Raises
    ------
    InputError
        When one is missing, unknown or wrong; the message names all of them.
    """
    with node.handle:
        given = {name: item.value for name, item in node.handle.get_parameters(Parameter).items()}
    own = {name: value for name, value in given.items() if not _is_of_ros(node, name)}
    values = checked(own, node.get_fully_qualified_name())
    for item in table.PARAMETERS:
        value = values[item.name]
        node.declare_parameter(
            item.name,
            list(value) if isinstance(value, tuple) else value,
            _descriptor(item),
            ignore_override=True,
        )
    return values


def checked(given: Mapping[str, object], node_name: str = "/odom_node") -> dict[str, Value]:
    """Values of all parameters, from those given; those that may be left out filled in.

    Raises
    ------
    InputError
        When one is missing, unknown or wrong; the message names all of them in one line.
    """
    values: dict[str, Value] = table.defaults()
    wrong: list[str] = []
    effects = given.get("effects")
    for name, value in given.items():
        if name == "effects" or _belongs_to_effect(name, effects):
            continue
        try:
            values[name] = table.find(name).checked(_plain(value))
        except InputError as error:
            wrong.append(str(error))
    wrong += _refused_effects(effects)
    without_ticks = _needs_no_ticks(values) and not any(name in given for name in _TICKS)
    if without_ticks:
        values.update(dict.fromkeys(_TICKS, VIRTUAL_TICKS_PER_REVOLUTION))
        if values["encoder_bits"]:
            wrong.append("encoder_bits needs " + " and ".join(_TICKS))
    missing = [
        f"{item.name} ({item.unit})"
        for item in table.PARAMETERS
        if item.name not in values and item.name not in given
    ]
    if missing:
        wrong.append(
            f"missing: {', '.join(missing)}; write them under ros__parameters of "
            f"{node_name.lstrip('/')} (or of /**) in the file given with --params-file"
        )
    if wrong:
        raise InputError(". ".join(wrong))
    return values


def has_virtual_ticks(values: Mapping[str, Value]) -> bool:
    """Whether the wheel angles come without the resolution of their encoders."""
    return values[_TICKS[0]] == VIRTUAL_TICKS_PER_REVOLUTION


def leftover_qos_overrides(node: Node) -> list[str]:
    """QoS overrides that no topic of the node took: misspelt ones."""
    with node.handle:
        given = node.handle.get_parameters(Parameter)
    return [name for name in given if name.startswith(_QOS) and not node.has_parameter(name)]


def with_floats(parameters: list[Parameter]) -> list[Parameter]:
    """Whole numbers given for floats (2000 for 2000.0) made floats, before types are compared."""
    return [
        Parameter(item.name, value=float(item.value))
        if item.name in _FLOATS and item.type_ is Parameter.Type.INTEGER
        else item
        for item in parameters
    ]


def judged(parameters: list[Parameter]) -> SetParametersResult:
    """Whether a change at run time may be made, and else why not."""
    for item in parameters:
        if item.name in CHANGEABLE:
            try:
                table.find(item.name).checked(item.value)
            except InputError as error:
                return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)


def changes_of(parameters: list[Parameter]) -> dict[str, Value]:
    """The values among `parameters` that are ours."""
    return {
        item.name: table.find(item.name).checked(item.value)
        for item in parameters
        if item.name in CHANGEABLE
    }


def _is_of_ros(node: Node, name: str) -> bool:
    return name.startswith(_QOS) or node.has_parameter(name)


def _belongs_to_effect(name: str, effects: object) -> bool:
    return isinstance(effects, Sequence) and name.partition(".")[0] in effects


def _refused_effects(effects: object) -> list[str]:
    """An empty list arrives from ROS as a parameter that is not set."""
    if effects is None:
        return []
    if isinstance(effects, str) or not isinstance(effects, Sequence):
        return [f"effects must be a list of names, not {effects!r}"]
    return [f"unknown effect {name}: this version knows no effects yet" for name in effects]


def _needs_no_ticks(values: Mapping[str, Value]) -> bool:
    return values["input_type"] == "joint_state" and values["position_unit"] == "radians"


def _plain(value: object) -> object:
    return "nothing" if value is None else value


def _descriptor(item: table.Parameter) -> ParameterDescriptor:
    unit = f" [{item.unit}]" if item.unit else ""
    description = ParameterDescriptor(
        description=item.says + unit, read_only=item.name not in CHANGEABLE
    )
    lowest = item.minimum if item.above is None else item.above
    if item.kind == "float" and lowest is not None:
        highest = sys.float_info.max if item.maximum is None else item.maximum
        description.floating_point_range = [FloatingPointRange(from_value=lowest, to_value=highest)]
    if item.above is not None:
        description.additional_constraints = f"greater than {item.above:g}"
    if item.choices:
        description.additional_constraints = "one of " + ", ".join(item.choices)
    return description
