# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Abrupt events in words, as JSON and in figures."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.inference.events.common_cause import Alike
from werrimbi_odom.inference.events.events import Channel, Event, Events
from werrimbi_odom.report import style
from werrimbi_odom.report.number_format import from_start, in_unit, picked, with_std
from werrimbi_odom.report.path_figure import add_path
from werrimbi_odom.report.phrases import drive_names
from werrimbi_odom.report.style import Figure

Names = dict[tuple[Path, bool], str]
"""A name for each drive, escaped, by its path and whether it was held out."""

_SUSPECTS: dict[str, dict[str, str]] = {
    "reversal": {
        "along": "a castor or of free play (castor_kick, castor_swing, left_backlash, "
        "right_backlash)",
    },
    "start or stop": {
        "along": "tyres or of clocks (longitudinal_slip, reference_delay)",
        "heading": "a castor, of free play or of a wheel that starts late (castor_kick, "
        "left_backlash, right_backlash, encoder_skew)",
    },
}
"""What may be the law behind events, by what they come with and the channel of most of them."""

_TOLD = 6
"""Number of events reported one by one: the most significant ones."""


def events_words(happened: Events, track: float, left_by: str | None = None) -> list[str]:
    """The events in the order of time; empty for none.

    `track`: the wheel base [m]. `left_by`: the law of the model, if any, that leaves such errors.
    """
    events = happened.events
    if not events:
        return []
    count = "Once" if len(events) == 1 else f"{len(events)} times"
    lines = [f"{count} something happened at once that no law explains, larger than the noise:"]
    names = drive_names(event.run for event in events)
    clear = sorted(events, key=lambda event: -abs(event.size) / event.std)[:_TOLD]
    for event in events:
        if event in clear:
            words = event_words(event, track, either=either(happened))
            lines.append(f"- at {when(event)} of {names[event.run]} {words};")
    lines[-1] = f"{lines[-1][:-1]}."
    rest = len(events) - len(clear)
    if rest:
        lines.append(f"So {'is' if rest == 1 else 'are'} {rest} more, in the report and the JSON.")
    if happened.told is not None:
        lines.append(alike_words(happened.told, happened, left_by))
    if either(happened):
        lines.append(_EITHER[happened.kind])
    if happened.left_out:
        they = "It is" if len(events) == 1 else "They are"
        lines.append(f"{they} left out of the fits.")
    elif happened.systematic:
        lines.append("They stay in the fits, for what repeats itself is no accident.")
    return lines


def event_words(event: Event, track: float, *, either: bool) -> str:
    """Description of one event, as the end of a sentence; `track` is the wheel base [m].

    `either`: whether steps of the robot and of the reference are indistinguishable.
    """
    size = _size(event)
    if event.channel == "reference":
        how = "and stayed there" if event.stays else "and was right again at the next pose"
        return f"the reference jumped by {size} {how}"
    if either or event.beside_lost:
        how = {"heading": "in heading"}.get(event.channel, event.channel)
        lost = " (just by a stretch in which its scans were lost)" if event.beside_lost else ""
        return f"the robot or the reference jumped by {size} {how}{lost}"
    slipped = _slipped(event, track)
    if slipped is not None:
        return slipped
    if event.channel == "heading":
        return f"it was turned by {size} to the {'left' if event.size > 0.0 else 'right'}"
    if event.channel == "sideways":
        return f"it was pushed {size} to the {'left' if event.size > 0.0 else 'right'}"
    way = "ahead of" if event.size > 0.0 else "behind"
    return f"it was thrown {size} {way} where its wheels were (a bump, a slip)"


def most_of(events: Sequence[Event]) -> Channel:
    """The channel in which most of the events are largest."""
    return Counter(event.channel for event in events).most_common(1)[0][0]


def alike_words(common: Alike, happened: Events, left_by: str | None = None) -> str:
    """Common cause of the events that happened, and its meaning; `left_by` as of `events_words`."""
    x, y = common.at
    near = f"{common.count} of {common.of}"
    if common.of < len(happened.events):
        near += " in what was fitted"
    if common.what in _SUSPECTS:
        near = f"{near} come with a {common.what.replace(' or ', ' or a ')}: "
        channel = most_of(happened.events)
        if left_by is not None:
            return (
                f"{near}the law of {left_by}, whose form or size does not quite fit, leaves such."
            )
        if channel == "reference":
            return (
                f"{near}then the reference goes wrong (a mount that shakes, stamps that are off)."
            )
        other = (
            "" if happened.kind == "absolute" else "of a reference that corrects itself then, or "
        )
        suspects = _SUSPECTS[common.what]
        whose = suspects.get(channel, suspects["along"])
        return f"{near}that is {other}a law that the model does not hold, of {whose}."
    where = {"x": f"x {x:.1f} m", "y": f"y {y:.1f} m", "place": f"x {x:.1f} m, y {y:.1f} m"}
    if common.of_reference:
        return (
            f"{near} happened at {where[common.what]}: there the reference goes wrong (a marker "
            "that is hidden or taken for another, say), or a cable tips the robot."
        )
    return (
        f"{near} happened at {where[common.what]}: look at the floor there, for a threshold, a "
        "joint or a cable."
    )


def events_json(happened: Events, track: float) -> list[dict[str, Any]]:
    """Fields of each event; times in the run's own clock [s]."""
    return [
        {
            **picked(event, "run t_s:time channel size std unit"),
            "words": event_words(event, track, either=either(happened)),
            "sizes": dict(zip(_SIZES, event.sizes, strict=True)),
            "stds": dict(zip(_SIZES, event.stds, strict=True)),
            "x_m": event.place[0],
            "y_m": event.place[1],
            **picked(event, "stays held_out p_value"),
            "left_out": happened.left_out,
        }
        for event in happened.events
    ]


