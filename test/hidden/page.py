# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""docs/evidence.md: what was judged, and everything that was found."""

from __future__ import annotations

import math
import re
from collections.abc import Collection, Sequence
from pathlib import Path

from test.hidden.coverage import RANKS, VERBS, Scores, ranks
from test.hidden.table_layout import Table

HEAD = """# Evidence: effects hidden by a physics engine, and what the diagnosis made of them

This page shows how often `werrimbi diagnose` finds what a physics engine hid, and how often it is
wrong. The first table has the rules that it must keep, broken ones included.

    make evidence          # judges fresh sets and writes this page (change nothing by hand)

{judged} of {planned} sets judged (`python -m test.hidden{how}`), with the code of `{commit}`,
digest `{digest}`{known}.

A *set* is a robot in a physics engine with something hidden in it: seven drives to learn from
and four held out. Its seed is drawn from the digest of the code that is judged, so nobody who wrote
that code has seen it. `werrimbi diagnose` is given the robot file and the runs, and the commands
that it prints are followed, word for word, until nothing more is proposed. The diagnosis never
learns what was hidden. Errors are root mean squares of the position error of held-out legs of 1 m,
medians over the sets.

- *Before*: with the robot file as it was. *After*: with the first printed command followed, if
  there was one. *Floor*: with the true effect in the model, fitted on the seven drives.
- A hidden effect *matters* if before is more than 1.1 times the floor; else it is *weak*.
- *Wrong*: another name, *unknown* for an effect that the library holds, or the drives refused.
  *Missed*: the verdict *none*; or only what the effect extends was named (a delay, of a clock that
  drifts), and said to be another from drive to drive.
- *Twins* are effects that no drive can tell apart; *rivals by construction* are effects that the
  drives of the set can hardly tell apart: only by what a leg of 0.25 m shows of a start, say.
- Intervals hold the true rate in at least 95 of 100 cases (Clopper and Pearson 1934).
"""


def page(
    tables: Sequence[Table],
    pictures: Sequence[tuple[str, str]],
    *,
    how: str,
    judged: int,
    planned: int,
    commit: str,
    digest: str,
    fresh: bool,
    before: str = "",
    not_run: Collection[str] = (),
) -> str:
    """The text; pictures are (file in docs/pictures, what it shows).

    Of tables that were `not_run`, what the page has `before` stays, with the code that it is of.
    """
    known = "" if fresh else ", on seeds that were judged many times before"
    head = HEAD.format(
        how=how, judged=judged, planned=planned, commit=commit, digest=digest, known=known
    )
    texts = [
        table.markdown() if table.rows else _kept(before, table.title)
        for table in tables
        if table.rows or table.title in not_run
    ]
    drawn = [name for name, _ in pictures]
    kept = [
        (name, _dated(says, before))
        for says, name in re.findall(r"^!\[(.*)\]\(pictures/(.*)\)$", before, flags=re.M)
        if name not in drawn
    ]
    shown = [f"![{says}](pictures/{name})\n\n*{says}*\n" for name, says in (*pictures, *kept)]
    return "\n".join([head, *filter(None, texts), *shown])


def with_part(before: str, tables: Sequence[Table], says: str) -> str:
    """The page with the sections of one part as they were made by themselves, which it `says`."""
    for table in tables:
        head = f"## {table.title}\n\n"
        made = table.markdown().replace(head, f"{head}*{says}*\n\n", 1) if table.rows else ""
        found = _section(before, table.title)
        if found is None:
            before += f"\n{made}" if made else ""
        else:
            before = before[: found.start()] + (f"{made}\n" if made else "") + before[found.end() :]
    return before


def _section(text: str, title: str) -> re.Match[str] | None:
    return re.search(rf"^## {re.escape(title)}\n\n(.*?)(?=^## |^!\[|\Z)", text, re.M | re.S)


