# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""History of one browser tab: effects added one after the other, undo, redo.

All are immutable values: undo returns the same value as before, and tests need no page.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.workbench.loaded_input import Look

GONE = -1
"""Index of a saved step that was undone and replaced: the file still belongs to the tab."""


class Drawn(NamedTuple):
    """A plotly figure as JSON, with its title and what to see."""

    title: str
    see: str
    figure: str


@dataclass(frozen=True, eq=False)
class Diagnosed:
    """A diagnosis with the next manoeuvre and detection limits, and its figures."""

    advised: AdvisedDiagnosis
    before_after: Drawn | None
    """The set-up, or the error over the variable of what is missing."""
    manoeuvre: str | None
    """The path to drive, as JSON."""

    @property
    def diagnosis(self) -> Diagnosis:
        """The diagnosis."""
        return self.advised.diagnosis


@dataclass(frozen=True, eq=False)
class ModelVersion:
    """A robot, its errors, and the effects that were added in this step."""

    look: Look
    added: Added | None = None
    """None for the robot as given."""

    @property
    def name(self) -> str:
        """Names of the added effects."""
        return "as given" if self.added is None else self.added.name.replace(",", " + ")


@dataclass(frozen=True)
class Saved:
    """Content of a written file."""

    step: int
    """Index of the saved step, or `GONE`."""
    text: str = field(repr=False)


@dataclass(frozen=True, eq=False)
class Session:
    """The steps of one tab; those after `at` were undone and can be redone."""

    steps: tuple[ModelVersion, ...]
    at: int = 0
    proposed: ModelVersion | None = None
    """A fitted step with an objection, which awaits the user's decision."""
    diagnoses: Mapping[int, Diagnosed] = field(default_factory=dict)
    """By the index of the diagnosed step."""
    saved: Mapping[Path, Saved] = field(default_factory=dict)
    """Files that this tab wrote."""

    @property
    def now(self) -> ModelVersion:
        """The current step."""
        return self.steps[self.at]

    @property
    def past(self) -> tuple[ModelVersion, ...]:
        """Steps up to the current one."""
        return self.steps[: self.at + 1]

    @property
    def diagnosis(self) -> Diagnosed | None:
        """Diagnosis of the current step, if any."""
        return self.diagnoses.get(self.at)

    @property
    def can_undo(self) -> bool:
        """Whether something was added."""
        return self.at > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was undone."""
        return self.at + 1 < len(self.steps)

    def diagnosed(self, diagnosis: Diagnosed) -> Session:
        """Session with a diagnosis of the current step."""
        return replace(self, diagnoses={**self.diagnoses, self.at: diagnosis})

    def fitted(self, step: ModelVersion) -> Session:
        """Session after a fit: the step is added if there is no objection, otherwise proposed."""
        if step.added is not None and step.added.objection is not None:
            return replace(self, proposed=step)
        return self.taken(step)

    def taken(self, step: ModelVersion) -> Session:
        """Session with a further step; undone steps are discarded."""
        following = self.at + 1
        return replace(
            self,
            steps=(*self.past, step),
            at=following,
            proposed=None,
            diagnoses={at: item for at, item in self.diagnoses.items() if at < following},
            saved={
                path: item if item.step < following else replace(item, step=GONE)
                for path, item in self.saved.items()
            },
        )

    def insisted(self) -> Session:
        """Session with the proposed step added, despite the objection."""
        return self if self.proposed is None else self.taken(self.proposed)

    def declined(self) -> Session:
        """Session without the proposed step."""
        return replace(self, proposed=None)

    def undone(self) -> Session:
        """Session one step back, if possible."""
        return replace(self, at=max(self.at - 1, 0), proposed=None)

    def redone(self) -> Session:
        """Session one step forward, if possible."""
        return replace(self, at=min(self.at + 1, len(self.steps) - 1), proposed=None)

    def written(self, path: Path, text: str) -> Session:
        """Session with the current step in a file."""
        others = {other: item for other, item in self.saved.items() if other != path}
        return replace(self, saved={**others, path: Saved(self.at, text)})


def begun(look: Look) -> Session:
    """A new session."""
    return Session((ModelVersion(look),))
