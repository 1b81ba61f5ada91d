# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a verb tells: paragraphs, tables and figures, made once by the verb's report.

`terminal` prints a document, `page` makes a page to mail of it (and the view of a notebook), the
workbench puts its parts among its buttons. None of them reads what another has printed.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from textwrap import dedent
from typing import Literal

from werrimbi_odom.report.style import Figure


@dataclass(frozen=True)
class Paragraph:
    """A paragraph of its own wherever it is shown."""

    text: str
    """`commands` in backquotes."""
    kind: Literal["words", "point", "command", "code"] = "words"
    hanging: bool = False
    """Whether printed lines after the first are indented: it begins with a word to find it by."""
    apart: bool = False
    """Whether an empty line stands before it where it is printed."""


@dataclass(frozen=True)
class Definition:
    """A name or a value, and below it what it is."""

    term: str
    says: str
    apart: bool = False


@dataclass(frozen=True)
class Table:
    """Cells; the first of each row names it."""

    title: str
    heads: Sequence[str]
    """Empty: names and what belongs to them, in words."""
    rows: Sequence[Sequence[str]]
    words: Collection[int] = ()
    """Columns that hold words, beside the first; others hold numbers."""
    rest: str = ""
    """What was left out."""


Part = Paragraph | Definition | Table


@dataclass(frozen=True)
class Shown:
    """One place on the page: a figure, or several to choose from, or a drawing."""

    key: str
    """Short name, in file names and links."""
    title: str
    see: str
    """One sentence: what to see."""
    figures: Mapping[str, Figure] = field(default_factory=dict)
    """By the words to choose them by; the first is shown."""
    choose: str = ""
    """What is chosen, where there are several."""
    html: str = ""
    """Below the figure: a drawing, a list, a table; trusted."""
    main: bool = True
    """Whether it is one for a paper."""


@dataclass(frozen=True, kw_only=True)
class Document:
    """Everything that a verb tells."""

    title: str
    words: Sequence[Part]
    """The verdict; its first paragraph is the headline."""
    tables: Sequence[Part] = ()
    """Below the words, and on a page below the figures."""
    draw: Callable[[], Sequence[Shown]] = tuple
    """The figures; drawn when somebody looks."""
    made: Mapping[str, str] = field(default_factory=dict)
    """How it was made: command, files, options."""


def paragraphs(
    texts: Iterable[str], *, hanging: Collection[str] = (), apart: bool = False
) -> tuple[Paragraph, ...]:
    """A paragraph for each text, but for empty ones.

    Parameters
    ----------
    texts
        What begins with "- " is a point of a list, with four blanks a command.
    hanging
        Words before a colon that a paragraph is found by: "How sure" for "How sure: ...".
    apart
        Whether an empty line is printed before each.
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
