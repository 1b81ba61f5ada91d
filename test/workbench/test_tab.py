# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A tab while something is under way: what is pressed meanwhile does not cost the result."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from test.loops import awaited
from test.workbench.test_tab_session import look, step
from werrimbi_odom.workbench import tab as tabs
from werrimbi_odom.workbench.session import ModelVersion, begun
from werrimbi_odom.workbench.tab import Shared, Tab


@pytest.mark.parametrize("pressed", ["insist", "decline"])
def test_an_objection_waits_while_another_effect_is_fitted(
    monkeypatch: pytest.MonkeyPatch, pressed: str
) -> None:
    fitted = step("second", 1.0)

    class Fitting:
        def __init__(self, task: object) -> None:
            self.task = task

        async def result(self, given: object, known: object) -> ModelVersion:
            getattr(tab, pressed)()
            return fitted

    monkeypatch.setattr(tabs, "Job", Fitting)
    monkeypatch.setattr(tabs, "known_to_both", lambda opened: {})
    opened = SimpleNamespace(given=None)
    shared = cast(Shared, SimpleNamespace(opened=opened, jobs=set()))
    given = cast(Any, look(3.0))
    given.robot = None
    start = begun(given).fitted(step("doubtful", 3.1, objection="it does not help"))
    tab = Tab(shared, start, lambda focus: None)
    awaited(tab.add("second"))
    assert [each.name for each in tab.session.past] == ["as given", "second"]
    assert "second added" in tab.news
