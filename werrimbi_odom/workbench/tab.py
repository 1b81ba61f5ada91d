# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What all browser tabs share, and one of them: its session, its work, what it looks at.

The first comparison is made while the server and the page come up, in a process of its own, as all
long work: in a thread it would hold up the server, and NiceGUI, as it starts, looks at every object
there is (`gc.get_objects`), which CPython does not allow beside a thread that is making tuples.
"""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from werrimbi_odom.effects.collection import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.verdict import Verdict
from werrimbi_odom.report.numbers import listed
from werrimbi_odom.workbench.job import Add, CancelledError, Diagnose, Job, Task
from werrimbi_odom.workbench.opened import Look, Opened
from werrimbi_odom.workbench.parts import Part
from werrimbi_odom.workbench.saving import Target, saved
from werrimbi_odom.workbench.steps import Session, begun
from werrimbi_odom.workbench.work import NOT_SENT, known_before, known_to_both

VIEWS = ("compare", "diagnose", "add", "save")


@dataclass(frozen=True, eq=False)
class Shared:
    """What all tabs share; nobody changes it, but for files written and work under way."""

    opened: Opened
    look: Look
    """The robot as given."""
    source: RobotFile
    collection: Collection
    target: Target
    taken: set[Path] = field(default_factory=set)
    """Files that some tab wrote."""
    jobs: set[Job] = field(default_factory=set)
    """Work under way, to be stopped when the server ends."""


@dataclass(eq=False)
class Tab:
    """State of one tab; `changed` is called whenever the page must be drawn again."""

    shared: Shared
    session: Session
    changed: Callable[[str | None], None]
    """Told the key of what should have the focus afterwards, or None."""
    view: str = "compare"
    part: Part | None = None
    """Of the drives, whose legs are shown."""
    held_out: bool = False
    """Whether the floor shows the held-out drives."""
    variable: int = 0
    why: str | None = None
    """Effect whose page is open."""
    dark: bool = False
    actions: dict[str, Callable[[], Any]] = field(default_factory=dict)
    """What each button that is drawn does, by its key."""
    job: Job | None = None
    news: str = ""
    """What happened last, for the status line and for screen readers."""
    trouble: bool = False
    """Whether that is something that did not work."""

    @property
    def comparison(self) -> Comparison:
        """Of the current robot, over the drives that are looked at."""
        look = self.session.now.look
        return look.holdout if self.held_out else look.train

    @property
    def verdict(self) -> Verdict:
        """Of `comparison`."""
        look = self.session.now.look
        return look.holdout_verdict if self.held_out else look.verdict

    def go(self, view: str) -> None:
        """Look at another step of the four, from its top."""
        self.view = view
        self.changed(f"title-{view}")

    def point(self, part: Part | None, focus: str) -> None:
        """Show the legs of a part; pressed again, all legs."""
        self.part = None if part == self.part else part
        self.changed(focus)

    def tell(self, words: str, *, trouble: bool = False) -> None:
        """Say something in the status line."""
        self.news, self.trouble = words, trouble

    async def diagnose(self) -> None:
        """Find out what is missing."""
        at = self.session.now
        found = await self._done(Diagnose(at.look.robot), "diagnosis")
        if found is not None and at is self.session.now:
            self.session = self.session.diagnosed(found)
            self.why = found.diagnosis.effect
            self.tell("Diagnosis done.")
            self.go("diagnose")

    async def add(self, *effects: str) -> None:
        """Fit effects together; taken where nothing speaks against any."""
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
        """The result of a task, or None where it failed or was cancelled; the page says which."""
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
        """Stop the work under way."""
        if self.job is not None:
            self.job.cancel()

    def insist(self) -> None:
        """Take the proposed effect all the same."""
        if self.session.proposed is None:
            return
        self.session = self.session.insisted()
        self.tell(f"{self.session.now.name} added, against the objection: {self.error_told()}")
        self.go("add")

    def decline(self) -> None:
        """Leave the proposed effect."""
        self.session = self.session.declined()
        self.tell("Left out; nothing has changed.")
        self.go("diagnose" if self.session.diagnosis else "add")

    def undo(self) -> None:
        """A step back."""
        if self.job is not None or not self.session.can_undo:
            return
        name = self.session.now.name
        self.session = self.session.undone()
        self.tell(f"{name} taken out again: {self.error_told()}")
        self.changed("undo" if self.session.can_undo else "redo")

    def redo(self) -> None:
        """A step forward again."""
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
        return f"held-out error {millimetres(self.session.now.look.holdout_error)}"


def millimetres(metres: float) -> str:
    """As text; a dash where nothing was measured."""
    if math.isnan(metres):
        return "not measured"
    if metres >= 1.0:
        return f"{metres:.2f} m"
    value = 1e3 * metres
    return f"{value:.2f} mm" if value < 10.0 else f"{value:.1f} mm"


def percent(share: float) -> str:
    """A change, with a real minus sign."""
    return f"{share:+.0f} %".replace("-", "−")


def new_tab(shared: Shared, changed: Callable[[str | None], None]) -> Tab:
    """A tab that has done nothing yet."""
    return Tab(shared, begun(shared.look), changed)


class Opening:
    """What all tabs wait for.

    Parameters
    ----------
    job : Job
        A process that was started, for an `Open`; it is asked at once.
    given : Recordings
        What was read.
    target : Target
        Where files may be written.

    Attributes
    ----------
    trouble : BaseException or None
        Why it did not work.
    """

    def __init__(self, job: Job, given: Recordings, target: Target) -> None:
        self.job, self.given = job, given
        self.trouble: BaseException | None = None
        self._target = target
        self._task: asyncio.Task[Shared] | None = None
        job.ask(given)

    @property
    def shared(self) -> Shared | None:
        """What was opened, if that is done already."""
        if self._task is None or not self._task.done() or self.trouble is not None:
            return None
        return self._task.result()

    async def result(self) -> Shared:
        """What was opened, once it is there; who stops waiting does not stop the others.

        Raises
        ------
        InputError
            When the drives cannot be used.
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
