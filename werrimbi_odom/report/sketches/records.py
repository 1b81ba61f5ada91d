# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of what is recorded otherwise than it was: by the counters, and by the reference."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from werrimbi_odom.report.sketches.parts import (
    BLUE,
    DASH,
    GREEN,
    GREY,
    INK,
    ORANGE,
    Parts,
    arc,
    arrow,
    circle,
    line,
    oblong,
    robot,
    words,
)


def _missed_ticks(side: str) -> Parts:
    colour = BLUE if side == "left" else ORANGE

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
    return [
        *parts,
        words(105, 120, "slow", colour=GREY),
        words(265, 120, "fast", colour=GREY),
    ]


def _lever_arm() -> Parts:
    return [
        robot(140, 78),
        circle(140, 78, 4, colour=INK, fill=INK),
        circle(200, 48, 6, colour=GREEN, fill=GREEN),
        arrow((140, 78), (195, 51)),
        words(212, 46, "what is measured", colour=GREEN, anchor="start"),
        words(104, 83, "axle's middle", anchor="end"),
    ]


def _yaw_offset() -> Parts:
    return [
        robot(120, 90, marker=True),
        arrow((120, 90), (250, 90), colour=GREY),
        words(256, 94, "robot", colour=GREY, anchor="start"),
        arrow((120, 90), (240, 45)),
        words(246, 44, "reference", colour=ORANGE, anchor="start"),
        arc(120, 90, 85, 0, 20, colour=ORANGE),
    ]


def _scale() -> Parts:
    return [
        robot(60, 85),
        arrow((60, 110), (230, 110), colour=GREY),
        words(236, 114, "what was", colour=GREY, anchor="start"),
        arrow((60, 55), (262, 55), colour=GREEN),
        words(150, 42, "what is shown", colour=GREEN),
    ]


def _mirrored() -> Parts:
    return [
        arrow((60, 110), (60, 40), colour=GREY),
        arrow((60, 110), (130, 110), colour=GREY),
        words(60, 32, "y", colour=GREY),
        words(140, 114, "x", colour=GREY),
        arc(60, 110, 35, 10, 80, colour=GREY, head=True),
        line((170, 25), (170, 135), dash=DASH),
        arrow((215, 40), (215, 110)),
        arrow((215, 40), (285, 40)),
        words(215, 126, "y", colour=ORANGE),
        words(295, 44, "x", colour=ORANGE),
        arc(215, 40, 35, -10, -80, colour=ORANGE, head=True),
    ]


def _late(first: str, second: str) -> Parts:
    def step(y: float, at: float, colour: str) -> str:
        return line(
            (20, y), (at, y), (at + 40, y - 38), (at + 130, y - 38), colour=colour, width=2.5
        )

    return [
        step(68, 70, BLUE),
        words(322, 34, first, colour=BLUE, anchor="end"),
        step(128, 112, ORANGE),
        words(322, 118, second, colour=ORANGE, anchor="end"),
        line((70, 22), (70, 134), colour=GREY, dash="2 4"),
        line((112, 22), (112, 134), colour=GREY, dash="2 4"),
        arrow((70, 26), (112, 26), colour=GREEN),
        words(120, 20, "late", colour=GREEN, anchor="start"),
    ]


def _wandering_bias() -> Parts:
    times = [x / 20.0 for x in range(21)]
    true = [(30 + 230 * at, 112 - 26 * at) for at in times]
    shown = [(30 + 230 * at, 112 - 26 * at - 52 * at * at) for at in times]
    return [
        arrow((30, 125), (318, 125), colour=GREY),
        words(318, 116, "time", colour=GREY, anchor="end"),
        line(*true, colour=BLUE, width=2.5),
        words(268, 90, "heading", colour=BLUE, anchor="start"),
        line(*shown, colour=ORANGE, width=2.5),
        words(268, 38, "the gyro's", colour=ORANGE, anchor="start"),
        arrow((255, 80), (255, 42), colour=GREY, both=True),
    ]


def _swapped() -> Parts:
    return [
        robot(90, 80, left=BLUE, right=ORANGE),
        oblong(270, 50, 70, 30),
        words(270, 55, "left", colour=INK),
        oblong(270, 110, 70, 30),
        words(270, 115, "right", colour=INK),
        line((102, 54), (150, 54), (200, 110), (235, 110), colour=BLUE, width=2.5),
        line((102, 106), (150, 106), (200, 50), (235, 50), colour=ORANGE, width=2.5),
    ]


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


DRAWINGS: Mapping[str, Callable[..., Parts]] = {
    "lost_counts": _missed_ticks,
    "lever_arm": _lever_arm,
    "yaw_offset": _yaw_offset,
    "mirrored": _mirrored,
    "scale": _scale,
    "late": _late,
    "wandering_bias": _wandering_bias,
    "swapped": _swapped,
    "wrong_sign": _reversed,
}
"""By name; what they are called with are the labels of a `Sketch`."""
