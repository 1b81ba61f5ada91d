# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model and measurement on the floor: legs coloured by error, dead reckoning with ellipses."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.dead_reckoning import covariance_along, middles
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import style
from werrimbi_odom.report.comparison.figures import CHANNELS
from werrimbi_odom.report.comparison.phrases import leg_when
from werrimbi_odom.report.path_figure import add_mark, add_path, ellipse, spread_along_path
from werrimbi_odom.report.style import Figure

_FEW = 3  # most runs for which the dead reckoning is also drawn in the figure of all runs
_ELLIPSES = 12


def path_figure(comparison: Comparison, run: int | None = None) -> Figure:
    """Measured path with its legs coloured by position error; for one run also the model's path.

    `run` is the index of one run; None for all, with the model's paths only for few runs.
    """
    figure = style.blank()
    which = range(len(comparison.paths)) if run is None else (run,)
    single = len(which) == 1
    most = max(style.FEWEST, style.MOST // max(len(which), 1))
    for index in which:
        _paths(
            figure, comparison, index, most, predicted=len(which) <= _FEW, first=index == which[0]
        )
    _legs(figure, comparison, run)
    if single:
        _ellipses(figure, comparison, which[0])
    for index in which if len(which) <= _FEW else ():
        _ends(figure, comparison, index, first=index == which[0])
    return style.from_above(figure, 680, zeroline=False).update_layout(dragmode="pan")


def _paths(
    figure: Figure, comparison: Comparison, index: int, most: int, *, predicted: bool, first: bool
) -> None:
    path = comparison.paths[index]
    name = style.escaped(comparison.runs[index].run.name)
    rows = style.along_path(path.measured, most)
    after = [end for _, end in comparison.runs[index].run.taken_out]
    pieces = np.searchsorted(path.time[rows], after)  # no line across a gap
    measured = np.insert(path.measured[rows], pieces, np.nan)
    add_path(
        figure,
        measured,
        "measured",
        {"color": style.paled(style.GREY, 0.5), "width": 7},
        said=f"{name}, measured",
        group="measured",
        shown=first,
    )
    if not predicted:
        return
    model = path.predicted[style.along_path(path.predicted, most)]
    add_path(
        figure,
        model,
        "model (dead reckoning from the start)",
        {"color": style.BLUE, "width": 2},
        said=f"{name}, model",
        group="model",
        shown=first,
    )


def _ends(figure: Figure, comparison: Comparison, index: int, *, first: bool) -> None:
    path = comparison.paths[index]
    known = np.flatnonzero(np.isfinite(path.measured) & np.isfinite(path.predicted))
    if known.size == 0:
        return
    begin, end = known[0], known[-1]
    for at, name, symbol, colour in (
        (path.measured[begin], "start", "circle", style.GREEN),
        (path.measured[end], "end, measured", "x", style.GREY),
        (path.predicted[end], "end, model", "square", style.BLUE),
    ):
        edge = {"width": 1.5, "color": style.PAPER}
        marker = {"symbol": symbol, "size": 12, "color": colour, "line": edge}
        add_mark(figure, at, name, marker, group=name, shown=first)


def leg_errors_to_colour(comparison: Comparison) -> tuple[Floats, str]:
    """Error of each leg as drawn, and its unit; of headings if there are no positions."""
    errors = comparison.legs.errors
    if np.isfinite(errors.distance).any():
        return 1e3 * errors.distance, "mm"
    return np.degrees(np.abs(errors.error[:, 2])), "°"


def _legs(figure: Figure, comparison: Comparison, run: int | None) -> None:
    legs = comparison.legs
    size, unit = leg_errors_to_colour(comparison)
    kept = ~legs.outlier
    finite = size[kept & np.isfinite(size)]
    top = float(np.quantile(finite, 0.98)) if finite.size else 1.0
    mine = np.isfinite(size) & (kept if run is None else kept & (legs.run == run))
    rows = np.flatnonzero(mine)
    rows = rows[style.spread_and_extremes(size[rows])]
    # Small ones first, so that large ones are on top.
    rows = rows[np.argsort(size[rows])]
    texts = [_told(comparison, row) for row in rows.tolist()]
    middle = middles(comparison)[rows]
    marker: dict[str, object] = {
        "color": style.small(size[rows]),
        "coloraxis": "coloraxis",
        "size": style.small(8.0 + 8.0 * np.clip(size[rows] / max(top, 1e-9), 0.0, 1.0)),
        "line": {"width": 1, "color": style.PAPER},
    }
    style.plot(
        figure, *style.places(middle), shown=False, text=texts, hover="%{text}", marker=marker
    )
    # Only for the legend, where a marker with many colours is black and invisible on a dark page.
    marker = {"color": style.GREY, "size": 12}
    style.plot(figure, [None], [None], "leg, coloured by its error", marker=marker)
    style.coloured(figure, max(top, 1e-9), f"error of<br>a leg [{unit}]")


def _told(comparison: Comparison, row: int) -> str:
    """Hover text of a leg."""
    legs = comparison.legs
    error = legs.errors.error[row]
    promised = np.sqrt(np.diagonal(legs.errors.covariance[row]))
    name = style.escaped(comparison.runs[int(legs.run[row])].run.name)
    lines = [f"{name}, {leg_when(comparison, row)}", str(legs.errors.kind[row])]
    for (word, unit, scale), value, sigma in zip(CHANNELS, error, promised, strict=True):
        if np.isfinite(value):
            lines.append(f"{word} {scale * value:+.2f} {unit} (promised ± {scale * sigma:.2f})")
    return "<br>".join(lines)


def _ellipses(figure: Figure, comparison: Comparison, index: int) -> None:
    """95 % ellipses of the dead reckoning, at equal distances along the model's path."""
    path = comparison.paths[index]
    if not np.isfinite(path.measured).any():
        return
    places = path.predicted
    chosen = spread_along_path(places.real, places.imag, _ELLIPSES)
    covariance = covariance_along(comparison, index)[chosen]
    outlines = [
        np.append(ellipse(at.real, at.imag, shape, points=49), [[np.nan], [np.nan]], axis=1)
        for at, shape in zip(places[chosen].tolist(), covariance, strict=True)
    ]
    x, y = np.concatenate(outlines, axis=1)
    style.plot(
        figure,
        style.small(x),
        style.small(y),
        "where the truth should be (95 % ellipse)",
        line={"color": style.ORANGE, "width": 1.5},
        fill="toself",
        fillcolor=style.paled(style.ORANGE, 0.13),
    )
