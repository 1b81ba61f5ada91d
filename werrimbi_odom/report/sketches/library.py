# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A sketch of each effect's physics: one small drawing a family, left and right by its colours."""

from __future__ import annotations

from werrimbi_odom.report.sketches import body, records
from werrimbi_odom.report.sketches.parts import drawing

SKETCHES = {**body.SKETCHES, **records.SKETCHES}
"""For each effect of the library what the drawing shows, and the drawing."""


def effect_sketch(name: str) -> str | None:
    """The drawing (SVG); None for an effect that the library does not hold."""
    found = SKETCHES.get(name)
    if found is None:
        return None
    says, draw = found
    return drawing(name, says, draw())
