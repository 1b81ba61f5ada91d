# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files: ROS 2 parameter files, read by the node and the command line."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

from ruamel.yaml.comments import CommentedMap

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.effect_parameters import (
    EFFECTS,
    Find,
    Named,
    is_effect_or_near,
    named_effects,
)
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value
from werrimbi_odom.files.robot_files.other_drivers_parameters import (
    OF_TURTLEBOT,
    TURTLEBOT,
    is_of_diff_drive,
    remark_on,
    translated,
)
from werrimbi_odom.files.robot_files.parameters import (
    PARAMETERS,
    TICKS,
    VIRTUAL_TICKS_PER_REVOLUTION,
    defaults,
    doubtful_sizes,
    find,
    limits_of,
    on_both_sides,
    robot_of,
    tolerance_of,
    virtual_ticks,
)
from werrimbi_odom.files.robot_files.yaml_text import line_of, load, plain
from werrimbi_odom.files.text_files import read_small_text
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.encoder_online import EncoderLimits
from werrimbi_odom.model.end_of_piece import PieceTolerance
from werrimbi_odom.model.robot import Robot

NODE = "odom_node"
PARAMETER_KEY = "ros__parameters"
ROS_OWN = ("use_sim_time", "start_type_description_service", "qos_overrides")
"""Parameters of every ROS node; allowed in the file and ignored."""

_YES = ("y", "Y", "yes", "Yes", "YES", "on", "On", "ON")
_NO = ("n", "N", "no", "No", "NO", "off", "Off", "OFF")


@dataclass(frozen=True)
class RobotFile:
    """Content of a robot file."""

    path: Path
    place: tuple[str, ...]
    """Keys above `ros__parameters`: namespaces, if any, and the node's name, or `/**` for any."""
    values: Mapping[str, Value]
    """All parameters; those not in the file have their defaults."""
    given: tuple[str, ...]
    """Names of the parameters in the file, in its order."""
    text: str = field(repr=False)
    """Text of the file, for rewriting it with its comments."""
    effects: tuple[AppliedEffect, ...] = ()
    """Physical effects, in order of application."""
    remarks: tuple[str, ...] = ()
    """Unused content, in words for the user."""

    @property
    def node(self) -> str:
        """Name of the node, or `/**` for any."""
        return self.place[-1]

    @property
    def robot(self) -> Robot:
        """Geometry, encoders, noise and physical effects."""
        return robot_of(self.values, self.effects)

    def refuse_counts(self, what: str | Path) -> None:
        """Check that the counts per turn are known.

        InputError if only positions in radians can be used with this file, and `what` contains
        counts.
        """
        if self.values[TICKS[0]] == VIRTUAL_TICKS_PER_REVOLUTION:
            raise InputError(
                f"{what} holds counts, and {self.path} does not say how many there are in a turn; "
                f"add {' and '.join(TICKS)} to it"
            )

    @property
    def tolerance(self) -> PieceTolerance:
        """Tolerances that end a piece."""
        return tolerance_of(self.values)

    @property
    def limits(self) -> EncoderLimits:
        """When counter readings are rejected."""
        return limits_of(self.values)


def read_robot_file(path: str | Path, effects: Collection | None = None) -> RobotFile:
    """Read a robot file.

    `path`: path of a YAML file in UTF-8, at most one megabyte. `effects`: collection in which
    effects are looked up; default: the library and installed packages. A robot file never names
    code. InputError if it is not usable; the message names file, line, parameter, and the remedy.
    """
    path = Path(path)
    text = read_small_text(
        path, wanted="give the YAML file in it", too_large="it is not a robot file"
    )
    return robot_file_of_text(text, path, None if effects is None else effects.find)


def robot_file_of_text(text: str, path: Path, find_effect: Find | None = None) -> RobotFile:
    """Parse the text of a robot file; see `read_robot_file`. `path` is used in error messages."""
    content, in_parts = load(text, path)
    place, block = _parameter_block(content, path)
    given: dict[str, Value] = {}
    wrong: list[tuple[int, str]] = []
    unused: list[str] = []
    of_turtlebot: list[str] = []
    turtlebot = translated(block)
    taken = {own: raw for own, raw in turtlebot.items() if own not in block}
    effects = None
    try:
        names = plain(block.get(EFFECTS, []))
        effects = named_effects("nothing" if names is None else names, find_effect)
    except InputError as error:
        wrong.append((line_of(block, EFFECTS), str(error)))
    for name, raw in block.items():
        if name == EFFECTS or (isinstance(name, str) and name.split(".")[0] in ROS_OWN):
            continue
        line = line_of(block, name)
        try:
            if is_of_diff_drive(name):
                unused.append(name)
            elif turtlebot and name in (TURTLEBOT, *OF_TURTLEBOT):
                if name == TURTLEBOT:
                    for own in taken:
                        given[own] = find(own).checked(_as_ros_reads(find(own), taken[own]))
                else:
                    of_turtlebot.append(name)
            elif _is_of_effect(name, raw, effects):
                if effects is not None:  # otherwise it is unknown which effects are listed
                    _take_effect(effects, name, raw)
            else:
                parameter = find(str(name))
                given[parameter.name] = parameter.checked(_as_ros_reads(parameter, raw))
        except _InBlockError as error:
            wrong.append((error.line, str(error)))
        except InputError as error:
            wrong.append((line, str(error)))
    values, ticks = {**defaults(), **given}, dict[str, Value]()
    try:
        ticks = virtual_ticks(values, block)
        values.update(ticks)
    except InputError as error:
        wrong.append((line_of(block, "encoder_bits"), str(error)))
    named = "right_wheel_names" if "right_wheel_names" in block else "left_wheel_names"
    wrong += [(line_of(block, named), each) for each in on_both_sides(values)]
    told = [f"line {line}: {words}" for line, words in sorted(wrong)]
    remarks = [*in_parts, *remark_on(unused), *remark_on(of_turtlebot, "TurtleBot3's driver")]
    if taken:
        read = " and ".join(f"{own} {raw}" for own, raw in taken.items())
        remarks.append(f"wheels is of TurtleBot3's driver; read as {read}")
    if ticks:
        remarks.append(
            f"{' and '.join(TICKS)} are not given: wheel positions must come in radians, and are "
            "taken as exact to a microradian"
        )
    missing = ", ".join(
        f"{item.name} ({item.unit})"
        for item in PARAMETERS
        if item.name not in values and item.name not in block
    )
    if missing:
        told.append(f"{place[-1]} must also give {missing}")
    if effects is None or told:
        where = f"{path}, " if wrong else f"{path}: "
        raise InputError(f"{where}{'; '.join(told)}")
    try:
        robot_of(values)
    except ValueError as error:  # a product of values is invalid, though each value is valid
        names_of = [name for name in re.findall(r"\w+", str(error)) if name in given]
        # The value farthest from 1 is the probable typo.
        worst = max(names_of, key=lambda name: abs(math.log(float(values[name]))))  # type: ignore[arg-type]
        raise InputError(f"{path}, line {line_of(block, worst)}: {error}") from None
    found = effects.applied()
    remarks += doubtful_sizes(values)
    values_of_all = MappingProxyType(values)
    return RobotFile(path, place, values_of_all, tuple(given), text, found, tuple(remarks))


