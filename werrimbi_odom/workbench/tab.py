# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""State shared by all browser tabs, and the state of one: session, work, selection.

The first comparison runs in another process while the server and the page start. In a thread it
would delay the server. Also, NiceGUI inspects all objects at its start (`gc.get_objects`), which
CPython does not allow while another thread creates tuples.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.verdict import Verdict
from werrimbi_odom.report.number_format import error_words, listed
from werrimbi_odom.workbench.job import CancelledError, Job
from werrimbi_odom.workbench.leg_selection import Part
from werrimbi_odom.workbench.loaded_input import Look, Opened
from werrimbi_odom.workbench.pickling import NOT_SENT, known_before, known_to_both
from werrimbi_odom.workbench.saving import Target, saved
from werrimbi_odom.workbench.session import Session
from werrimbi_odom.workbench.task import Add, Diagnose, Task

VIEWS = ("compare", "diagnose", "add", "save")


@dataclass(frozen=True, eq=False)
class Shared:
    """State shared by all tabs; constant except for written files and running jobs."""

    opened: Opened
    look: Look
    """Comparison of the robot as given."""
    source: RobotFile
    collection: Collection
    target: Target
    taken: set[Path] = field(default_factory=set)
    """Files written by any tab."""
    jobs: set[Job] = field(default_factory=set)
    """Running jobs, to be cancelled when the server ends."""


@dataclass(eq=False)
class Tab:
    """State of one tab; `changed` is called whenever the page must be redrawn."""

    shared: Shared
    session: Session
    changed: Callable[[str | None], None]
    """Called with the key of the element to focus afterwards, or None."""
    view: str = "compare"
    part: Part | None = None
    """Selected part of the drives; its legs are shown."""
    held_out: bool = False
    """Whether the floor shows the held-out drives."""
    variable: int = 0
    why: str | None = None
    """Effect with its page open."""
    dark: bool = False
    actions: dict[str, Callable[[], Any]] = field(default_factory=dict)
    """Actions of all drawn buttons by their keys."""
    job: Job | None = None
    news: str = ""
    """Last message, for the status line and for screen readers."""
    trouble: bool = False
    """Whether this message is an error."""

    @property
    def comparison(self) -> Comparison:
        """Comparison of the current robot on the selected drives."""
        look = self.session.now.look
        return look.holdout if self.held_out else look.train

    @property
    def verdict(self) -> Verdict:
        """Verdict of `comparison`."""
        look = self.session.now.look
        return look.holdout_verdict if self.held_out else look.verdict

    def go(self, view: str) -> None:
        """Go to another of the four views, at its top."""
        self.view = view
        self.changed(f"title-{view}")

    def point(self, part: Part | None, focus: str) -> None:
        """Show the legs of a part; if already selected, all legs."""
        self.part = None if part == self.part else part
        self.changed(focus)

    def tell(self, words: str, *, trouble: bool = False) -> None:
        """Show a message in the status line."""
        self.news, self.trouble = words, trouble

    async def diagnose(self) -> None:
        """Diagnose the current robot."""
        at = self.session.now
        found = await self._done(Diagnose(at.look.robot), "diagnosis")
        if found is not None and at is self.session.now:
            self.session = self.session.diagnosed(found)
            self.why = found.diagnosis.effect
            self.tell("Diagnosis done.")
            self.go("diagnose")

    async def add(self, *effects: str) -> None:
        """Fit effects together; add them if there is no objection."""
        at = self.session.now
        self.view = "add"
        effect = listed(effects)
        step = await self._done(Add(effects, at.look.robot), f"fit of {effect}")
        if step is None or at is not self.session.now:
            return
        self.session = self.session.fitted(step)
        if self.session.proposed is not None:
            self.tell(f"{effect}: fitted, but something speaks against it.", trouble=True)
        else:
            self.tell(f"{effect} added: {self.error_told()}")
        self.go("add")

    async def _done(self, task: Task, name: str) -> Any:
        """Result of a task, or None if it failed or was cancelled, with a message on the page."""
        if self.job is not None:
            return None
        job = self.job = Job(task)
        self.shared.jobs.add(job)
        self.tell("")
        try:
            self.changed("cancel")
            opened = self.shared.opened
            return await job.result(opened.given, known_to_both(opened))
        except CancelledError:
            self.tell(f"The {name} was cancelled; nothing has changed.")
        except InputError as error:
            self.tell(str(error), trouble=True)
        finally:
            self.job = None
            self.shared.jobs.discard(job)
        self.view = "diagnose" if self.view == "add" and not self.session.can_undo else self.view
        self.changed(f"title-{self.view}")
        return None

    def cancel(self) -> None:
        """Cancel the running work."""
        if self.job is not None:
            self.job.cancel()

    def insist(self) -> None:
        """Add the proposed effect despite the objection."""
        if self.job is not None or self.session.proposed is None:
            return
        self.session = self.session.insisted()
        self.tell(f"{self.session.now.name} added, against the objection: {self.error_told()}")
        self.go("add")

    def decline(self) -> None:
        """Discard the proposed effect."""
        self.session = self.session.declined()
        self.tell("Left out; nothing has changed.")
        self.go("diagnose" if self.session.diagnosis else "add")

    def undo(self) -> None:
        """Go one step back."""
        if self.job is not None or not self.session.can_undo:
            return
        name = self.session.now.name
        self.session = self.session.undone()
        self.tell(f"{name} taken out again: {self.error_told()}")
        self.changed("undo" if self.session.can_undo else "redo")

    def redo(self) -> None:
        """Go one step forward."""
        if self.job is not None or not self.session.can_redo:
            return
        self.session = self.session.redone()
        self.tell(f"{self.session.now.name} put in again: {self.error_told()}")
        self.changed("redo" if self.session.can_redo else "undo")

    def save(self) -> None:
        """Write the robot file."""
        shared = self.shared
        taken = shared.taken - set(self.session.saved)
        try:
            self.session = saved(shared.source, self.session, shared.target, taken)
        except InputError as error:
            self.tell(str(error), trouble=True)
        else:
            path = tuple(self.session.saved)[-1]
            shared.taken.add(path)
            self.tell(f"Written: {path}")
        self.changed("title-save")

    def error_told(self) -> str:
        """The held-out error in words."""
        look = self.session.now.look
        return f"held-out error {size_told(look.holdout_error, look.unit)}"


