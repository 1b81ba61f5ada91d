# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A figure on the page, drawn by plotly.js itself.

It is asked for before the first figure comes, so that it is there by then.
"""

from __future__ import annotations

from importlib.resources import as_file
from typing import Any

from nicegui import app, ui
from nicegui.element import Element

from werrimbi_odom.report.page import drawing_program
from werrimbi_odom.workbench.drawings import shown
from werrimbi_odom.workbench.html import box

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
