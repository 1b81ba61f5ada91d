# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of the robot's motion on its floor, and of errors of the reference."""

from __future__ import annotations

from collections.abc import Mapping

from werrimbi_odom.report.sketches.parts import (
    BLUE,
    DASH,
    GREEN,
    GREY,
    INK,
    ORANGE,
    Drawing,
    Parts,
    arc,
    arrow,
    circle,
    floor,
    line,
    oblong,
    robot,
    words,
)


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


_TIMES = [x / 20.0 for x in range(21)]

DRAWINGS: Mapping[str, Drawing] = {
    "track": [
        robot(150, 78),
        line((150, 52), (150, 104), colour=GREY, dash=DASH),
        arrow((215, 52), (215, 104), colour=GREY, both=True),
        words(222, 82, "entered", colour=GREY, anchor="start"),
        arrow((100, 40), (100, 116), both=True),
        words(93, 82, "true", colour=ORANGE, anchor="end"),
        line((100, 40), (150, 40), colour=ORANGE, dash="2 4"),
        line((100, 116), (150, 116), colour=ORANGE, dash="2 4"),
    ],
    "slip_above": [
        line((50, 120), (335, 120), colour=GREY),
        line((50, 120), (50, 25), colour=GREY),
        line((50, 120), (180, 120), colour=GREEN),
        line((180, 120), (310, 40)),
        line((180, 126), (180, 30), colour=GREY, dash=DASH),
        words(115, 108, "it holds", colour=GREEN),
        words(236, 62, "it slips", colour=ORANGE, anchor="end"),
        words(192, 138, "acceleration", colour=GREY, anchor="start"),
        words(58, 32, "lost", colour=GREY, anchor="start"),
    ],
    "slip_ahead": [
        floor(120),
        circle(80, 82, 38),
        arc(80, 82, 24, 140, 20, colour=BLUE, head=True),
        arrow((130, 62), (215, 62), colour=BLUE),
        words(172, 52, "gaining speed", colour=BLUE),
        arrow((95, 128), (58, 128)),
        words(110, 137, "the tyre creeps back", colour=ORANGE, anchor="start"),
        line((240, 105), (265, 75), (295, 75), (318, 105), colour=GREY),
    ],
    "slip_outwards": [
        arc(150, 190, 130, 130, 50, colour=GREY, dash=DASH),
        arc(150, 190, 152, 118, 50, colour=ORANGE, head=True),
        robot(142, 50, turn=2, size=0.8),
        arrow((175, 38), (182, 8)),
        words(192, 20, "outwards", colour=ORANGE, anchor="start"),
        words(240, 96, "predicted", colour=GREY, anchor="start"),
    ],
    "two_bases": [
        robot(75, 70, size=0.8),
        arc(75, 70, 45, 40, 330, colour=BLUE, head=True),
        words(75, 140, "on the spot", colour=BLUE),
        robot(225, 100, size=0.8),
        arc(225, 20, 80, 235, 305, colour=ORANGE, head=True),
        words(225, 143, "wide curve", colour=ORANGE),
    ],
    "skid": [
        oblong(155, 80, 92, 34, colour=BLUE),
        *(oblong(x, y, 34, 13, colour=INK, fill=GREY) for x in (128, 182) for y in (58, 102)),
        line((155, 12), (155, 148), colour=GREY, dash=DASH),
        circle(163, 18, 4, colour=ORANGE, fill=ORANGE),
        circle(163, 142, 4, colour=ORANGE, fill=ORANGE),
        words(172, 22, "centre of the left side", colour=ORANGE, anchor="start"),
        words(172, 146, "centre of the right side", colour=ORANGE, anchor="start"),
        arrow((82, 18), (82, 142), both=True),
        words(76, 84, "acts", colour=ORANGE, anchor="end"),
        arrow((100, 58), (100, 102), colour=GREY, both=True),
        arc(155, 80, 78, 335, 25, colour=ORANGE, head=True),
    ],
    "sideways": [
        robot(80, 105),
        line((110, 105), (320, 105), colour=GREY, dash=DASH),
        arrow((110, 100), (318, 60)),
        words(322, 125, "faces", colour=GREY, anchor="end"),
        words(322, 50, "goes", colour=ORANGE, anchor="end"),
        line((80, 68), (86, 142), colour=ORANGE, dash="2 4"),
    ],
    "slope": [
        line((30, 75), (310, 115), colour=GREY, width=3),
        line((30, 115), (310, 115), colour=GREY, dash=DASH),
        oblong(150, 72, 64, 26, turn=8, fill=GREY),
        circle(128, 82, 9),
        circle(170, 88, 9),
        arrow((200, 80), (275, 91)),
        words(240, 72, "downhill", colour=ORANGE),
    ],
    "carpet": [
        *(line((25, y), (185, y), colour=GREY, width=1.0) for y in range(24, 138, 14)),
        robot(75, 94, size=0.7),
        arrow((100, 94), (190, 94), colour=GREEN),
        words(200, 98, "along it: more", colour=GREEN, anchor="start"),
        arrow((75, 70), (75, 20)),
        words(200, 34, "across it: less", colour=ORANGE, anchor="start"),
    ],
    "castor": [
        robot(180, 72, size=1.3),
        circle(134, 72, 5, colour=INK, fill=INK),
        oblong(116, 72, 28, 10, colour=GREY, dash="3 3"),
        oblong(146, 58, 28, 10, turn=-48, colour=ORANGE, fill=ORANGE),
        arc(134, 72, 25, 170, 65, colour=ORANGE, head=True),
        arrow((240, 50), (312, 50), colour=GREY),
        arrow((312, 64), (240, 64), colour=GREY),
        words(276, 38, "reverses", colour=GREY),
        arc(180, 72, 62, -40, -85, colour=ORANGE, head=True),
        words(262, 122, "kick", colour=ORANGE),
        words(60, 76, "castor", colour=GREY),
    ],
    "lever_arm": [
        robot(140, 78),
        circle(140, 78, 4, colour=INK, fill=INK),
        circle(200, 48, 6, colour=GREEN, fill=GREEN),
        arrow((140, 78), (195, 51)),
        words(212, 46, "what is measured", colour=GREEN, anchor="start"),
        words(104, 83, "axle's middle", anchor="end"),
    ],
    "yaw_offset": [
        robot(120, 90, marker=True),
        arrow((120, 90), (250, 90), colour=GREY),
        words(256, 94, "robot", colour=GREY, anchor="start"),
        arrow((120, 90), (240, 45)),
        words(246, 44, "reference", colour=ORANGE, anchor="start"),
        arc(120, 90, 85, 0, 20, colour=ORANGE),
    ],
    "mirrored": [
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
    ],
    "scale": [
        robot(60, 85),
        arrow((60, 110), (230, 110), colour=GREY),
        words(236, 114, "what was", colour=GREY, anchor="start"),
        arrow((60, 55), (262, 55), colour=GREEN),
        words(150, 42, "what is shown", colour=GREEN),
    ],
    "late": _late,
    "wandering_bias": [
        arrow((30, 125), (318, 125), colour=GREY),
        words(318, 116, "time", colour=GREY, anchor="end"),
        line(*((30 + 230 * at, 112 - 26 * at) for at in _TIMES), colour=BLUE, width=2.5),
        words(268, 90, "heading", colour=BLUE, anchor="start"),
        line(
            *((30 + 230 * at, 112 - 26 * at - 52 * at * at) for at in _TIMES),
            colour=ORANGE,
            width=2.5,
        ),
        words(268, 38, "the gyro's", colour=ORANGE, anchor="start"),
        arrow((255, 80), (255, 42), colour=GREY, both=True),
    ],
}
"""By name; the arguments of those that have any are the labels of a `Sketch`."""