def _parameter_block(content: CommentedMap, path: Path) -> tuple[tuple[str, ...], CommentedMap]:
    """Name of the node, with the namespaces that it is written below, and its parameters."""
    nodes = dict(_nodes(content))
    place = next(iter(nodes), ())
    if len(nodes) != 1:
        named = [
            name for name in nodes if isinstance(name[-1], str) and name[-1].strip("/") == NODE
        ]
        named = named or [name for name in nodes if _tells_of_wheels(nodes[name])]
        if len(named) != 1 or ("/**",) in nodes:
            names = ", ".join("/".join(map(str, each)) for each in nodes) or "none"
            raise InputError(
                f"{path}: a robot file tells of one node ({NODE} or /**); here are: {names}"
            )
        place = named[0]
    above = content
    for name in place:
        if not isinstance(name, str) or not name:
            raise InputError(f"{path}, line 1: the top key must be a node's name, not {name!r}")
        line, above = line_of(above, name), above[name]
    if not isinstance(above, CommentedMap) or PARAMETER_KEY not in above:
        raise InputError(
            f"{path}, line {line}: below {place[-1]} comes {PARAMETER_KEY}: and then the parameters"
        )
    block = above[PARAMETER_KEY]
    if block is None:
        block = CommentedMap()
    if not isinstance(block, CommentedMap):
        line = line_of(above, PARAMETER_KEY)
        raise InputError(f"{path}, line {line}: {PARAMETER_KEY} must hold lines of name: value")
    return place, block


def _nodes(
    content: CommentedMap, above: tuple[str, ...] = ()
) -> Iterator[tuple[tuple[str, ...], object]]:
    """Each node with its place; below a namespace (`/robot1`, `/**`) come nodes again."""
    for name, below in content.items():
        within = isinstance(below, CommentedMap) and PARAMETER_KEY not in below
        if within and any(_has_parameters(each) for each in below.values()):
            yield from _nodes(below, (*above, name))
        else:
            yield (*above, name), below


def _has_parameters(below: object) -> bool:
    return isinstance(below, CommentedMap) and (
        PARAMETER_KEY in below or any(map(_has_parameters, below.values()))
    )


def _tells_of_wheels(below: object) -> bool:
    """Whether one of several nodes, as in a controller manager's file, has a wheelbase."""
    block = below.get(PARAMETER_KEY) if isinstance(below, CommentedMap) else None
    return isinstance(block, CommentedMap) and bool({"wheel_separation", TURTLEBOT} & set(block))


def _as_ros_reads(parameter: NodeParameter, raw: object) -> object:
    """Convert a value; booleans also from the words that ROS accepts from YAML 1.1 (yes, off)."""
    if parameter.kind == "boolean" and type(raw) is str:  # quoted texts are of another type
        return True if raw in _YES else False if raw in _NO else raw
    return plain(raw)


class _InBlockError(InputError):
    """An error within the block of an effect."""

    def __init__(self, message: str, line: int) -> None:
        super().__init__(message)
        self.line = line


def _is_of_effect(name: object, raw: object, effects: Named | None) -> bool:
    """Whether a key belongs to an effect: it names one, or has a block that nothing else has."""
    if not isinstance(name, str) or any(item.name == name for item in PARAMETERS):
        return False
    first = name.partition(".")[0]
    listed = effects is not None and any(effect.name == first for effect in effects.effects)
    return listed or isinstance(raw, CommentedMap) or is_effect_or_near(first)


def _take_effect(effects: Named, name: str, raw: object) -> None:
    """Read a block of parameters, or one parameter with a dotted name."""
    if "." in name:
        effects.take(name, plain(raw))
        return
    if not isinstance(raw, CommentedMap):
        raise effects.refuse_value(name, plain(raw))
    effects.listed(name)
    for parameter, value in raw.items():
        try:
            effects.take(f"{name}.{parameter}", plain(value))
        except InputError as error:
            raise _InBlockError(str(error), line_of(raw, parameter)) from None
