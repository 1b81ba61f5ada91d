# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the covariance is honest: NEES by length of leg, beside what an honest one gives."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.report.comparison.channels import NAMES, measured_channels
from werrimbi_odom.report.style import BLUE, GREEN, GREY, INK, ORANGE, paled, plain

if TYPE_CHECKING:
    import plotly.graph_objects as go


def nees_figure(comparison: Comparison) -> go.Figure:
    """NEES by length of leg and type of motion, with the range that an honest one lies in."""
    import plotly.graph_objects as go
    from scipy.stats import chi2

    figure = go.Figure()
    free = len(measured_channels(comparison))
    lengths = [f"{item.leg:g} m" for item in comparison.lengths]
    looks = {
        "all": (INK, "diamond", None),
        "line": (BLUE, "circle", -0.24),
        "arc": (ORANGE, "square", 0.0),
        "spin": (GREEN, "triangle-up", 0.24),
    }
    drawn = False
    for kind, (colour, symbol, aside) in looks.items():
        if aside is None:
            continue
        at, values, low, high, texts = [], [], [], [], []
        for number, item in enumerate(comparison.lengths):
            found = item.by_motion[kind].figures
            if found.count < 2 or not np.isfinite(found.nees):
                continue
            degrees = free * found.count
            bounds = chi2.ppf([0.025, 0.975], degrees) / degrees
            at.append(number + aside)
            values.append(found.nees)
            low.append(float(bounds[0]))
            high.append(float(bounds[1]))
            texts.append(
                f"{NAMES[kind]}, legs of {item.leg:g} m: {found.count}<br>NEES {found.nees:.2f}, "
                f"honest within {bounds[0]:.2f} to {bounds[1]:.2f}"
                f"<br>{100.0 * found.coverage_95:.0f} % inside the 95 % ellipsoid"
            )
        if not at:
            continue
        x, y = _bars(at, low, high)
        figure.add_scatter(
            x=x,
            y=y,
            mode="lines",
            line={"color": paled(GREY, 0.45), "width": 16},
            name="where an honest covariance lies, 19 times in 20",
            legendgroup="bounds",
            showlegend=not drawn,
            hoverinfo="skip",
        )
        drawn = True
        figure.add_scatter(
            x=at,
            y=values,
            mode="markers",
            name=NAMES[kind],
            text=texts,
            hovertemplate="%{text}<extra></extra>",
            marker={"color": colour, "symbol": symbol, "size": 12},
        )
    figure.add_hline(y=1.0, line={"color": GREY, "width": 1.5, "dash": "dash"})
    figure.update_xaxes(
        title="length of the legs", tickvals=list(range(len(lengths))), ticktext=lengths
    )
    figure.update_yaxes(title="NEES (1 is honest)")
    plain(figure, height=430)
    ticks = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 1e4, 1e5]
    figure.update_yaxes(type="log", tickvals=ticks, ticktext=[f"{tick:g}" for tick in ticks])
    figure.update_xaxes(zeroline=False)
    return figure


def _bars(at: Sequence[float], low: Sequence[float], high: Sequence[float]) -> tuple[list, list]:  # type: ignore[type-arg]
    """Vertical strokes as one line with gaps."""
    x: list[float | None] = []
    y: list[float | None] = []
    for where, bottom, top in zip(at, low, high, strict=True):
        x += [where, where, None]
        y += [bottom, top, None]
    return x, y
