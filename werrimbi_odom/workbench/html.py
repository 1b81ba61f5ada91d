# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain HTML elements, with names for screen readers, and figures, drawn by plotly.js itself.

The drawing program is asked for before the first figure comes, so that it is there by then.
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
from werrimbi_odom.report.page import as_html, drawing_program
from werrimbi_odom.workbench.drawings import shown


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


_DRAWING = "/plotly.min.js"


class _Figure(Element, component="figure.js"):
    """What `figure.js` draws."""

    def __init__(self, drawn: dict[str, Any]) -> None:
        super().__init__()
        self._props["figure"] = drawn


def serve_drawing() -> None:
    """Have the drawing program at an address of the server; it never leaves this machine."""
    with as_file(drawing_program()) as file:
        app.add_static_file(local_file=file, url_path=_DRAWING)


def ask_for_drawing(at_once: bool) -> None:
    """Have the page load the drawing program while other things go on.

    Parameters
    ----------
    at_once
        Whether figures will be there at once. It holds the page for a second as it begins: where
        they will not, what needs no figure is shown first.
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
    """A plotly figure, or its JSON, in the page's colours; `label` is for who does not see it."""
    with box("div", "figure", role="figure", aria_label=label):
        _Figure(shown(drawn, dark)).classes(classes)
