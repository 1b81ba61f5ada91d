# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a fleet: words, a figure of each robot's error before and after, and a table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from io import StringIO
from pathlib import Path

from werrimbi_odom.errors import InputError
from werrimbi_odom.report import style
from werrimbi_odom.report.document import Document, Shown, Table
from werrimbi_odom.report.fleet import (
    ERROR,
    Fleet,
    Row,
    believed,
    error_words,
    number,
    words_of,
)
from werrimbi_odom.report.html_page import table_html
from werrimbi_odom.report.number_format import listed, with_std
from werrimbi_odom.report.save import save_report
from werrimbi_odom.report.style import Figure
from werrimbi_odom.report.terminal import as_text

_FREQUENT = ((style.BLUE, "circle"), (style.ORANGE, "square"), (style.GREEN, "diamond"))
"""Colour and mark of the effects that most robots miss."""
_OTHERS = {
    "something else": (style.INK, "triangle-up"),
    "ambiguous": (style.GREY, "cross"),
    "unknown": (style.GREY, "x"),
    "nothing": (style.GREY, "pentagon"),
}
_LOGARITHMIC = 20.0
"""Ratio of the largest to the smallest error from which on the axis is logarithmic."""
_CLOSE = 60
"""Number of robots from which on rows are closer together."""


def fleet_figure(fleet: Fleet) -> Figure | None:
    """Held-out error of each robot [mm] in rows; None if no robot has such an error."""
    shown = [row for row in fleet.rows if all(map(math.isfinite, row.errors))]
    if not shown:
        return None
    looks = _looks(fleet)
    figure = style.blank()
    for group, (colour, mark) in looks.items():
        rows = [row for row in shown if _group(row, looks) == group]
        if not rows:
            continue
        before = [1e3 * row.errors[0] for row in rows]
        after = [1e3 * row.errors[1] for row in rows]
        names = [style.escaped(row.robot) for row in rows]
        line = {"color": colour, "width": 2}
        x, y = style.apart(before, after), style.apart(names, names)
        style.plot(figure, x, y, group=group, shown=False, line=line)
        hollow = {"color": style.PAPER, "symbol": mark, "size": 9, "line": line}
        told = "%{y}, as given: %{x:.2f} mm"
        style.plot(figure, before, names, group=group, shown=False, hover=told, marker=hollow)
        missing = [" ".join("; ".join(missing_words(row)).split()) for row in rows]
        style.plot(
            figure,
            after,
            names,
            f"{group} ({len(rows)})",
            group=group,
            hover="%{y}: %{x:.2f} mm<br>missing: %{customdata}",
            customdata=list(map(style.escaped, missing)),
            marker={"color": colour, "symbol": mark, "size": 10},
        )
    _axes(figure, shown)
    height = max(150 + (26 if len(shown) <= _CLOSE else 15) * len(shown), 260)
    style.plain(figure, height=height)
    figure.update_layout(legend={"y": 1.0 + 12.0 / height})
    return figure


def _axes(figure: Figure, shown: list[Row]) -> None:
    errors = [1e3 * value for row in shown for value in row.errors]
    low, high = min(errors), max(errors)
    title = (
        "position error of held-out legs [mm]<br>"
        "hollow: as given, filled: with what is missing put in"
    )
    if low > 0.0 and high > _LOGARITHMIC * low:
        figure.update_xaxes(type="log", title=title, dtick="D1" if high < 1e3 * low else 1)
    else:
        figure.update_xaxes(title=title, range=[0.0, 1.06 * high])
    figure.update_yaxes(
        type="category",
        categoryorder="array",
        categoryarray=[style.escaped(row.robot) for row in shown],
        range=[len(shown) - 0.4, -0.6],  # first robot on top
        tickmode="linear",
        dtick=1,
    )


def _looks(fleet: Fleet) -> Mapping[str, tuple[str, str]]:
    """Colour and mark of each group."""
    frequent = zip(fleet.by_effect, _FREQUENT, strict=False)
    return {**dict(frequent), **_OTHERS}


def _group(row: Row, looks: Mapping[str, tuple[str, str]]) -> str:
    """Group of a robot in the figure: that of its most important effect, or of its verdict."""
    assert row.verdict != ERROR
    if row.verdict == "named":
        return row.missing[0] if row.missing[0] in looks else "something else"
    return {"none": "nothing"}.get(row.verdict, row.verdict)


def write_fleet_page(fleet: Fleet, path: Path, made: Mapping[str, str]) -> list[Path]:
    """Write the report as .html, or the figure alone as .pdf or .png; return the written files.

    `made` is the provenance: command, files, options. InputError if it cannot be written, or a
    picture is requested and there is nothing to draw.
    """
    document = replace(document_of(fleet), made=made)
    if path.suffix.lower() in (".pdf", ".png") and fleet_figure(fleet) is None:
        raise InputError(f"--report {path}: no robot has a held-out error to draw; try .html")
    return save_report(document, path)


def document_of(fleet: Fleet) -> Document:
    """The complete report."""
    count = len(fleet.rows)
    title = f"What {count} robots are missing" if count != 1 else "What one robot is missing"
    return Document(title=title, words=words_of(fleet), draw=lambda: _figures(fleet))


