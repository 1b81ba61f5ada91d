# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a calibration: its words, its figure, and the written parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from werrimbi_odom.inference.calibration.squares import Squares, e_max_syst
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report.adding.document import clouds_of_legs
from werrimbi_odom.report.document import Document, Part, Shown, Table
from werrimbi_odom.report.html_page import table_html
from werrimbi_odom.report.path_figure import ellipse
from werrimbi_odom.report.style import BLUE, GREY, ORANGE, Figure, blank, from_above, plain, plot


def calibration_document(
    title: str,
    words: Sequence[Part],
    heading: str,
    see: str,
    figure: Callable[[], Figure],
    changes: Mapping[str, tuple[float, float]],
) -> Document:
    """A document with one figure, which has a heading and says what to see in it.

    `changes` are the written parameters by name, before and after.
    """
    rows = [[name, f"{before:.6g}", f"{after:.6g}"] for name, (before, after) in changes.items()]
    table = Table("", ("parameter", "before", "after"), rows)
    says = "The parameters that the calibration moved."
    written = Shown("written", "Written to the robot file", says, html=table_html(table))

    def draw() -> list[Shown]:
        return [Shown("figure", heading, see, {"": figure()}), *([written] if rows else [])]

    return Document(title=title, words=words, draw=draw)


_MILLI = 1e3


def umbmark_figure(before: Squares, after: Squares | None, name: str) -> Figure:
    """Offsets of clockwise and anticlockwise squares with their centres of gravity (figure 3).

    Circles of radius E_max,syst go through the farther centre of each set. Equal scales. `name`:
    of what comes after.
    """
    figure = blank()
    clouds = [("before", before, True)] + ([(name, after, False)] if after else [])
    for name, cloud, filled in clouds:
        _circle(figure, name, cloud, "dash" if filled else "dot")
    for name, cloud, filled in clouds:
        for sense, offsets, colour, symbol in (
            ("cw", cloud.cw, BLUE, "square"),
            ("ccw", cloud.ccw, ORANGE, "circle"),
        ):
            _offsets(figure, f"{sense}, {name}", offsets, colour, symbol, filled)
    cross = {"symbol": "x", "size": 13, "color": GREY}
    plot(figure, [None], [None], "centres of gravity", hover=None, marker=cross)
    x, y = "x, along the first leg [mm]", "y, to its left [mm]"
    return from_above(figure, 760, x, y, zeroline=True)


def _offsets(
    figure: Figure, name: str, offsets: Floats, colour: str, symbol: str, filled: bool
) -> None:
    x, y = _MILLI * offsets.T
    place = "<br>x %{x:.1f} mm<br>y %{y:.1f} mm"
    marker: dict[str, object] = {
        "symbol": symbol if filled else f"{symbol}-open",
        "size": 10,
        "color": colour,
        "opacity": 0.55 if filled else 1.0,
        "line": {"width": 0.0 if filled else 1.8, "color": colour},
    }
    plot(figure, x, y, name, group=name, marker=marker, hover=f"{name}{place}")
    marker = {"symbol": "x", "size": 14, "color": colour, "line": {"width": 1, "color": "white"}}
    centre, told = "centre of gravity", f"{name}: centre of gravity{place}"
    at = [float(x.mean())], [float(y.mean())]
    plot(figure, *at, centre, group=name, shown=False, marker=marker, hover=told)


def _circle(figure: Figure, name: str, cloud: Squares, dash: str) -> None:
    radius = _MILLI * e_max_syst(cloud)
    angle = np.linspace(0.0, 2.0 * np.pi, 145)
    name = f"E<sub>max,syst</sub> {name}: {radius:.{1 if radius < 10.0 else 0}f} mm"
    line = {"color": GREY, "width": 1.3, "dash": dash}
    plot(figure, radius * np.cos(angle), radius * np.sin(angle), name, line=line)


def noise_figure(errors: Floats, data: Floats, model: Floats) -> Figure:
    """Errors of repeated drives with the 95 % ellipses of data and model (figures 4 a to c).

    `errors` are x, y [m], yaw [rad], shape (n, 3). Both ellipses, of covariances of shape (3, 3),
    are centred at the mean of the runs.
    """
    from plotly.subplots import make_subplots

    axes = (("x", "mm"), ("y", "mm"), ("yaw", "mrad"))
    panels = ((0, 1), (0, 2), (1, 2))
    figure = make_subplots(rows=1, cols=3, horizontal_spacing=0.075)
    scaled = _MILLI * errors
    for column, (across, up) in enumerate(panels, start=1):
        first = column == 1
        at: dict[str, Any] = {"row": 1, "col": column}
        marker, name = {"color": GREY, "size": 6, "opacity": 0.7}, f"{len(errors)} runs"
        runs = scaled[:, across], scaled[:, up]
        plot(figure, *runs, name, group="runs", shown=first, hover=None, marker=marker, **at)
        for name, covariance, colour, dash in (
            ("95 % ellipse of the runs", data, BLUE, "dash"),
            ("95 % ellipse of the model", model, ORANGE, "solid"),
        ):
            shape = _MILLI**2 * covariance[np.ix_((across, up), (across, up))]
            middle = float(runs[0].mean()), float(runs[1].mean())
            x, y = ellipse(*middle, shape, points=145)
            line = {"color": colour, "width": 2.2, "dash": dash}
            plot(figure, x, y, name, group=name, shown=first, line=line, **at)
        titles = [f"e<sub>{name}</sub> [{unit}]" for name, unit in (axes[across], axes[up])]
        figure.update_xaxes(title=titles[0], zeroline=True, **at)
        figure.update_yaxes(title=titles[1], title_standoff=4, zeroline=True, **at)
    return plain(figure, height=560)


def leg_figure(before: Floats, after: Floats) -> Figure:
    """Measured minus predicted position at the end of each leg, before and after.

    Errors in the frame of the robot at the leg's start [m], shape (m, 2) or (m, 3); NaN where not
    measured.
    """
    looks = (("before", before, ORANGE, "circle-open"), ("after", after, BLUE, "circle"))
    return clouds_of_legs(looks, digits=1, height=820)
