# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The new robot file: where it goes, what changes in it, and that nothing else is ever written."""

from __future__ import annotations

import difflib
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

from werrimbi_odom.files.parameters import PARAMETERS
from werrimbi_odom.files.robot_file import PARAMETER_KEY, RobotFile, write_robot_file
from werrimbi_odom.files.yaml_edit import edited
from werrimbi_odom.files.yaml_effects import with_effects
from werrimbi_odom.inference.fitting.knobs import MULTIPLIERS
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.workbench.steps import Session

NOISES = ("left_wheel_noise", "right_wheel_noise")


@dataclass(frozen=True)
class Target:
    """Where files may be written: one place, and numbered ones beside it."""

    path: Path
    force: bool = False
    """Whether `path` itself may be overwritten."""

    def of(self, session: Session, taken: Collection[Path] = ()) -> Path:
        """The file of one tab: the place if it is free or its own, else the next free number.

        Parameters
        ----------
        taken
            What other tabs have written.
        """
        for path in session.saved:
            return path
        if self.path not in taken and (self.force or not self.path.exists()):
            return self.path
        number = 2
        while (path := self._numbered(number)).exists():
            number += 1
        return path

    def _numbered(self, number: int) -> Path:
        return self.path.with_name(f"{self.path.stem}_{number}{self.path.suffix}")


def beside(robot: Path) -> Path:
    """Where the new robot file goes if nothing else was said."""
    return robot.with_name(f"{robot.stem}_new{robot.suffix}")


def changes_of(robot: Robot, source: RobotFile) -> dict[str, float]:
    """Numbers that differ from the file's."""
    given = source.robot
    return {
        name: float(getattr(robot, name))
        for name in (*MULTIPLIERS, *NOISES)
        if getattr(robot, name) != getattr(given, name)
    }


def text_of(source: RobotFile, robot: Robot) -> str:
    """The new file's text, for who wants to read it before it is written."""
    place = (source.node, PARAMETER_KEY)
    order = tuple(item.name for item in PARAMETERS)
    text = edited(source.text, place, changes_of(robot, source), order)
    return with_effects(text, place, robot.effects)


def saved(
    source: RobotFile, session: Session, target: Target, taken: Collection[Path] = ()
) -> Session:
    """Write the current step's robot file.

    Raises
    ------
    InputError
        When it cannot be written; then nothing was.
    """
    path = target.of(session, taken)
    robot = session.now.look.robot
    write_robot_file(
        source,
        changes_of(robot, source),
        path,
        force=path in session.saved or (target.force and path == target.path),
        effects=robot.effects,
    )
    return session.written(path)


def changed_lines(before: str, after: str) -> list[tuple[str, str]]:
    """Lines of the new file with "+" (new), "-" (gone) or " " (as before) before each."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [(line[0], line[2:]) for line in lines if line[0] in "+- "]
