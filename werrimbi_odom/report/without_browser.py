# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Lines, marks and bars of a plotly figure drawn by matplotlib, where there is no browser.

plotly itself draws pictures by a browser alone. Heat maps and the like are left to it.
"""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import plotly.graph_objects as go

_DASHES = {"dash": "--", "dot": ":", "dashdot": "-."}
_MARKS = {"circle": "o", "square": "s", "x": "x", "diamond": "D"}
_INCH = 100.0
"""Pixels of plotly's sizes."""


def save_simple_png(figure: go.Figure, path: Path) -> bool:
    """A PNG; False, and nothing written, where matplotlib is not installed."""
    if find_spec("matplotlib") is None:
        return False
    from matplotlib.figure import Figure

    layout = figure.layout
    size = (float(layout.width or 1000) / _INCH, float(layout.height or 600) / _INCH)
    canvas = Figure(figsize=size, layout="constrained")
    axes = canvas.add_subplot()
    bars = [trace for trace in figure.data if trace.type == "bar"]
    for number, trace in enumerate(bars):
        _bars(axes, trace, number, len(bars))
    for trace in figure.data:
        if trace.type == "scatter":
            _scatter(axes, trace)
    for shape in layout.shapes:
        if shape.type == "line" and shape.y0 == shape.y1:  # plotly's add_hline
            axes.axhline(shape.y0, **_line(shape.line))
    axes.set_xlabel(_said(layout.xaxis.title.text))
    axes.set_ylabel(_said(layout.yaxis.title.text))
    axes.set_title(_said(layout.title.text), loc="left")
    if layout.yaxis.range:
        axes.set_ylim(layout.yaxis.range)
    if layout.yaxis.scaleanchor:
        axes.set_aspect("equal", adjustable="datalim")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    canvas.legend(loc="outside lower left", ncols=3, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path, dpi=150)
    return True


def _bars(axes: Any, trace: Any, number: int, count: int) -> None:
    """One of `count` bars at each name."""
    width = 0.65 / count
    places = np.arange(len(trace.x)) + (number - 0.5 * (count - 1)) * width
    drawn = axes.bar(places, trace.y, width, color=trace.marker.color, label=trace.name)
    if trace.text is not None:
        axes.bar_label(drawn, trace.text, label_type="center", color=trace.textfont.color)
    axes.set_xticks(np.arange(len(trace.x)), [_said(name) for name in trace.x])


def _scatter(axes: Any, trace: Any) -> None:
    """A line, an area or marks; in the legend unless plotly leaves it out."""
    label = trace.name if trace.showlegend is not False else None
    x, y = (
        np.array([np.nan if value is None else value for value in part], dtype=np.float64)
        for part in (trace.x, trace.y)
    )
    if trace.fill == "toself":
        axes.fill(x, y, color=trace.line.color, alpha=0.16, label=label, linewidth=0)
        axes.plot(x, y, **_line(trace.line))
        return
    look: dict[str, Any] = {"alpha": trace.opacity, "label": label}
    if "lines" in (trace.mode or "lines"):
        look |= _line(trace.line)
    else:
        look |= {"linestyle": "none", "color": trace.marker.color}
    if "markers" in (trace.mode or ""):
        look |= {"marker": _MARKS.get(trace.marker.symbol, "o"), "color": trace.marker.color}
    axes.plot(x, y, **look)


def _line(line: Any) -> dict[str, Any]:
    return {
        "color": line.color,
        "linewidth": 0.7 * (line.width or 2.0),
        "linestyle": _DASHES.get(line.dash, "-"),
    }


def _said(text: str | None) -> str:
    """Text without plotly's marks."""
    plain = re.sub(r"<[^>]*>", "", (text or "").replace("<br>", "\n"))
    return plain.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&")
