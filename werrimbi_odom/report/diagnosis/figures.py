# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of a diagnosis: the ranking with the gain of each effect, and set-up mistakes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.ranking import Ranked
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.prediction import predicted_legs, right_handed
from werrimbi_odom.inference.manoeuvres.ideal_drives import DrivingLimits, ideal_run
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES, Ideal
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report import style
from werrimbi_odom.report.number_format import error_words, p_words
from werrimbi_odom.report.style import Figure

_MOST_BARS = 10
_PER_EFFECT = 52  # height of its two bars and the gap [pixels]
_GAP = 0.3
_WORST = -60.0  # lower limit of the axis; longer bars are cut off [%]


def ranking_figure(diagnosis: Diagnosis) -> Figure:
    """Reduction of the leg errors by each fitted effect, in descending order.

    Filled bars are for the held-out drives, outlined ones for the drives of the fit.
    """
    ranked = [item for item in diagnosis.ranking if item.holdout or item.train][:_MOST_BARS]
    figure = style.blank()
    names = [_label(item, diagnosis) for item in ranked]
    for word, side, look in (
        (
            "drives of the fit",
            "train",
            {"color": style.paled(style.GREY, 0.25), "line": {"color": style.GREY, "width": 1.5}},
        ),
        ("held-out drives", "holdout", {"color": [_colour(item, diagnosis) for item in ranked]}),
    ):
        sides: list[Sides | None] = [getattr(item, side) for item in ranked]
        gains = [_gain(each) for each in sides]
        figure.add_bar(
            y=names,
            x=gains,
            orientation="h",
            name=word,
            marker=look,
            text=[
                _text(each) if side == "holdout" and gain >= 0.0 else ""
                for each, gain in zip(sides, gains, strict=True)
            ],
            textposition="outside",
            cliponaxis=False,
            customdata=[item.effect for item in ranked],
            hovertext=[
                f"{item.effect}, {word}: {_text(each)}<br>chance: {p_words(item.p_value)}"
                for item, each in zip(ranked, sides, strict=True)
            ],
            hovertemplate="%{hovertext}<extra></extra>",
        )
    finite = [
        gain
        for item in ranked
        for gain in (_gain(item.holdout), _gain(item.train))
        if np.isfinite(gain)
    ]
    low, high = max(min([0.0, *finite]), _WORST), max([5.0, *finite])
    figure.update_xaxes(
        title="error lowered by [%]", range=[1.05 * low, high + 0.35 * (high - low)]
    )
    figure.update_yaxes(autorange="reversed", showgrid=False)
    for name, item in zip(names, ranked, strict=True):
        if _gain(item.holdout) < 0.0:  # left of the bar its text would overlap the names
            figure.add_annotation(
                text=_text(item.holdout),
                x=0.0,
                y=name,
                xanchor="left",
                yshift=-0.25 * _PER_EFFECT * (1.0 - _GAP),
                showarrow=False,
            )
    style.plain(figure, height=130 + _PER_EFFECT * max(len(ranked), 2))
    return figure.update_layout(barmode="group", bargap=_GAP)


def _label(item: Ranked, diagnosis: Diagnosis) -> str:
    name = style.escaped(item.effect)
    return f"<b>{name}</b>" if item.effect in (*diagnosis.found, *diagnosis.rivals) else name


def _colour(item: Ranked, diagnosis: Diagnosis) -> str:
    if item.effect in diagnosis.rivals:
        return style.ORANGE
    return style.BLUE if item.effect in diagnosis.found else style.GREY


def _gain(sides: Sides | None) -> float:
    if sides is None or not sides.before > 0.0:
        return float("nan")
    return 100.0 * (1.0 - sides.after / sides.before)


def _text(sides: Sides | None) -> str:
    if sides is None or not np.isfinite(sides.before):
        return ""
    return " → ".join(error_words(value, sides.unit) for value in (sides.before, sides.after))


