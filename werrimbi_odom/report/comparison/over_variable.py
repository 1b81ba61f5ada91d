# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of an error over one variable: leg errors, and wheel errors over a turn."""

from __future__ import annotations

from typing import Any

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.over_variable import (
    FINE,
    binned,
    once_a_turn,
    over_a_turn,
    wheel_errors,
)
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import style
from werrimbi_odom.report.comparison.figures import CHANNELS, measured_channels
from werrimbi_odom.report.style import Figure

WHEEL_ANGLES = ("left wheel's angle [°]", "right wheel's angle [°]")

_MOST_RUNS = 6
"""Most runs in the figure of a wheel's angle."""

_FEWEST = 6  # least number of bins of a turn for the fit of a sine

_LOOKS = (
    (style.BLUE, "solid", "circle"),
    (style.ORANGE, "solid", "square"),
    (style.GREEN, "solid", "triangle-up"),
    (style.GREY, "solid", "diamond"),
    (style.BLUE, "dash", "x"),
    (style.ORANGE, "dash", "cross"),
)


def wheel_angle_figure(comparison: Comparison, variable: str) -> Figure:
    """Error of a wheel's travel in mm per metre over its angle, with a sine for each run."""
    side = -1 if variable == WHEEL_ANGLES[0] else 1
    word = "left" if side < 0 else "right"
    figure = style.blank()
    longest = sorted(
        range(len(comparison.runs)), key=lambda index: -comparison.runs[index].distance_m
    )[:_MOST_RUNS]
    for index, (colour, dash, symbol) in zip(sorted(longest), _LOOKS, strict=False):
        centre, mean, spread = over_a_turn(*wheel_errors(comparison, index, side))
        if np.isfinite(mean).sum() < _FEWEST:
            continue
        amplitude, std, wave = once_a_turn(centre, mean, spread)
        name = style.escaped(comparison.runs[index].run.name)
        style.plot(
            figure,
            centre,
            mean,
            group=name,
            shown=False,
            hover=f"{name}<br>%{{x:.0f}}°: %{{y:+.2f}} ± %{{error_y.array:.2f}} mm per m",
            marker={"symbol": symbol, "size": 8, "color": style.paled(colour, 0.6)},
            error_y=style.error_bars(2.0 * spread, style.paled(colour, 0.3), 1, 0),
        )
        line = {"color": colour, "dash": dash, "width": 2.5}
        words = f"{name}: once a turn {amplitude:.1f} ± {std:.1f}"
        style.plot(figure, style.small(FINE), style.small(wave), words, group=name, line=line)
    if not figure.data:
        words = "The reference measures no headings and positions this often."
        middle = {"x": 0.5, "y": 0.5, "xref": "paper", "yref": "paper"}
        figure.add_annotation(text=words, showarrow=False, **middle)
    error = f"error of the {word} wheel's travel [mm per m]"
    return style.over(figure, f"angle of the {word} wheel [°]", error, 480, turn=True)


def variables_of(comparison: Comparison) -> list[str]:
    """Variables for the figures, the most significant first."""
    varied = [item.name for item in comparison.variables]
    sure = {item.name: min(item.p_values.values()) for item in comparison.variables}
    ordered = sorted(varied, key=lambda name: sure[name] if sure[name] < 1e-4 else 1.0)
    return [*ordered, *WHEEL_ANGLES]


def error_against_figure(comparison: Comparison, variable: str) -> Figure:
    """Leg errors over one of `variables_of`: a dot for each leg, and bin means with error bars."""
    from plotly.subplots import make_subplots

    if variable in WHEEL_ANGLES:
        return wheel_angle_figure(comparison, variable)
    legs = comparison.legs
    values = legs.variables[variable]
    is_angle = variable.startswith("heading")
    if is_angle:
        values = np.degrees(np.mod(values + np.pi, 2.0 * np.pi) - np.pi)
    columns = measured_channels(comparison)
    figure = make_subplots(rows=len(columns), cols=1, shared_xaxes=True, vertical_spacing=0.06)
    known = ~legs.outlier & np.isfinite(values)
    for place, column in enumerate(columns, start=1):
        name, unit, factor = CHANNELS[column]
        error = factor * legs.errors.error[:, column]
        rows = np.flatnonzero(known & np.isfinite(error))
        drawn = rows[style.spread_and_extremes(error[rows], style.MARKS // 2)]
        at: dict[str, Any] = {"shown": place == 1, "row": place, "col": 1}
        style.plot(
            figure,
            style.small(values[drawn]),
            style.small(error[drawn]),
            "a leg",
            group="leg",
            hover=f"%{{x:.3g}}<br>{name} %{{y:.2f}} {unit}",
            marker={"color": style.paled(style.GREY, 0.55), "size": 5},
            **at,
        )
        centre, mean, spread, count = binned(values[rows], error[rows], periodic=is_angle)
        style.plot(
            figure,
            centre,
            mean,
            "mean, ± 2 standard errors",
            group="mean",
            hover=f"%{{x:.3g}}<br>{name} %{{y:.2f}} ± %{{error_y.array:.2f}} {unit}"
            "<br>%{customdata} legs",
            customdata=count,
            line={"color": style.BLUE, "width": 2},
            marker={"color": style.BLUE, "size": 8},
            error_y=style.error_bars(2.0 * spread, style.BLUE),
            **at,
        )
        figure.update_yaxes(title=f"{name} [{unit}]", row=place, col=1)
        _range(figure, error[rows], place)
    style.plain(figure, height=150 + 175 * len(columns))
    label = variable.replace("[rad]", "[°]") if is_angle else variable
    figure.update_xaxes(title=label, row=len(columns), col=1)
    if is_angle:
        figure.update_xaxes(dtick=45, range=[-185, 185])
    figure.update_xaxes(gridcolor=style.FAINT)
    return figure


def _range(figure: Figure, values: Floats, place: int) -> None:
    """Axis range with most of the points; outliers are outside."""
    if values.size == 0:
        return
    low, high = np.quantile(values, [0.005, 0.995]).tolist()
    room = 0.15 * max(high - low, 1e-9)
    figure.update_yaxes(range=[min(low, 0.0) - room, max(high, 0.0) + room], row=place, col=1)
