# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a comparison: by type of motion, against the covariance, against a variable."""

from __future__ import annotations

from typing import Any

import numpy as np

from werrimbi_odom.inference.comparison.compare import KINDS, Comparison
from werrimbi_odom.inference.distributions import NORMAL_95
from werrimbi_odom.report import style
from werrimbi_odom.report.comparison.phrases import length_of
from werrimbi_odom.report.style import Figure

NAMES = {"line": "straight", "arc": "curves", "spin": "spins"}
CHANNELS = (("along", "mm", 1e3), ("sideways", "mm", 1e3), ("heading", "°", float(np.degrees(1.0))))
"""Name, unit and conversion factor of each column of the leg errors."""


def measured_channels(comparison: Comparison) -> list[int]:
    """Columns of the errors with any measurement."""
    return [
        column for column in range(3) if np.isfinite(comparison.legs.errors.error[:, column]).any()
    ]


def nees_figure(comparison: Comparison) -> Figure:
    """NEES by leg length and type of motion, with the 95 % range of a consistent covariance."""
    from scipy.stats import chi2

    figure = style.blank()
    free = len(measured_channels(comparison))
    lengths = [length_of(item) for item in comparison.lengths]
    looks = {
        "line": (style.BLUE, "circle", -0.24),
        "arc": (style.ORANGE, "square", 0.0),
        "spin": (style.GREEN, "triangle-up", 0.24),
    }
    drawn = False
    for kind, (colour, symbol, aside) in looks.items():
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
                f"{NAMES[kind]}, legs of {lengths[number]}: {found.count}"
                f"<br>NEES {found.nees:.2f}, honest within {bounds[0]:.2f} to {bounds[1]:.2f}"
                f"<br>{100.0 * found.coverage_95:.0f} % inside the 95 % ellipsoid"
            )
        if not at:
            continue
        bar = {"color": style.paled(style.GREY, 0.45), "width": 16}
        words = "where an honest covariance lies, 19 times in 20"
        x, y = style.apart(at, at), style.apart(low, high)
        style.plot(figure, x, y, words, group="bounds", shown=not drawn, line=bar)
        drawn = True
        marker = {"color": colour, "symbol": symbol, "size": 12}
        style.plot(figure, at, values, NAMES[kind], hover="%{text}", text=texts, marker=marker)
    figure.add_hline(y=1.0, line={"color": style.GREY, "width": 1.5, "dash": "dash"})
    figure.update_xaxes(
        title="length of the legs", tickvals=list(range(len(lengths))), ticktext=lengths
    )
    figure.update_yaxes(title="NEES (1 is honest)")
    style.plain(figure, height=430)
    ticks = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1e3, 1e4, 1e5]
    figure.update_yaxes(type="log", tickvals=ticks, ticktext=[f"{tick:g}" for tick in ticks])
    figure.update_xaxes(zeroline=False)
    return figure


def legs_by_motion_figure(comparison: Comparison) -> Figure:
    """Leg errors by type of motion, next to the range that the covariance predicts."""
    from plotly.subplots import make_subplots

    legs = comparison.legs
    kept = ~legs.outlier
    columns = measured_channels(comparison)
    titles = [f"{CHANNELS[column][0]} [{CHANNELS[column][1]}]" for column in columns]
    figure = make_subplots(
        rows=1, cols=len(columns), subplot_titles=titles, horizontal_spacing=0.09
    )
    for place, column in enumerate(columns, start=1):
        name, unit, factor = CHANNELS[column]
        at: dict[str, Any] = {"row": 1, "col": place}
        for kind in KINDS:
            mine = kept & (legs.errors.kind == kind)
            values = factor * legs.errors.error[mine, column]
            values = values[np.isfinite(values)]
            if values.size == 0:
                continue
            sigma = legs.errors.covariance[mine, column, column]
            promised = NORMAL_95 * factor * float(np.sqrt(np.mean(sigma)))
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
                line={"color": style.BLUE, "width": 2},
                fillcolor=style.paled(style.BLUE, 0.25),
                width=0.38,
                hoverinfo="skip",
                **at,
            )
            style.plot(
                figure,
                [NAMES[kind]],
                [middle],
                hover=f"{NAMES[kind]}, {name}: {values.size} legs"
                f"<br>mean {values.mean():+.2f} {unit}"
                f"<br>95 % of them {low:+.2f} to {high:+.2f} {unit}"
                f"<br>promised ± {promised:.2f} {unit}",
                shown=False,
                marker={"color": style.BLUE, "size": 14, "opacity": 0.0},
                **at,
            )
    figure.update_xaxes(categoryorder="array", categoryarray=list(NAMES.values()))
    figure.update_yaxes(zeroline=True)
    return style.plain(figure, height=430).update_layout(
        margin={"t": 90}, legend={"y": 1.13}, boxmode="overlay", barmode="overlay"
    )


def _first_kind(comparison: Comparison) -> str:
    kinds = comparison.legs.errors.kind[~comparison.legs.outlier]
    return next((kind for kind in KINDS if (kinds == kind).any()), "")


def _promise(
    figure: Figure, name: str, promised: float, unit: str, place: int, *, first: bool
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
            "color": style.paled(style.GREY, 0.18),
            "line": {"color": style.GREY, "width": 1},
            "pattern": {"shape": "/", "fgcolor": style.paled(style.GREY, 0.5), "size": 7},
        },
        hovertemplate=f"promised ± {promised:.2f} {unit}<extra></extra>",
        row=1,
        col=place,
    )
