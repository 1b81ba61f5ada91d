# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The dependence behind a cell of the evidence map: a curve, waves, or a map of the floor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, functions_of
from werrimbi_odom.report.diagnosis.evidence_figures import amount_words, unit_of
from werrimbi_odom.report.over_variable import labelled, over
from werrimbi_odom.report.style import (
    BLUE,
    GREEN,
    GREY,
    INK,
    MARKS,
    ORANGE,
    coloured,
    escaped,
    plain,
    small,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go

_POINTS = 160


def dependence_figure(cell: Dependence, run_names: Sequence[str] = ()) -> go.Figure:
    """The error of a cell over its variable, as the evidence map has fitted it."""
    import plotly.graph_objects as go

    if cell.form == "place":
        return _floor(cell)
    figure = go.Figure()
    unit, factor = unit_of(cell.amount)
    if cell.form == "turns":
        _turns(figure, cell, unit, factor, run_names)
    else:
        _curve(figure, cell, unit, factor)
    error = f"{amount_words(cell.amount)}<br>[{unit}]"
    over(figure, labelled(cell), error, 360, turn=cell.form == "turns")
    if cell.variable.name == CONSTANT:
        figure.update_xaxes(showticklabels=False, title="whatever is driven")
    return figure


def _curve(figure: go.Figure, cell: Dependence, unit: str, factor: float) -> None:
    left, right = functions_of(cell.variable)[cell.form]
    values = cell.variable.left
    functions = left
    if not cell.variable.shared:
        values, functions = (
            np.concatenate([values, cell.variable.right]),
            np.concatenate([left, right]),
        )
    order = np.argsort(values)
    chosen = np.unique(order[np.linspace(0, values.size - 1, _POINTS).astype(int)])
    chosen = chosen[np.argsort(values[chosen])]
    figure.add_scatter(
        x=small(values[chosen]),
        y=small(factor * (functions[chosen] @ cell.coefficients)),
        mode="lines",
        line={"color": BLUE, "width": 3},
        name=cell.form,
        hovertemplate=f"%{{x:.3g}}: %{{y:+.3g}} {unit}<extra></extra>",
        showlegend=False,
    )
    if cell.variable.name == CONSTANT:
        level = factor * float(cell.coefficients[0])
        figure.add_hline(y=level, line={"color": BLUE, "width": 3})
        figure.add_annotation(
            text=f"{level:+.3g} {unit}, whatever is driven",
            x=0.5,
            y=level,
            xref="paper",
            yanchor="bottom" if level > 0.0 else "top",
            showarrow=False,
        )


def _turns(
    figure: go.Figure, cell: Dependence, unit: str, factor: float, run_names: Sequence[str]
) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    waves = np.stack(
        [np.cos(cell.variable.harmonic * angle), np.sin(cell.variable.harmonic * angle)], axis=-1
    )
    looks = (
        (BLUE, "solid"),
        (ORANGE, "dash"),
        (GREEN, "dot"),
        (INK, "dashdot"),
        (GREY, "solid"),
        (ORANGE, "solid"),
    )
    own = np.atleast_2d(cell.coefficients)
    for number, (coefficients, (colour, dash)) in enumerate(zip(own, looks, strict=False)):
        name = run_names[number] if cell.variable.per_run and number < len(run_names) else ""
        figure.add_scatter(
            x=small(np.degrees(angle)),
            y=small(factor * (waves @ coefficients)),
            mode="lines",
            line={"color": colour, "width": 2.5, "dash": dash},
            name=escaped(name),
            showlegend=bool(name),
            hovertemplate=f"%{{x:.0f}}°: %{{y:+.3g}} {unit}<extra></extra>",
        )


def _floor(cell: Dependence) -> go.Figure:
    """The error of a cell by place: larger where it is darker, signs by shape."""
    import plotly.graph_objects as go

    unit, factor = unit_of(cell.amount)
    cells, _ = functions_of(cell.variable)["place"]
    values = factor * (cells @ cell.coefficients)
    rows = np.linspace(0, values.size - 1, min(values.size, MARKS)).astype(int)
    x, y, error = cell.variable.left[rows], cell.variable.right[rows], values[rows]
    largest = max(float(np.max(np.abs(error), initial=0.0)), 1e-12)
    figure = go.Figure()
    for name, which, symbol in (
        ("more than predicted", error > 0.0, "triangle-up"),
        ("less than predicted", error <= 0.0, "triangle-down"),
    ):
        figure.add_scatter(
            x=small(x[which]),
            y=small(y[which]),
            mode="markers",
            name=name,
            marker={
                "symbol": symbol,
                "size": small(5.0 + 7.0 * np.abs(error[which]) / largest),
                "color": small(np.abs(error[which])),
                "coloraxis": "coloraxis",
                "line": {"width": 0},
            },
            customdata=small(error[which]),
            hovertemplate=f"x %{{x:.2f}} m, y %{{y:.2f}} m<br>%{{customdata:+.3g}} {unit}"
            "<extra></extra>",
        )
    coloured(figure, largest, f"{amount_words(cell.amount)}<br>[{unit}]")
    figure.update_xaxes(title="x [m]")
    figure.update_yaxes(title="y [m]", scaleanchor="x", scaleratio=1)
    return plain(figure, height=480)
