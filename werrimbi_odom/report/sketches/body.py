# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of what the robot does: its wheels, axle, gears and tyres, its castor, the floor."""

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
    floor,
    line,
    oblong,
    robot,
    words,
)


def _track_width() -> Parts:
    return [
        robot(150, 78),
        line((150, 52), (150, 104), colour=GREY, dash=DASH),
        arrow((215, 52), (215, 104), colour=GREY, both=True),
        words(222, 82, "entered", colour=GREY, anchor="start"),
        arrow((100, 40), (100, 116), both=True),
        words(93, 82, "true", colour=ORANGE, anchor="end"),
        line((100, 40), (150, 40), colour=ORANGE, dash="2 4"),
        line((100, 116), (150, 116), colour=ORANGE, dash="2 4"),
    ]


def _unequal_radii() -> Parts:
    return [
        floor(112),
        circle(95, 80, 32, colour=BLUE),
        circle(205, 87, 25, colour=ORANGE),
        line((95, 80), (205, 87)),
        words(95, 40, "left", colour=BLUE),
        words(205, 50, "right", colour=ORANGE),
        arc(300, 30, 80, 215, 275, colour=ORANGE, head=True),
    ]


def _radius_scale() -> Parts:
    return [
        floor(125),
        circle(80, 90, 35, colour=ORANGE),
        circle(80, 98, 27, colour=GREY, dash=DASH),
        line((80, 90), (104, 65), colour=ORANGE),
        words(125, 62, "true", colour=ORANGE, anchor="start"),
        words(125, 82, "entered", colour=GREY, anchor="start"),
        arrow((130, 108), (300, 108)),
        arrow((130, 118), (255, 118), colour=GREY),
    ]


def _squash() -> Parts:
    return [
        floor(120),
        circle(75, 82, 38, colour=BLUE),
        words(75, 86, "slow", colour=BLUE),
        arrow((120, 60), (150, 60), colour=GREY),
        arc(235, 88, 38, -57, 237, colour=ORANGE),
        line((214, 120), (256, 120), colour=ORANGE, width=3),
        words(235, 92, "fast", colour=ORANGE),
        arrow((280, 60), (328, 60), colour=GREY),
        arrow((290, 84), (290, 119), both=True),
    ]


def _by_channel() -> Parts:
    return [
        floor(125),
        circle(70, 85, 40, colour=ORANGE),
        circle(70, 93, 32, colour=GREY, dash=DASH),
        line((150, 120), (150, 40), colour=GREY),
        line((150, 120), (320, 120), colour=GREY),
        line((150, 100), (190, 60), (235, 92), (280, 52), (318, 70), colour=ORANGE),
        words(235, 40, "a column of ticks.csv", colour=GREY),
    ]


def _load() -> Parts:
    return [
        floor(122),
        oblong(170, 66, 110, 28, fill=GREY),
        oblong(112, 92, 22, 60, colour=BLUE),
        oblong(228, 96, 26, 52, colour=ORANGE),
        words(60, 92, "inner", colour=BLUE),
        words(280, 92, "outer", colour=ORANGE),
        arrow((140, 34), (205, 34)),
        words(132, 30, "load", colour=ORANGE, anchor="end"),
    ]


def _carpet() -> Parts:
    ribs = [line((25, y), (185, y), colour=GREY, width=1.0) for y in range(24, 138, 14)]
    return [
        *ribs,
        robot(75, 94, size=0.7),
        arrow((100, 94), (190, 94), colour=GREEN),
        words(200, 98, "along it: more", colour=GREEN, anchor="start"),
        arrow((75, 70), (75, 20)),
        words(200, 34, "across it: less", colour=ORANGE, anchor="start"),
    ]


def _longitudinal_slip() -> Parts:
    return [
        floor(120),
        circle(80, 82, 38),
        arc(80, 82, 24, 140, 20, colour=BLUE, head=True),
        arrow((130, 62), (215, 62), colour=BLUE),
        words(172, 52, "gaining speed", colour=BLUE),
        arrow((95, 128), (58, 128)),
        words(110, 137, "the tyre creeps back", colour=ORANGE, anchor="start"),
        line((240, 105), (265, 75), (295, 75), (318, 105), colour=GREY),
    ]


