# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of compare_node, declared once; a robot file given to it as well is let pass."""

from __future__ import annotations

import difflib
import math

from rcl_interfaces.msg import ParameterDescriptor
from rclpy.node import Node
from rclpy.parameter import Parameter as Given

from werrimbi_odom.errors import InputError
from werrimbi_odom.files import parameters as robot_file
from werrimbi_odom.files.effect_parameters import EFFECTS
from werrimbi_odom.files.parameters import Parameter, Value
from werrimbi_odom.inference.rules import TAPE_XY, TAPE_YAW
from werrimbi_odom.ros.compare_inputs import REFERENCE_TYPES

LEAST, MOST = 1e-9, 1e6
"""Of a standard deviation of the reference, so that its square is a number, and no zero."""

PARAMETERS: tuple[Parameter, ...] = (
    Parameter(
        "reference_type",
        "string",
        "pose_stamped",
        "",
        "Kind of the messages on `reference`.",
        choices=tuple(REFERENCE_TYPES),
    ),
    Parameter(
        "leg",
        "float",
        1.0,
        "m",
        "Path of a leg; a quarter turn on the spot makes one too. Too short: the reference's "
        "noise hides what the odometry does.",
        above=0.0,
    ),
    Parameter(
        "window",
        "integer",
        20,
        "legs",
        "Legs that the verdict looks back on. More: it sees smaller faults, and later.",
        minimum=5,
        maximum=100_000,
    ),
    Parameter(
        "reference_sigma_xy",
        "float",
        TAPE_XY,
        "m",
        "Standard deviation of the reference's x and y, where its messages state none.",
        minimum=LEAST,
        maximum=MOST,
    ),
    Parameter(
        "reference_sigma_yaw",
        "float",
        TAPE_YAW,
        "rad",
        "The same of its heading.",
        minimum=LEAST,
        maximum=MOST,
    ),
)


def declared(node: Node) -> dict[str, Value]:
    """Declare every parameter, with the values that the node was started with.

    Raises
    ------
    InputError
        When one is unknown or wrong; the message names all of them.
    """
    with node.handle:
        given = {name: item.value for name, item in node.handle.get_parameters(Given).items()}
    known = {item.name: item for item in PARAMETERS}
    wrong = [
        _unknown(name, list(known))
        for name in given
        if name not in known and not _is_for_others(node, name)
    ]
    values: dict[str, Value] = {}
    for item in PARAMETERS:
        assert item.default is not None
        try:
            values[item.name] = item.checked(given.get(item.name, item.default))
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
    """Whether it is ROS's own, or stands in a robot file whose top key is /**."""
    if name.startswith("qos_overrides.") or node.has_parameter(name):
        return True
    return "." in name or name in {EFFECTS, *(item.name for item in robot_file.PARAMETERS)}


def _unknown(name: str, known: list[str]) -> str:
    near = difflib.get_close_matches(name, known, 1, 0.5)
    hint = f"did you mean {near[0]}?" if near else f"there are {', '.join(known)}"
    return f"unknown parameter {name}: {hint}"


def squared(values: dict[str, Value], name: str) -> float:
    """A standard deviation's square."""
    return math.pow(float(values[name]), 2)  # type: ignore[arg-type]


def table() -> str:
    """The parameters as Markdown, for docs/node.md."""
    lines = ["| parameter | type | default | unit | what it is |", "|---|---|---|---|---|"]
    for item in PARAMETERS:
        says = item.says
        if item.choices:
            says += f" One of {', '.join(f'`{each}`' for each in item.choices)}."
        start = f"| `{item.name}` | {item.kind} | `{item.default}`"
        lines.append(f"{start} | {item.unit} | {says} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print(table(), end="")
