# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A report as one file: verdict in words, figures with a sentence each, tables, how it was made.

The file holds everything it needs, the drawing program once, and forbids itself the network.
"""

from __future__ import annotations

import html
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.files.replacing import replacing
from werrimbi_odom.files.text import readable
from werrimbi_odom.report.style import IN_THE_DARK
from werrimbi_odom.report.text import paragraphs, tables

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable

    import plotly.graph_objects as go


def drawing_program() -> Traversable:
    """Where it is; 1.5 MB of JavaScript."""
    return files("werrimbi_odom.report") / "plotly_js" / "plotly-cartesian.min.js"


_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; form-action 'none'; base-uri 'none'"
)


NOTHING_SAID: Mapping[str, str] = {}
"""Of how a page was made."""


@dataclass(frozen=True)
class Shown:
    """One place on the page: a figure, or several to choose from, or a drawing."""

    key: str
    """Short name, in file names and links."""
    title: str
    see: str
    """One sentence: what to see."""
    figures: Mapping[str, go.Figure] = field(default_factory=dict)
    """By the words to choose them by; the first is shown."""
    choose: str = ""
    """What is chosen, where there are several."""
    html: str = ""
    """Below the figure: a drawing, a list, a table; trusted."""
    main: bool = True
    """Whether it is one for a paper."""


@dataclass(frozen=True)
class Page:
    """A report."""

    title: str
    words: str
    """The verdict, plain text as it is printed."""
    shown: Sequence[Shown]
    tables: str = ""
    """Plain text as it is printed."""
    made: Mapping[str, str] = field(default_factory=dict)
    """How it was made: command, files, options."""


def write_page(page: Page, path: Path) -> None:
    """Write a self-contained page.

    Raises
    ------
    InputError
        When it cannot be written.
    """
    with replacing(path) as file:
        file.write(readable(page_html(page)))


def page_html(page: Page) -> str:
    """The whole page."""
    assets = files("werrimbi_odom.report")
    style = (assets / "page.css").read_text(encoding="utf-8")
    script = (assets / "page.js").read_text(encoding="utf-8")
    figures = {
        f"{shown.key}-{number}": json.loads(figure.to_json())
        for shown in page.shown
        for number, figure in enumerate(shown.figures.values())
    }
    data = {"figures": figures, "dark": dict(IN_THE_DARK)}
    links = "".join(
        f'<li><a href="#{shown.key}">{html.escape(shown.title)}</a></li>' for shown in page.shown
    )
    nav = ""
    if len(page.shown) > 1:
        nav = f'<nav aria-label="On this page"><ul>{links}</ul></nav>'
    body = "\n".join(_section(shown) for shown in page.shown)
    numbers = ""
    if page.tables:
        numbers = f'<section id="tables"><h2>Tables</h2>\n{tables(page.tables)}</section>'
    return f"""<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{_POLICY}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{html.escape(page.title)}</title>
<link rel="icon" href="data:,">
<style>
{style}
</style>
</head>
<body>
<a class="skip" href="#words">Skip to the verdict</a>
<header>
<h1>{html.escape(page.title)}</h1>
<button type="button" id="theme" aria-pressed="false">Dark</button>
</header>
{nav}
<main>
<section id="words" aria-label="Verdict">
{paragraphs(page.words)}
</section>
{body}
{numbers}
<section id="made"><h2>How this was made</h2>
{_made(page.made)}
</section>
</main>
<script>{drawing_program().read_text(encoding="utf-8")}</script>
<script type="application/json" id="data">{_embedded(data)}</script>
<script>
{script}
</script>
</body>
</html>
"""


def _section(shown: Shown) -> str:
    title, see = html.escape(shown.title), html.escape(shown.see)
    parts = [f'<section id="{shown.key}"><h2>{title}</h2>', f"<p>{see}</p>"]
    if len(shown.figures) > 1:
        options = "".join(
            f'<option value="{number}">{html.escape(name)}</option>'
            for number, name in enumerate(shown.figures)
        )
        parts.append(
            f'<p><label>{html.escape(shown.choose)} <select data-for="{shown.key}">{options}'
            "</select></label></p>"
        )
    if shown.figures:
        first = next(iter(shown.figures.values()))
        height = int(first.layout.height or 450)
        parts.append(
            f'<div class="figure" id="figure-{shown.key}" data-figure="{shown.key}" tabindex="0" '
            f'role="figure" aria-label="{title}. {see}" style="height:{height}px"></div>'
            '<p class="keys">Arrow keys move, + and − zoom, 0 shows all again.</p>'
        )
    if shown.html:
        parts.append(shown.html)
    parts.append("</section>")
    return "\n".join(parts)


def _made(made: Mapping[str, str]) -> str:
    rows = {"werrimbi_odom": own_version(), **made}
    return (
        '<dl class="made">'
        + "".join(
            f"<dt>{html.escape(name)}</dt><dd>{html.escape(value)}</dd>"
            for name, value in rows.items()
        )
        + "</dl>"
    )


def own_version() -> str:
    """Of this package; "not installed" where it runs from a checkout."""
    try:
        return version("werrimbi_odom")
    except PackageNotFoundError:
        return "from a checkout, not installed"


def _embedded(data: object) -> str:
    """JSON that cannot end its script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
