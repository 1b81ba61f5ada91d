# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Manoeuvres that can be driven: those that `diagnose` proposes, UMBmark's, the paper's."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from werrimbi_odom.driving.limits import Limits
from werrimbi_odom.driving.plan import ManoeuvrePlan, Move
from werrimbi_odom.errors import InputError, nearest
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES, Ideal

SIDE = 4.0
"""Side of UMBmark's square [m], as in its publication."""
WAY = 10.0
"""Length of the paper's out-and-back [m] (Chong and Kleeman 1997, section 5.2)."""
LONGEST = 1440.0
"""Longest drive that a diagnosis may propose [min]: a day."""
PACE = 0.6
"""Speed of both, as a share of the full speed: slow enough that slip does not matter."""


def _sides(side: float, sense: float) -> list[Move]:
    return [Move(side, 0.0, PACE), Move(0.0, sense * 0.5 * math.pi, PACE)] * 4


BEFORE = Move(0.0, 0.0, rest=1.0)
"""A rest of one second before the first move, as a warning and for the recording."""

OWN: dict[str, tuple[str, float, Callable[[float], list[Move]]]] = {
    "umbmark_ccw": ("UMBmark's square to the left", SIDE, lambda side: _sides(side, 1.0)),
    "umbmark_cw": ("UMBmark's square to the right", SIDE, lambda side: _sides(side, -1.0)),
    "umbmark": (
        "UMBmark's squares, to the left and to the right",
        SIDE,
        lambda side: _sides(side, 1.0) + _sides(side, -1.0),
    ),
    "paper_out_and_back": (
        "straight ahead and backwards again",
        WAY,
        lambda way: [Move(way, 0.0, PACE), Move(-way, 0.0, PACE)],
    ),
}
"""Description, default length [m], and moves for a length."""

NAMES = (*(each.name for each in MANOEUVRES), *OWN)


def plan_of(
    name: str, *, size: float = 1.0, length: float = 0.0, repetitions: int = 1
) -> ManoeuvrePlan:
    """Plan for the manoeuvre of this name; InputError if there is none.

    `size` is the unit of length of the library's manoeuvres [m], `length` the side or length of the
    others [m], 0 for the default.
    """
    if name in OWN:
        words, usual, moves = OWN[name]
        return ManoeuvrePlan(name, words, (BEFORE, *moves(length or usual) * repetitions))
    ideal = next((each for each in MANOEUVRES if each.name == name), None)
    if ideal is None:
        near = nearest(name, NAMES) or f"; there are {', '.join(NAMES)}"
        raise InputError(f"no manoeuvre is called {name!r}{near}")
    return ManoeuvrePlan(name, ideal.words, (BEFORE, *_moves(ideal, size) * repetitions))


def _moves(ideal: Ideal, size: float) -> list[Move]:
    """Moves of an ideal manoeuvre; its rests are given as (0, 0, seconds)."""
    moves = []
    for length, turn, pace in ideal.moves(size):
        if length == 0.0 and turn == 0.0:
            moves.append(Move(0.0, 0.0, rest=pace))
        else:
            moves.append(Move(length, turn, pace, ideal.hard))
    return moves


def proposed(path: Path, limits: Limits, *, size: float = 1.0) -> ManoeuvrePlan:
    """Plan for the manoeuvre that `werrimbi diagnose --json FILE` proposes, for its stated time.

    InputError if the file is not from diagnose, or proposes nothing that can be driven.
    """
    try:
        told: Any = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"diagnosis: {path} cannot be read as JSON: {error}") from error
    if not isinstance(told, dict) or "next_manoeuvre" not in told:
        raise InputError(f"diagnosis: {path} was not written by werrimbi diagnose --json")
    ahead = told["next_manoeuvre"]
    if ahead is None:
        verdict = told.get("verdict")
        if verdict == "ambiguous":
            raise InputError(
                "diagnosis: no manoeuvre tells its rivals apart in reasonable time; a ruler may"
            )
        if told.get("drives_differ"):
            raise InputError(
                "diagnosis: it proposes nothing to drive: the robot was not the same in all of its "
                "drives; diagnose those since the change alone"
            )
        if verdict == "unknown":
            raise InputError(
                "diagnosis: it proposes nothing to drive: the verdict is unknown, and the errors "
                "depend on nothing that was measured"
            )
        raise InputError(f"diagnosis: nothing needs to be driven next: the verdict is {verdict}")
    if not isinstance(ahead, dict) or not isinstance(ahead.get("name"), str):
        raise InputError(
            f"diagnosis: next_manoeuvre in {path} is no manoeuvre of werrimbi diagnose"
        )
    if ahead["name"] not in NAMES:
        raise InputError(
            f"diagnosis: {ahead['name']} is no drive, but work by hand: "
            f"{ahead.get('do') or ahead.get('why')}"
        )
    once = plan_of(ahead["name"], size=size)
    minutes = ahead.get("minutes") or 0.0
    if not isinstance(minutes, int | float) or not 0.0 <= minutes <= LONGEST:
        raise InputError(
            f"diagnosis: minutes in {path} must be a number from 0 to {LONGEST:g}, not {minutes!r}"
        )
    times = max(math.ceil(60.0 * minutes / once.duration(limits)), 1)
    return plan_of(once.name, size=size, repetitions=times)
