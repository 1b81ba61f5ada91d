# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of the legs before and after a calibration, as the robot sees them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.report.path_figure import Floats
from werrimbi_odom.report.style import BLUE, MARKS, ORANGE, plain, small, spread_and_extremes

if TYPE_CHECKING:
    import plotly.graph_objects as go


def leg_figure(before: Floats, after: Floats) -> go.Figure:
    """Measured minus predicted position at the end of each leg, along and sideways.

    Parameters
    ----------
    before, after : ndarray, shape (m, 2) or (m, 3)
        Errors in the frame of the robot at the leg's start [m]; NaN where not measured.
    """
    import plotly.graph_objects as go

    figure = go.Figure()
    for name, errors, colour, symbol in (
        ("before", before, ORANGE, "circle-open"),
        ("after", after, BLUE, "circle"),
    ):
        known = errors[np.isfinite(errors[:, :2]).all(axis=1)]
        size = 1e3 * np.hypot(known[:, 0], known[:, 1])
        drawn = 1e3 * known[spread_and_extremes(size, MARKS // 2)]
        figure.add_scatter(
            x=small(drawn[:, 0]),
            y=small(drawn[:, 1]),
            mode="markers",
            name=f"{name}: median {np.median(size):.1f} mm",
            marker={"color": colour, "symbol": symbol, "size": 7},
            opacity=0.7,
            hovertemplate=f"{name}<br>along %{{x:.1f}} mm<br>sideways %{{y:.1f}} mm<extra></extra>",
        )
    figure.update_xaxes(title="error along [mm]", zeroline=True)
    figure.update_yaxes(title="error sideways [mm]", zeroline=True, scaleanchor="x", scaleratio=1)
    return plain(figure, height=820)
