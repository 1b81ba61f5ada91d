# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""While the drives are compared for the first time: how far it is, and where they went."""

from __future__ import annotations

from typing import Any

from nicegui import ui

from werrimbi_odom.workbench.drawings import measured_drawing
from werrimbi_odom.workbench.html import box, text
from werrimbi_odom.workbench.opening import Opening


def opening_view(opening: Opening) -> None:
    """What is known before anything is compared: the measured paths."""
    with box("header"), box("div", "title"):
        text("h1", "werrimbi workbench")
        runs = (*opening.given.runs, *opening.given.holdout)
        text("p", f"{opening.given.source.path.name}: {len(runs)} drives.")
    with box("section", "work", aria_label="Work under way"):
        words = text("p", "Comparing …")
        bar: Any = box("progress", max="1", value="0", aria_label="Comparing, share done")
    drawn = measured_drawing(runs)
    if drawn is not None:
        text("h2", "Measured paths; where the model fails on them is being worked out")
        ui.html(drawn, sanitize=False)

    def look() -> None:
        words.set_text(f"Comparing: {opening.job.words} ({100.0 * opening.job.share:.0f} %)")
        bar.props["value"] = f"{opening.job.share:.3f}"

    ui.timer(0.2, look)


def failed_view(reason: str) -> None:
    """Why nothing could be opened; the command says the same, and ends."""
    text("h1", "werrimbi workbench")
    text("p", f"These drives cannot be opened: {reason}", "verdict", role="alert")
