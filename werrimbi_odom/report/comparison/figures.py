# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison in figures: by type of motion, against what was promised, against a variable."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.comparison.compare import KINDS, Comparison
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.comparison.channels import CHANNELS, NAMES, measured_channels
from werrimbi_odom.report.comparison.nees_figure import nees_figure
from werrimbi_odom.report.comparison.path_figure import path_figure
from werrimbi_odom.report.diagnosis.wheel_angle import WHEEL_ANGLES, wheel_angle_figure
from werrimbi_odom.report.style import (
    BLUE,
    FAINT,
    GREY,
    MARKS,
    paled,
    plain,
    small,
    spread_and_extremes,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go

__all__ = [
    "NAMES",
    "error_against_figure",
    "legs_by_motion_figure",
    "nees_figure",
    "path_figure",
    "variables_of",
]

_TWO_SIGMA = 1.959964
_BINS = 12
_FEWEST = 5  # legs in a bin whose mean is drawn


def _panels(titles: Sequence[str], *, rows: bool = False, **more: object) -> go.Figure:
    from plotly.subplots import make_subplots

    count = len(titles)
    if rows:
        return make_subplots(rows=count, cols=1, shared_xaxes=True, vertical_spacing=0.06, **more)
    return make_subplots(rows=1, cols=count, subplot_titles=titles, horizontal_spacing=0.09, **more)


def legs_by_motion_figure(comparison: Comparison) -> go.Figure:
    """Errors of the legs by type of motion, beside what the covariance promised for them."""
    legs = comparison.legs
    kept = ~legs.outlier
    columns = measured_channels(comparison)
    figure = _panels([f"{CHANNELS[column][0]} [{CHANNELS[column][1]}]" for column in columns])
    for place, column in enumerate(columns, start=1):
        name, unit, factor = CHANNELS[column]
        for kind in KINDS:
            mine = kept & (legs.errors.kind == kind)
            values = factor * legs.errors.error[mine, column]
            values = values[np.isfinite(values)]
            if values.size == 0:
                continue
            sigma = legs.errors.covariance[mine, column, column]
            promised = _TWO_SIGMA * factor * float(np.sqrt(np.mean(sigma)))
            _promise(figure, NAMES[kind], promised, unit, place, first=place == 1)
            low, first, middle, third, high = np.quantile(
                values, [0.025, 0.25, 0.5, 0.75, 0.975]
            ).tolist()
            figure.add_box(
                x=[NAMES[kind]],
                lowerfence=[low],
                q1=[first],
                median=[middle],
                q3=[third],
                upperfence=[high],
                mean=[float(values.mean())],
                name="errors of the legs: half of them in the box, 95 % within the whiskers",
                legendgroup="errors",
                showlegend=place == 1 and kind == _first_kind(comparison),
                line={"color": BLUE, "width": 2},
                fillcolor=paled(BLUE, 0.25),
                width=0.38,
                hoverinfo="skip",
                row=1,
                col=place,
            )
            figure.add_scatter(
                x=[NAMES[kind]],
                y=[middle],
                mode="markers",
                marker={"color": BLUE, "size": 14, "opacity": 0.0},
                showlegend=False,
                hovertemplate=(
                    f"{NAMES[kind]}, {name}: {values.size} legs<br>mean {values.mean():+.2f} {unit}"
                    f"<br>95 % of them {low:+.2f} to {high:+.2f} {unit}"
                    f"<br>promised ± {promised:.2f} {unit}<extra></extra>"
                ),
                row=1,
                col=place,
            )
    figure.update_xaxes(categoryorder="array", categoryarray=list(NAMES.values()))
    figure.update_yaxes(zeroline=True)
    return plain(figure, height=430).update_layout(
        margin={"t": 90}, legend={"y": 1.13}, boxmode="overlay", barmode="overlay"
    )


def _first_kind(comparison: Comparison) -> str:
    kinds = comparison.legs.errors.kind[~comparison.legs.outlier]
    return next((kind for kind in KINDS if (kinds == kind).any()), "")


def _promise(
    figure: go.Figure, name: str, promised: float, unit: str, place: int, *, first: bool
) -> None:
    figure.add_bar(
        x=[name],
        y=[2.0 * promised],
        base=[-promised],
        width=0.8,
        name="promised by the covariance for 95 % of them",
        legendgroup="promised",
        showlegend=first and not any(trace.type == "bar" for trace in figure.data),
        marker={
            "color": paled(GREY, 0.18),
            "line": {"color": GREY, "width": 1},
            "pattern": {"shape": "/", "fgcolor": paled(GREY, 0.5), "size": 7},
        },
        hovertemplate=f"promised ± {promised:.2f} {unit}<extra></extra>",
        row=1,
        col=place,
    )


def variables_of(comparison: Comparison) -> list[str]:
    """What errors can be drawn against, those that they go with most surely first."""
    varied = [item.name for item in comparison.variables]
    sure = {item.name: min(item.p_values.values()) for item in comparison.variables}
    ordered = sorted(varied, key=lambda name: sure[name] if sure[name] < 1e-4 else 1.0)
    return [*ordered, *WHEEL_ANGLES]


def error_against_figure(comparison: Comparison, variable: str) -> go.Figure:
    """Errors of the legs over one variable: each leg a dot, means of equal parts with error bars.

    Parameters
    ----------
    variable : str
        One of `variables_of`.
    """
    if variable in WHEEL_ANGLES:
        return wheel_angle_figure(comparison, variable)
    legs = comparison.legs
    values = legs.variables[variable]
    is_angle = variable.startswith("heading")
    if is_angle:
        values = np.degrees(np.mod(values + np.pi, 2.0 * np.pi) - np.pi)
    columns = measured_channels(comparison)
    figure = _panels(["" for _ in columns], rows=True)
    known = ~legs.outlier & np.isfinite(values)
    for place, column in enumerate(columns, start=1):
        name, unit, factor = CHANNELS[column]
        error = factor * legs.errors.error[:, column]
        rows = np.flatnonzero(known & np.isfinite(error))
        drawn = rows[spread_and_extremes(error[rows], MARKS // 2)]
        figure.add_scatter(
            x=small(values[drawn]),
            y=small(error[drawn]),
            mode="markers",
            name="a leg",
            legendgroup="leg",
            showlegend=place == 1,
            marker={"color": paled(GREY, 0.55), "size": 5},
            hovertemplate=f"%{{x:.3g}}<br>{name} %{{y:.2f}} {unit}<extra></extra>",
            row=place,
            col=1,
        )
        centre, mean, spread, count = binned(values[rows], error[rows], periodic=is_angle)
        figure.add_scatter(
            x=centre,
            y=mean,
            mode="lines+markers",
            name="mean, ± 2 standard errors",
            legendgroup="mean",
            showlegend=place == 1,
            line={"color": BLUE, "width": 2},
            marker={"color": BLUE, "size": 8},
            error_y={"array": 2.0 * spread, "color": BLUE, "thickness": 2, "width": 5},
            customdata=count,
            hovertemplate=(
                f"%{{x:.3g}}<br>{name} %{{y:.2f}} ± %{{error_y.array:.2f}} {unit}"
                "<br>%{customdata} legs<extra></extra>"
            ),
            row=place,
            col=1,
        )
        figure.update_yaxes(title=f"{name} [{unit}]", row=place, col=1)
        _range(figure, error[rows], place)
    plain(figure, height=150 + 175 * len(columns))
    label = variable.replace("[rad]", "[°]") if is_angle else variable
    figure.update_xaxes(title=label, row=len(columns), col=1)
    if is_angle:
        figure.update_xaxes(dtick=45, range=[-185, 185])
    figure.update_xaxes(gridcolor=FAINT)
    return figure


def _range(figure: go.Figure, values: Floats, place: int) -> None:
    """Most of the points; the few far out may be zoomed to."""
    if values.size == 0:
        return
    low, high = np.quantile(values, [0.005, 0.995]).tolist()
    room = 0.15 * max(high - low, 1e-9)
    figure.update_yaxes(range=[min(low, 0.0) - room, max(high, 0.0) + room], row=place, col=1)


def binned(
    values: Floats, error: Floats, *, periodic: bool = False
) -> tuple[Floats, Floats, Floats, NDArray[np.intp]]:
    """Centre, mean, its standard error and number of rows of parts that hold as many rows each.

    Parameters
    ----------
    periodic : bool
        Parts of equal width instead, of a whole turn in degrees.
    """
    parts = max(2, min(_BINS, values.size // (2 * _FEWEST)))
    edges = (
        np.linspace(-180.0, 180.0, _BINS + 1)
        if periodic
        else np.unique(np.quantile(values, np.linspace(0.0, 1.0, parts + 1)))
        if values.size
        else np.zeros(0)
    )
    found = []
    for low, high in pairwise(edges.tolist()):
        mine = (values >= low) & ((values < high) | (high == edges[-1]))
        count = int(mine.sum())
        if count < _FEWEST:
            continue
        part = error[mine]
        found.append(
            (float(values[mine].mean()), float(part.mean()), float(part.std(ddof=1)), count)
        )
    table = np.array(found).reshape(-1, 4)
    return (
        table[:, 0],
        table[:, 1],
        table[:, 2] / np.sqrt(np.maximum(table[:, 3], 1.0)),
        table[:, 3].astype(np.intp),
    )
