# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How all figures look: colours that the colour-blind tell apart, a heading, a legend below."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import plotly.graph_objects as go

# Okabe and Ito's palette.
BLUE, ORANGE, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#6B6B6B"


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
