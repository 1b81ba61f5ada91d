# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where legs ended against where they should have: clouds of errors, along and sideways."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.style import MARKS, escaped, paled, plain, small, spread_and_extremes

if TYPE_CHECKING:
    import plotly.graph_objects as go


def clouds_of_legs(
    clouds: Iterable[tuple[str, Floats, str, str]], *, digits: int, height: int
) -> go.Figure:
    """A cloud for each model, with its median; equal scales.

    Parameters
    ----------
    clouds
        Name, errors along and sideways [m] of shape (m, 2) or more columns (NaN where not
        measured), colour and symbol.
    digits
        After the point, of millimetres.
    """
    import plotly.graph_objects as go

    figure = go.Figure()
    for name, errors, colour, symbol in clouds:
        known = 1e3 * errors[np.isfinite(errors[:, :2]).all(axis=1)]
        if known.size == 0:
            continue
        size = np.hypot(known[:, 0], known[:, 1])
        drawn = known[spread_and_extremes(size, MARKS // 2)]
        figure.add_scatter(
            x=small(drawn[:, 0]),
            y=small(drawn[:, 1]),
            mode="markers",
            name=f"{name}: median {np.median(size):.{digits}f} mm",
            marker={"color": paled(colour, 0.75), "symbol": symbol, "size": 8},
            hovertemplate=(
                f"{escaped(name)}<br>along %{{x:.{digits}f}} mm<br>sideways %{{y:.{digits}f}} mm"
                "<extra></extra>"
            ),
        )
    figure.update_xaxes(title="error along [mm]")
    figure.update_yaxes(title="error sideways [mm]", scaleanchor="x", scaleratio=1)
    return plain(figure, height=height)
