# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Work under way, with its progress; and the page while the drives are opened."""

from __future__ import annotations

import time
from typing import Any

from nicegui import ui

from werrimbi_odom.report.number_format import counted
from werrimbi_odom.workbench.drawings import measured_drawing
from werrimbi_odom.workbench.html import box, button, text
from werrimbi_odom.workbench.job import Job
from werrimbi_odom.workbench.tab import Opening, Tab


def under_way(tab: Tab) -> None:
    """Running work: its progress, and a button to cancel it."""
    job = tab.job
    if job is None:
        return
    name = "Diagnosing" if type(job.task).__name__ == "Diagnose" else "Fitting"
    with _progress(job, name, timed=True):
        button(tab, "Cancel", tab.cancel, key="cancel")


def opening_view(opening: Opening) -> None:
    """The page before the comparison is done: the measured paths."""
    with box("header"), box("div", "title"):
        text("h1", "werrimbi workbench")
        runs = (*opening.given.runs, *opening.given.holdout)
        text("p", f"{opening.given.source.path.name}: {counted(len(runs), 'drive')}.")
    _progress(opening.job, "Comparing")
    drawn = measured_drawing(runs)
    if drawn is not None:
        text("h2", "Measured paths; where the model fails on them is being worked out")
        ui.html(drawn, sanitize=False)


def failed_view(reason: str) -> None:
    """The error on opening; the command prints the same and ends."""
    text("h1", "werrimbi workbench")
    text("p", f"These drives cannot be opened: {reason}", "verdict", role="alert")


def _progress(job: Job, name: str, *, timed: bool = False) -> Any:
    """The section with a job's progress; on request with its time."""
    section = box("section", "work", aria_label="Work under way")
    with section:
        words = text("p", f"{name} …")
        bar: Any = box("progress", max="1", value="0", aria_label=f"{name}, share done")

    def look() -> None:
        took = f", {time.monotonic() - job.begun:.0f} s" if timed else ""
        words.set_text(f"{name}: {job.words} ({100.0 * job.share:.0f} %{took})")
        bar.props["value"] = f"{job.share:.3f}"

    ui.timer(0.2, look)
    return section
