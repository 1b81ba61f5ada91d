# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Error of one wheel's travel over its own turn, from the reference's shortest intervals.

A leg of a metre holds several turns of a wheel, so legs say nothing of them. The counters of each
run may start anywhere, so each run is a line of its own: an eccentric wheel shows the same sine in
all of them, begun at different angles.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.style import BLUE, GREEN, GREY, ORANGE, escaped, paled, plain, small

if TYPE_CHECKING:
    import plotly.graph_objects as go

WHEEL_ANGLES = ("left wheel's angle [°]", "right wheel's angle [°]")

_PARTS = 16
_MOST_RUNS = 6
_FEWEST = 6  # parts of a turn, that a wave is laid through
_FINE = np.linspace(0.0, 360.0, 91)
_LOOKS = (
    (BLUE, "solid", "circle"),
    (ORANGE, "solid", "square"),
    (GREEN, "solid", "triangle-up"),
    (GREY, "solid", "diamond"),
    (BLUE, "dash", "x"),
    (ORANGE, "dash", "cross"),
)


def wheel_errors(comparison: Comparison, index: int, side: int) -> tuple[Floats, Floats, Floats]:
    """Wheel's angle [rad], its error [m] and its travel [m] in each reference interval of a run.

    Parameters
    ----------
    side : int
        -1 for the left wheel, +1 for the right one.
    """
    group = next(item for item in comparison.prepared.groups if index in item.index)
    own = group.index.index(index)
    every, path = group.every, comparison.paths[index]
    robot = comparison.model.of_run(index)
    travel, drive = every.raw(robot), every.drive(robot)
    legs = slice(every.legs[own], every.legs[own + 1])
    begin, end = every.begin[legs], every.end[legs]
    angle = drive.left_angle if side < 0 else drive.right_angle
    rolled = travel.left if side < 0 else travel.right
    sums = np.concatenate([[0.0], np.cumsum(rolled)])
    last = np.maximum(end, begin + 1) - 1
    middle = 0.5 * (angle.start[begin] + angle.end[last])
    along, turned = path.intervals[:, 0], path.intervals[:, 2]
    return middle, along + side * 0.5 * robot.track * turned, sums[end] - sums[begin]


def wheel_angle_figure(comparison: Comparison, variable: str) -> go.Figure:
    """Error of a wheel's travel, in mm for each metre rolled, over its turn; a wave a run."""
    import plotly.graph_objects as go

    side = -1 if variable == WHEEL_ANGLES[0] else 1
    word = "left" if side < 0 else "right"
    figure = go.Figure()
    longest = sorted(
        range(len(comparison.runs)), key=lambda index: -comparison.runs[index].distance_m
    )[:_MOST_RUNS]
    for index, (colour, dash, symbol) in zip(sorted(longest), _LOOKS, strict=False):
        centre, mean, spread = over_a_turn(*wheel_errors(comparison, index, side))
        if np.isfinite(mean).sum() < _FEWEST:
            continue
        amplitude, std, wave = once_a_turn(centre, mean, spread)
        name = escaped(comparison.runs[index].run.name)
        figure.add_scatter(
            x=centre,
            y=mean,
            mode="markers",
            legendgroup=name,
            showlegend=False,
            marker={"symbol": symbol, "size": 8, "color": paled(colour, 0.6)},
            error_y={
                "array": 2.0 * spread,
                "color": paled(colour, 0.3),
                "thickness": 1,
                "width": 0,
            },
            hovertemplate=(
                f"{name}<br>%{{x:.0f}}°: %{{y:+.2f}} ± %{{error_y.array:.2f}} mm per m"
                "<extra></extra>"
            ),
        )
        figure.add_scatter(
            x=small(_FINE),
            y=small(wave),
            mode="lines",
            name=f"{name}: once a turn {amplitude:.1f} ± {std:.1f}",
            legendgroup=name,
            line={"color": colour, "dash": dash, "width": 2.5},
            hoverinfo="skip",
        )
    if not figure.data:
        figure.add_annotation(
            text="The reference measures no headings and positions this often.",
            showarrow=False,
            x=0.5,
            y=0.5,
            xref="paper",
            yref="paper",
        )
    figure.add_hline(y=0.0, line={"color": GREY, "width": 1})
    figure.update_xaxes(title=f"angle of the {word} wheel [°]", dtick=45, range=[0, 360])
    figure.update_yaxes(title=f"error of the {word} wheel's travel [mm per m]")
    return plain(figure, height=480)


def over_a_turn(angle: Floats, error: Floats, travel: Floats) -> tuple[Floats, Floats, Floats]:
    """Centres [°], error per travel and its standard error [mm/m] in equal parts of a turn."""
    known = np.isfinite(error) & (np.abs(travel) > 0.0)
    part = np.floor(np.mod(angle, 2.0 * np.pi) / (2.0 * np.pi) * _PARTS).astype(int) % _PARTS
    mean, spread = np.full(_PARTS, np.nan), np.full(_PARTS, np.nan)
    for number in range(_PARTS):
        mine = known & (part == number)
        weight = travel[mine]
        total = float(np.sum(weight**2))
        if mine.sum() < 8 or total <= 0.0:
            continue
        slope = float(np.sum(weight * error[mine]) / total)
        left = error[mine] - slope * weight
        mean[number] = 1e3 * slope
        spread[number] = 1e3 * float(np.sqrt(np.sum((weight * left) ** 2)) / total)
    return (np.arange(_PARTS) + 0.5) * 360.0 / _PARTS, mean, spread


def once_a_turn(centre: Floats, mean: Floats, spread: Floats) -> tuple[float, float, Floats]:
    """Amplitude and standard error of the wave that suits the parts best, and the wave itself.

    A mean is taken off with it: that is calibration.
    """
    known = np.isfinite(mean) & (spread > 0.0)
    terms = _terms(centre[known]) / spread[known, None]
    inverse = np.linalg.pinv(terms.T @ terms, hermitian=True)
    values = inverse @ (terms.T @ (mean[known] / spread[known]))
    std = float(np.sqrt(0.5 * (inverse[1, 1] + inverse[2, 2])))
    return float(np.hypot(values[1], values[2])), std, _terms(_FINE) @ values


def _terms(degrees: Floats) -> Floats:
    angle = np.radians(degrees)
    return np.stack([np.ones_like(angle), np.cos(angle), np.sin(angle)], axis=-1)
