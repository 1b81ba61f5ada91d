# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot file that another was made of by `add`, found by its name and its content."""

from __future__ import annotations

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file

ADDED = ("better", "new")
"""Words that `add` is told to put behind the name of a robot file (`files.text_files.beside`)."""
_SAME = ("wheel_separation", "wheel_radius")


def earlier_robot_file(source: RobotFile, collection: Collection) -> RobotFile | None:
    """The file beside `source` from which effects were added to it; None if it is not there.

    It is called as `source` is, without the word that was put behind; it has the same sizes by
    tape, and some of the same effects and no others.
    """
    path = source.path
    for word in ADDED:
        stem = path.stem.removesuffix(f"_{word}")
        if not stem or stem == path.stem:
            continue
        try:
            found = read_robot_file(path.with_name(stem + path.suffix), collection)
        except InputError:
            continue
        names = {each.name for each in found.effects}
        fewer = names < {each.name for each in source.effects}
        if fewer and all(found.values[name] == source.values[name] for name in _SAME):
            return found
    return None
