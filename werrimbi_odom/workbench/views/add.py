# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Step 3: effect of an addition on the error, objections, and fitted values."""

from __future__ import annotations

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.report.adding.words import remark_told, value_told, words_of
from werrimbi_odom.report.document import Table
from werrimbi_odom.report.number_format import listed
from werrimbi_odom.workbench.drawings import gain_figure
from werrimbi_odom.workbench.html import box, button, figure, prose, text
from werrimbi_odom.workbench.session import ModelVersion
from werrimbi_odom.workbench.tab import Tab, change_told, size_told

NOTHING = (
    "Nothing is added yet. Diagnose, and press Add beside an effect: it is fitted together with "
    "all calibration, and judged on drives that took no part."
)


def add_view(tab: Tab) -> None:
    """The proposed step if there is one, and what was added so far."""
    text("h2", "Does it help?", tabindex="-1", data_key="title-add")
    session = tab.session
    if session.proposed is not None:
        _proposed(tab, session.proposed)
    if not session.can_undo:
        if tab.job is not None:
            text("p", "It is fitted together with all calibration, then judged on held-out drives.")
        elif session.proposed is None:
            text("p", NOTHING)
            button(
                tab, "← Diagnose", lambda: tab.go("diagnose"), key="to-diagnose", classes="primary"
            )
        return
    with box("div", "columns"):
        with box("div", "left"):
            _gain(tab)
        with box("div", "right"):
            for number, step in enumerate(session.past[1:], start=1):
                if step.added is not None:
                    _values(number, step.added)
    _following(tab)


def _gain(tab: Tab) -> None:
    past = tab.session.past
    errors = [step.look.holdout_error for step in past]
    sizes = [size_told(error, past[-1].look.unit) for error in errors]
    told = ", then ".join(f"{step.name} {size}" for step, size in zip(past, sizes, strict=True))
    before, after = errors[-2], errors[-1]
    word = "fell" if after < before else "did not fall"
    change = change_told(before, after)
    beside = f" ({change})" if change else ""
    with box("p", "verdict headline"):
        text(
            "span",
            f"With {past[-1].name} the held-out error {word}: {sizes[-2]} → {sizes[-1]}{beside}.",
        )
    figure(gain_figure(past), tab.dark, f"Held-out error, bar by bar: {told}", "plot low")


def _values(number: int, added: Added) -> None:
    with box("section", "values"):
        text("h3", f"{number}. {listed([effect.name for effect in added.effects])}")
        if added.parameters:
            heads = ("parameter", "value ± 1 σ", "what it is")
            rows = [
                (name, value_told(item), item.declared.says + remark_told(item))
                for name, item in added.parameters.items()
            ]
            prose([Table("Fitted with all calibration", heads, rows, words=(1, 2))])
        with box("details"):
            text("summary", "All words and figures of this step")
            prose(words_of(added))


def _proposed(tab: Tab, step: ModelVersion) -> None:
    assert step.added is not None
    with box("section", "proposed", aria_label="An objection"):
        text("p", f"{step.name}: not added, something speaks against it.", "headline")
        text("p", f"{step.added.objection}.")
        button(tab, "Leave it out", tab.decline, key="decline", classes="primary")
        busy = tab.job is not None
        button(tab, "Add it all the same", tab.insist, key="insist", disabled=busy)


def _following(tab: Tab) -> None:
    with box("p", "following"):
        button(tab, "Is more missing? Diagnose again", lambda: tab.go("diagnose"), key="again")
        button(tab, "Where does it still fail?", lambda: tab.go("compare"), key="to-compare")
        button(
            tab, "Save the robot file →", lambda: tab.go("save"), key="to-save", classes="primary"
        )
