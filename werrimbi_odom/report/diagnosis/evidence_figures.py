# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The evidence map, the dependence behind a field, and an error before and after an effect."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.response_curve import BeforeAfter
from werrimbi_odom.inference.diagnosis.step_jacobians import CHANNELS
from werrimbi_odom.inference.diagnosis.variables import CONSTANT, functions_of
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.report import style
from werrimbi_odom.report.diagnosis.dependence import VARIABLES, error_of, label_of, unit_of
from werrimbi_odom.report.style import Figure

FAINTEST = 150.0
"""Smallest reduction of chi-squared with full colour, so that noise alone stays pale."""

_CHANNELS = {"left": "left wheel", "right": "right wheel"}


def best_cells(cells: Sequence[Dependence]) -> dict[tuple[str, str], Dependence]:
    """The strongest dependence of each channel on each variable."""
    found: dict[tuple[str, str], Dependence] = {}
    for cell in cells:
        key = cell.channel, cell.variable.name
        if key not in found or _worth(cell) > _worth(found[key]):
            found[key] = cell
    return found


def best_by_name(cells: Iterable[Dependence]) -> dict[tuple[str, str], Dependence]:
    """The same by name and channel; constant errors have a name for each amount."""
    rows: dict[str, list[Dependence]] = {}
    for cell in cells:
        rows.setdefault(cell.name, []).append(cell)
    return {
        (name, cell.channel): cell
        for name, alike in rows.items()
        for cell in best_cells(alike).values()
    }


def _worth(cell: Dependence) -> float:
    return cell.gain - 2.0 * cell.degrees


def ordered_cells(cells: Sequence[Dependence]) -> list[Dependence]:
    """One cell for each field of the map, in descending order."""
    return sorted(best_cells(cells).values(), key=lambda cell: -_worth(cell))


def evidence_map_figure(cells: Sequence[Dependence], *, opens: str = "") -> Figure:
    """Heat map of error channels and variables: darker for a larger explained part of the misfit.

    The custom data of a field are channel, variable, `opens`, and the index of the field in
    `ordered_cells`, for click handlers.
    """
    best = best_cells(cells)
    order = {id(cell): number for number, cell in enumerate(ordered_cells(cells))}
    names = list(dict.fromkeys(cell.variable.name for cell in cells))
    places = {name: number for number, name in enumerate((CONSTANT, *VARIABLES))}
    names.sort(key=lambda name: (places.get(name, len(places)), name))
    grid = [[best.get((channel, name)) for name in names] for channel in CHANNELS]
    top = max((max(_worth(cell), 0.0) for cell in best.values()), default=0.0)
    figure = style.blank()
    figure.add_heatmap(
        z=np.array(
            [
                [np.nan if cell is None else np.sqrt(max(_worth(cell), 0.0)) for cell in row]
                for row in grid
            ]
        ),
        x=[label_of(name) for name in names],
        y=list(CHANNELS),
        text=[["" if cell is None else _told(cell) for cell in row] for row in grid],
        customdata=[
            [
                [channel, name, *(("", "") if cell is None else (opens, order[id(cell)]))]
                for name, cell in zip(names, row, strict=True)
            ]
            for channel, row in zip(CHANNELS, grid, strict=True)
        ],
        hovertemplate="%{text}<extra></extra>",
        hoverongaps=False,
        coloraxis="coloraxis",
        xgap=2,
        ygap=2,
    )
    # Marks have an outline on a light disc, so that they are legible on any colour.
    marked = [cell for row in grid for cell in row if cell and cell.p_value < rules.VERY_SURE]
    stars = [_worth(cell) == top for cell in marked]
    style.plot(
        figure,
        [label_of(cell.variable.name) for cell in marked],
        [cell.channel for cell in marked],
        shown=False,
        marker={
            "symbol": ["star" if star else "circle" for star in stars],
            "size": [17 if star else 9 for star in stars],
            "color": "#FFFFFE",
            "line": {"width": 1.5, "color": "#000001"},
        },
    )
    full = float(np.sqrt(max(top, FAINTEST)))
    shown = _ticks(max(top, FAINTEST))
    style.coloured(
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
    style.plain(figure, height=430, legend=False)
    figure.update_layout(dragmode=False, margin={"t": 40})
    return figure


def _ticks(top: float) -> list[float]:
    """Ticks for the square-root scale, with enough distance for their labels."""
    found = [0.0]
    for value in (10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6):
        if value <= top and np.sqrt(value) - np.sqrt(found[-1]) >= 0.12 * np.sqrt(top):
            found.append(value)
    return found


def _told(cell: Dependence) -> str:
    chance = "beyond any chance" if cell.p_value < 1e-12 else f"p = {cell.p_value:.1e}"
    return (
        f"<b>{cell.channel}</b> with <b>{label_of(cell.variable.name)}</b>"
        f"<br>in proportion to {cell.amount.per}, as a {cell.form}"
        f"<br>χ² falls by {cell.gain:.0f} for {cell.degrees} numbers; {chance}"
    )


_POINTS = 160


def dependence_figure(cell: Dependence, run_names: Sequence[str]) -> Figure:
    """The error of a cell over its variable, as fitted for the evidence map."""
    if cell.form == "place":
        return _floor(cell)
    figure = style.blank()
    unit, factor = unit_of(cell.amount)
    if cell.form == "turns":
        _turns(figure, cell, unit, factor, run_names)
    else:
        _curve(figure, cell, unit, factor)
    error = f"{error_of(cell.amount)}<br>[{unit}]"
    style.over(figure, labelled(cell), error, 360, turn=cell.form == "turns")
    if cell.variable.name == CONSTANT:
        figure.update_xaxes(showticklabels=False, title="whatever is driven")
    return figure


def _curve(figure: Figure, cell: Dependence, unit: str, factor: float) -> None:
    left, right = functions_of(cell.variable)[cell.form]
    values = cell.variable.left
    functions = left
    if not cell.variable.shared:
        values = np.concatenate([values, cell.variable.right])
        functions = np.concatenate([left, right])
    order = np.argsort(values)
    chosen = np.unique(order[np.linspace(0, values.size - 1, _POINTS).astype(int)])
    chosen = chosen[np.argsort(values[chosen])]
    line = {"color": style.BLUE, "width": 3}
    style.plot(
        figure,
        style.small(values[chosen]),
        style.small(factor * (functions[chosen] @ cell.coefficients)),
        cell.form,
        hover=f"%{{x:.3g}}: %{{y:+.3g}} {unit}",
        shown=False,
        line=line,
    )
    if cell.variable.name == CONSTANT:
        level = factor * float(cell.coefficients[0])
        figure.add_hline(y=level, line=line)
        figure.add_annotation(
            text=f"{level:+.3g} {unit}, whatever is driven",
            x=0.5,
            y=level,
            xref="paper",
            yanchor="bottom" if level > 0.0 else "top",
            showarrow=False,
        )


def _turns(
    figure: Figure, cell: Dependence, unit: str, factor: float, run_names: Sequence[str]
) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 121)
    waves = np.stack(
        [np.cos(cell.variable.harmonic * angle), np.sin(cell.variable.harmonic * angle)], axis=-1
    )
    looks = (
        (style.BLUE, "solid"),
        (style.ORANGE, "dash"),
        (style.GREEN, "dot"),
        (style.INK, "dashdot"),
        (style.GREY, "solid"),
        (style.ORANGE, "solid"),
    )
    own = np.atleast_2d(cell.coefficients)
    for number, (coefficients, (colour, dash)) in enumerate(zip(own, looks, strict=False)):
        name = run_names[number] if cell.variable.per_run and number < len(run_names) else ""
        style.plot(
            figure,
            style.small(np.degrees(angle)),
            style.small(factor * (waves @ coefficients)),
            style.escaped(name),
            hover=f"%{{x:.0f}}°: %{{y:+.3g}} {unit}",
            shown=bool(name),
            line={"color": colour, "width": 2.5, "dash": dash},
        )


