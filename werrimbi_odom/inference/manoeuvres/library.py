# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Library of simple manoeuvres, which anybody and `drive_node` can drive: definitions only."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

Move = tuple[float, float, float]
"""Length [m], turn [rad], and pace: 1 for fast, less for slower."""


@dataclass(frozen=True, slots=True)
class Ideal:
    """A manoeuvre of the library."""

    name: str
    """As in `werrimbi_odom.simulation`, if it is there."""
    words: str
    """What to drive."""
    where: str
    """Phrase for a sentence about the differences to expect."""
    moves: Callable[[float], Sequence[Move]]
    """Moves for a robot of a given size [m]."""
    hard: bool = False
    """With starts and stops as hard as the robot's."""


def _square(size: float) -> list[Move]:
    sides = [(2.0 * size, 0.0, 0.6), (0.0, 0.5 * math.pi, 0.6)]
    return sides * 4 + [(length, -turn, pace) for length, turn, pace in sides] * 4


def _spins(size: float) -> list[Move]:
    return [(0.0, sense * 4.0 * math.pi, pace) for pace in (1.0, 0.4) for sense in (1.0, -1.0)]


def _arcs(size: float) -> list[Move]:
    return [
        (direction * radius * size * math.pi, direction * sense * math.pi, pace)
        for pace in (0.3, 1.0)
        for radius in (0.4, 1.2)
        for sense in (1.0, -1.0)
        for direction in (1.0, -1.0)
    ]


def _out_and_back(size: float) -> list[Move]:
    return [(way * 3.0 * size, 0.0, pace) for pace in (0.25, 0.6, 1.0) * 2 for way in (1.0, -1.0)]


def _start_stop(size: float) -> list[Move]:
    # Hops of unequal length: otherwise all legs, of one length, would end at the same speed.
    hops = (0.35, 0.5, 0.65, 0.8, 0.45, 0.6)
    return [(way * hop * size, 0.0, 1.0) for way in (1.0, -1.0) for hop in hops] * 2


def _figure_eight(size: float) -> list[Move]:
    around = 2.0 * math.pi * size
    return [(around, sense * 2.0 * math.pi, pace) for pace in (0.3, 0.8) for sense in (1.0, -1.0)]


def _stand_still(size: float) -> list[Move]:
    return [(0.0, 0.0, 60.0), (size, 0.0, 0.6), (0.0, 0.0, 60.0), (-size, 0.0, 0.6)]


MANOEUVRES: tuple[Ideal, ...] = (
    Ideal("spins", "spins on the spot, to the left and to the right, fast and slow",
          "spinning on the spot", _spins),
    Ideal("arcs", "small and large arcs, to both sides, forwards and backwards, slow and fast",
          "on small and large arcs, slow and fast", _arcs),
    Ideal("out_and_back", "lines, forwards and backwards again, slowly, then faster, then fast",
          "on lines, slow and fast, forwards and backwards", _out_and_back),
    Ideal("start_stop", "short hops with hard starts and hard stops, forwards and backwards",
          "starting and stopping hard", _start_stop, True),
    Ideal("square", "a square to the left and a square to the right, turning on the spot",
          "around squares in both senses", _square),
    Ideal("figure_eight", "figures of eight, slowly, then fast", "around eights, slow and fast",
          _figure_eight),
    Ideal("stand_still", "short lines, with a minute of standing still between them",
          "standing still", _stand_still),
)  # fmt: skip
"""Simplest first: of equals the first one is chosen."""
