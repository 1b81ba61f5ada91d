# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot file as ROS parameters, rejected as a whole if any is invalid.

Types, ranges and descriptions come from `werrimbi_odom.files.robot_files.parameters`.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

from rcl_interfaces.msg import FloatingPointRange, ParameterDescriptor, SetParametersResult
from rclpy.node import Node
from rclpy.parameter import Parameter

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files import parameters as table
from werrimbi_odom.files.robot_files.effect_parameters import (
    EFFECTS,
    Named,
    named_effects,
    parameters_of,
)
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value
from werrimbi_odom.files.robot_files.other_drivers_parameters import is_of_diff_drive
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.ros.counter_inputs import robot_at_counters
from werrimbi_odom.ros.declared_parameters import given_to
from werrimbi_odom.ros.live_odometer import rehearse

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
"""Parameters of the robot that may change at run time; how it is wired may not."""

_QOS = "qos_overrides."

Changeable = Mapping[str, NodeParameter]
"""Parameters that may change at run time, by name."""


class Settings(NamedTuple):
    """Parameters of the robot and of its wiring, and its effects."""

    values: Mapping[str, Value]
    effects: tuple[AppliedEffect, ...]

    @property
    def robot(self) -> Robot:
        """Robot parameters for the counters, with the effects."""
        return replace(robot_at_counters(self.values), effects=self.effects)

    @property
    def tolerance(self) -> PieceTolerance:
        """Tolerances that end a piece."""
        return table.tolerance_of(self.values)

    @property
    def limits(self) -> EncoderLimits:
        """When counter readings are rejected."""
        return table.limits_of(self.values)

    def after(self, changes: Mapping[str, Value]) -> Settings:
        """Return the settings with some values changed.

        ValueError if the node could not continue with them.
        """
        own = {name: value for name, value in changes.items() if name in self.values}
        settings = Settings({**self.values, **own}, with_changes(self.effects, changes))
        rehearse(settings.robot, settings.tolerance)
        return settings


def changeable(effects: tuple[AppliedEffect, ...]) -> Changeable:
    """Parameters that may change at run time: `CHANGEABLE`, and every parameter of an effect."""
    items = [item for item in table.PARAMETERS if item.name in CHANGEABLE]
    items += [item for applied in effects for item in parameters_of(applied.effect)]
    return {item.name: item for item in items}


def declared(node: Node) -> Settings:
    """Declare every parameter on a node, with the values it was started with.

    InputError if any is missing, unknown or invalid; the message names all of them.
    """
    own = {
        name: value
        for name, value in given_to(node).items()
        if not (name.startswith(_QOS) or node.has_parameter(name))
    }
    values, effects = settings = settings_of(own, node.get_fully_qualified_name())
    for item in table.PARAMETERS:
        value = values[item.name]
        node.declare_parameter(
            item.name,
            list(value) if isinstance(value, tuple) else value,
            _descriptor(item, item.name in CHANGEABLE),
            ignore_override=True,
        )
    _declare_effects(node, effects)
    return settings


def _declare_effects(node: Node, effects: tuple[AppliedEffect, ...]) -> None:
    if effects:  # rclpy cannot infer the type of an empty list
        description = ParameterDescriptor(
            description="Physical effects, in order of application.", read_only=True
        )
        names = [applied.name for applied in effects]
        node.declare_parameter(EFFECTS, names, description, ignore_override=True)
    for applied in effects:
        for item in parameters_of(applied.effect):
            name = item.name.partition(".")[2]
            unknown = name in applied.unknown
            descriptor = _descriptor(item, True)
            descriptor.dynamic_typing = unknown  # no value yet, so no type
            value = None if unknown else applied.values[name]
            node.declare_parameter(item.name, value, descriptor, ignore_override=True)


