# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain HTML elements: real buttons, headings and tables, with names for screen readers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from nicegui import ui
from nicegui.elements.mixins.text_element import TextElement


def text(tag: str, words: str = "", classes: str = "", **attributes: object) -> Any:
    """An element with text; an attribute `aria_label` becomes aria-label."""
    element = TextElement(tag=tag, text=words)
    return _dressed(element, classes, attributes)


def box(tag: str = "div", classes: str = "", **attributes: object) -> Any:
    """An element for others to go in."""
    return _dressed(ui.element(tag), classes, attributes)


def button(
    words: str,
    pressed: Callable[[], Any],
    *,
    key: str,
    classes: str = "",
    disabled: bool = False,
    **attributes: object,
) -> Any:
    """A real button; `key` is how the page finds it again, for the focus."""
    element = text("button", words, classes, type="button", data_key=key, **attributes)
    if disabled:
        element.props["disabled"] = True
    return element.on("click", lambda: pressed(), [])


def _dressed(element: Any, classes: str, attributes: dict[str, object]) -> Any:
    if classes:
        element.classes(classes)
    for name, value in attributes.items():
        element.props[name.rstrip("_").replace("_", "-")] = value
    return element


def paragraphs(words: str, classes: str = "") -> None:
    """Lines of text as paragraphs; those that begin with "- " as a list, indented ones as code."""
    points: list[str] = []

    def flush() -> None:
        if points:
            with box("ul"):
                for point in points:
                    text("li", point)
            points.clear()

    for line in words.splitlines():
        if line.startswith("- "):
            points.append(line[2:])
            continue
        flush()
        if line.startswith("    "):
            text("pre", line.strip())
        elif line.strip():
            text("p", line.strip(), classes)
    flush()


def rows(heads: list[str], lines: list[list[str]], caption: str) -> None:
    """A table of texts; the first column names its row."""
    with box("div", "wide"), box("table"):
        text("caption", caption)
        with box("thead"), box("tr"):
            for head in heads:
                text("th", head, scope="col")
        with box("tbody"):
            for line in lines:
                with box("tr"):
                    text("th", line[0], scope="row")
                    for cell in line[1:]:
                        text("td", cell)
