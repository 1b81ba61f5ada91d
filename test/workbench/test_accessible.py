# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The workbench by axe-core's rules, in each of its states, in light and dark."""

from __future__ import annotations

import pytest

from test.axe import COUNT, RUN, axe_script
from test.workbench.conftest import PATIENCE, Looked
from test.workbench.session import HIDDEN


def assert_accessible(looked: Looked, state: str, width: int = 1440) -> None:
    looked.page.set_viewport_size({"width": width, "height": 900})
    looked.page.wait_for_timeout(300)  # colours fade from one theme to the other
    assert looked.page.evaluate(RUN) == [], state
    assert looked.page.evaluate(COUNT) > 10
    assert looked.page.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), (
        f"{state}: wider than {width} pixels"
    )


def assert_in_light_and_dark(looked: Looked, state: str) -> None:
    assert_accessible(looked, f"{state}, light")
    assert_accessible(looked, f"{state}, light, on a telephone", 390)
    looked.page.set_viewport_size({"width": 1440, "height": 900})
    looked.at("theme").click()
    looked.page.locator("body.body--dark").wait_for()
    assert_accessible(looked, f"{state}, dark")
    looked.at("theme").click()
    looked.page.locator("body:not(.body--dark)").wait_for()


@pytest.mark.evidence
def test_no_rule_is_broken_in_any_state(looked: Looked) -> None:
    script, page = axe_script(), looked.page
    page.evaluate(script)
    assert_in_light_and_dark(looked, "compare")
    looked.at("motion-line").click()
    page.locator('[data-key="motion-line"][aria-pressed="true"]').wait_for()
    page.locator("summary", has_text="All figures as tables").click()
    assert_accessible(looked, "a part pressed")
    looked.at("go-add").click()
    looked.at("title-add").wait_for()
    assert_accessible(looked, "nothing added yet")
    looked.at("go-diagnose").click()
    looked.at("title-diagnose").wait_for()
    looked.at(f"why-{HIDDEN}").click()
    looked.at(f"page-{HIDDEN}").wait_for()
    assert_in_light_and_dark(looked, "not diagnosed yet")
    looked.at("diagnose").click()
    page.get_by_role("progressbar").wait_for()
    assert_accessible(looked, "under way")
    looked.at("verdict").wait_for(timeout=PATIENCE)
    for summary in page.locator("summary").all():
        summary.click()
    assert_in_light_and_dark(looked, "diagnosed")
    looked.at(f"add-{HIDDEN}").click()
    looked.at("undo").and_(page.locator(":enabled")).wait_for(timeout=PATIENCE)
    assert_in_light_and_dark(looked, "added")
    looked.at("go-save").click()
    looked.at("title-save").wait_for()
    assert_in_light_and_dark(looked, "save")
    assert looked.complaints == []
