# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of a calibration: its words, its figure, and the numbers that were written."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.report.document import Document, Part, Shown, Table
from werrimbi_odom.report.page import table_html

if TYPE_CHECKING:
    import plotly.graph_objects as go


def calibration_document(
    title: str,
    words: Sequence[Part],
    heading: str,
    see: str,
    figure: Callable[[], go.Figure],
    changes: Mapping[str, tuple[float, float]],
) -> Document:
    """A document with one figure.

    Parameters
    ----------
    heading, see
        Of the figure: its heading, and what to see in it.
    changes
        Name of each parameter that was written, before and after.
    """
    rows = [[name, f"{before:.6g}", f"{after:.6g}"] for name, (before, after) in changes.items()]
    table = Table("", ("parameter", "before", "after"), rows)
    says = "The parameters that the calibration moved."
    written = Shown("written", "Written to the robot file", says, html=table_html(table))

    def draw() -> list[Shown]:
        return [Shown("figure", heading, see, {"": figure()}), *([written] if rows else [])]

    return Document(title=title, words=words, draw=draw)
