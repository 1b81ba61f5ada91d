# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect's page: what it is, what it does to the data, how to check it with a ruler."""

from __future__ import annotations

from nicegui import ui

from werrimbi_odom.effects.page import MEANING, numbers, page_of
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.sketches import effect_sketch
from werrimbi_odom.workbench.html import box, text
from werrimbi_odom.workbench.tab import Tab


def why(tab: Tab, name: str) -> None:
    """The page of one effect."""
    try:
        effect = tab.shared.collection.find(name)
    except InputError:  # a finding of the set-up that is no effect: degrees for radians
        return
    page = page_of(effect)
    with box("section", "why", aria_label=f"About {name}", tabindex="0"):
        text("h3", f"What is {name}?", tabindex="-1", data_key=f"page-{name}")
        _sketch(effect)
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


def _sketch(effect: Effect) -> None:
    """Its sketch, where there is one: our own drawing, no text of a record in it."""
    drawn = effect_sketch(effect)
    if drawn is not None:
        ui.html(drawn, sanitize=False)
