# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Style of all figures: a palette for colour-blind readers, a legend, and limits on points.

Only the number of drawn points is reduced; statistics are of all data.
"""

from __future__ import annotations

import html
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from plotly.graph_objects import Figure as Figure
else:  # plotly is imported when a figure is drawn, because a robot may not have it
    Figure = Any

# Palette of Okabe and Ito.
BLUE, ORANGE, GREEN, GREY = "#0072B2", "#D55E00", "#009E73", "#6B6B6B"
INK, FAINT, PAPER = "#1B1F24", "#D9DCE0", "#FFFFFF"
"""Text, grid lines, and background in the light theme."""

IN_THE_DARK: Mapping[str, str] = {
    BLUE: "#56B4E9",
    ORANGE: "#F0904A",
    GREEN: "#3CC79B",
    GREY: "#A3A9B1",
    INK: "#E8EAED",
    FAINT: "#3A4048",
    PAPER: "#15181C",
}
"""Replacements of colours in the dark theme; pages replace them by name."""

KEPT_HERE: Mapping[str, object] = {"showSendToCloud": False, "plotlyServerURL": ""}
"""Settings that disable the upload of figures, which plotly offers from version 4 on."""

RISING = (
    (0.0, "#F3E9A6"),
    (0.2, "#E2C35C"),
    (0.4, "#C79A3E"),
    (0.6, "#9A6A4F"),
    (0.8, "#5D3F63"),
    (1.0, "#1B1145"),
)
"""Sequential colour scale with even steps of lightness, so that it is also legible in grey and with
any kind of colour blindness. Pages reverse it in the dark theme."""


def blank() -> Figure:
    """An empty figure."""
    from plotly.graph_objects import Figure as Blank

    return Blank()


def plot(
    figure: Figure,
    x: Any,
    y: Any,
    name: str | None = None,
    *,
    hover: str | None = "",
    group: str | None = None,
    shown: bool | None = None,
    **looks: Any,
) -> None:
    """Add lines (if `line` is given), marks (if `marker` is) or both.

    `name`, `group` and `shown` are for the legend. `hover` is the text shown by the pointer, a
    template of plotly's; "" for none, None for plotly's own.
    """
    mode = "+".join(f"{look}s" for look in ("line", "marker") if look in looks)
    shows = {"hovertemplate": hover if hover and "<extra>" in hover else f"{hover}<extra></extra>"}
    if not hover:
        shows = {} if hover is None else {"hoverinfo": "skip"}
    figure.add_scatter(
        x=x, y=y, mode=mode, name=name, legendgroup=group, showlegend=shown, **shows, **looks
    )


def apart(starts: Iterable[object], ends: Iterable[object]) -> list[object]:
    """A coordinate of separate lines, for `plot`: from each start to its end, then a gap."""
    return [each for line in zip(starts, ends, strict=True) for each in (*line, None)]


def error_bars(
    sizes: Any, colour: str, thickness: float = 2, width: float = 5
) -> dict[str, object]:
    """Error bars, for `error_y` of `plot`."""
    return {"array": sizes, "color": colour, "thickness": thickness, "width": width}


def from_above(
    figure: Figure, height: int, x: str = "x [m]", y: str = "y [m]", **axes: object
) -> Figure:
    """A figure of the floor for a page: equal scales on both axes."""
    figure.update_xaxes(title=x, **axes)
    figure.update_yaxes(title=y, scaleanchor="x", scaleratio=1, **axes)
    return plain(figure, height=height)


def coloured(figure: Figure, most: float, title: str, **bar: object) -> Figure:
    """Set the colour scale from zero to `most`, with a colour bar."""
    bar = {"title": {"text": title}, "thickness": 14, **bar}
    scale = [list(stop) for stop in RISING]
    return figure.update_layout(
        coloraxis={"colorscale": scale, "cmin": 0.0, "cmax": most, "colorbar": bar}
    )


def paled(colour: str, share: float) -> str:
    """A colour with an opacity from 0 to 1; pages still recognise it in the dark theme."""
    return f"{colour}{round(255 * share):02X}"


def styled(figure: Figure, title: str, subtitle: str, *, width: int, height: int) -> Figure:
    """Figure with heading, legend and size; equal scales on both axes."""
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


def plain(figure: Figure, *, height: int, legend: bool = True) -> Figure:
    """Figure for a page: without heading, with the width of its container, for both themes."""
    return _laid_out(figure, height=height, showlegend=legend)


_AXIS = {
    "gridcolor": FAINT,
    "linecolor": GREY,
    "zerolinecolor": GREY,
    "zerolinewidth": 1,
    "ticks": "outside",
    "tickcolor": GREY,
    "automargin": True,
}
_PLAIN: dict[str, Any] = {
    "template": "none",
    "font": {"size": 14, "color": INK, "family": "system-ui, 'Segoe UI', sans-serif"},
    "paper_bgcolor": PAPER,
    "plot_bgcolor": PAPER,
    "margin": {"l": 70, "r": 20, "t": 40, "b": 55},
    "autosize": True,
    "legend": {"orientation": "h", "x": 0.0, "y": 1.02, "yanchor": "bottom"},
    "hoverlabel": {"bgcolor": PAPER, "bordercolor": GREY, "font": {"color": INK, "size": 14}},
    "dragmode": "zoom",
    "modebar": {"color": GREY, "activecolor": BLUE, "bgcolor": "rgba(0,0,0,0)"},
}


def _laid_out(figure: Figure, **more: Any) -> Figure:
    """Lay a figure out as `_PLAIN`, with `more`.

    The layout is replaced as a whole: plotly's `update_layout`, which looks every key up again,
    takes ten times as long, and a report may have a hundred figures.
    """
    layout = figure.layout.to_plotly_json()
    layout.pop("template", None)
    layout = _merged(_merged(layout, _PLAIN), more)
    axes = (key for key in layout if key.rstrip("0123456789") in ("xaxis", "yaxis"))
    for key in {"xaxis", "yaxis", *axes}:
        layout[key] = _merged(layout.get(key, {}), _AXIS)
    for note in layout.get("annotations", ()):
        note["font"] = {**note.get("font", {}), "color": INK, "size": 14}
    figure.layout = layout
    return figure


def _merged(one: Mapping[str, Any], other: Mapping[str, Any]) -> dict[str, Any]:
    """Nested dictionaries as one; what `other` has is taken."""
    return {
        **one,
        **{
            key: _merged(one[key], value)
            if isinstance(value, Mapping) and isinstance(one.get(key), Mapping)
            else value
            for key, value in other.items()
        },
    }


def escaped(text: str) -> str:
    """A name from a record, escaped for a figure's texts, which interpret some HTML."""
    return html.escape(text, quote=False)


