# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The bar that is always visible: the four steps, the held-out error, undo and redo."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.workbench.html import box, button, text
from werrimbi_odom.workbench.saving import file_of
from werrimbi_odom.workbench.tab import VIEWS, Tab, change_told, size_told

TITLES = {"compare": "Compare", "diagnose": "Diagnose", "add": "Add", "save": "Save"}


def steps_bar(tab: Tab) -> None:
    """The whole bar."""
    with box("div", "steps-bar"):
        with box("nav", "steps", aria_label="The four steps"):
            for number, view in enumerate(VIEWS, start=1):
                _step(tab, number, view)
        _meter(tab)
        busy = tab.job is not None
        with box("div", "history", role="group", aria_label="History"):
            off, title = busy or not tab.session.can_undo, "take the last effect out again"
            button(tab, "↶ Undo", tab.undo, key="undo", disabled=off, title=title)
            off, title = busy or not tab.session.can_redo, "put it in again"
            button(tab, "↷ Redo", tab.redo, key="redo", disabled=off, title=title)


def _step(tab: Tab, number: int, view: str) -> None:
    current = view == tab.view
    classes = "step current" if current else "step"
    pressed = button(tab, "", lambda: tab.go(view), key=f"go-{view}", classes=classes)
    if current:
        pressed.props["aria-current"] = "step"
    with pressed:
        text("span", str(number), "number", aria_hidden="true")
        with box("span", "of"):
            text("strong", TITLES[view])
            text("span", _state(tab, view), "state")


def _state(tab: Tab, view: str) -> str:
    """State of a step in a few words."""
    session = tab.session
    if view == "compare":
        good = session.now.look.verdict.good
        return "the model is good" if good else "the model fails"
    if view == "diagnose":
        if session.diagnosis is None:
            return "not asked yet" if not session.can_undo else "ask again"
        found = session.diagnosis.diagnosis
        if found.verdict == "named" and found.effect is not None:
            return found.effect
        return {"none": "nothing is missing", "ambiguous": "cannot tell yet"}.get(
            found.verdict, "unknown"
        )
    if view == "add":
        count = sum(len(step.added.effects) for step in session.past if step.added is not None)
        return "nothing yet" if not count else "1 effect" if count == 1 else f"{count} effects"
    if file_of(session) is not None:
        return "saved"
    return "not saved" if session.can_undo else "nothing to save"


def _meter(tab: Tab) -> None:
    """The held-out error, and a bar for each step."""
    session = tab.session
    errors = [step.look.holdout_error for step in session.past]
    now, first, unit = errors[-1], errors[0], session.now.look.unit
    with box("div", "meter", role="group", aria_label="Held-out error"):
        with box("div"):
            text("div", "Held-out error", "label", title="rms error of the legs of drives "
                 "that took no part in any fit")  # fmt: skip
            text("strong", size_told(now, unit), "value", data_key="error")
            if session.can_undo and (change := change_told(first, now)):
                text("span", f" {change} (was {size_told(first, unit)})", "fall")
        _bars(tab, errors)


def _bars(tab: Tab, errors: list[float]) -> None:
    later = [step.look.holdout_error for step in tab.session.steps[tab.session.at + 1 :]]
    every = [*errors, *later]
    top = max((error for error in every if np.isfinite(error)), default=0.0)
    if len(every) < 2 or not top > 0.0:
        return
    pairs = list(zip([step.name for step in tab.session.steps], every, strict=True))
    unit = tab.session.now.look.unit
    told = ", ".join(f"{name} {size_told(error, unit)}" for name, error in pairs)
    with box("div", "bars", role="img", aria_label=f"Bar by bar: {told}"):
        for index, (name, error) in enumerate(pairs):
            kind = "bar" if index < len(errors) else "bar undone"
            height = 100.0 * error / top if np.isfinite(error) else 0.0
            bar = box("div", kind, title=f"{name}: {size_told(error, unit)}")
            bar.style(f"height: {height:.0f}%")
