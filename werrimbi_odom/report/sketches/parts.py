# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drawing primitives for the sketches: SVG with the colours of the page around it."""

from __future__ import annotations

import html
import math
from collections.abc import Callable, Sequence

INK = "currentColor"
BLUE, ORANGE = "var(--blue, #0072B2)", "var(--orange, #D55E00)"
GREEN, GREY = "var(--green, #009E73)", "var(--grey, #6B6B6B)"
SIDES = {"left": BLUE, "right": ORANGE}
WIDTH, HEIGHT = 340, 170

DASH = "6 5"
"""Dash pattern of lines for what is only intended or imagined."""

Point = tuple[float, float]
Parts = list[str]
Drawing = Parts | Callable[..., Parts]


def drawing(name: str, says: str, caption: str, parts: Sequence[str]) -> str:
    """The whole sketch; `says` is its text for screen readers."""
    below = words(WIDTH / 2, HEIGHT - 11, caption)
    return (
        f'<svg class="sketch" viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" '
        f'role="img" aria-label="{html.escape(f"{name}: {says}")}" fill="none" '
        f'stroke-linecap="round" stroke-linejoin="round" font-family="system-ui, sans-serif" '
        f'font-size="13">{"".join(parts)}{below}</svg>'
    )


def line(*points: Point, colour: str = INK, width: float = 2.0, dash: str = "") -> str:
    """A polyline."""
    path = "M" + " L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path d="{path}" stroke="{colour}" stroke-width="{width}"{_dashed(dash)}/>'


def circle(
    x: float, y: float, r: float, *, colour: str = INK, dash: str = "", fill: str = ""
) -> str:
    """A circle; a disc if filled."""
    return (
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="{r:.1f}" stroke="{colour}" stroke-width="2"'
        f"{_dashed(dash)}{_filled(fill)}/>"
    )


def oblong(
    x: float, y: float, width: float, height: float,
    *, turn: float = 0.0, colour: str = INK, fill: str = "", dash: str = "",
) -> str:  # fmt: skip
    """A rectangle by its centre, rotated clockwise [degrees]."""
    return (
        f'<rect x="{x - width / 2:.1f}" y="{y - height / 2:.1f}" width="{width:.1f}" '
        f'height="{height:.1f}" rx="3" transform="rotate({turn:.1f} {x:.1f} {y:.1f})" '
        f'stroke="{colour}" stroke-width="2"{_dashed(dash)}{_filled(fill)}/>'
    )


def arrow(start: Point, end: Point, *, colour: str = ORANGE, both: bool = False) -> str:
    """A straight arrow."""
    parts = [line(start, end, colour=colour, width=2.5), _head(start, end, colour)]
    if both:
        parts.append(_head(end, start, colour))
    return "".join(parts)


def arc(
    x: float, y: float, r: float, begin: float, end: float,
    *, colour: str = INK, dash: str = "", head: bool = False,
) -> str:  # fmt: skip
    """Part of a circle between two angles [degrees, anticlockwise from the right]."""
    count = max(6, int(abs(end - begin) / 6))
    points = [
        (x + r * math.cos(math.radians(at)), y - r * math.sin(math.radians(at)))
        for at in (begin + (end - begin) * step / count for step in range(count + 1))
    ]
    found = line(*points, colour=colour, dash=dash)
    return found + (_head(points[-2], points[-1], colour) if head else "")


def wave(
    x: float, y: float, width: float, height: float, *, colour: str = ORANGE, turns: float = 2.0
) -> str:
    """A sine wave to the right."""
    points = [
        (x + width * step / 60, y - height * math.sin(2.0 * math.pi * turns * step / 60))
        for step in range(61)
    ]
    return line(*points, colour=colour, width=2.5)


def words(x: float, y: float, text: str, *, colour: str = INK, anchor: str = "middle") -> str:
    """A label."""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" text-anchor="{anchor}">'
        f"{html.escape(text)}</text>"
    )


def robot(
    x: float, y: float, *, turn: float = 0.0, size: float = 1.0,
    left: str = INK, right: str = INK, marker: bool = False,
) -> str:  # fmt: skip
    """A robot from above, facing right, rotated anticlockwise [degrees]; left is up on the page."""
    s = size
    parts = [
        f'<path d="M{-26 * s} {-20 * s} H{14 * s} L{28 * s} 0 L{14 * s} {20 * s} H{-26 * s} Z" '
        f'stroke="{INK}" stroke-width="2" fill="{GREY}" fill-opacity="0.15"/>',
        _wheel(-26.0 * s, s, left),
        _wheel(26.0 * s, s, right),
    ]
    if marker:
        parts.append(f'<circle cx="0" cy="0" r="{4 * s}" fill="{GREEN}"/>')
    return f'<g transform="translate({x} {y}) rotate({-turn})">{"".join(parts)}</g>'


def _wheel(y: float, s: float, colour: str) -> str:
    return (
        f'<rect x="{-11.0 * s}" y="{y - 4 * s}" width="{22 * s}" height="{8 * s}" rx="2" '
        f'fill="{colour}" stroke="{colour}"/>'
    )


def floor(y: float = 140.0, end: float = WIDTH - 20.0) -> str:
    """The floor, seen from the side."""
    return line((20, y), (end, y), colour=GREY)


def _head(start: Point, end: Point, colour: str) -> str:
    angle = math.atan2(end[1] - start[1], end[0] - start[0])
    sides = [
        (end[0] - 10 * math.cos(angle + off), end[1] - 10 * math.sin(angle + off))
        for off in (0.45, -0.45)
    ]
    return line(sides[0], end, sides[1], colour=colour, width=2.5)


def _dashed(dash: str) -> str:
    return f' stroke-dasharray="{dash}"' if dash else ""


def _filled(fill: str) -> str:
    return f' fill="{fill}" fill-opacity="0.25"' if fill else ""