def set_up_figure(diagnosis: Diagnosis) -> Figure:
    """Turn and travel of each leg, measured against predicted: as given, and corrected.

    A correct set-up lies on the diagonal; a wrong sign or factor on another line.
    """
    from plotly.subplots import make_subplots

    figure = make_subplots(
        rows=1,
        cols=2,
        subplot_titles=("turn of a leg [°]", "travel ahead [m]"),
        horizontal_spacing=0.12,
    )
    runs = diagnosis.runs
    for name, robot, colour, symbol in (
        ("as the robot file says", diagnosis.given, style.ORANGE, "x"),
        ("with that put right", diagnosis.set_up.robot, style.BLUE, "circle"),
    ):
        measured, predicted = _legs(diagnosis, robot)
        rows = np.linspace(0, runs.count - 1, min(runs.count, style.MARKS // 4)).astype(int)
        for place, column, factor, unit in ((1, 2, float(np.degrees(1.0)), "°"), (2, 0, 1.0, "m")):
            style.plot(
                figure,
                style.small(factor * predicted[rows, column]),
                style.small(factor * measured[rows, column]),
                name,
                group=name,
                shown=place == 1,
                hover=f"{name}<br>predicted %{{x:.2f}} {unit}, measured %{{y:.2f}} {unit}",
                marker={"color": style.paled(colour, 0.7), "symbol": symbol, "size": 7},
                row=1,
                col=place,
            )
    for place in (1, 2):
        spans = [
            np.abs(np.asarray(values, dtype=np.float64))
            for trace in figure.data
            if (trace.xaxis or "x") == ("x" if place == 1 else "x2")
            for values in (trace.x, trace.y)
        ]
        largest = max((float(np.nanmax(span, initial=0.0)) for span in spans), default=1.0)
        line, ends = {"color": style.GREEN, "width": 2, "dash": "dash"}, [-largest, largest]
        at: dict[str, Any] = {"row": 1, "col": place}
        words = "measured as predicted"
        style.plot(figure, ends, ends, words, group="right", shown=place == 1, line=line, **at)
        figure.update_xaxes(title="predicted", **at)
        figure.update_yaxes(title="measured", **at)
    style.plain(figure, height=470)
    return figure.update_layout(margin={"t": 80}, legend={"y": 1.12})


def _legs(diagnosis: Diagnosis, robot: Robot) -> tuple[Floats, Floats]:
    """Measured and predicted relative poses of all legs, shape (m, 3), in their start frames."""
    runs = diagnosis.runs
    view = view_of(robot.effects)
    start, finish = right_handed(runs.start, view), right_handed(runs.finish, view)
    moved = (finish[:, 0] - start[:, 0]) + 1j * (finish[:, 1] - start[:, 1])
    moved = moved * np.exp(-1j * start[:, 2])
    turn = wrap_all(finish[:, 2] - start[:, 2])
    predicted = predicted_legs(Model(robot, tuple({} for _ in runs.runs)), runs)
    return np.stack([moved.real, moved.imag, turn], axis=-1), predicted


_TICK = 0.05  # [s]
_ARROWS = 10


def ideal_of(name: str) -> Ideal | None:
    """The manoeuvre of this name; None if it is not a drive (a marker to be remounted)."""
    return next((item for item in MANOEUVRES if item.name == name), None)


def manoeuvre_figure(ideal: Ideal, robot: Robot, pace: DrivingLimits) -> Figure:
    """Wheel tracks of a manoeuvre, for a robot of this base at the speed of the recorded drives.

    The robot's effects are ignored.
    """
    robot = replace(robot, effects=())
    run = ideal_run(ideal, robot, pace, ticks=_TICK, poses=_TICK, measures=(True, True))
    reference = run.reference
    assert reference is not None
    place = reference.x + 1j * reference.y
    yaw = np.unwrap(reference.yaw)
    time = reference.time
    half = 0.5 * robot.track
    figure = style.blank()
    wheels = ((1.0, style.BLUE, "left wheel"), (-1.0, style.ORANGE, "right wheel"))
    for side, colour, name in wheels:
        track = place + side * half * 1j * np.exp(1j * yaw)
        style.plot(
            figure,
            *style.places(track),
            f"track of the {name}",
            hover=f"{name}<br>x %{{x:.2f}} m, y %{{y:.2f}} m<br>after %{{customdata:.0f}} s",
            customdata=style.small(time),
            line={"color": style.paled(colour, 0.75), "width": 2},
        )
    _arrows(figure, place, yaw, half)
    _robot(figure, half)
    return style.from_above(figure, 480)


def _arrows(figure: Figure, place: np.ndarray, yaw: Floats, half: float) -> None:
    """Arrow heads along the path, in the direction of motion (also backwards)."""
    moved = np.abs(np.diff(place))
    length = np.concatenate([[0.0], np.cumsum(moved)])
    if length[-1] < half:
        return
    wanted = (np.arange(_ARROWS) + 0.5) / _ARROWS * length[-1]
    at = np.clip(np.searchsorted(length, wanted), 1, place.size - 1)
    course = np.degrees(np.angle(place[at] - place[at - 1]))
    angle = (90.0 - course).tolist()
    marker = {"symbol": "arrow", "size": 13, "angle": angle, "color": style.GREEN}
    style.plot(figure, *style.places(place[at]), "way of the robot", marker=marker)


def _robot(figure: Figure, half: float) -> None:
    """Outline of the robot at the start, facing x: body, wheels, nose."""
    body = half * np.array(
        [-1.3 - 0.85j, 1.0 - 0.85j, 1.5 + 0j, 1.0 + 0.85j, -1.3 + 0.85j, -1.3 - 0.85j]
    )
    tyre = np.array([-0.5, 0.5, 0.5, -0.5, -0.5]) + 0.12j * np.array([-1, -1, 1, 1, -1])
    parts = [body, *(half * (tyre + 1j * side) for side in (1.0, -1.0))]
    gap = np.array([np.nan + 0j])
    style.plot(
        figure,
        *style.places(np.concatenate([piece for part in parts for piece in (part, gap)])),
        "the robot at the start, to scale",
        line={"color": style.INK, "width": 2},
        fill="toself",
        fillcolor=style.paled(style.GREY, 0.25),
    )
