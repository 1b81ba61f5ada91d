# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The page: built for each browser tab, redrawn on every change of its state."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from nicegui import Client, app, ui

from werrimbi_odom.errors import InputError
from werrimbi_odom.report.number_format import counted
from werrimbi_odom.workbench.drawings import empty_floor
from werrimbi_odom.workbench.html import ask_for_drawing, box, button, listen, text
from werrimbi_odom.workbench.session import begun
from werrimbi_odom.workbench.tab import Opening, Shared, Tab
from werrimbi_odom.workbench.views.add import add_view
from werrimbi_odom.workbench.views.compare import compare_view
from werrimbi_odom.workbench.views.diagnose import diagnose_view
from werrimbi_odom.workbench.views.save import save_view
from werrimbi_odom.workbench.views.steps_bar import steps_bar
from werrimbi_odom.workbench.views.under_way import failed_view, opening_view, under_way

STYLE = Path(__file__).with_name("page.css")
VIEW = {"compare": compare_view, "diagnose": diagnose_view, "add": add_view, "save": save_view}
FOCUS = """<script>
let werrimbiWanted;
function werrimbiFocus(key) {
  if (key.startsWith("title-")) window.scrollTo(0, 0);
  const wanted = werrimbiWanted = {until: performance.now() + 3000};
  const look = () => {
    if (wanted !== werrimbiWanted || performance.now() > wanted.until) return;
    const at = document.activeElement;
    const found = document.querySelector('[data-key="' + key + '"]');
    if (found && (!at || at === document.body)) found.focus({preventScroll: true});
    setTimeout(look, 40);
  };
  setTimeout(look, 40);
}
for (const event of ["keydown", "pointerdown"]) {
  addEventListener(event, () => { werrimbiWanted = null; }, true);  // the user goes his own way
}
</script>"""
"""The browser redraws at its own time; until then the old element may still be there."""

_SESSION, _DARK = "session", "dark"


async def page(opening: Opening) -> None:
    """The whole page of a tab; at first with what is known before the comparison."""
    ask_for_drawing(at_once=opening.shared is not None)
    ui.add_css(STYLE.read_text(encoding="utf-8"))
    ui.add_head_html(FOCUS)
    ui.page_title(f"{opening.given.source.path.name} · werrimbi workbench")
    client, theme = ui.context.client, ui.dark_mode(None)  # as in the system settings, until known
    first = box("div")
    with first:
        if opening.shared is None:
            opening_view(opening)
        else:
            text("p", "Opening …", "opening")
    await client.connected()
    if not client.has_socket_connection:
        return  # only fetched the page
    kept = app.storage.tab
    dark = kept.get(_DARK)
    if dark is None:
        dark = await ui.run_javascript(
            "matchMedia('(prefers-color-scheme: dark)').matches", timeout=30.0
        )
    theme.set_value(bool(dark))
    if opening.shared is None:
        empty_floor()  # initialise plotly, which takes time, while the other process works
    try:
        shared = await opening.result()
    except InputError as error:
        first.clear()
        with first:
            failed_view(str(error))
        return
    if client.id in Client.instances:  # the browser may have disconnected meanwhile
        first.delete()
        _work(shared, kept, bool(dark), theme)


def _work(shared: Shared, kept: Any, dark: bool, theme: Any) -> None:
    """The page after opening."""
    client = ui.context.client
    status = text("p", "", "status", role="status", aria_live="polite")
    top = box("header")
    bar = box("div", "steps-bar-place")
    main = box("div", "main", data_key="main")

    def draw(focus: str | None) -> None:
        if client.id not in Client.instances:
            return  # the tab was closed while something was under way
        with client:  # the caller's slot may be deleted: a pressed button is redrawn
            tab.actions.clear()
            for place in (top, bar, main):
                place.clear()
            with top:
                _head(tab, turn_theme)
            with bar:
                steps_bar(tab)
            with main:
                under_way(tab)
                VIEW[tab.view](tab)
            status.set_text(tab.news)
            status.classes(
                add="trouble" if tab.trouble else "", remove="" if tab.trouble else "trouble"
            )
            kept[_SESSION], kept[_DARK] = tab.session, tab.dark
            if focus is not None:
                ui.run_javascript(f"werrimbiFocus({json.dumps(focus)})")

    def turn_theme() -> None:
        tab.dark = not tab.dark
        theme.set_value(tab.dark)
        draw("theme")

    tab = Tab(shared, kept.get(_SESSION, begun(shared.look)), draw, dark=dark)
    for place in (top, bar, main):
        listen(place, tab)
    client.on_delete(tab.cancel)
    draw(None)


def _head(tab: Tab, turn_theme: object) -> None:
    shared = tab.shared
    given = shared.opened.given
    drives = f"{counted(len(given.runs), 'drive')}, parts held out"
    if given.holdout:
        drives = f"{len(given.runs)} fitted and {len(given.holdout)} held-out drives"
    with box("div", "title"):
        text("h1", "werrimbi workbench")
        text(
            "p",
            f"{shared.source.path.name}: {drives}. "
            "Find out where the wheel odometry fails, why, and mend it: 1 to 4.",
        )
    assert callable(turn_theme)
    button(
        tab, "Light" if tab.dark else "Dark", turn_theme, key="theme", aria_label="Light or dark"
    )
