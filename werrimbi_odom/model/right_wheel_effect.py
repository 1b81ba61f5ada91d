# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects of the right wheel, which are those of the left one with the sides exchanged."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

from werrimbi_odom.model.effect import Apply, Effect, Sketch

_SIDES = {"left": "right", "right": "left", "Left": "Right", "Right": "Left"}


def on_the_right(left: Effect) -> Callable[[Apply], Effect]:
    """Declare a function as the effect `left` of the right wheel.

    Parameters, page and sketch are those of `left`; the function's docstring is not shown to users.
    """

    def declare(apply: Apply) -> Effect:
        sketch = left.sketch
        if sketch is not None:
            says, caption = _exchanged(sketch.says), _exchanged(sketch.caption)
            sketch = Sketch(sketch.drawing, says, caption, tuple(map(_exchanged, sketch.labels)))
        name, doc = apply.__name__, _exchanged(left.doc)
        return replace(left, name=name, apply=apply, doc=doc, sketch=sketch)

    return declare


def _exchanged(words: str) -> str:
    """Text with left and right exchanged, as words of their own or in names (left_backlash)."""
    return re.sub(
        r"(?<![A-Za-z])(?:[Ll]eft|[Rr]ight)(?![A-Za-z])", lambda side: _SIDES[side[0]], words
    )
