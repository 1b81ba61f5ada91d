# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The evidence map as a heat map."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import VERY_SURE
from werrimbi_odom.inference.diagnosis.evidence import CHANNELS, Amount, Dependence
from werrimbi_odom.inference.diagnosis.variables import CONSTANT
from werrimbi_odom.report.diagnosis.dependence import short_name
from werrimbi_odom.report.style import coloured, escaped, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go

FAINTEST = 150.0
"""Fall of chi-squared that is given full colour at the least: noise alone stays pale."""

_CHANNELS = {"left": "left wheel", "right": "right wheel"}


def variable_words(name: str) -> str:
    """A variable's name for a figure."""
    return escaped(short_name(name))


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


def unit_of(amount: Amount) -> tuple[str, float]:
    """Unit in which an error for each unit of its amount is told, and the factor to it."""
    degree = math.degrees(1.0)
    if amount.channel == "heading":
        return {
            "turn": ("% of the turn", 100.0),
            "duration": ("° per s", degree),
        }.get(amount.per, ("° per m", degree))
    return ("mm per radian turned", 1e3) if amount.per == "turn" else ("mm per m", 1e3)


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
    shown = _ticks(max(top, FAINTEST))
    coloured(
        figure,
        full,
        "explained<br>(fall of χ²)",
        tickvals=np.sqrt(shown).tolist(),
        ticktext=[f"{value:g}" for value in shown],
    )
    figure.update_yaxes(
        autorange="reversed",
        title={"text": "error of", "standoff": 12},
        showgrid=False,
        tickvals=list(CHANNELS),
        ticktext=[_CHANNELS.get(channel, channel) for channel in CHANNELS],
    )
    figure.update_xaxes(tickangle=-40, title="goes with", showgrid=False)
    plain(figure, height=height, legend=False)
    figure.update_layout(dragmode=False, margin={"t": 40})
    return figure


def _ticks(top: float) -> list[float]:
    """Values for the scale, which goes by the root, far enough apart to be read."""
    found = [0.0]
    for value in (10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6):
        if value <= top and np.sqrt(value) - np.sqrt(found[-1]) >= 0.12 * np.sqrt(top):
            found.append(value)
    return found


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
