# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The new robot file: where it goes, what changes in it, and that nothing else is ever written."""

from __future__ import annotations

import difflib
import os
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

from werrimbi_odom.files.robot_file import RobotFile, new_text, write_robot_file
from werrimbi_odom.files.text_files import place_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.workbench.steps import Session

NOISES = ("left_wheel_noise", "right_wheel_noise")


@dataclass(frozen=True)
class Target:
    """Where files may be written: one place, and numbered ones beside it."""

    path: Path
    force: bool = False
    """Whether what is at `path` may be overwritten, once."""
    leads_to: str = field(init=False)
    """Where `path` led at the beginning: a link that somebody puts there later is no leave."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "leads_to", place_of(self.path))

    def of(self, session: Session, taken: Collection[Path] = ()) -> Path:
        """The file of one tab: its own, if nobody has touched it since, else a free one.

        Parameters
        ----------
        taken
            What other tabs have written.
        """
        for path, item in reversed(tuple(session.saved.items())):
            if _holds(path, item.text):
                return path
        may = self.force and self.path not in session.saved and place_of(self.path) == self.leads_to
        if self.path not in taken and (may or not os.path.lexists(self.path)):
            return self.path
        number = 2
        while os.path.lexists(path := self._numbered(number)):
            number += 1
        return path

    def _numbered(self, number: int) -> Path:
        return self.path.with_name(f"{self.path.stem}_{number}{self.path.suffix}")


def _holds(path: Path, text: str) -> bool:
    """Whether a file is as it was written: one that was edited since, or replaced, is not ours."""
    try:
        return not path.is_symlink() and path.read_bytes() == text.encode()
    except OSError:
        return False


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
    return new_text(source, changes_of(robot, source), robot.effects)


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
    written = write_robot_file(
        source,
        changes_of(robot, source),
        path,
        force=path in session.saved or (target.force and path == target.path),
        effects=robot.effects,
    )
    return session.written(path, written.text)


def changed_lines(before: str, after: str) -> list[tuple[str, str]]:
    """Lines of the new file with "+" (new), "-" (gone) or " " (as before) before each."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [(line[0], line[2:]) for line in lines if line[0] in "+- "]
