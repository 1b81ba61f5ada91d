# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a verb: paragraphs, tables and figures, independent of the output.

`terminal` prints a document, `page` writes it as an HTML page (and as the view of a notebook), the
workbench arranges its parts. None of them parses printed text.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import dedent
from typing import Literal

from werrimbi_odom.report.style import Figure


@dataclass(frozen=True)
class Paragraph:
    """A paragraph of its own in every output."""

    text: str
    """Text, with `commands` in backquotes."""
    kind: Literal["words", "point", "command", "code"] = "words"
    hanging: bool = False
    """Whether printed lines after the first are indented, because it begins with a keyword."""
    apart: bool = False
    """Whether an empty line is printed before it."""


@dataclass(frozen=True)
class Definition:
    """A name or a value, with its description below."""

    term: str
    says: str
    apart: bool = False


@dataclass(frozen=True)
class Table:
    """A table; the first cell of each row is its name."""

    title: str
    heads: Sequence[str]
    """Column headings; empty for a list of names with descriptions."""
    rows: Sequence[Sequence[str]]
    words: Collection[int] = ()
    """Columns with words, in addition to the first; the others have numbers."""
    rest: str = ""
    """Remark on omitted rows."""


Part = Paragraph | Definition | Table


@dataclass(frozen=True)
class Shown:
    """One section of the page: a figure, or several to choose from, or HTML."""

    key: str
    """Short name for file names and links."""
    title: str
    see: str
    """One sentence on what to see."""
    figures: Mapping[str, Figure] = field(default_factory=dict)
    """Figures by the labels of their selection; the first one is shown at first."""
    choose: str = ""
    """Label of the selection, if there are several."""
    html: str = ""
    """Trusted HTML below the figure: a drawing, a list, a table."""
    main: bool = True
    """Whether it is saved as a figure for a paper."""


@dataclass(frozen=True, kw_only=True)
class Document:
    """Complete report of a verb."""

    title: str
    words: Sequence[Part]
    """Summary; its first paragraph is the headline."""
    tables: Sequence[Part] = ()
    """Tables below the words, and on a page below the figures."""
    draw: Callable[[], Sequence[Shown]] = tuple
    """Makes the figures when they are needed."""
    made: Mapping[str, str] = field(default_factory=dict)
    """Provenance: command, files, options."""


def paragraphs(
    texts: Iterable[str], *, hanging: Collection[str] = (), apart: bool = False
) -> tuple[Paragraph, ...]:
    """A paragraph for each non-empty text: "- " begins an item of a list, four spaces a command.

    `hanging` are keywords before a colon ("How sure" for "How sure: ..."); `apart`: whether an
    empty line is printed before each.
    """
    return tuple(
        Paragraph(dedent(text).rstrip(), "command", apart=apart)
        if text.startswith("    ")
        else Paragraph(text[2:], "point", apart=apart)
        if text.startswith("- ")
        else Paragraph(text, hanging=text.partition(": ")[0] in hanging, apart=apart)
        for text in texts
        if text.strip()
    )
