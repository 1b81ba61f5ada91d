# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Events on the measured paths, and along the time of each drive."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.events.events import Event, Events, Way
from werrimbi_odom.report.events import either, event_words, when
from werrimbi_odom.report.path_figure import add_path
from werrimbi_odom.report.style import (
    BLUE,
    GREEN,
    GREY,
    MOST,
    ORANGE,
    PAPER,
    along_path,
    escaped,
    paled,
    plain,
    small,
)

if TYPE_CHECKING:
    import plotly.graph_objects as go

_LOOKS = {
    "along": ("along", ORANGE, "square"),
    "sideways": ("sideways", BLUE, "diamond"),
    "heading": ("heading", GREEN, "circle"),
    "reference": ("the reference jumped", GREY, "x"),
}
_DRIVE = 30  # height of a drive's line [pixels]


def on_the_path(happened: Events, track: float) -> go.Figure | None:
    """Where events happened; None where the reference saw no place."""
    import plotly.graph_objects as go

    seen = [way for way in happened.ways if np.isfinite(way.x).any()]
    if not seen:
        return None
    figure = go.Figure()
    for number, way in enumerate(seen):
        rows = along_path(way.x + 1j * way.y, max(MOST // len(seen), 200))
        add_path(
            figure,
            small(way.x[rows]),
            small(way.y[rows]),
            "measured",
            {"color": paled(GREY, 0.5), "width": 3},
            said=escaped(_name(way)),
            legendgroup="measured",
            showlegend=number == 0,
        )
    _marks(figure, happened, track, [event.place for event in happened.events])
    figure.update_xaxes(title="x [m]", zeroline=False)
    figure.update_yaxes(title="y [m]", zeroline=False, scaleanchor="x", scaleratio=1)
    return plain(figure, height=620)


def over_time(happened: Events, track: float) -> go.Figure:
    """When events happened, drive by drive."""
    import plotly.graph_objects as go

    figure = go.Figure()
    starts = {}
    for way in happened.ways:
        name = escaped(_name(way))
        starts[(way.run, way.held_out)] = (name, float(way.time[0]))
        figure.add_scatter(
            x=[0.0, float(way.time[-1] - way.time[0])],
            y=[name, name],
            mode="lines",
            line={"color": paled(GREY, 0.5), "width": 3},
            showlegend=False,
            hoverinfo="skip",
        )
    places = []
    for event in happened.events:
        name, start = starts[(event.run, event.held_out)]
        places.append((event.seen - start, name))
    _marks(figure, happened, track, places)
    figure.update_xaxes(title="time since the drive's first pose [s]", zeroline=False)
    figure.update_yaxes(autorange="reversed", showgrid=False)
    return plain(figure, height=140 + _DRIVE * len(happened.ways))


def _marks(
    figure: go.Figure,
    happened: Events,
    track: float,
    places: list[tuple[float, float]] | list[tuple[float, str]],
) -> None:
    for channel, (words, colour, symbol) in _LOOKS.items():
        own = [index for index, event in enumerate(happened.events) if event.channel == channel]
        if not own:
            continue
        figure.add_scatter(
            x=[places[index][0] for index in own],
            y=[places[index][1] for index in own],
            mode="markers",
            name=words,
            marker={
                "color": colour,
                "symbol": symbol,
                "size": 12,
                "line": {"color": PAPER, "width": 1.5},
            },
            hovertext=[_said(happened, happened.events[index], track) for index in own],
            hovertemplate="%{hovertext}<extra></extra>",
        )


def _said(happened: Events, event: Event, track: float) -> str:
    where = f"{escaped(event.run.name)}, {when(event)}"
    return f"{where}<br>{escaped(event_words(event, track, either=either(happened)))}"


def _name(way: Way) -> str:
    return f"{way.run.name} (held out)" if way.held_out else way.run.name
