# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Side panels: the floor with the legs of the selected part, or the page of an effect."""

from __future__ import annotations

from functools import partial

import numpy as np
from nicegui import ui

from werrimbi_odom.effects.effect_docstring import MEANING, numbers, page_of
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.comparison.dead_reckoning import headings_alone
from werrimbi_odom.report.comparison.phrases import leg_when
from werrimbi_odom.report.document import Table
from werrimbi_odom.report.number_format import capital, counted
from werrimbi_odom.report.sketches import effect_sketch
from werrimbi_odom.workbench.drawings import errors_told, floor_figure
from werrimbi_odom.workbench.html import box, button, figure, prose, text
from werrimbi_odom.workbench.leg_selection import figures_of, worst
from werrimbi_odom.workbench.loaded_input import error_of
from werrimbi_odom.workbench.tab import Tab, size_told


def floor(tab: Tab) -> None:
    """The figure, its description, and the worst legs."""
    comparison, part = tab.comparison, tab.part
    which = None if part is None else part.legs(comparison)
    chosen = np.ones(comparison.legs.run.size, dtype=np.bool_) if which is None else which
    figures = figures_of(comparison, chosen)
    error = size_told(*error_of(figures))
    if part is None:
        told = f"All {counted(figures.count, 'leg')}: {error} rms."
    else:
        rest = figures_of(comparison, ~chosen)
        told = (
            f"{capital(part.words)}: {counted(figures.count, 'leg')}, {error} rms; "
            f"the other {rest.count}: {size_told(*error_of(rest))}."
        )
    with box("section", "floor", aria_label="The floor"):
        with box("div", "floorhead"):
            text("p", told, "told", role="status", data_key="told")
            if part is not None:
                button(tab, "Show all legs", lambda: tab.point(None, "told"), key="all-legs")
            _which_drives(tab)
        figure(floor_figure(comparison, which), tab.dark, f"The floor from above. {told}")
        if headings_alone(comparison):
            text("p", "Where no positions are measured, legs lie where the wheels say.")
        legs = comparison.legs
        lines = [
            {
                "run": comparison.runs[legs.run[index]].run.name,
                "when": leg_when(comparison, index),
                "motion": str(legs.errors.kind[index]),
                **errors_told(comparison, index),
            }
            for index in worst(comparison, chosen, 5)
        ]
        heads = list(dict.fromkeys(name for line in lines for name in line))
        rows = [list(line.values()) for line in lines]
        prose([Table("The worst of these legs, measured minus predicted", heads, rows, (1, 2))])


def _which_drives(tab: Tab) -> None:
    def choose(held_out: bool) -> None:
        tab.held_out = held_out
        tab.changed("drives-held" if held_out else "drives-fitted")

    with box("div", "tabs", role="group", aria_label="Which drives"):
        for held_out, words, key in (
            (False, "fitted drives", "drives-fitted"),
            (True, "held-out drives", "drives-held"),
        ):
            pressed = str(tab.held_out == held_out).lower()
            button(tab, words, partial(choose, held_out), key=key, aria_pressed=pressed)


def why(tab: Tab, name: str) -> None:
    """The page of one effect."""
    try:
        effect = tab.shared.collection.find(name)
    except InputError:  # a finding of the set-up that is no effect, such as degrees for radians
        return
    page = page_of(effect)
    with box("section", "why", aria_label=f"About {name}", tabindex="0"):
        text("h3", f"What is {name}?", tabindex="-1", data_key=f"page-{name}")
        drawn = effect_sketch(effect)  # trusted: it holds no text of a record
        if drawn is not None:
            ui.html(drawn, sanitize=False)
        for paragraph in page.physics:
            text("p", paragraph)
        with box("dl"):
            for section, words in page.sections.items():
                text("dt", f"{section}: {MEANING[section]}")
                with box("dd"):
                    if section == "Formula":
                        text("pre", words)
                    else:
                        text("p", " ".join(words.split()))
            for parameter, item in effect.parameters.items():
                unit = f" [{item.unit}]" if item.unit else ""
                text("dt", f"{parameter}{unit}")
                text("dd", f"{item.says}; {numbers(effect, parameter)}")