def size_told(error: float, unit: str) -> str:
    """A leg error as text, of positions [m] or of headings [rad]; "not measured" for NaN."""
    if math.isnan(error):
        return "not measured"
    if unit == "rad":
        return error_words(error, unit)
    if error >= 1.0:
        return f"{error:.2f} m"
    value = 1e3 * error
    return f"{value:.2f} mm" if value < 10.0 else f"{value:.1f} mm"


def change_told(before: float, after: float) -> str:
    """A relative change, with a minus sign instead of a hyphen; "" if it is not known."""
    if not (before > 0.0 and math.isfinite(after)):
        return ""
    return f"{100.0 * (after / before - 1.0):+.0f} %".replace("-", "−")


class Opening:
    """The opening of the drives, which all tabs wait for.

    `job` is a started process for an `Open`, which gets its task at once. `trouble` is the error,
    if it failed.
    """

    def __init__(self, job: Job, given: Recordings, target: Target) -> None:
        self.job, self.given = job, given
        self.trouble: BaseException | None = None
        self._target = target
        self._task: asyncio.Task[Shared] | None = None
        job.ask(given)

    @property
    def shared(self) -> Shared | None:
        """The result, if it is ready."""
        if self._task is None or not self._task.done() or self.trouble is not None:
            return None
        return self._task.result()

    async def result(self) -> Shared:
        """The result, when ready; cancelling one wait does not affect the others.

        InputError if the drives cannot be used.
        """
        if self._task is None:
            self._task = asyncio.create_task(self._finished())
        return await asyncio.shield(self._task)

    async def _finished(self) -> Shared:
        try:
            known = {**known_before(self.given), **NOT_SENT}
            made: Any = await self.job.result(self.given, known)
        except BaseException as error:
            self.trouble = error
            raise
        opened, look = made
        return Shared(opened, look, self.given.source, self.given.collection, self._target)
