# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plain text as it is printed: filled sentences, and tables; and HTML made of it."""

from __future__ import annotations

import html
import re
import textwrap
from collections.abc import Sequence

WIDTH = 80
"""Columns that printed words are filled to."""


def filled(text: str, *, hanging: bool = False) -> str:
    """A paragraph; what begins with "- " hangs, and others on request."""
    return textwrap.fill(
        text,
        WIDTH,
        subsequent_indent="  " if hanging or text.startswith("- ") else "",
        break_long_words=False,
        break_on_hyphens=False,
    )


def table(title: str, heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """First column to the left, the others to the right, two blanks between."""
    columns = list(zip(heads, *rows, strict=True))
    widths = [max(map(len, column)) for column in columns]
    lines = [title]
    for row in (heads, *rows):
        cells = [row[0].ljust(widths[0])]
        cells += [cell.rjust(width) for cell, width in zip(row[1:], widths[1:], strict=True)]
        lines.append(("  " + "  ".join(cells)).rstrip())
    return "\n".join(lines)


def pairs(title: str, rows: Sequence[tuple[str, str]]) -> str:
    """Names to the left, values to the right of them, filled."""
    width = max(len(name) for name, _ in rows) + 4
    lines = [
        textwrap.fill(
            value,
            max(WIDTH, width + 40),
            initial_indent=f"  {name}".ljust(width),
            subsequent_indent=" " * width,
            break_long_words=False,
            break_on_hyphens=False,
        )
        for name, value in rows
    ]
    return "\n".join([title, *lines])


_WITH_SPREAD = re.compile(r"\(?[-\d.]+ ± [\d.]+\)?(?:e-?\d+)?")

COMMAND = "    "
"""What a line of a command begins with."""


def paragraphs(text: str) -> str:
    """Printed text: sentences, "- " points, commands, and tables between empty lines.

    The first paragraph is the headline.
    """
    parts: list[str] = []
    for block in re.split(r"\n\s*\n", text.strip("\n")):
        lines = block.splitlines()
        if (
            len(lines) > 2
            and all(line.startswith("  ") for line in lines[1:])
            and _cells(lines[1:])
        ):
            parts.append(_table(lines))
        elif all(line.startswith("  ") for line in lines):
            parts.append(_verbatim(lines))
        else:
            parts += _sentences(block, first=not parts)
    return "\n".join(parts)


def _sentences(text: str, *, first: bool) -> list[str]:
    parts: list[str] = []
    points: list[str] = []
    for item in [*unwrapped(text), ""]:
        if item.startswith("- "):
            points.append(f"<li>{_inline(item[2:])}</li>")
            continue
        if points:
            parts.append(f"<ul>{''.join(points)}</ul>")
            points = []
        if item.startswith(COMMAND):
            parts.append(_verbatim(item.splitlines()))
        elif item:
            mark = ' class="headline"' if first and not parts else ""
            parts.append(f"<p{mark}>{_inline(item)}</p>")
    return parts


def unwrapped(text: str) -> list[str]:
    """Paragraphs of text that was filled to `WIDTH` columns, without their line breaks.

    A line goes on with the one before it when its first word had no room there any more, or when it
    is indented; lines that begin with four blanks are a command and are left as they are.
    """
    found: list[str] = []
    before = ""
    for line in text.splitlines():
        words = line.split()
        if not words:
            before = ""
            continue
        command = line.startswith(COMMAND)
        point = line.startswith("- ")
        full = len(before) + 1 + len(words[0]) > WIDTH
        if command and found and found[-1].startswith(COMMAND):
            found[-1] += f"\n{line}"
        elif command:
            found.append(line)
        elif before and not point and not before.startswith(COMMAND) and (full or line[0] == " "):
            found[-1] += " " + " ".join(words)
        else:
            found.append(" ".join(words))
        before = line
    return found


def _verbatim(lines: list[str]) -> str:
    return f"<pre>{html.escape(textwrap.dedent(chr(10).join(lines)))}</pre>"


def _inline(text: str) -> str:
    """Escaped, with `commands` in their own type, and values on one line with their spread."""
    coded = re.sub(r"`([^`]*)`", r"<code>\1</code>", html.escape(text))
    return _WITH_SPREAD.sub(r'<span class="value">\g<0></span>', coded)


def tables(text: str) -> str:
    """Plain tables, parted by empty lines: a heading, a row of heads, rows."""
    return "\n".join(_table(block.splitlines()) for block in re.split(r"\n\s*\n", text.strip("\n")))


def _cells(lines: list[str]) -> list[list[str]]:
    """Cells of a plain table: columns are parted by two blanks or more in all of its lines.

    Empty where there are no such columns.
    """
    width = max(map(len, lines))
    filled = [line.ljust(width) for line in lines]
    used = "".join("x" if any(line[at] != " " for line in filled) else " " for at in range(width))
    columns = [match.span() for match in re.finditer(r"x+(?: x+)*", used)]
    if len(columns) < 2 or len(lines) < 2:
        return []
    return [[line[begin:end].strip() for begin, end in columns] for line in filled]


def _table(lines: list[str]) -> str:
    rows = _cells(lines[1:]) if len(lines) > 2 else []
    if not rows:
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
        f'<div class="wide"><table><caption><span>{html.escape(lines[0])}</span></caption>'
        f"<thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table></div>"
    )
