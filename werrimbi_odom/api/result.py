# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Result of a verb, and its forms: words, JSON, figures, a report page, a notebook view."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from werrimbi_odom.errors import InputError

if TYPE_CHECKING:
    import plotly.graph_objects as go

    from werrimbi_odom.files.robot_files.robot_file import RobotFile
    from werrimbi_odom.model.effect import AppliedEffect
    from werrimbi_odom.report.document import Document

Found = TypeVar("Found")


@dataclass(frozen=True)
class NewRobot:
    """Changes of a verb to a robot file."""

    source: RobotFile
    changes: dict[str, Any]
    """New values by parameter name."""
    effects: Sequence[AppliedEffect] | None = None
    """All effects of the new file; None: unchanged."""


@dataclass(frozen=True, repr=False, kw_only=True)
class Result(Generic[Found]):
    """Result of a verb, with its presentations.

    Attributes
    ----------
    found
        The result itself, with all its numbers (`werrimbi_odom.inference`).
    """

    found: Found
    document: Callable[[], Document] = field(compare=False)
    figures_of_json: Callable[[], dict[str, Any]] = field(compare=False)
    new_robot: NewRobot | None = None

    def summary(self) -> str:
        """Text and tables as in the terminal."""
        from werrimbi_odom.report.terminal import printed

        return printed(self.document())

    def to_dict(self) -> dict[str, Any]:
        """Content of `--json`: numbers, strings, lists, dictionaries; None: not known."""
        from werrimbi_odom.report.number_format import plain

        found = plain(self.figures_of_json())
        assert isinstance(found, dict)
        return found

    def figures(self) -> dict[str, go.Figure]:
        """Figures of the report, by name; one of several alternatives is NAME: CHOICE."""
        return {
            f"{part.key}: {choice}" if choice and len(part.figures) > 1 else part.key: figure
            for part in self.document().draw()
            for choice, figure in part.figures.items()
        }

    def write_report(self, path: str | Path, made: Mapping[str, str] | None = None) -> list[Path]:
        """Write the report; return its files.

        Parameters
        ----------
        path
            .html for a page, .pdf or .png for the main figures only.
        made
            Origin of the report (command, files, options), for the foot of the page.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        from werrimbi_odom.report.save import save_report

        return save_report(replace(self.document(), made=made or {}), Path(path))

    def write_robot(self, path: str | Path, *, force: bool = False) -> RobotFile:
        """Write the robot file with the results; comments and order are kept.

        Raises
        ------
        InputError
            If this verb changes no robot file, or the file exists and `force` is not set.
        """
        from werrimbi_odom.files.robot_files.robot_file_rewrite import write_robot_file

        if self.new_robot is None:
            raise InputError("this finding changes no robot file; add and calibrate do")
        new = self.new_robot
        return write_robot_file(
            new.source, new.changes, Path(path), force=force, effects=new.effects
        )

    def __repr__(self) -> str:
        first = self.summary().strip().partition("\n")[0]
        return f"<{type(self.found).__name__}: {first}>"

    def _repr_html_(self) -> str:
        """Report page in an iframe, for a notebook."""
        from html import escape

        from werrimbi_odom.report.html_page import page_html

        page = escape(page_html(self.document()), quote=True)
        return f'<iframe srcdoc="{page}" width="100%" height="800" frameborder="0"></iframe>'
