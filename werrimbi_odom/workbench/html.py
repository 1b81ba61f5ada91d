# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain HTML elements with labels for screen readers, and figures drawn by plotly.js.

plotly.js is requested before the first figure arrives, so that it is loaded by then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib.resources import as_file
from inspect import isawaitable
from typing import Any, Protocol

from nicegui import app, ui
from nicegui.element import Element
from nicegui.elements.mixins.text_element import TextElement
from nicegui.events import GenericEventArguments

from werrimbi_odom.report.document import Part
from werrimbi_odom.report.html_page import as_html, drawing_program
from werrimbi_odom.workbench.drawings import shown


def text(tag: str, words: str = "", classes: str = "", **attributes: object) -> Any:
    """An element with text; an attribute `aria_label` becomes aria-label."""
    element = TextElement(tag=tag, text=words)
    return _dressed(element, classes, attributes)


def box(tag: str = "div", classes: str = "", **attributes: object) -> Any:
    """A container element."""
    return _dressed(ui.element(tag), classes, attributes)


class HasActions(Protocol):
    """An object with the actions of buttons by their keys."""

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
    """A button element; `key` identifies it and its action after a redraw."""
    element = text("button", words, classes, type="button", data_key=key, **attributes)
    if disabled:
        element.props["disabled"] = True
    tab.actions[key] = pressed
    return element


def listen(place: Any, tab: HasActions) -> None:
    """Handle clicks on every button within, including those drawn later.

    A click is identified by the button's key, so it works even if the button was redrawn while it
    was pressed.
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
    """Parts of a document as HTML."""
    ui.html(as_html(parts), sanitize=False)


_DRAWING = "/plotly.min.js"


class _Figure(Element, component="figure.js"):
    """The Vue component of `figure.js`."""

    def __init__(self, drawn: dict[str, Any]) -> None:
        super().__init__()
        self._props["figure"] = drawn


def serve_drawing() -> None:
    """Serve plotly.js locally."""
    with as_file(drawing_program()) as file:
        app.add_static_file(local_file=file, url_path=_DRAWING)


def ask_for_drawing(at_once: bool) -> None:
    """Load plotly.js in the background.

    Loading blocks the page for a second, so it waits until the rest is shown, unless figures are
    shown at once.
    """
    begin = "ask()" if at_once else "addEventListener('load', () => setTimeout(ask, 50))"
    ui.add_head_html(
        f"""<script>{{
  const ask = () => {{
    const program = document.createElement("script");
    program.src = "{_DRAWING}";
    document.head.append(program);
  }};
  {begin};
}}</script>"""
    )


def figure(drawn: Any, dark: bool, label: str, classes: str = "plot") -> None:
    """A plotly figure, or its JSON, in the page's colours; `label` is for screen readers."""
    with box("div", "figure", role="figure", aria_label=label):
        _Figure(shown(drawn, dark)).classes(classes)
