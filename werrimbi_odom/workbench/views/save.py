# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Step 4: the new robot file, with a preview."""

from __future__ import annotations

from werrimbi_odom.errors import InputError
from werrimbi_odom.workbench.html import box, button, text
from werrimbi_odom.workbench.saving import changed_lines, file_of, text_of
from werrimbi_odom.workbench.tab import Tab

NEAR = 2
"""Unchanged lines shown around a change."""


def save_view(tab: Tab) -> None:
    """The path, the changes, and the button."""
    text("h2", "The new robot file", tabindex="-1", data_key="title-save")
    shared, session = tab.shared, tab.session
    if not session.can_undo:
        text("p", "Nothing was added, so there is nothing to save.")
        return
    written = file_of(session)
    path = written or shared.target.of(session, shared.taken - set(session.saved))
    with box("p"):
        text("span", "It will be written to " if written is None else "It was written to ")
        text("code", str(path), data_key="path")
        text("span", f". {shared.source.path} stays as it is.")
    if written is not None:
        text("p", "✓ Saved. Give this file to the node, and to the other commands with --robot.",
             "saved")  # fmt: skip
    else:
        button(tab, "Save", tab.save, key="save", classes="primary", disabled=tab.job is not None)
    text("h3", "What changes in it")
    try:
        _changes(shared.source.text, text_of(shared.source, session.now.look.robot))
    except InputError as error:
        text("p", str(error))


def _changes(before: str, after: str) -> None:
    lines = changed_lines(before, after)
    near = {
        place
        for index, (mark, _) in enumerate(lines)
        if mark != " "
        for place in range(index - NEAR, index + NEAR + 1)
    }
    with box("div", "diff", role="region", aria_label="Changes", tabindex="0"):
        gap = False
        for index, (mark, words) in enumerate(lines):
            if index not in near:
                if not gap:
                    text("div", "…")
                gap = True
                continue
            gap = False
            kind = {"+": "new", "-": "gone"}.get(mark, "")
            text("div", f"{mark} {words}", kind)
