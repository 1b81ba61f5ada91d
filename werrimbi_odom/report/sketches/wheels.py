# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of wheels (shape, size, tread, gears) and of their counters."""

from __future__ import annotations

import math
from collections.abc import Mapping

from werrimbi_odom.report.sketches.parts import (
    BLUE,
    DASH,
    GREEN,
    GREY,
    INK,
    ORANGE,
    SIDES,
    Drawing,
    Parts,
    arc,
    arrow,
    circle,
    floor,
    line,
    oblong,
    robot,
    wave,
    words,
)


def _eccentric(side: str) -> Parts:
    colour = SIDES[side]
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
    colour = SIDES[side]
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
    colour = SIDES[side]
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


def _backlash(side: str) -> Parts:
    colour = SIDES[side]
    return [
        circle(90, 78, 34, colour=INK),
        words(90, 83, "encoder"),
        circle(215, 78, 44, colour=colour),
        words(215, 83, f"{side} wheel", colour=colour),
        line((124, 70), (148, 70), (148, 86), (124, 86)),
        line((171, 58), (155, 58), (155, 66), (171, 66), colour=colour),
        line((171, 92), (155, 92), (155, 100), (171, 100), colour=colour),
        arrow((137, 112), (137, 90), colour=GREEN),
        words(137, 127, "free play", colour=GREEN),
    ]


def _missed_ticks(side: str) -> Parts:
    colour = SIDES[side]
    parts: Parts = []
    x = 25.0
    for number in range(13):
        width = 17.0 if number < 5 else 9.0
        lost = number in (7, 10)
        parts.append(
            line(
                (x, 95),
                (x, 60),
                (x + width, 60),
                (x + width, 95),
                (x + 2 * width, 95),
                colour=GREY if lost else colour,
                dash="2 4" if lost else "",
            )
        )
        if lost:
            parts.append(words(x + 5, 52, "×", colour=INK))
        x += 2 * width
    return [*parts, words(105, 120, "slow", colour=GREY), words(265, 120, "fast", colour=GREY)]


def _reversed(side: str) -> Parts:
    left, right = (ORANGE, INK) if side == "left" else (INK, ORANGE)
    wrong, good = (54, 106) if side == "left" else (106, 54)
    return [
        robot(110, 80, left=left, right=right),
        arrow((150, good), (230, good), colour=BLUE),
        words(240, good + 4, "counts up", colour=BLUE, anchor="start"),
        arrow((230, wrong), (150, wrong)),
        words(240, wrong + 4, "counts down", colour=ORANGE, anchor="start"),
    ]


_ROUND = [math.tau * (step / 72 - 0.5) for step in range(73)]


DRAWINGS: Mapping[str, Drawing] = {
    "eccentric": _eccentric,
    "oval": _oval,
    "tread_bump": _tread_bump,
    "unequal": [
        floor(112),
        circle(95, 80, 32, colour=BLUE),
        circle(205, 87, 25, colour=ORANGE),
        line((95, 80), (205, 87)),
        words(95, 40, "left", colour=BLUE),
        words(205, 50, "right", colour=ORANGE),
        arc(300, 30, 80, 215, 275, colour=ORANGE, head=True),
    ],
    "radius": [
        floor(125),
        circle(80, 90, 35, colour=ORANGE),
        circle(80, 98, 27, colour=GREY, dash=DASH),
        line((80, 90), (104, 65), colour=ORANGE),
        words(125, 62, "true", colour=ORANGE, anchor="start"),
        words(125, 82, "entered", colour=GREY, anchor="start"),
        arrow((130, 108), (300, 108)),
        arrow((130, 118), (255, 118), colour=GREY),
    ],
    "squash": [
        floor(120),
        circle(75, 82, 38, colour=BLUE),
        words(75, 86, "slow", colour=BLUE),
        arrow((120, 60), (150, 60), colour=GREY),
        arc(235, 88, 38, -57, 237, colour=ORANGE),
        line((214, 120), (256, 120), colour=ORANGE, width=3),
        words(235, 92, "fast", colour=ORANGE),
        arrow((280, 60), (328, 60), colour=GREY),
        arrow((290, 84), (290, 119), both=True),
    ],
    "by_channel": [
        floor(125),
        circle(70, 85, 40, colour=ORANGE),
        circle(70, 93, 32, colour=GREY, dash=DASH),
        line((150, 120), (150, 40), colour=GREY),
        line((150, 120), (320, 120), colour=GREY),
        line((150, 100), (190, 60), (235, 92), (280, 52), (318, 70), colour=ORANGE),
        words(235, 40, "a column of ticks.csv", colour=GREY),
    ],
    "shrinking": [
        floor(115),
        circle(75, 77, 38, colour=BLUE),
        circle(180, 82, 33, colour=BLUE, dash=DASH),
        circle(280, 88, 27, colour=ORANGE),
        arrow((30, 130), (310, 130), colour=GREY),
        words(170, 146, "time, distance", colour=GREY),
    ],
    "backlash": _backlash,
    "lost_counts": _missed_ticks,
    "swapped": [
        robot(90, 80, left=BLUE, right=ORANGE),
        oblong(270, 50, 70, 30),
        words(270, 55, "left", colour=INK),
        oblong(270, 110, 70, 30),
        words(270, 115, "right", colour=INK),
        line((102, 54), (150, 54), (200, 110), (235, 110), colour=BLUE, width=2.5),
        line((102, 106), (150, 106), (200, 50), (235, 50), colour=ORANGE, width=2.5),
    ],
    "wrong_sign": _reversed,
    "load": [
        floor(122),
        oblong(170, 66, 110, 28, fill=GREY),
        oblong(112, 92, 22, 60, colour=BLUE),
        oblong(228, 96, 26, 52, colour=ORANGE),
        words(60, 92, "inner", colour=BLUE),
        words(280, 92, "outer", colour=ORANGE),
        arrow((140, 34), (205, 34)),
        words(132, 30, "load", colour=ORANGE, anchor="end"),
    ],
}
"""By name; the arguments of those that have any are the labels of a `Sketch`."""