def _figures(fleet: Fleet) -> list[Shown]:
    figure = fleet_figure(fleet)
    words = [at for at in range(1, len(HEADS)) if at not in _RIGHT]
    table = Table("", HEADS, [cells(row, whole=True) for row in fleet.rows], words)
    shown = []
    if figure is not None:
        shown.append(
            Shown(
                "errors",
                "What each robot would gain",
                "From the hollow mark, as given, to the filled one, with what is missing put in: "
                "the error of drives that took no part in the fit. Colour and mark say what is "
                "missing.",
                {"": figure},
            )
        )
    shown.append(
        Shown(
            "robots",
            "The robots",
            "What each of them is missing, how large that is (± one standard deviation), and what "
            "to do next.",
            html=table_html(table),
        )
    )
    return shown


HEADS = ("robot", "runs", "verdict", "what is missing", "held-out error [mm]", "next step")
_ROBOT, _RUNS, _VERDICT, _MISSING, _ERROR, _NEXT = range(len(HEADS))
_RIGHT = (_RUNS, _ERROR)
_MOST = 20
"""Width of columns with names on the terminal; longer names are wrapped."""


def fleet_table(fleet: Fleet, width: int = 100) -> str:
    """The table as text of at most `width` columns; without rich in long lines."""
    rows = [cells(row) for row in fleet.rows]
    try:
        from rich import box
        from rich.console import Console
        from rich.table import Table as Grid
        from rich.text import Text
    except ModuleNotFoundError:
        single = [[" ".join(cell.split()) for cell in row] for row in rows]
        return as_text([Table("The robots", HEADS, single)])
    made = Grid(box=box.SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0), expand=True)
    for at, head in enumerate(HEADS):
        made.add_column(
            Text(head.replace(" error", "\nerror")),
            justify="right" if at in _RIGHT else "left",
            overflow="fold",
            no_wrap=at == _VERDICT,
            max_width=_MOST if at in (_ROBOT, _NEXT) else None,
            ratio=1 if at == _MISSING else None,
        )
    for cut in rows:
        made.add_row(*map(Text, cut))
    written = StringIO()
    Console(file=written, width=width, color_system=None, legacy_windows=False).print(made)
    lines = written.getvalue().splitlines()
    return "\n".join(line.rstrip() for line in lines if line.strip())


def cells(row: Row, *, whole: bool = False) -> list[str]:
    """Cells of a robot; effects are separated by line breaks.

    With `whole`, error messages too, as on a page; the terminal prints them above the table.
    """
    missing = "\n".join(missing_words(row))
    error, then = error_words(row), next_words(row)
    if whole:
        error = error.replace(" ", "\N{NO-BREAK SPACE}")
    if row.verdict == ERROR:
        missing, then = (row.error, "") if whole else ("could not be diagnosed", "see above")
    return [row.robot, str(row.runs), row.verdict, missing, error, then]


def missing_words(row: Row) -> list[str]:
    """Missing effects of a robot, each with its fitted values."""
    if row.verdict == "none":
        return ["nothing"]
    said = [f"{row.rivals[0]} or {listed(row.rivals[1:], 'or')}"] if len(row.rivals) > 1 else []
    said += [_with_values(row, effect) for effect in row.missing]
    if row.told.get("drives_differ"):
        said.append("not the same in all drives")
    elif wheel := _one_wheel(row):
        said.append("the wheels err" if wheel == "both" else f"the {wheel} wheel errs")
        said[-1] += ", by no law"
    elif when := _by_events(row):
        said.append(f"something at each {when}")
    elif row.verdict == "unknown":
        cells = row.told["depends_on"]
        said.append(cells[0]["words"] if cells else "no effect of the library")
    return said


def _with_values(row: Row, effect: str) -> str:
    values = [
        f"{name} {with_std(item['value'], number(item['std']))} {item['unit']}".rstrip()
        for name, item in believed(row.values(effect)).items()
    ]
    return "\n  ".join([f"{effect}:", *values]) if values else effect


def _one_wheel(row: Row) -> str:
    """The wheel that errs far more than the other, by no law; "" if none does."""
    return str((row.told.get("one_sided_noise") or {}).get("side", ""))


def _by_events(row: Row) -> str:
    """With what abrupt errors come that alone say that something is missing; "" if none do."""
    return str(row.told["events_alike"]["what"]) if row.told.get("by_events") else ""


def next_words(row: Row) -> str:
    """Next step in a few words; `add` and `draft` are verbs of this tool."""
    if row.verdict == "named":
        return f"add {','.join(row.missing)}"
    if row.told.get("drives_differ"):
        return "diagnose the drives since the change"
    if wheel := _one_wheel(row):
        return "look at the wheels" if wheel == "both" else f"look at the {wheel} wheel"
    if row.told.get("as_a_floor"):
        return "record with motion capture"
    if row.verdict == "unknown" and not _by_events(row):
        return "draft"
    if row.verdict == "none" and row.told["outdated"]:
        return f"add {row.told['outdated'][0]['effect']}"
    if row.verdict in ("ambiguous", "unknown"):
        move = row.told["next_manoeuvre"]
        if move is None:
            return "use a ruler"
        name = str(move["name"]).replace("_", " ")
        return f"drive {name} ({move['minutes']:.0f} min)" if move["minutes"] else name
    return ""