MOST = 4000
"""Approximate limit of points in the lines of a figure."""

MARKS = 1000
"""Limit of marks in a figure: each is an element of the page and costs more than a point."""

FEWEST = 20
"""Least number of points of one of many lines, so that its shape remains."""


def along_path(places: NDArray[np.complex128], most: int = MOST) -> NDArray[np.intp]:
    """Indices of points of a path (x + iy) at about equal distances, with all ends and gaps.

    Equal times would waste points while the robot stands still.
    """
    if places.size <= most:
        return np.arange(places.size)
    step = np.abs(np.diff(places))
    length = np.concatenate([[0.0], np.cumsum(np.nan_to_num(step))])
    wanted = np.linspace(0.0, length[-1], most)
    gaps = np.flatnonzero(~np.isfinite(places))
    edges = gaps[np.concatenate([[True], np.diff(gaps) > 1])] if gaps.size else gaps
    kept = np.concatenate([[0], np.searchsorted(length, wanted), edges, [places.size - 1]])
    return np.unique(np.minimum(kept, places.size - 1)).astype(np.intp)


def spread_and_extremes(values: NDArray[np.float64], most: int = MARKS) -> NDArray[np.intp]:
    """Indices of rows to draw: the largest absolute values, and an even selection of the rest."""
    if values.size <= most:
        return np.arange(values.size)
    size = np.nan_to_num(np.abs(values))
    largest = np.argpartition(size, -most // 4)[-most // 4 :]
    every = np.linspace(0, values.size - 1, most - largest.size).round().astype(np.intp)
    return np.unique(np.concatenate([largest, every])).astype(np.intp)


def places(at: NDArray[np.complex128]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Places x + iy, apart and in single precision."""
    return small(at.real), small(at.imag)


def small(values: NDArray[np.float64]) -> NDArray[np.float32]:
    """Values for drawing in single precision, which halves the size of the file."""
    return np.asarray(values, dtype=np.float32)


def over(figure: Figure, variable: str, error: str, height: int, *, turn: bool) -> Figure:
    """Axes with a line at zero; with `turn`, an axis of one turn in degrees."""
    zero = {
        "type": "line",
        "x0": 0,
        "x1": 1,
        "xref": "x domain",
        "y0": 0.0,
        "y1": 0.0,
        "yref": "y",
        "line": {"color": GREY, "width": 1},
    }
    one_turn = {"dtick": 45, "range": [0, 360]} if turn else {}
    return _laid_out(
        figure,
        height=height,
        showlegend=True,
        shapes=[*figure.layout.to_plotly_json().get("shapes", ()), zero],
        xaxis={"title": {"text": variable}, **one_turn},
        yaxis={"title": {"text": error}},
    )
