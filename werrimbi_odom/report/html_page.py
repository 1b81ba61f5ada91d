# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A report as one HTML file: verdict in words, figures with a sentence each, tables, provenance.

The file includes all its resources, plotly once, and its content security policy forbids network
access.
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterable, Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.files.text_files import readable, replacing
from werrimbi_odom.report.document import Definition, Document, Paragraph, Part, Shown, Table
from werrimbi_odom.report.style import IN_THE_DARK

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


def drawing_program() -> Traversable:
    """Resource with the 1.5 MB of JavaScript of plotly."""
    return files("werrimbi_odom.report") / "plotly_js" / "plotly-cartesian.min.js"


_POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; form-action 'none'; base-uri 'none'"
)


_LONG, _BEGIN = 2000, 200
"""Characters of a value that is folded, and of what stays of it."""


def write_page(page: Document, path: Path) -> None:
    """Write a self-contained page; InputError if it cannot be written."""
    with replacing(path) as file:
        file.write(readable(page_html(page)))


def page_html(page: Document) -> str:
    """The whole page as HTML."""
    assets = files("werrimbi_odom.report")
    style = (assets / "page.css").read_text(encoding="utf-8")
    script = (assets / "page.js").read_text(encoding="utf-8")
    drawn = page.draw()
    figures = {
        f"{shown.key}-{number}": json.loads(figure.to_json())
        for shown in drawn
        for number, figure in enumerate(shown.figures.values())
    }
    data = {"figures": figures, "dark": dict(IN_THE_DARK)}
    links = "".join(
        f'<li><a href="#{shown.key}">{html.escape(shown.title)}</a></li>' for shown in drawn
    )
    nav = ""
    if len(drawn) > 1:
        nav = f'<nav aria-label="On this page"><ul>{links}</ul></nav>'
    body = "\n".join(_section(shown) for shown in drawn)
    numbers = as_html(page.tables)
    if numbers:
        numbers = f'<section id="tables"><h2>Tables</h2>\n{numbers}</section>'
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
{_headed(page.words)}
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


def _headed(parts: Sequence[Part]) -> str:
    """The verdict, with its first paragraph as the headline."""
    first = parts[0]
    if not isinstance(first, Paragraph) or first.kind != "words":
        return as_html(parts)
    rest = as_html(parts[1:])
    return f'<p class="headline">{_inline(first.text)}</p>\n{rest}'


def as_html(parts: Iterable[Part]) -> str:
    """Parts of a document as HTML; consecutive points form a list."""
    written: list[str] = []
    for tag, group in groupby(parts, key=_list_of):
        found = [_of_part(part) for part in group]
        written += [f"<{tag}>{''.join(found)}</{tag}>"] if tag else found
    return "\n".join(written)


def _list_of(part: Part) -> str:
    """Tag of the list that a part is an item of; "" for none."""
    if isinstance(part, Definition):
        return "dl"
    return "ul" if isinstance(part, Paragraph) and part.kind == "point" else ""


def _of_part(part: Part) -> str:
    if isinstance(part, Table):
        return table_html(part)
    if isinstance(part, Definition):
        return f"<dt>{_inline(part.term)}</dt><dd>{_inline(part.says)}</dd>"
    if part.kind in ("command", "code"):
        return f"<pre>{html.escape(part.text)}</pre>"
    tag = "li" if part.kind == "point" else "p"
    return f"<{tag}>{_inline(part.text)}</{tag}>"


def table_html(table: Table) -> str:
    """A table in a container that scrolls if it is wider than the page."""
    words = table.words if table.heads else (1,)

    def cell(tag: str, at: int, text: str, scope: str = "") -> str:
        mark = ' class="words"' if at in words else ""
        return f"<{tag}{scope}{mark}>{_lines(text)}</{tag}>"

    heads = "".join(cell("th", at, text, ' scope="col"') for at, text in enumerate(table.heads))
    rows = "".join(
        "<tr>"
        + cell("th", 0, row[0], ' scope="row"')
        + "".join(cell("td", at, text) for at, text in enumerate(row[1:], start=1))
        + "</tr>"
        for row in table.rows
    )
    label = html.escape(table.title or "Table", quote=True)
    return (
        f'<div class="wide" tabindex="0" role="group" aria-label="{label}"><table>'
        + (f"<caption><span>{html.escape(table.title)}</span></caption>" if table.title else "")
        + (f"<thead><tr>{heads}</tr></thead>" if heads else "")
        + f"<tbody>{rows}</tbody></table></div>"
        + (f"<p>{html.escape(table.rest)}</p>" if table.rest else "")
    )


def _lines(cell: str) -> str:
    """Escaped text of a cell with its line breaks and indentation."""
    kept = (line.replace("  ", "\N{NO-BREAK SPACE}" * 3) for line in cell.splitlines())
    return "<br>".join(map(html.escape, kept))


_WITH_SPREAD = re.compile(r"\(?[-\d.]+ ± [\d.]+\)?(?:e-?\d+)?")


def _inline(text: str) -> str:
    """Escaped text with `commands` as code; values are not separated from their deviations."""
    coded = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))
    return _WITH_SPREAD.sub(r'<span class="value">\g<0></span>', coded)


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
            f"<dt>{html.escape(name)}</dt><dd>{_folded(value)}</dd>" for name, value in rows.items()
        )
        + "</dl>"
    )


def _folded(value: str) -> str:
    """As HTML, all of it; what is long (paths of a thousand drives) below its begin."""
    whole = html.escape(value)
    if len(value) <= _LONG:
        return whole
    return f"<details><summary>{html.escape(value[:_BEGIN])} ...</summary>{whole}</details>"


def own_version() -> str:
    """Version of this package; that it is not installed, in a checkout."""
    try:
        return version("werrimbi_odom")
    except PackageNotFoundError:
        return "from a checkout, not installed"


def _embedded(data: object) -> str:
    """JSON that cannot end its script element."""
    return json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
