# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The error falling, bar by bar, as effects are added."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.report.style import BLUE, GREY, ORANGE, PAPER, plain
from werrimbi_odom.workbench.steps import Step

if TYPE_CHECKING:
    import plotly.graph_objects as go


def gain_figure(steps: Sequence[Step]) -> go.Figure:
    """Held-out and fitted drives apart, and what noise alone would leave of the held-out ones."""
    import plotly.graph_objects as go

    figure = go.Figure()
    names = [step.name if step.added is None else f"+ {step.name}" for step in steps]
    sides = (
        ("held-out drives", BLUE, "", [step.look.holdout_error for step in steps]),
        ("fitted drives", GREY, "/", [step.look.train_error for step in steps]),
    )
    for name, colour, shape, errors in sides:
        values = [1e3 * error for error in errors]
        figure.add_bar(
            x=list(range(len(names))),
            y=values,
            name=name,
            marker={
                "color": colour,
                "pattern": {"shape": shape, "fillmode": "overlay", "fgopacity": 0.25},
            },
            text=[f"{value:.2f}" for value in values],
            textposition="inside",
            insidetextanchor="start",
            textangle=0,
            textfont={"color": PAPER, "size": 15},
            hovertemplate=f"{name}: %{{y:.2f}} mm<extra></extra>",
        )
    added = steps[-1].added
    last = max(len(names), 3) - 0.4  # room for the next bar
    if added is not None and added.explained:
        floor = 1e3 * added.noise_alone(added.holdout)
        figure.add_scatter(
            x=[-0.6, last],
            y=[floor, floor],
            mode="lines",
            name=f"what noise alone would leave: {floor:.2f} mm",
            line={"color": ORANGE, "width": 3, "dash": "dash"},
            hoverinfo="skip",
        )
    plain(figure, height=380)
    figure.update_layout(barmode="group", bargap=0.35, dragmode=False)
    places = list(range(len(names)))
    figure.update_xaxes(
        tickvals=places, ticktext=names, range=[-0.6, last], showgrid=False, zeroline=False
    )
    measured = [error for *_, errors in sides for error in errors if error == error]
    top = 1e3 * max(measured, default=1e-3)
    figure.update_yaxes(title="position error [mm]", range=[0.0, 1.08 * top])
    return figure