def _slip_above() -> Parts:
    return [
        line((50, 120), (335, 120), colour=GREY),
        line((50, 120), (50, 25), colour=GREY),
        line((50, 120), (180, 120), colour=GREEN),
        line((180, 120), (310, 40)),
        line((180, 126), (180, 30), colour=GREY, dash=DASH),
        words(115, 108, "it holds", colour=GREEN),
        words(236, 62, "it slips", colour=ORANGE, anchor="end"),
        words(192, 138, "acceleration", colour=GREY, anchor="start"),
        words(58, 32, "lost", colour=GREY, anchor="start"),
    ]


def _lateral_slip() -> Parts:
    return [
        arc(150, 190, 130, 130, 50, colour=GREY, dash=DASH),
        arc(150, 190, 152, 118, 50, colour=ORANGE, head=True),
        robot(142, 50, turn=2, size=0.8),
        arrow((175, 38), (182, 8)),
        words(192, 20, "outwards", colour=ORANGE, anchor="start"),
        words(240, 96, "predicted", colour=GREY, anchor="start"),
    ]


def _turn_dependent() -> Parts:
    return [
        robot(75, 70, size=0.8),
        arc(75, 70, 45, 40, 330, colour=BLUE, head=True),
        words(75, 140, "on the spot", colour=BLUE),
        robot(225, 100, size=0.8),
        arc(225, 20, 80, 235, 305, colour=ORANGE, head=True),
        words(225, 143, "wide curve", colour=ORANGE),
    ]


def _skid_steer() -> Parts:
    tyres = [oblong(x, y, 34, 13, colour=INK, fill=GREY) for x in (128, 182) for y in (58, 102)]
    return [
        oblong(155, 80, 92, 34, colour=BLUE),
        *tyres,
        line((155, 12), (155, 148), colour=GREY, dash=DASH),
        circle(163, 18, 4, colour=ORANGE, fill=ORANGE),
        circle(163, 142, 4, colour=ORANGE, fill=ORANGE),
        words(172, 22, "centre of the left side", colour=ORANGE, anchor="start"),
        words(172, 146, "centre of the right side", colour=ORANGE, anchor="start"),
        arrow((82, 18), (82, 142), both=True),
        words(76, 84, "acts", colour=ORANGE, anchor="end"),
        arrow((100, 58), (100, 102), colour=GREY, both=True),
        arc(155, 80, 78, 335, 25, colour=ORANGE, head=True),
    ]


def _sideways_drift() -> Parts:
    return [
        robot(80, 105),
        line((110, 105), (320, 105), colour=GREY, dash=DASH),
        arrow((110, 100), (318, 60)),
        words(322, 125, "faces", colour=GREY, anchor="end"),
        words(322, 50, "goes", colour=ORANGE, anchor="end"),
        line((80, 68), (86, 142), colour=ORANGE, dash="2 4"),
    ]


def _floor_slope() -> Parts:
    return [
        line((30, 75), (310, 115), colour=GREY, width=3),
        line((30, 115), (310, 115), colour=GREY, dash=DASH),
        oblong(150, 72, 64, 26, turn=8, fill=GREY),
        circle(128, 82, 9),
        circle(170, 88, 9),
        arrow((200, 80), (275, 91)),
        words(240, 72, "downhill", colour=ORANGE),
    ]


def _castor_kick() -> Parts:
    return [
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
    ]


def _backlash(side: str) -> Parts:
    colour = BLUE if side == "left" else ORANGE

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


def _radius_drift() -> Parts:
    return [
        floor(115),
        circle(75, 77, 38, colour=BLUE),
        circle(180, 82, 33, colour=BLUE, dash=DASH),
        circle(280, 88, 27, colour=ORANGE),
        arrow((30, 130), (310, 130), colour=GREY),
        words(170, 146, "time, distance", colour=GREY),
    ]


DRAWINGS: Mapping[str, Callable[..., Parts]] = {
    "track": _track_width,
    "unequal": _unequal_radii,
    "radius": _radius_scale,
    "squash": _squash,
    "load": _load,
    "by_channel": _by_channel,
    "slip_above": _slip_above,
    "slip_ahead": _longitudinal_slip,
    "slip_outwards": _lateral_slip,
    "two_bases": _turn_dependent,
    "skid": _skid_steer,
    "sideways": _sideways_drift,
    "slope": _floor_slope,
    "carpet": _carpet,
    "castor": _castor_kick,
    "backlash": _backlash,
    "shrinking": _radius_drift,
}
"""By name; what they are called with are the labels of a `Sketch`."""
