# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sketches of the physics of effects: one parametric drawing for each family of effects."""

from __future__ import annotations

from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.sketches import robot, wheels
from werrimbi_odom.report.sketches.parts import drawing

DRAWINGS = {**wheels.DRAWINGS, **robot.DRAWINGS}


def effect_sketch(effect: Effect) -> str | None:
    """The sketch as SVG; None for an effect without one."""
    sketch = effect.sketch
    if sketch is None:
        return None
    drawn = DRAWINGS[sketch.drawing]
    parts = drawn(*sketch.labels) if callable(drawn) else drawn
    return drawing(effect.name, sketch.says, sketch.caption, parts)
