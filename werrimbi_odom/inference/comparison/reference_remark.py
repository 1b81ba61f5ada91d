# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is suspect about a reference, and where."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

What = Literal[
    "another_drive",
    "no_turn",
    "places",
    "scale",
    "short",
    "sideways",
    "sideways_by_place",
    "apart",
    "metre",
    "at_rest",
]
"""Kind of anomaly. another_drive: nothing in common with the wheels; no_turn: headings that do not
change; places: only its turns; scale: only its way, by a factor; short: path shorter (or longer) in
places; sideways: constant angle between path and heading; sideways_by_place: such an angle in
places; apart: an angle that grows; metre: another metric scale; at_rest: the wheels go on where it
stands."""


@dataclass(frozen=True, slots=True)
class Stretch:
    """A few metres of a run."""

    run: Path
    begin: float
    """[s]"""
    end: float
    size: float
    """Size of the anomaly."""
    started: float = 0.0
    """First tick of the run [s], as in `LeftOut`."""


@dataclass(frozen=True, slots=True)
class ReferenceRemark:
    """An anomaly of a reference, or of the wheels beside it."""

    what: What
    size: float
    """short, metre: relative path length error, negative if shorter; scale: its path [m]; at_rest:
    speed of the left wheel [m/s]; else an angle [rad]."""
    usual: float = 0.0
    """Value over the normal stretches; no_turn: turn by the wheels [rad]; scale: their way [m];
    at_rest: speed of the right wheel [m/s]."""
    stretches: tuple[Stretch, ...] = ()
    """Stretches concerned; empty if all."""