def settings_of(given: Mapping[str, object], node_name: str = "/odom_node") -> Settings:
    """Check the given parameters, and fill in the defaults of the others.

    InputError if any is missing, unknown or invalid; the message names all of them in one line.
    """
    values: dict[str, Value] = table.defaults()
    wrong: list[str] = []
    effects = _named(given.get(EFFECTS), wrong)
    for name, value in given.items():
        try:
            if name == EFFECTS or is_of_diff_drive(name):  # diff_drive_controller's file
                continue
            if "." in name or any(name == effect.name for effect in effects.effects):
                _take_of_effect(effects, name, value)
            else:
                values[name] = table.find(name).checked(_plain(value))
        except InputError as error:
            wrong.append(str(error))
    wrong += _without_channels(effects)
    try:
        values.update(table.virtual_ticks(values, given))
    except InputError as error:
        wrong.append(str(error))
    wrong += table.on_both_sides(values)
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
    settings = Settings(values, effects.applied())
    try:
        rehearse(settings.robot, settings.tolerance)
    except ValueError as error:
        raise InputError(str(error)) from error
    return settings


def has_virtual_ticks(values: Mapping[str, Value]) -> bool:
    """Whether wheel angles are given without the resolution of their encoders."""
    return values[table.TICKS[0]] == table.VIRTUAL_TICKS_PER_REVOLUTION


def leftover_qos_overrides(node: Node) -> list[str]:
    """Overrides of a QoS that no topic of the node uses: misspelt ones."""
    given = given_to(node)
    return [name for name in given if name.startswith(_QOS) and not node.has_parameter(name)]


def with_floats(items: Changeable, parameters: list[Parameter]) -> list[Parameter]:
    """Convert integers given for floats (2000 for 2000.0), before types are compared."""
    floats = {item.name for item in (*table.PARAMETERS, *items.values()) if item.kind == "float"}
    return [
        Parameter(item.name, value=float(item.value))
        if item.name in floats and item.type_ is Parameter.Type.INTEGER
        else item
        for item in parameters
    ]


def judged(
    items: Changeable, settings: Settings, parameters: list[Parameter]
) -> SetParametersResult:
    """Whether a change at run time is allowed, and otherwise the reason."""
    try:
        settings.after(changes_of(items, parameters))
    except ValueError as error:
        return SetParametersResult(successful=False, reason=str(error))
    return SetParametersResult(successful=True)


def changes_of(items: Changeable, parameters: list[Parameter]) -> dict[str, Value]:
    """Values among `parameters` that belong to this package; InputError if a value is invalid."""
    return {
        item.name: items[item.name].checked(_plain(item.value))
        for item in parameters
        if item.name in items
    }


def with_changes(
    effects: tuple[AppliedEffect, ...], changes: Mapping[str, Value]
) -> tuple[AppliedEffect, ...]:
    """Return the effects with their share of the changes; values given are no longer unknown."""

    def own(applied: AppliedEffect) -> dict[str, float]:
        begin = f"{applied.name}."
        mine = {key.removeprefix(begin): v for key, v in changes.items() if key.startswith(begin)}
        return {name: float(value) for name, value in mine.items()}  # type: ignore[arg-type]

    return tuple(applied.learnt(**own(applied)) for applied in effects)


def _named(names: object, wrong: list[str]) -> Named:
    """The named effects; ROS delivers an empty list as a parameter that is not set."""
    try:
        return named_effects(names)
    except InputError as error:
        wrong.append(str(error))
        return Named(())


def _take_of_effect(effects: Named, name: str, value: object) -> None:
    if "." in name:
        effects.take(name, _plain(value))
    elif value is not None:  # ROS delivers an empty block, {}, as a parameter that is not set
        raise effects.refuse_value(name, value)


def _without_channels(effects: Named) -> list[str]:
    """Effects that need a measured channel: a live node has only the counters."""
    return [
        f"effect {effect.name} looks at the measured channel {', '.join(effect.lacks(()))}, which "
        "the node does not have; it works on recorded runs alone. Take it out of effects"
        for effect in effects.effects
        if effect.lacks(())
    ]


def _plain(value: object) -> object:
    return "nothing" if value is None else value


def _descriptor(item: NodeParameter, may_change: bool) -> ParameterDescriptor:
    unit = f" [{item.unit}]" if item.unit else ""
    description = ParameterDescriptor(description=item.says + unit, read_only=not may_change)
    lowest = item.minimum if item.above is None else item.above
    if item.kind == "float" and lowest is not None:
        highest = sys.float_info.max if item.maximum is None else item.maximum
        description.floating_point_range = [FloatingPointRange(from_value=lowest, to_value=highest)]
    if item.above is not None:
        description.additional_constraints = f"greater than {item.above:g}"
    if item.choices:
        description.additional_constraints = "one of " + ", ".join(item.choices)
    return description
