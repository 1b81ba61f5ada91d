# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What happened at an instant, in words and as JSON."""

from __future__ import annotations

import math
from typing import Any

from werrimbi_odom.inference.events.common_cause import Alike
from werrimbi_odom.inference.events.events import Event, Events
from werrimbi_odom.report.numbers import from_start, in_unit, with_std

_TOLD = 6
"""Events that are told one by one, the largest against their noise."""


def events_words(happened: Events, track: float) -> list[str]:
    """What happened, in the order of time; nothing where nothing did. `track`: of the robot [m]."""
    events = happened.events
    if not events:
        return []
    count = "Once" if len(events) == 1 else f"{len(events)} times"
    lines = [f"{count} something happened at once that no law explains, larger than the noise:"]
    drives = {event.run for event in events}
    twice = len({run.name for run in drives}) < len(drives)
    clear = sorted(events, key=lambda event: -abs(event.size) / event.std)[:_TOLD]
    for event in events:
        if event in clear:
            name = "/".join(event.run.parts[-2:]) if twice else event.run.name
            where = f" of {name}" if len(drives) > 1 else ""
            words = event_words(event, track, either=either(happened))
            lines.append(f"- at {when(event)}{where} {words};")
    lines[-1] = f"{lines[-1][:-1]}."
    rest = len(events) - len(clear)
    if rest:
        lines.append(f"So {'is' if rest == 1 else 'are'} {rest} more, in the report and the JSON.")
    if happened.alike is not None:
        lines.append(alike_words(happened.alike))
    if either(happened):
        lines.append(_EITHER[happened.kind])
    if happened.left_out:
        they = "It is" if len(events) == 1 else "They are"
        lines.append(f"{they} left out of the fits.")
    elif not happened.accidents:
        lines.append("They stay in the fits, for what repeats itself is no accident.")
    return lines


def event_words(event: Event, track: float, *, either: bool = False) -> str:
    """What one was, as the end of a sentence.

    Parameters
    ----------
    either
        Whether a step of the robot looks as one of the reference.
    """
    size, unit = _size(event)
    if event.channel == "reference":
        how = "and stayed there" if event.stays else "and was right again at the next pose"
        return f"the reference jumped by {size} {unit} {how}"
    if either:
        how = {"heading": "in heading"}.get(event.channel, event.channel)
        return f"the robot or the reference jumped by {size} {unit} {how}"
    slipped = _slipped(event, track)
    if slipped is not None:
        return slipped
    if event.channel == "heading":
        return f"it was turned by {size} {unit} to the {'left' if event.size > 0.0 else 'right'}"
    if event.channel == "sideways":
        return f"it was pushed {size} {unit} to the {'left' if event.size > 0.0 else 'right'}"
    way = "ahead of" if event.size > 0.0 else "behind"
    return f"it was thrown {size} {unit} {way} where its wheels were (a bump, a slip)"


def alike_words(common: Alike) -> str:
    """What events have in common, and what that says."""
    x, y = common.at
    near = f"{common.count} of {common.of}"
    if common.what == "reversal":
        return (
            f"{near} come with a reversal: that is a law that the model does not hold, of a castor "
            "or of free play (castor_kick, left_backlash, right_backlash)."
        )
    if common.what == "start or stop":
        return (
            f"{near} come with a start or a stop: that is a law that the model does not hold, of "
            "tyres or of clocks (longitudinal_slip, reference_delay)."
        )
    where = {"x": f"x {x:.1f} m", "y": f"y {y:.1f} m", "place": f"x {x:.1f} m, y {y:.1f} m"}
    return (
        f"{near} happened at {where[common.what]}: look at the floor there, for a threshold, a "
        "joint or a cable."
    )


def events_json(happened: Events, track: float) -> list[dict[str, Any]]:
    """Field for field; times in the run's own clock [s]."""
    return [
        {
            "run": str(event.run),
            "t_s": event.time,
            "channel": event.channel,
            "size": event.size,
            "std": event.std,
            "unit": event.unit,
            "words": event_words(event, track, either=either(happened)),
            "sizes": dict(zip(_SIZES, event.sizes, strict=True)),
            "stds": dict(zip(_SIZES, event.stds, strict=True)),
            "x_m": event.place[0],
            "y_m": event.place[1],
            "stays": event.stays,
            "held_out": event.held_out,
            "left_out": happened.left_out,
            "p_value": event.p_value,
        }
        for event in happened.events
    ]


def either(happened: Events) -> bool:
    """Whether a step of the robot looks as one of the reference; a gyro loses no place."""
    seen = any(math.isfinite(event.place[0]) for event in happened.events)
    return happened.kind in _EITHER and seen


_EITHER = {
    "incremental": "To a reference whose errors add up a step of the robot and a match that failed "
    "are one and the same.",
    "local_map": "A localiser that corrects itself, at once or within a second, looks as if the "
    "robot had been pushed.",
}
"""Why nobody can tell which of both it was, by the kind of the reference."""


_SIZES = ("along_m", "sideways_m", "heading_rad")


def alike_json(happened: Events) -> dict[str, Any] | None:
    """What they have in common; null where that is nothing."""
    common = happened.alike
    if common is None:
        return None
    return {
        "what": common.what,
        "count": common.count,
        "of": common.of,
        "x_m": common.at[0],
        "y_m": common.at[1],
        "p_value": common.p_value,
        "words": alike_words(common),
    }


def when(event: Event) -> str:
    """When it was, told from the run's first tick if its clock shows the time of day."""
    return f"{from_start(event.started, event.time)[0]:.1f} s"


def _size(event: Event) -> tuple[str, str]:
    if event.unit == "rad":
        return with_std(math.degrees(abs(event.size)), math.degrees(event.std)), "°"
    return in_unit(abs(event.size), event.std, event.unit)


def _slipped(event: Event, track: float) -> str | None:
    """Which wheel lost travel, where along and heading are those of one wheel alone."""
    (along, sideways, turn), (s_along, s_sideways, s_turn) = event.sizes, event.stds
    lost = 0.5 * track * turn
    spread = math.hypot(s_along, 0.5 * track * s_turn)
    sure = abs(turn) > _SURELY * s_turn and abs(along) > _SURELY * s_along
    if not sure or abs(sideways) > _SURELY * s_sideways:
        return None
    if abs(abs(along) - abs(lost)) > _SURELY * spread:
        return None
    # Of a wheel that loses travel the robot lags behind its way, and turns to that wheel's side.
    side = "left" if (turn > 0.0) == (along < 0.0) else "right"
    size, unit = in_unit(2.0 * abs(along), 2.0 * s_along, "m")
    return f"its {side} wheel slipped by {size} {unit}"


_SURELY = 3.0
"""Standard deviations."""
