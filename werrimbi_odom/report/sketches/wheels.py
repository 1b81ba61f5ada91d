# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of wheels that are not round, or not hung in their middle."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from werrimbi_odom.report.sketches.parts import (
    BLUE,
    DASH,
    GREY,
    INK,
    ORANGE,
    Parts,
    arc,
    circle,
    floor,
    line,
    wave,
    words,
)


def _eccentric(side: str) -> Parts:
    colour = BLUE if side == "left" else ORANGE

    return [
        floor(125, 145),
        circle(80, 85, 40, colour=colour),
        circle(80, 85, 3, colour=GREY, fill=GREY),
        circle(93, 75, 4, colour=INK, fill=INK),
        line((80, 85), (93, 75), colour=INK),
        words(76, 74, "axle", anchor="end"),
        arc(80, 85, 50, 150, 100, colour=GREY, head=True),
        line((165, 85), (315, 85), colour=GREY),
        wave(165, 85, 150, 24, colour=colour),
        words(240, 130, "turns of the wheel", colour=GREY),
    ]


def _oval(side: str) -> Parts:
    colour = BLUE if side == "left" else ORANGE
    shape = [
        (80 + 46 * math.cos(at) + 4 * math.sin(at), 84 + 36 * math.sin(at) + 4 * math.cos(at))
        for at in (math.tau * step / 48 for step in range(49))
    ]
    return [
        floor(125, 145),
        line(*shape, colour=colour),
        circle(80, 84, 41, colour=GREY, dash=DASH),
        circle(80, 84, 4, colour=INK, fill=INK),
        arc(80, 84, 54, 150, 100, colour=GREY, head=True),
        line((165, 85), (315, 85), colour=GREY),
        wave(165, 85, 150, 20, colour=colour, turns=4.0),
        words(240, 130, "turns of the wheel", colour=GREY),
    ]


def _tread_bump(side: str) -> Parts:
    colour = BLUE if side == "left" else ORANGE
    radii = [36 + 9 * max(0.0, math.cos(3.0 * at)) * (abs(at) < 0.6) for at in _ROUND]
    tread = [
        (80 + size * math.sin(at - 0.7), 86 - size * math.cos(at - 0.7))
        for at, size in zip(_ROUND, radii, strict=True)
    ]
    jumps = [(165, 108), (195, 108), (207, 82), (262, 82), (274, 56), (315, 56)]
    return [
        floor(122, 145),
        line(*tread, colour=colour),
        circle(80, 86, 36, colour=GREY, dash=DASH),
        circle(80, 86, 4, colour=INK, fill=INK),
        arc(80, 86, 54, 60, 10, colour=GREY, head=True),
        line((165, 108), (315, 108), colour=GREY),
        line(*jumps, colour=colour),
        words(240, 130, "turns of the wheel", colour=GREY),
    ]


_ROUND = [math.tau * (step / 72 - 0.5) for step in range(73)]


DRAWINGS: Mapping[str, Callable[..., Parts]] = {
    "eccentric": _eccentric,
    "oval": _oval,
    "tread_bump": _tread_bump,
}
"""By name; what they are called with are the labels of a `Sketch`."""
