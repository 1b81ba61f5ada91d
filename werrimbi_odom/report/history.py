# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a history: words, and a panel for each parameter over the dates."""

from __future__ import annotations

from dataclasses import asdict
from datetime import datetime, timezone
from typing import Any

import numpy as np

from werrimbi_odom.inference.changes.dated_drives import Dated, History
from werrimbi_odom.inference.changes.history import BASE_OVER_RADIUS, Number
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import history_words as words
from werrimbi_odom.report import style
from werrimbi_odom.report.changes import changes_json
from werrimbi_odom.report.document import Document, Shown
from werrimbi_odom.report.number_format import picked
from werrimbi_odom.report.style import Figure

_HEIGHT = 190
"""Height of a panel [pixels]."""
_UNSURE = 5.0
"""A drive's own value with a standard deviation above this many medians is not drawn."""


def document_of(history: History) -> Document:
    """The complete report."""
    some = bool(history.course.numbers)
    return Document(
        title=_title(history),
        words=words.words_of(history),
        tables=[words.table_of(history)] if some else (),
        draw=lambda: _figures(history) if some else (),
    )


def _title(history: History) -> str:
    if history.course.changes:
        return "What changed"
    return "Nothing changed" if history.course.numbers else "Nothing is known"


def _figures(history: History) -> list[Shown]:
    return [
        Shown(
            "history",
            "Each number over the drives",
            "Dots are what each drive alone says, with two standard deviations; the line is "
            "what the robot was between the changes; dashed, the robot file. A number is "
            "changed where the line steps, at a dotted line.",
            {"": history_figure(history)},
        )
    ]


def history_figure(history: History) -> Figure:
    """Panels above each other, with a common axis of dates."""
    from plotly.subplots import make_subplots

    numbers = history.course.numbers
    titles = [
        f"{words.TITLES.get(each.name, style.escaped(each.name))}{_unit(each)}" for each in numbers
    ]
    figure = make_subplots(
        rows=len(numbers),
        cols=1,
        shared_xaxes=True,
        vertical_spacing=0.25 / len(numbers),
        subplot_titles=titles,
    )
    dates = _dates(history)
    names = [style.escaped(name) for name in words.dated_names(history)]
    for row, number in enumerate(numbers, start=1):
        _panel(figure, row, number, history, dates, names)
    figure = style.plain(figure, height=120 + _HEIGHT * len(numbers))
    figure.update_xaxes(showticklabels=True)
    if _in_order(history):
        figure.update_xaxes(title_text="drive, in the order given", row=len(numbers))
    return figure.update_layout(legend={"y": 1.0 + 40.0 / figure.layout.height})


def _panel(
    figure: Figure, row: int, number: Number, history: History, dates: list[Any], names: list[str]
) -> None:
    factor, offset = _scale(number)
    std = number.own_std
    usual = float(np.nanmedian(std))
    told = np.flatnonzero(np.isfinite(number.own) & ~(std > _UNSURE * usual))
    told = told[style.spread_and_extremes(number.own[told] - number.level[told])]

    def drawn(values: Floats) -> list[float]:
        return [float(factor * (value - offset)) for value in values]

    at: dict[str, Any] = {"shown": row == 1, "row": row, "col": 1}
    bars = [2.0 * factor * float(each) for each in std[told]]
    style.plot(
        figure,
        [dates[index] for index in told],
        drawn(number.own[told]),
        "a drive by itself",
        group="own",
        hover="%{text}<br>%{y:.4g}",
        text=[names[index] for index in told],
        marker={"color": style.BLUE, "size": 5},
        error_y=style.error_bars(bars, style.paled(style.BLUE, 0.4), 1, 0),
        **at,
    )
    line = {"color": style.ORANGE, "width": 2, "shape": "hv"}
    level = drawn(number.level)
    style.plot(figure, dates, level, "between the changes", group="level", line=line, **at)
    for value, colour, name in (
        (number.given, style.GREY, "robot file"),
        *(((words.there(history, number), style.GREEN, "the other file"),) if history.like else ()),
    ):
        line = {"color": colour, "width": 1, "dash": "dash"}
        ends, values = [dates[0], dates[-1]], drawn(np.array([value, value]))
        style.plot(figure, ends, values, name, group=name, line=line, **at)
    changes = (move for move in history.course.changes if _moves(move.what, number.name))
    changed = {int(move.from_run) for move in changes}
    for index in sorted(changed):
        line = {"color": style.GREY, "width": 1, "dash": "dot"}
        figure.add_vline(x=dates[index], line=line, row=row, col=1)


def _moves(what: str, name: str) -> bool:
    """Whether a change of one parameter also changes the other."""
    of_radii = name in ("unequal_wheel_radii", "wheel_radius_scale", BASE_OVER_RADIUS)
    of_base = what == MULTIPLIERS[0] and name == BASE_OVER_RADIUS
    return what == name or of_base or ("radius_multiplier" in what and of_radii)


def _scale(number: Number) -> tuple[float, float]:
    """Factor and origin of the drawn values; multipliers in % from the robot file."""
    if "." not in number.name:
        return 100.0 / number.given, number.given
    return (1e3, 0.0) if number.unit in ("m", "rad", "s") else (1.0, 0.0)


def _unit(number: Number) -> str:
    if "." not in number.name:
        return " [% off the robot file]"
    unit = {"m": "mm", "rad": "mrad", "s": "ms"}.get(number.unit, number.unit)
    return f" [{unit}]" if unit else ""


def _in_order(history: History) -> bool:
    """Whether drives have no dates."""
    return any(drive.date_from == "order" for drive in history.drives)


def _dates(history: History) -> list[Any]:
    if _in_order(history):
        return list(range(1, len(history.drives) + 1))
    return [
        datetime.fromtimestamp(drive.date, timezone.utc).strftime("%Y-%m-%d %H:%M:%S")
        for drive in history.drives
    ]


def json_of(history: History) -> dict[str, Any]:
    """Complete result as JSON."""
    course = history.course
    paths = [str(drive.run) for drive in history.drives]
    return {
        "drives": [
            {
                **picked(drive, "run date_from way_m:estimate.way"),
                "date": _date(drive),
                "numbers": {
                    number.name: {
                        name: values[index]
                        for name, values in picked(
                            number, "value:own std:own_std pooled pooled_std"
                        ).items()
                    }
                    for number in course.numbers
                },
            }
            for index, drive in enumerate(history.drives)
        ],
        "numbers": {
            number.name: {
                **picked(number, "unit robot_file:given scatter"),
                "now": number.level[-1],
                "std": number.level_std[-1],
            }
            for number in course.numbers
        },
        "changes": [
            {**each, "date": _date(history.drives[int(move.from_run)])}
            for move, each in zip(
                course.changes,
                changes_json(words.told_as(history, paths), history.robot),
                strict=True,
            )
        ],
        "alarms": [asdict(alarm) for alarm in words.alarms(history)],
        "like": [asdict(each) for each in words.against(history)],
        "unusable": [picked(each, "run why") for each in history.unusable],
    }


def _date(drive: Dated) -> str | None:
    if drive.date_from == "order":
        return None
    return datetime.fromtimestamp(drive.date, timezone.utc).isoformat(timespec="seconds")
