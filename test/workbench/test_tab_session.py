# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A tab's session is a value: forward, back, and forward again are the same values."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from werrimbi_odom.workbench.saving import file_of
from werrimbi_odom.workbench.session import Diagnosed, ModelVersion, Session, begun


def look(error: float) -> Any:
    return SimpleNamespace(holdout_error=error, unit="m")


def step(name: str, error: float, objection: str | None = None) -> ModelVersion:
    added = SimpleNamespace(name=name, objection=objection)
    return ModelVersion(look(error), cast(Any, added))


def diagnosis() -> Diagnosed:
    return cast(Diagnosed, SimpleNamespace())


@pytest.fixture
def two() -> Session:
    return begun(look(3.0)).fitted(step("first", 2.0)).fitted(step("second", 1.0))


def test_what_was_added_is_the_current_step(two: Session) -> None:
    assert [item.name for item in two.past] == ["as given", "first", "second"]
    assert two.now.look.holdout_error == 1.0
    assert not two.can_redo


def test_undo_and_redo_give_back_the_very_same_steps(two: Session) -> None:
    back = two.undone()
    assert back.now is two.steps[1]
    assert back.redone().now is two.now
    assert back.undone().now is two.steps[0]
    assert not back.undone().can_undo


def test_beyond_the_ends_nothing_happens(two: Session) -> None:
    assert two.redone().at == two.at
    assert begun(look(1.0)).undone().at == 0


def test_something_else_after_an_undo_forgets_what_was_undone(two: Session) -> None:
    other = two.undone().fitted(step("other", 1.5))
    assert [item.name for item in other.past] == ["as given", "first", "other"]
    assert not other.can_redo
    assert len(two.steps) == 3, "the session before is a value of its own"


def test_a_step_with_an_objection_waits_for_the_user() -> None:
    start = begun(look(3.0))
    asked = start.fitted(step("doubtful", 3.1, objection="it does not help"))
    assert asked.at == 0
    assert asked.proposed is not None
    assert asked.declined().proposed is None
    assert asked.declined().at == 0
    assert asked.insisted().now.name == "doubtful"
    assert asked.insisted().proposed is None
    assert asked.undone().proposed is None, "going elsewhere leaves it"


def test_a_diagnosis_belongs_to_its_step(two: Session) -> None:
    first = diagnosis()
    asked = two.undone().diagnosed(first)
    assert asked.diagnosis is first
    assert asked.redone().diagnosis is None
    assert asked.redone().undone().diagnosis is first
    assert asked.fitted(step("other", 1.0)).diagnosis is None, "another robot, another question"
    assert two.undone().diagnosis is None


def test_saved_is_said_of_the_step_that_the_file_holds(two: Session, tmp_path: Path) -> None:
    file = tmp_path / "robot_new.yaml"
    file.write_text("its text")
    kept = two.written(file, "its text")
    assert file_of(kept) == file
    assert file_of(kept.undone()) is None
    assert file_of(kept.undone().redone()) == file
    other = kept.undone().fitted(step("other", 1.5))
    assert file_of(other) is None
    assert file in other.saved, "the file is still this tab's own"


def test_saved_is_said_as_long_as_the_file_is_as_it_was_written(
    two: Session, tmp_path: Path
) -> None:
    """Else the page named the file that is next as the one that was written."""
    file = tmp_path / "robot_new.yaml"
    file.write_text("its text")
    kept = two.written(file, "its text")
    file.write_text("its text, and a line by hand")
    assert file_of(kept) is None
    file.unlink()
    assert file_of(kept) is None
