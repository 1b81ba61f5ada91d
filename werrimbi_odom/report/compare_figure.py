# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The legs on the floor where they were driven, larger and redder where the model errs more."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.compare import Comparison
from werrimbi_odom.report.style import BLUE, GREY, styled

if TYPE_CHECKING:
    import plotly.graph_objects as go

_POINTS = 4000  # of a path, that are drawn


def comparison_figure(comparison: Comparison) -> go.Figure:
    """Measured and dead-reckoned paths, and the error of each leg."""
    import plotly.graph_objects as go

    figure = go.Figure()
    for index, path in enumerate(comparison.paths):
        every = slice(None, None, max(1, path.measured.size // _POINTS))
        for name, places, colour, width in (
            ("measured", path.measured[every], GREY, 4),
            ("dead reckoning", path.predicted[every], BLUE, 1.5),
        ):
            figure.add_scatter(
                x=places.real,
                y=places.imag,
                mode="lines",
                name=name,
                legendgroup=name,
                showlegend=index == 0,
                line={"color": colour, "width": width},
                opacity=0.6,
                hoverinfo="skip",
            )
    legs = comparison.legs
    error = np.where(
        np.isfinite(legs.errors.distance), legs.errors.distance, np.abs(legs.errors.error[:, 2])
    )
    largest = float(np.nanquantile(error[~legs.outlier], 0.98)) if (~legs.outlier).any() else 1.0
    texts = [
        f"{comparison.runs[run].run.name}, {begin:.1f} to {end:.1f} s<br>{kind}: "
        f"along {1e3 * row[0]:.1f} mm, sideways {1e3 * row[1]:.1f} mm, "
        f"heading {np.degrees(row[2]):.2f}°"
        for run, begin, end, kind, row in zip(
            legs.run,
            legs.start_time,
            legs.end_time,
            legs.errors.kind,
            legs.errors.error,
            strict=True,
        )
    ]
    figure.add_scatter(
        x=0.5 * (legs.x + legs.end_x),
        y=0.5 * (legs.y + legs.end_y),
        mode="markers",
        name="leg, by its position error",
        text=texts,
        hovertemplate="%{text}<extra></extra>",
        marker={
            "color": 1e3 * error,
            "colorscale": "Inferno",
            "reversescale": True,
            "cmin": 0.0,
            "cmax": 1e3 * max(largest, 1e-6),
            "size": 6.0 + 10.0 * np.clip(np.nan_to_num(error) / max(largest, 1e-9), 0.0, 1.0),
            "colorbar": {"title": "error [mm]"},
            "line": {"width": 0.5, "color": "white"},
        },
    )
    figure.update_xaxes(title="x [m]", zeroline=False)
    figure.update_yaxes(title="y [m]", zeroline=False)
    count = int((~legs.outlier).sum())
    return styled(
        figure,
        "Where the model fails",
        f"{count} legs of {comparison.prepared.leg:g} m, where they were driven",
        width=1000,
        height=860,
    )