def _floor(cell: Dependence) -> Figure:
    """The error of a cell by position: darker for larger size, sign by the shape of the mark."""
    unit, factor = unit_of(cell.amount)
    cells, _ = functions_of(cell.variable)["place"]
    values = factor * (cells @ cell.coefficients)
    rows = np.linspace(0, values.size - 1, min(values.size, style.MARKS)).astype(int)
    x, y, error = cell.variable.left[rows], cell.variable.right[rows], values[rows]
    largest = max(float(np.max(np.abs(error), initial=0.0)), 1e-12)
    figure = style.blank()
    for name, which, symbol in (
        ("more than predicted", error > 0.0, "triangle-up"),
        ("less than predicted", error <= 0.0, "triangle-down"),
    ):
        style.plot(
            figure,
            style.small(x[which]),
            style.small(y[which]),
            name,
            hover=f"x %{{x:.2f}} m, y %{{y:.2f}} m<br>%{{customdata:+.3g}} {unit}",
            customdata=style.small(error[which]),
            marker={
                "symbol": symbol,
                "size": style.small(5.0 + 7.0 * np.abs(error[which]) / largest),
                "color": style.small(np.abs(error[which])),
                "coloraxis": "coloraxis",
                "line": {"width": 0},
            },
        )
    style.coloured(figure, largest, f"{error_of(cell.amount)}<br>[{unit}]")
    return style.from_above(figure, 480)


def before_after_figure(found: BeforeAfter) -> Figure:
    """Error over the variable with error bars, before (and after)."""
    unit, factor = unit_of(found.cell.amount)
    scale = float(np.degrees(1.0)) if found.turns else 1.0
    figure = style.blank()
    words = f"with {found.effect}" if found.effect else ""
    before = "calibrated alone" if found.effect not in CALIBRATED else "as given"
    for name, item, colour, symbol, dash in (
        (f"before: {before}", found.before, style.ORANGE, "square", "dot"),
        (f"after: {words}", found.after, style.BLUE, "circle", "solid"),
    ):
        if item is None:
            continue
        style.plot(
            figure,
            scale * item.centre,
            factor * item.value,
            name if found.effect else "what the error goes with",
            hover=f"%{{x:.3g}}: %{{y:+.3g}} ± %{{error_y.array:.2g}} {unit}<extra>{name}</extra>",
            line={"color": colour, "width": 2, "dash": dash},
            marker={"color": colour, "symbol": symbol, "size": 9},
            error_y=style.error_bars(2.0 * (factor * item.std), colour, 1.5),
        )
    label = labelled(found.cell)
    if found.turns and found.aligned:
        label = label.replace(" [°]", ", from where the fit puts its zero [°]")
    error = f"{error_of(found.cell.amount)}<br>[{unit}]"
    return style.over(figure, label, error, 430, turn=found.turns)


def labelled(cell: Dependence) -> str:
    """The variable with its unit."""
    unit = "°" if cell.form == "turns" else cell.variable.unit
    name = label_of(cell.variable.name)
    return f"{name} [{unit}]" if unit else name
