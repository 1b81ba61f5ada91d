# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How all figures look: colours that the colour-blind tell apart, a heading, a legend below."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import plotly.graph_objects as go

# Okabe and Ito's palette.
BLUE, ORANGE, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#6B6B6B"
INK, FAINT, PAPER = "#1B1F24", "#D9DCE0", "#FFFFFF"
"""Text, grid lines, and what lies behind them, on white."""

IN_THE_DARK: Mapping[str, str] = {
    BLUE: "#56B4E9",
    ORANGE: "#F0904A",
    GREEN: "#3CC79B",
    GREY: "#A3A9B1",
    INK: "#E8EAED",
    FAINT: "#3A4048",
    PAPER: "#15181C",
}
"""What each colour becomes on a dark page; pages exchange them by name."""

KEPT_HERE: Mapping[str, object] = {"showSendToCloud": False, "plotlyServerURL": ""}
"""Settings of plotly, which from version 4 on offers to upload a figure: it stays where it is."""

RISING = (
    (0.0, "#F3E9A6"),
    (0.2, "#E2C35C"),
    (0.4, "#C79A3E"),
    (0.6, "#9A6A4F"),
    (0.8, "#5D3F63"),
    (1.0, "#1B1145"),
)
"""From little to much: even steps of lightness, so that it stays a scale in grey; yellow to violet
is told apart with any kind of colour blindness. Pages turn it round in the dark."""


def paled(colour: str, share: float) -> str:
    """A colour with an opacity from 0 to 1; the page still knows its name in the dark."""
    return f"{colour}{round(255 * share):02X}"


def styled(figure: go.Figure, title: str, subtitle: str, *, width: int, height: int) -> go.Figure:
    """The figure with heading, legend and size; equal scales on both axes."""
    heading = f"<b>{title}</b>"
    if subtitle:
        heading += f"<br><span style='font-size:14px'>{subtitle}</span>"
    figure.update_layout(
        title={"text": heading, "x": 0.02, "xanchor": "left", "y": 0.96, "yanchor": "top"},
        template="plotly_white",
        font={"size": 15},
        margin={"l": 70, "r": 25, "t": 85, "b": 110},
        legend={"orientation": "h", "x": 0.0, "y": -0.1, "yanchor": "top"},
        width=width,
        height=height,
    )
    figure.update_yaxes(scaleanchor="x", scaleratio=1)
    return figure


def plain(figure: go.Figure, *, height: int, legend: bool = True) -> go.Figure:
    """A figure for a page: no heading (the page has it), as wide as its place, either theme."""
    figure.update_layout(
        template="none",
        font={"size": 14, "color": INK, "family": "system-ui, 'Segoe UI', sans-serif"},
        paper_bgcolor=PAPER,
        plot_bgcolor=PAPER,
        margin={"l": 70, "r": 20, "t": 40, "b": 55},
        height=height,
        autosize=True,
        showlegend=legend,
        legend={"orientation": "h", "x": 0.0, "y": 1.02, "yanchor": "bottom"},
        hoverlabel={"bgcolor": PAPER, "bordercolor": GREY, "font": {"color": INK, "size": 14}},
        dragmode="zoom",
        modebar={"color": GREY, "activecolor": BLUE, "bgcolor": "rgba(0,0,0,0)"},
    )
    lines = {"gridcolor": FAINT, "linecolor": GREY, "zerolinecolor": GREY, "zerolinewidth": 1}
    figure.update_xaxes(**lines, ticks="outside", tickcolor=GREY, automargin=True)
    figure.update_yaxes(**lines, ticks="outside", tickcolor=GREY, automargin=True)
    figure.update_annotations(font={"color": INK, "size": 14})
    return figure


def escaped(text: str) -> str:
    """A name from a record, safe in a figure's texts, which know some HTML."""
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")