def _kept(before: str, title: str) -> str:
    """A section of the page as it was, with the code that it is of; empty if it has none.

    Its title stays, since other pages link to it.
    """
    found = _section(before, title)
    if found is None:
        return ""
    old = found[1].startswith(("*Not run anew", "*Run by itself"))
    return f"## {title}\n\n" + ("" if old else f"*{_dated('Not run anew', before)}*\n\n") + found[1]


def _dated(title: str, before: str) -> str:
    """A title with the code that it is of: that of the page it stood on, unless it says so."""
    code = re.search(r"with the code of `(\w+)", before)
    return title if title.endswith("`)") or not code else f"{title} (code `{code[1]}`)"


def draw(
    found: Scores,
    ratios: dict[str, tuple[float, float]],
    true: list[float],
    false: list[float],
    sure: float,
    place: Path,
) -> list[tuple[str, str]]:
    """The pictures that can be drawn; none without a browser.

    Parameters
    ----------
    ratios
        By effect: the size that is named over the smallest that could be, and the factor by which
        that may be wrong.
    true, false
        Minus log10 of p-values, of what is hidden and of the likeliest where nothing is.
    sure : float
        The p-value below which the diagnosis believes.
    """
    import plotly.graph_objects as go

    from werrimbi_odom.report.save import save_png
    from werrimbi_odom.report.style import BLUE, GREY, ORANGE, styled

    made = []

    def save(figure: go.Figure, name: str, title: str, x: str, y: str, height: int = 520) -> None:
        styled(figure, title, "", width=900, height=height)
        figure.update_layout(legend={"y": -0.22}, barmode="group")
        figure.update_xaxes(title=x)
        figure.update_yaxes(title=y, scaleanchor=None, scaleratio=None, automargin=True)
        if save_png(figure, place / name):
            made.append((name, title))

    if ratios:
        names = sorted(ratios, key=lambda name: ratios[name][0])
        values = [ratios[name][0] for name in names]
        up = [ratios[name][0] * (ratios[name][1] - 1.0) for name in names]
        down = [ratios[name][0] * (1.0 - 1.0 / ratios[name][1]) for name in names]
        error = {"array": up, "arrayminus": down, "color": GREY}
        bars = go.Bar(x=values, y=names, orientation="h", marker_color=BLUE, error_x=error)
        figure = go.Figure(bars)
        figure.add_vline(x=1.0, line={"color": GREY, "dash": "dash"})
        title = "Size named in 95 of 100 cases, over the smallest that could be named at all"
        save(figure, "evidence_smallest.png", title, "ratio", "", 200 + 24 * len(names))
    if sum(ranks(found, "add")):
        figure = go.Figure()
        for verb, colour in zip(VERBS, (GREY, BLUE, ORANGE), strict=True):
            counts = ranks(found, verb)
            if not any(counts):
                continue  # its part of the evidence was not run
            share = [RANKS * count / sum(counts) for count in counts]
            middle = [(number + 0.5) / RANKS for number in range(RANKS)]
            figure.add_bar(x=middle, y=share, name=verb, marker_color=colour, showlegend=True)
        figure.add_hline(y=1.0, line={"color": GREY, "dash": "dash"})
        title = "Where the truth lies in what is stated: even where the intervals are right"
        save(figure, "evidence_ranks.png", title, "rank of the truth", "share, over even")
    if true or false:
        figure = go.Figure()
        for values, name, colour in (
            (true, "what is hidden", BLUE),
            (false, "the likeliest where none is", ORANGE),
        ):
            figure.add_histogram(
                x=[min(value, 60.0) for value in values],
                name=name,
                marker_color=colour,
                xbins={"start": 0.0, "end": 61.0, "size": 1.0},
            )
        figure.add_vline(x=-math.log10(sure), line={"color": GREY, "dash": "dash"})
        title = (
            "How sure: minus log10 of the stated chance (60: or more); believed right of the line"
        )
        save(figure, "evidence_sureness.png", title, "- log10 p", "sets")
    return made
