# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files written again with some values changed; comments and order are kept."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.effect_parameters import parameters_of
from werrimbi_odom.files.robot_files.node_parameter import Value
from werrimbi_odom.files.robot_files.parameters import PARAMETERS, find, robot_of
from werrimbi_odom.files.robot_files.robot_file import PARAMETER_KEY, RobotFile, robot_file_of_text
from werrimbi_odom.files.robot_files.yaml_edit import known_values, with_values
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.model.effect import AppliedEffect


def write_robot_file(
    source: RobotFile,
    changes: Mapping[str, Value],
    out: str | Path,
    *,
    force: bool = False,
    effects: Sequence[AppliedEffect] | None = None,
) -> RobotFile:
    """Write a robot file with some values changed; comments and order are kept.

    `source`: need not exist on disk any more: its text is stored. `changes`: new values by
    parameter name; parameters missing in the source are added. `out`: may be the source's own path,
    with `force`. `force`: whether an existing `out` may be overwritten. `effects`: all effects of
    the new file, in order of application; default: those of the source. Unknown parameters (per
    run) are omitted. Result: the robot file as written. InputError if a new value is invalid, or
    `out` exists or is not writable; nothing is written then.
    """
    out = Path(out)
    if out.is_dir():
        raise InputError(f"{out} is a folder; give a file name in it")
    if out.exists() and not force:
        raise InputError(f"{out} exists; --force overwrites it")
    wanted = {name: find(name).checked(value) for name, value in changes.items()}
    try:
        robot_of({**source.values, **wanted})
    except ValueError as error:
        raise InputError(str(error)) from error
    text = new_text(source, wanted, effects)
    held = source.effects if effects is None else tuple(effects)
    written = _read_back(text, out, source, held)
    if (
        written is None
        or any(written.values[name] != value for name, value in {**source.values, **wanted}.items())
        or [(item.name, known_values(item)) for item in written.effects]
        != [(item.name, known_values(item)) for item in held]
    ):
        raise InputError(f"{source.path}: its layout cannot be kept; write it in block style")
    with replacing(out) as file:
        file.write(text)
    return written


def new_text(
    source: RobotFile, changes: Mapping[str, Value], effects: Sequence[AppliedEffect] | None
) -> str:
    """Text that `write_robot_file` would write, for a preview.

    InputError if a new value of a parameter or effect is invalid.
    """
    wanted = {name: find(name).checked(value) for name, value in changes.items()}
    for name in source.given:
        if find(name).kind == "float":  # ROS parameters are typed: 2000 is not a double
            wanted.setdefault(name, source.values[name])
    place = (*source.place, PARAMETER_KEY)
    for applied in effects or ():  # every value must be readable again, else nothing is written
        for item in parameters_of(applied.effect):
            name = item.name.partition(".")[2]
            item.checked(applied.values.get(name, item.default))
    order = tuple(item.name for item in PARAMETERS)
    return with_values(source.text, place, wanted, order, effects)


def _read_back(
    text: str, out: Path, source: RobotFile, effects: Sequence[AppliedEffect]
) -> RobotFile | None:
    """The new text as it will be read; None if it is unreadable."""
    collection = Collection(tuple(item.effect for item in (*effects, *source.effects)))
    try:
        return robot_file_of_text(text, out, collection.find)
    except InputError:
        return None
