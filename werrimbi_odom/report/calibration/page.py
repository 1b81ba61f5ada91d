# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of a calibration: its words, its figure, and the numbers that were written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.report.page import Page, Shown
from werrimbi_odom.report.style import plain

if TYPE_CHECKING:
    import plotly.graph_objects as go


def calibration_page(
    title: str,
    words: str,
    see: str,
    figure: go.Figure,
    changes: Mapping[str, tuple[float, float]],
    made: Mapping[str, str],
) -> Page:
    """A page with one figure.

    Parameters
    ----------
    see
        What to see in the figure.
    changes
        Name of each parameter that was written, before and after.
    """
    return Page(
        title,
        words,
        [Shown("figure", figure_title(figure) or title, see, {"": on_a_page(figure)})],
        written_table(changes),
        made,
    )


def figure_title(figure: go.Figure) -> str:
    """The heading that a figure has of its own, without its marks."""
    text = figure.layout.title.text or ""
    return text.split("<br>")[0].replace("<b>", "").replace("</b>", "")


def on_a_page(figure: go.Figure) -> go.Figure:
    """A figure with a heading of its own, as the page wants it: without, and in either theme."""
    import plotly.graph_objects as go

    found = go.Figure(figure)
    height = int(found.layout.height or 600)
    found.update_layout(title=None, width=None, legend={"borderwidth": 0})
    return plain(found, height=height)


def written_table(changes: Mapping[str, tuple[float, float]]) -> str:
    """Parameters before and after, as a plain table."""
    from werrimbi_odom.report.printed import table

    if not changes:
        return ""
    rows: list[Sequence[str]] = [
        [name, f"{before:.6g}", f"{after:.6g}"] for name, (before, after) in changes.items()
    ]
    return table("Written to the robot file", ("parameter", "before", "after"), rows)
