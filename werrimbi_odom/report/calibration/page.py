# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of a calibration: its words, its figure, and the numbers that were written."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.report.page import Page, Shown

if TYPE_CHECKING:
    import plotly.graph_objects as go


def calibration_page(
    title: str,
    words: str,
    heading: str,
    see: str,
    figure: go.Figure,
    changes: Mapping[str, tuple[float, float]],
    made: Mapping[str, str],
) -> Page:
    """A page with one figure.

    Parameters
    ----------
    heading, see
        Of the figure: its heading, and what to see in it.
    changes
        Name of each parameter that was written, before and after.
    """
    return Page(
        title,
        words,
        [Shown("figure", heading, see, {"": figure})],
        written_table(changes),
        made,
    )


def written_table(changes: Mapping[str, tuple[float, float]]) -> str:
    """Parameters before and after, as a plain table."""
    from werrimbi_odom.report.text import table

    if not changes:
        return ""
    rows: list[Sequence[str]] = [
        [name, f"{before:.6g}", f"{after:.6g}"] for name, (before, after) in changes.items()
    ]
    return table("Written to the robot file", ("parameter", "before", "after"), rows)
