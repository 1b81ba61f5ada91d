# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The evidence map as a heat map, and the dependence behind each of its cells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import VERY_SURE
from werrimbi_odom.inference.diagnosis.evidence import CHANNELS, Amount, Dependence
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, functions_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.decimate import small
from werrimbi_odom.report.response import unit_of
from werrimbi_odom.report.style import BLUE, GREEN, GREY, INK, ORANGE, RISING, escaped, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

FAINTEST = 150.0
"""Fall of chi-squared that is given full colour at the least: noise alone stays pale."""

_WORDS = {
    CONSTANT: "always",
    "wheel_speed": "wheel's speed",
    "yaw_rate": "turn rate",
    "yaw_rate_size": "turn rate, size",
    "travel_since_reversal": "travel since reversal",
    "left_wheel_angle": "left wheel's angle",
    "right_wheel_angle": "right wheel's angle",
    "left_wheel_angle_twice": "left wheel's angle, twice",
    "right_wheel_angle_twice": "right wheel's angle, twice",
    "position": "place on the floor",
}

_POINTS = 160
_RUNS = 6
_CELLS = 1500


def variable_words(name: str) -> str:
    """A variable's name for a figure."""
    return escaped(_WORDS.get(name, name.replace("_", " ")))


def amount_words(amount: Amount) -> str:
    """An error for each unit of its amount."""
    what = {
        "left": "error of the left wheel's travel",
        "right": "error of the right wheel's travel",
        "along": "error along",
        "sideways": "sideways error",
        "heading": "heading error",
    }[amount.channel]
    return what


def best_cells(cells: Sequence[Dependence]) -> dict[tuple[str, str], Dependence]:
    """The strongest dependence of each channel on each variable."""
    found: dict[tuple[str, str], Dependence] = {}
    for cell in cells:
        key = cell.channel, cell.variable.name
        if key not in found or _worth(cell) > _worth(found[key]):
            found[key] = cell
    return found


def _worth(cell: Dependence) -> float:
    return cell.gain - 2.0 * cell.degrees


def ordered_cells(cells: Sequence[Dependence]) -> list[Dependence]:
    """One cell for each field of the map, the strongest first."""
    return sorted(best_cells(cells).values(), key=lambda cell: -_worth(cell))


def evidence_map_figure(
    cells: Sequence[Dependence], *, opens: str = "", height: int = 430
) -> go.Figure:
    """Error channel against measured variable: the darker, the more of the misfit goes with it.

    The custom data of a field are channel, variable, `opens`, and the field's number in
    `ordered_cells`, for whoever listens to clicks.
    """
    import plotly.graph_objects as go

    best = best_cells(cells)
    order = {id(cell): number for number, cell in enumerate(ordered_cells(cells))}
    names = list(dict.fromkeys(cell.variable.name for cell in cells))
    names.sort(key=lambda name: (name != CONSTANT, _place_of(name), name))
    values = np.full((len(CHANNELS), len(names)), np.nan)
    marks = [["" for _ in names] for _ in CHANNELS]
    texts = [["" for _ in names] for _ in CHANNELS]
    custom: list[list[list[object]]] = [
        [[channel, name, "", ""] for name in names] for channel in CHANNELS
    ]
    top = max((max(_worth(cell), 0.0) for cell in best.values()), default=0.0)
    for row, channel in enumerate(CHANNELS):
        for column, name in enumerate(names):
            cell = best.get((channel, name))
            if cell is None:
                continue
            values[row, column] = np.sqrt(max(_worth(cell), 0.0))
            sure = cell.p_value < VERY_SURE
            marks[row][column] = "★" if sure and _worth(cell) == top else "●" if sure else ""
            texts[row][column] = _told(cell)
            custom[row][column] = [channel, name, opens, order[id(cell)]]
    full = float(np.sqrt(max(top, FAINTEST)))
    figure = go.Figure()
    figure.add_heatmap(
        z=values,
        x=[variable_words(name) for name in names],
        y=list(CHANNELS),
        text=texts,
        customdata=custom,
        hovertemplate="%{text}<extra></extra>",
        hoverongaps=False,
        coloraxis="coloraxis",
        xgap=2,
        ygap=2,
    )
    # Marks have their own ink on a disc of paper, so that they are read on any field.
    where = [
        (variable_words(names[column]), CHANNELS[row], marks[row][column])
        for row in range(len(CHANNELS))
        for column in range(len(names))
        if marks[row][column]
    ]
    figure.add_scatter(
        x=[item[0] for item in where],
        y=[item[1] for item in where],
        mode="markers",
        marker={
            "symbol": ["star" if item[2] == "★" else "circle" for item in where],
            "size": [17 if item[2] == "★" else 9 for item in where],
            "color": "#FFFFFE",
            "line": {"width": 1.5, "color": "#000001"},
        },
        hoverinfo="skip",
        showlegend=False,
    )
    shown = [
        value
        for value in (0.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 1e6)
        if value <= max(top, FAINTEST)
    ]
    figure.update_layout(
        coloraxis={
            "colorscale": [list(stop) for stop in RISING],
            "cmin": 0.0,
            "cmax": full,
            "colorbar": {
                "title": {"text": "explained<br>(fall of χ²)"},
                "tickvals": np.sqrt(shown).tolist(),
                "ticktext": [f"{value:g}" for value in shown],
                "thickness": 14,
            },
        }
    )
    figure.update_yaxes(autorange="reversed", title="error of", showgrid=False)
    figure.update_xaxes(tickangle=-40, title="goes with", showgrid=False)
    plain(figure, height=height, legend=False)
    figure.update_layout(dragmode=False, margin={"t": 40})
    return figure


