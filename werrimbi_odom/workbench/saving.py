# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The new robot file: its path, its changes, and protection of all other files."""

from __future__ import annotations

import difflib
import os
from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import Path

from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.robot_files.robot_file_rewrite import new_text, write_robot_file
from werrimbi_odom.files.text_files import place_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.workbench.session import Session

NOISES = ("left_wheel_noise", "right_wheel_noise")


@dataclass(frozen=True)
class Target:
    """Allowed output files: one path, and numbered ones beside it."""

    path: Path
    force: bool = False
    """Whether the file at `path` may be overwritten, once."""
    leads_to: str = field(init=False)
    """Target of `path` at the start: a symbolic link that is made later is not followed."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "leads_to", place_of(self.path))

    def of(self, session: Session, taken: Collection[Path] = ()) -> Path:
        """The file of one tab: its own if it is unmodified, otherwise a free one.

        `taken` are files written by other tabs.
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


def file_of(session: Session) -> Path | None:
    """The file that holds the current step, as it was written; None if there is none."""
    return next(
        (
            path
            for path, item in session.saved.items()
            if item.step == session.at and _holds(path, item.text)
        ),
        None,
    )


def _holds(path: Path, text: str) -> bool:
    """Whether a file is as it was written, neither edited nor replaced."""
    try:
        return not path.is_symlink() and path.read_bytes() == text.encode()
    except OSError:
        return False


def changes_of(robot: Robot, source: RobotFile) -> dict[str, float]:
    """Parameters that differ from those of the file."""
    given = source.robot
    return {
        name: float(getattr(robot, name))
        for name in (*MULTIPLIERS, *NOISES)
        if getattr(robot, name) != getattr(given, name)
    }


def text_of(source: RobotFile, robot: Robot) -> str:
    """Text of the new file, for a preview."""
    return new_text(source, changes_of(robot, source), robot.effects)


def saved(
    source: RobotFile, session: Session, target: Target, taken: Collection[Path] = ()
) -> Session:
    """Write the robot file of the current step.

    InputError if it cannot be written; then nothing is.
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
    """Lines of a diff, with "+" (added), "-" (removed) or " " (unchanged) before each."""
    lines = difflib.ndiff(before.splitlines(), after.splitlines())
    return [(line[0], line[2:]) for line in lines if line[0] in "+- "]
