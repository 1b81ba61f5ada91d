# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What one browser tab has done so far: effects added one after the other, undone, done again.

Values only: a step back is the same value as before, and no page is needed to try it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.manoeuvres.advice import Told
from werrimbi_odom.workbench.opened import Look

GONE = -1
"""Index of a step that was saved, undone, and replaced by another one: its file is still ours."""


@dataclass(frozen=True, eq=False)
class Diagnosed:
    """What is missing, what to drive next, what these drives could have shown, and its figures."""

    told: Told
    figures: Mapping[str, str]
    """Plotly figures as JSON: response (before and after along the effect's variable), set_up,
    manoeuvre; only those that there are."""

    @property
    def diagnosis(self) -> Diagnosis:
        """What is missing."""
        return self.told.diagnosis


@dataclass(frozen=True, eq=False)
class ModelVersion:
    """A robot, how it does, and what was added to get there."""

    look: Look
    added: Added | None = None
    """None: the robot as given."""

    @property
    def name(self) -> str:
        """What was added."""
        return "as given" if self.added is None else self.added.name.replace(",", " + ")


@dataclass(frozen=True)
class Saved:
    """What was written to a file."""

    step: int
    """Index of the step that it holds, or `GONE`."""
    text: str = field(repr=False)


@dataclass(frozen=True, eq=False)
class Session:
    """The steps of one tab; those after `at` were undone and can be done again."""

    steps: tuple[ModelVersion, ...]
    at: int = 0
    proposed: ModelVersion | None = None
    """Fitted, but something speaks against it: the user has to say."""
    diagnoses: Mapping[int, Diagnosed] = field(default_factory=dict)
    """By the index of the step that was diagnosed."""
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
        """Of the current step, where it was diagnosed."""
        return self.diagnoses.get(self.at)

    @property
    def can_undo(self) -> bool:
        """Whether something was added."""
        return self.at > 0

    @property
    def can_redo(self) -> bool:
        """Whether something was undone."""
        return self.at + 1 < len(self.steps)

    @property
    def is_saved(self) -> bool:
        """Whether a file holds the current step."""
        return any(item.step == self.at for item in self.saved.values())

    def diagnosed(self, diagnosis: Diagnosed) -> Session:
        """With what is missing at the current step."""
        return replace(self, diagnoses={**self.diagnoses, self.at: diagnosis})

    def fitted(self, step: ModelVersion) -> Session:
        """An effect was fitted: taken if nothing speaks against it, else proposed."""
        if step.added is not None and step.added.objection is not None:
            return replace(self, proposed=step)
        return self.taken(step)

    def taken(self, step: ModelVersion) -> Session:
        """A step further; what was undone is gone."""
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
        """The user wants the proposed step, whatever speaks against it."""
        return self if self.proposed is None else self.taken(self.proposed)

    def declined(self) -> Session:
        """The user leaves the proposed step."""
        return replace(self, proposed=None)

    def undone(self) -> Session:
        """A step back; where there is none, the same."""
        return replace(self, at=max(self.at - 1, 0), proposed=None)

    def redone(self) -> Session:
        """A step forward again; where there is none, the same."""
        return replace(self, at=min(self.at + 1, len(self.steps) - 1), proposed=None)

    def written(self, path: Path, text: str) -> Session:
        """The current step is in a file."""
        others = {other: item for other, item in self.saved.items() if other != path}
        return replace(self, saved={**others, path: Saved(self.at, text)})


def begun(look: Look) -> Session:
    """A session that has done nothing yet."""
    return Session((ModelVersion(look),))