def _place_of(name: str) -> int:
    known = [
        "speed",
        "wheel_speed",
        "direction",
        "acceleration",
        "yaw_rate",
        "yaw_rate_size",
        "travel_since_reversal",
        "left_wheel_angle",
        "right_wheel_angle",
        "left_wheel_angle_twice",
        "right_wheel_angle_twice",
        "heading",
        "position",
        "time",
        "distance",
    ]
    return known.index(name) if name in known else len(known)


def _told(cell: Dependence) -> str:
    chance = "beyond any chance" if cell.p_value < 1e-12 else f"p = {cell.p_value:.1e}"
    return (
        f"<b>{cell.channel}</b> with <b>{variable_words(cell.variable.name)}</b>"
        f"<br>in proportion to {cell.amount.per}, as a {cell.form}"
        f"<br>χ² falls by {cell.gain:.0f} for {cell.degrees} numbers; {chance}"
    )


def dependence_figure(cell: Dependence, run_names: Sequence[str] = ()) -> go.Figure:
    """The error of a cell over its variable, as the evidence map has fitted it."""
    import plotly.graph_objects as go

    figure = go.Figure()
    unit, factor = unit_of(cell.amount)
    if cell.form == "place":
        return _floor(cell, unit, factor)
    if cell.form == "turns":
        _turns(figure, cell, unit, factor, run_names)
    else:
        _curve(figure, cell, unit, factor)
    figure.add_hline(y=0.0, line={"color": GREY, "width": 1})
    figure.update_yaxes(title=f"{amount_words(cell.amount)}<br>[{unit}]")
    return plain(figure, height=360)


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
    name = variable_words(cell.variable.name)
    if cell.variable.name == CONSTANT:
        figure.update_xaxes(showticklabels=False)
        figure.add_annotation(
            text=f"{factor * float(cell.coefficients[0]):+.3g} {unit}, whatever is driven",
            x=0.5,
            y=0.5,
            xref="paper",
            yref="paper",
            showarrow=False,
        )
    figure.update_xaxes(title=f"{name} [{cell.variable.unit}]" if cell.variable.unit else name)


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
    figure.update_xaxes(title=f"{variable_words(cell.variable.name)} [°]", dtick=45, range=[0, 360])


def _floor(cell: Dependence, unit: str, factor: float) -> go.Figure:
    """The error by place: larger where it is darker, signs by shape."""
    import plotly.graph_objects as go

    cells, _ = functions_of(cell.variable)["place"]
    values = factor * (cells @ cell.coefficients)
    step = max(1, values.size // _CELLS)
    x, y, error = cell.variable.left[::step], cell.variable.right[::step], values[::step]
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
    figure.update_layout(
        coloraxis={
            "colorscale": [list(stop) for stop in RISING],
            "cmin": 0.0,
            "cmax": largest,
            "colorbar": {
                "title": {"text": f"{amount_words(cell.amount)}<br>[{unit}]"},
                "thickness": 14,
            },
        }
    )
    figure.update_xaxes(title="x [m]")
    figure.update_yaxes(title="y [m]", scaleanchor="x", scaleratio=1)
    return plain(figure, height=480)


def values_at_steps(cell: Dependence) -> Floats:
    """The variable itself, at every step (of the left wheel, where each has its own)."""
    return cell.variable.left
