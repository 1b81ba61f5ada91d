# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Step 1: where the model fails, in words, by parts, and on the floor."""

from __future__ import annotations

from functools import partial

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.consistency import consistency
from werrimbi_odom.inference.comparison.leg_errors import LegStatistics
from werrimbi_odom.report.comparison.document import tables_of
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.number_format import counted
from werrimbi_odom.workbench.html import box, button, prose, text
from werrimbi_odom.workbench.leg_selection import Part, PlacePart, bin_parts, motion_parts
from werrimbi_odom.workbench.loaded_input import error_of
from werrimbi_odom.workbench.tab import Tab, size_told
from werrimbi_odom.workbench.views.side_panels import floor


def compare_view(tab: Tab) -> None:
    """Words and parts on the left, the floor on the right."""
    comparison = tab.comparison
    with box("div", "columns"):
        with box("div", "left"):
            text("h2", "Where does the model fail?", tabindex="-1", data_key="title-compare")
            _words(tab)
            _next(tab)
            text("h3", "Press a part to see its legs on the floor")
            _motions(tab, comparison)
            _variables(tab, comparison)
            _places(tab, comparison)
        with box("div", "right"):
            floor(tab)
    with box("details"):
        text("summary", "All figures as tables")
        prose(tables_of(comparison, tab.verdict))


def _words(tab: Tab) -> None:
    first, *others = words_of(tab.comparison, next_step="", verdict=tab.verdict)
    with box("div", "verdict"):
        text("p", first.text, "headline")
        prose(others)


def _next(tab: Tab) -> None:
    good = tab.session.now.look.verdict.good
    with box("p"):
        button(
            tab,
            "Next: find out which effect is missing →",
            lambda: tab.go("diagnose"),
            key="to-diagnose",
            classes="quiet" if good else "primary",
        )


def _chip(tab: Tab, part: Part, words: str, figures: LegStatistics, key: str) -> None:
    """A button for a part: its error, and a mark if its covariance is too small."""
    times = np.sqrt(figures.nees)
    fails = consistency(figures.nees, figures.freedom) == "too small"
    promised = f"{times:.2g} × promised" if np.isfinite(times) else "not measured"
    pressed = button(
        tab,
        "",
        lambda: tab.point(part, key),
        key=key,
        classes="chip fails" if fails else "chip",
        aria_pressed="true" if tab.part == part else "false",
    )
    with pressed:
        text("span", words, "what")
        text(
            "span",
            f"{size_told(*error_of(figures))}, {counted(figures.count, 'leg')}",
            "size",
        )
        text("span", f"✗ {promised}" if fails else f"✓ {promised}", "mark")


def _motions(tab: Tab, comparison: Comparison) -> None:
    with box("div", "chips", role="group", aria_label="By type of motion"):
        for part in motion_parts(comparison):
            figures = comparison.main.by_motion[part.kind].figures
            _chip(tab, part, part.words, figures, f"motion-{part.kind}")


def _variables(tab: Tab, comparison: Comparison) -> None:
    """Bins of one variable, with a selection of the variable above them."""
    every = bin_parts(comparison)
    if not every:
        return
    names = list(every)
    tab.variable = min(tab.variable, len(names) - 1)

    def choose(index: int) -> None:
        tab.variable = index
        tab.changed(f"variable-{index}")

    with box("div", "tabs", role="group", aria_label="By which variable"):
        text("span", "by")
        for index, name in enumerate(names):
            button(
                tab,
                name.split(" [")[0],
                partial(choose, index),
                key=f"variable-{index}",
                aria_pressed="true" if index == tab.variable else "false",
            )
    chosen = names[tab.variable]
    with box("div", "chips", role="group", aria_label=f"By {chosen}"):
        for index, (part, figures) in enumerate(every[chosen]):
            _chip(tab, part, part.range, figures, f"bin-{tab.variable}-{index}")


def _places(tab: Tab, comparison: Comparison) -> None:
    places = [cell for cell in comparison.cells if cell.stands_out]
    if not places:
        return
    with box("div", "chips", role="group", aria_label="By place on the floor"):
        for index, cell in enumerate(places[:4]):
            part = PlacePart(cell.x, cell.y, cell.side)
            _chip(tab, part, part.words, cell.figures, f"place-{index}")
