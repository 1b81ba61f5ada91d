# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The error falling as effects are added, bar by bar, and the floor that noise leaves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.report.legs_figure import clouds_of_legs
from werrimbi_odom.report.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    PAPER,
    escaped,
    paled,
    plain,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go


@dataclass(frozen=True, slots=True)
class ErrorOfModel:
    """The error of one model on the way."""

    name: str
    """What was done last: as given, calibrated, + an effect."""
    train: float
    """Root mean square error of the drives of the fit."""
    holdout: float
    """Of the drives held out."""
    unit: str = "m"
    """m, of positions; rad, of headings where nothing else was measured."""


def steps_of(added: Added) -> list[ErrorOfModel]:
    """As given, calibrated alone, and with the effect."""
    names = [("as given", "before"), (f"+ {added.name.replace(',', ', ')}", "after")]
    if not added.is_calibration:
        names.insert(1, ("calibrated", "calibrated"))
    return [
        ErrorOfModel(
            name,
            added.train.error(which),
            added.holdout.error(which),
            added.holdout.unit,
        )
        for name, which in names
    ]


def error_falling_figure(steps: Sequence[ErrorOfModel], floor: float = float("nan")) -> go.Figure:
    """One pair of bars for each step; a line where the noise of the final model ends.

    Parameters
    ----------
    floor : float
        Position error of the held-out drives that noise alone would make [m]; NaN: not drawn.
    """
    import plotly.graph_objects as go

    figure = go.Figure()
    largest = max(
        (value for step in steps for value in (step.train, step.holdout) if np.isfinite(value)),
        default=1.0,
    )
    unit, factor = ("m", 1.0) if largest > 0.1 else ("mm", 1e3)
    of_headings = bool(steps) and steps[0].unit == "rad"
    if of_headings:
        unit, factor = "°", np.degrees(1.0)
    names = [escaped(step.name) for step in steps]
    for name, values, ink, look in (
        (
            "drives of the fit",
            [factor * step.train for step in steps],
            INK,
            {"color": paled(GREY, 0.25), "line": {"color": GREY, "width": 1.5}},
        ),
        ("held-out drives", [factor * step.holdout for step in steps], PAPER, {"color": BLUE}),
    ):
        figure.add_bar(
            x=names,
            y=values,
            name=name,
            marker=look,
            text=[f"{value:.2f}" if np.isfinite(value) else "" for value in values],
            # At the foot of the bars: at their heads the floor's line would run through it.
            textposition="inside",
            insidetextanchor="start",
            textangle=0,
            textfont={"size": 15, "color": ink},
            hovertemplate=f"%{{x}}, {name}<br>%{{y:.3g}} {unit}<extra></extra>",
        )
    if np.isfinite(floor):
        figure.add_hline(y=factor * floor, line={"color": GREEN, "width": 2.5, "dash": "dash"})
        figure.add_scatter(
            x=[None],
            y=[None],
            mode="lines",
            line={"color": GREEN, "width": 2.5, "dash": "dash"},
            name=f"floor: what noise alone leaves, {factor * floor:.2f} {unit}",
        )
    figure.update_yaxes(title=f"error of a leg, rms [{unit}]", range=[0.0, 1.16 * factor * largest])
    figure.update_xaxes(showgrid=False)
    plain(figure, height=420)
    return figure.update_layout(barmode="group", bargap=0.35)


def held_out_legs_figure(added: Added) -> go.Figure:
    """Errors of the held-out legs along and sideways, as given and with the effect."""
    clouds = [
        (name, legs.errors.error[~legs.outlier], colour, symbol)
        for name, legs, colour, symbol in (
            ("as given", added.holdout.before, ORANGE, "x"),
            (f"with {added.name.replace(',', ', ')}", added.holdout.after, BLUE, "circle"),
        )
    ]
    return clouds_of_legs(clouds, digits=2, height=560)
