# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Printed text as HTML: sentences unwrapped, points as lists, plain tables as tables."""

from __future__ import annotations

import html
import re

WIDTH = 80
"""Columns that printed words are filled to."""


def paragraphs(text: str) -> str:
    """Paragraphs and "- " points of filled text; the first paragraph is the headline."""
    parts: list[str] = []
    points: list[str] = []
    for item in unwrapped(text):
        if item.startswith("- "):
            points.append(f"<li>{_inline(item[2:])}</li>")
            continue
        if points:
            parts.append(f"<ul>{''.join(points)}</ul>")
            points = []
        mark = ' class="headline"' if not parts else ""
        parts.append(f"<p{mark}>{_inline(item)}</p>")
    if points:
        parts.append(f"<ul>{''.join(points)}</ul>")
    return "\n".join(parts)


def unwrapped(text: str) -> list[str]:
    """Paragraphs of text that was filled to `WIDTH` columns, without their line breaks.

    A line goes on with the one before it when its first word had no room there any more.
    """
    found: list[str] = []
    before = ""
    for line in text.splitlines():
        words = line.split()
        if not words:
            before = ""
            continue
        full = len(before) + 1 + len(words[0]) > WIDTH
        hanging = line.startswith(" ") and not line.lstrip().startswith("- ")
        if before and not line.lstrip().startswith("- ") and (full or hanging):
            found[-1] += " " + " ".join(words)
        else:
            found.append(" ".join(words))
        before = line
    return found


def _inline(text: str) -> str:
    """Escaped, with `commands` in their own type."""
    return re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))


def tables(text: str) -> str:
    """Plain tables, parted by empty lines: a heading, a row of heads, rows."""
    return "\n".join(_table(block.splitlines()) for block in re.split(r"\n\s*\n", text.strip("\n")))


def _table(lines: list[str]) -> str:
    rows = [re.split(r"\s{2,}", line.strip()) for line in lines[1:]]
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        if all(not line.startswith(" ") for line in lines):
            return f"<p>{_inline(' '.join(lines))}</p>"
        return f"<pre>{html.escape(chr(10).join(lines))}</pre>"
    heads = "".join(f'<th scope="col">{html.escape(cell)}</th>' for cell in rows[0])
    body = "".join(
        f'<tr><th scope="row">{html.escape(row[0])}</th>'
        + "".join(f"<td>{html.escape(cell)}</td>" for cell in row[1:])
        + "</tr>"
        for row in rows[1:]
    )
    return (
        f"<div class='wide'><table><caption>{html.escape(lines[0])}</caption>"
        f"<thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table></div>"
    )
