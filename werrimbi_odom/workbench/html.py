# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain HTML elements: real buttons, headings and tables, with names for screen readers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from inspect import isawaitable
from typing import Any, Protocol

from nicegui import ui
from nicegui.elements.mixins.text_element import TextElement
from nicegui.events import GenericEventArguments

from werrimbi_odom.report.document import Part
from werrimbi_odom.report.page import as_html


def text(tag: str, words: str = "", classes: str = "", **attributes: object) -> Any:
    """An element with text; an attribute `aria_label` becomes aria-label."""
    element = TextElement(tag=tag, text=words)
    return _dressed(element, classes, attributes)


def box(tag: str = "div", classes: str = "", **attributes: object) -> Any:
    """An element for others to go in."""
    return _dressed(ui.element(tag), classes, attributes)


class HasActions(Protocol):
    """What knows what each button does."""

    actions: dict[str, Callable[[], Any]]


def button(
    tab: HasActions,
    words: str,
    pressed: Callable[[], Any],
    *,
    key: str,
    classes: str = "",
    disabled: bool = False,
    **attributes: object,
) -> Any:
    """A real button; `key` is how the page finds it again, and what it does, after a redraw."""
    element = text("button", words, classes, type="button", data_key=key, **attributes)
    if disabled:
        element.props["disabled"] = True
    tab.actions[key] = pressed
    return element


def listen(place: Any, tab: HasActions) -> None:
    """Hear every button within, those drawn later too.

    A press names its button by key: one that was drawn anew while the finger came down still does
    what it says.
    """

    async def pressed(event: GenericEventArguments) -> None:
        action = tab.actions.get(str(event.args))
        result = action() if action is not None else None
        if isawaitable(result):
            await result

    place.on(
        "click",
        pressed,
        js_handler="""(event) => {
            const button = event.target.closest("button[data-key]");
            if (button && !button.disabled) emit(button.dataset.key);
        }""",
    )


def _dressed(element: Any, classes: str, attributes: dict[str, object]) -> Any:
    if classes:
        element.classes(classes)
    for name, value in attributes.items():
        element.props[name.rstrip("_").replace("_", "-")] = value
    return element


def prose(parts: Iterable[Part]) -> None:
    """Parts of a document, as its page has them."""
    ui.html(as_html(parts), sanitize=False)
