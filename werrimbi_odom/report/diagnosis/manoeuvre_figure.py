# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A manoeuvre drawn to scale: the tracks of both wheels, and the robot where it starts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from werrimbi_odom.inference.manoeuvres.drives import MANOEUVRES, Ideal, Pace, ideal_run
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.style import BLUE, GREEN, GREY, INK, ORANGE, paled, plain, small

if TYPE_CHECKING:
    import plotly.graph_objects as go

_TICK = 0.05  # [s]
_ARROWS = 10


def ideal_of(name: str) -> Ideal | None:
    """The manoeuvre of a name; None for what is no drive (a marker to be remounted)."""
    return next((item for item in MANOEUVRES if item.name == name), None)


def manoeuvre_figure(ideal: Ideal, robot: Robot, pace: Pace) -> go.Figure:
    """Where the wheels roll, for a robot of this size that drives as this one did.

    Parameters
    ----------
    robot : Robot
        Gives the base; its effects are left aside.
    """
    import plotly.graph_objects as go

    robot = replace(robot, effects=())
    run = ideal_run(ideal, robot, pace, ticks=_TICK, poses=_TICK, measures=(True, True))
    reference = run.reference
    assert reference is not None
    place = reference.x + 1j * reference.y
    yaw = np.unwrap(reference.yaw)
    time = reference.time
    half = 0.5 * robot.track
    figure = go.Figure()
    for side, colour, name in ((1.0, BLUE, "left wheel"), (-1.0, ORANGE, "right wheel")):
        track = place + side * half * 1j * np.exp(1j * yaw)
        figure.add_scatter(
            x=small(track.real),
            y=small(track.imag),
            mode="lines",
            name=f"track of the {name}",
            line={"color": paled(colour, 0.75), "width": 2},
            customdata=small(time),
            hovertemplate=(
                f"{name}<br>x %{{x:.2f}} m, y %{{y:.2f}} m<br>after %{{customdata:.0f}} s"
                "<extra></extra>"
            ),
        )
    _arrows(figure, place, yaw, half)
    _robot(figure, half)
    figure.update_xaxes(title="x [m]")
    figure.update_yaxes(title="y [m]", scaleanchor="x", scaleratio=1)
    return plain(figure, height=480)


def _arrows(figure: go.Figure, place: np.ndarray, yaw: Floats, half: float) -> None:
    """Heads along the way, pointing where the robot goes (backwards too)."""
    moved = np.abs(np.diff(place))
    length = np.concatenate([[0.0], np.cumsum(moved)])
    if length[-1] < half:
        return
    wanted = (np.arange(_ARROWS) + 0.5) / _ARROWS * length[-1]
    at = np.clip(np.searchsorted(length, wanted), 1, place.size - 1)
    course = np.degrees(np.angle(place[at] - place[at - 1]))
    figure.add_scatter(
        x=small(place[at].real),
        y=small(place[at].imag),
        mode="markers",
        name="way of the robot",
        marker={
            "symbol": "arrow",
            "size": 13,
            "angle": (90.0 - course).tolist(),
            "color": GREEN,
        },
        hoverinfo="skip",
    )


def _robot(figure: go.Figure, half: float) -> None:
    """Outline at the start, facing x: body, wheels, nose."""
    body = half * np.array(
        [-1.3 - 0.85j, 1.0 - 0.85j, 1.5 + 0j, 1.0 + 0.85j, -1.3 + 0.85j, -1.3 - 0.85j]
    )
    parts: list[np.ndarray] = [body]
    for side in (1.0, -1.0):
        parts.append(
            half
            * (
                np.array([-0.5, 0.5, 0.5, -0.5, -0.5])
                + 1j * side
                + 0.12j * np.array([-1, -1, 1, 1, -1])
            )
        )
    gap = np.array([np.nan + 0j])
    line = np.concatenate([piece for part in parts for piece in (part, gap)])
    figure.add_scatter(
        x=small(line.real),
        y=small(line.imag),
        mode="lines",
        name="the robot at the start, to scale",
        line={"color": INK, "width": 2},
        fill="toself",
        fillcolor=paled(GREY, 0.25),
        hoverinfo="skip",
    )