def either(happened: Events) -> bool:
    """Whether steps of the robot and of the reference look alike; not for a gyro."""
    seen = any(math.isfinite(event.place[0]) for event in happened.events)
    return happened.kind in _EITHER and seen


_EITHER = {
    "incremental": "To a reference whose errors add up a step of the robot and a match that failed "
    "are one and the same.",
    "local_map": "A localiser that corrects itself, at once or within a second, looks as if the "
    "robot had been pushed.",
}
"""Reason why the two are indistinguishable, by the kind of reference."""


_SIZES = ("along_m", "sideways_m", "heading_rad")


def alike_json(happened: Events, left_by: str | None = None) -> dict[str, Any] | None:
    """Common cause of the events; null for none. `left_by` as of `events_words`."""
    common = happened.told
    if common is None:
        return None
    x, y = common.at
    words = alike_words(common, happened, left_by)
    return {**picked(common, "what count of p_value"), "x_m": x, "y_m": y, "words": words}


def when(event: Event) -> str:
    """Time of an event, from the run's first tick if the clock shows the time of day."""
    return f"{from_start(event.started, event.time)[0]:.1f} s"


def _size(event: Event) -> str:
    if event.unit == "rad":
        return f"{with_std(math.degrees(abs(event.size)), math.degrees(event.std))}°"
    return " ".join(in_unit(abs(event.size), event.std, event.unit))


def _slipped(event: Event, track: float) -> str | None:
    """The slipped wheel, if along and heading steps agree with those of one wheel; or None."""
    (along, sideways, turn), (s_along, s_sideways, s_turn) = event.sizes, event.stds
    lost = 0.5 * track * turn
    spread = math.hypot(s_along, 0.5 * track * s_turn)
    sure = abs(turn) > _SURELY * s_turn and abs(along) > _SURELY * s_along
    if not sure or abs(sideways) > _SURELY * s_sideways:
        return None
    if abs(abs(along) - abs(lost)) > _SURELY * spread:
        return None
    # If a wheel loses travel, the robot lags behind its path and turns to the side of that wheel.
    side = "left" if (turn > 0.0) == (along < 0.0) else "right"
    size = " ".join(in_unit(2.0 * abs(along), 2.0 * s_along, "m"))
    return f"its {side} wheel slipped by {size}"


_SURELY = 3.0
"""Threshold in standard deviations."""


_LOOKS = {
    "along": ("along", style.ORANGE, "square"),
    "sideways": ("sideways", style.BLUE, "diamond"),
    "heading": ("heading", style.GREEN, "circle"),
    "reference": ("the reference jumped", style.GREY, "x"),
}
_DRIVE = 30  # height of the line of a drive [pixels]


def on_the_path(happened: Events, track: float) -> Figure | None:
    """Events on the measured path; None if no positions were measured."""
    seen = [way for way in happened.ways if np.isfinite(way.x).any()]
    if not seen:
        return None
    figure, names = style.blank(), _names(happened)
    for number, way in enumerate(seen):
        path = way.x + 1j * way.y
        add_path(
            figure,
            path[style.along_path(path, max(style.MOST // len(seen), 200))],
            "measured",
            {"color": style.paled(style.GREY, 0.5), "width": 3},
            said=names[way.run, way.held_out],
            group="measured",
            shown=number == 0,
        )
    _marks(figure, happened, track, [event.place for event in happened.events], names)
    return style.from_above(figure, 620, zeroline=False)


def over_time(happened: Events, track: float) -> Figure:
    """Events over time, drive by drive."""
    figure, names = style.blank(), _names(happened)
    starts = {}
    for way in happened.ways:
        name = names[way.run, way.held_out]
        starts[(way.run, way.held_out)] = (name, float(way.time[0]))
        line = {"color": style.paled(style.GREY, 0.5), "width": 3}
        times = [0.0, float(way.time[-1] - way.time[0])]
        style.plot(figure, times, [name, name], shown=False, line=line)
    places = []
    for event in happened.events:
        name, start = starts[(event.run, event.held_out)]
        places.append((event.seen - start, name))
    _marks(figure, happened, track, places, names)
    figure.update_xaxes(title="time since the drive's first pose [s]", zeroline=False)
    figure.update_yaxes(autorange="reversed", showgrid=False)
    return style.plain(figure, height=140 + _DRIVE * len(happened.ways))


def _marks(
    figure: Figure,
    happened: Events,
    track: float,
    places: list[tuple[float, float]] | list[tuple[float, str]],
    names: Names,
) -> None:
    for channel, (words, colour, symbol) in _LOOKS.items():
        own = [index for index, event in enumerate(happened.events) if event.channel == channel]
        if own:
            edge = {"color": style.PAPER, "width": 1.5}
            style.plot(
                figure,
                [places[index][0] for index in own],
                [places[index][1] for index in own],
                words,
                hover="%{hovertext}",
                hovertext=[_said(happened, happened.events[index], track, names) for index in own],
                marker={"color": colour, "symbol": symbol, "size": 12, "line": edge},
            )


def _said(happened: Events, event: Event, track: float, names: Names) -> str:
    where = f"{names[event.run, event.held_out]}, {when(event)}"
    return f"{where}<br>{style.escaped(event_words(event, track, either=either(happened)))}"


def _names(happened: Events) -> Names:
    found: Names = {}
    for held_out, beside in ((False, ""), (True, " (held out)")):
        runs = [way.run for way in happened.ways if way.held_out == held_out]
        for run, name in drive_names(runs).items():
            found[run, held_out] = style.escaped(f"{name}{beside}")
    return found
