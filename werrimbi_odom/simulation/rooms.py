# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Rooms for a lidar: furnished, bare, long. They are centred at the origin unless stated."""

from __future__ import annotations

import numpy as np

from .engine import Floats
from .lidar import Person, Room


def living_room(people: bool = False) -> Room:
    """6 m by 5 m with a cupboard, shelves, a sofa, table legs and an oblique wall."""
    walls = [
        box(-3.0, -2.5, 3.0, 2.5),
        box(2.5, -1.2, 3.0, 0.6),  # a cupboard
        box(-3.0, 1.6, -2.2, 2.5),  # shelves
        box(-0.8, 2.0, 1.1, 2.5),  # a sofa
        np.array([[-3.0, -1.3, -2.1, -2.5]]),
        *(box(x, y, x + 0.05, y + 0.05) for x in (1.3, 2.2) for y in (1.2, 1.8)),
    ]
    walking = (
        Person((-1.8, -1.8), (1.9, -1.9), 9.0),
        Person((2.2, 1.0), (2.1, -1.4), 7.0),
        Person((-2.4, 1.2), (0.8, 1.7), 11.0),
    )
    return Room(np.vstack(walls), walking if people else ())


def living_room_with_glass() -> Room:
    """The same; 2 m of a wall are a pane, and behind it is another room."""
    walls = living_room().walls
    left = (walls[:, [0, 2]] == -3.0).all(axis=1) & (np.abs(walls[:, 3] - walls[:, 1]) > 4.0)
    sides = [[-3.0, -2.5, -3.0, -1.0], [-3.0, 1.0, -3.0, 2.5], [-5.5, -2.5, -5.5, 2.5]]
    return Room(np.vstack([walls[~left], sides]), panes=np.array([[-3.0, -1.0, -3.0, 1.0]]))


def arena(side: float = 2.6) -> Room:
    """A square with a bar in it."""
    half = 0.5 * side
    return Room(np.vstack([box(-half, -half, half, half), box(0.8, -0.3, 1.0, 0.1)]))


def corridor(length: float = 80.0, width: float = 2.0) -> Room:
    """Two bare walls along x, from -10 m on; the ends are beyond the lidar's range."""
    half = 0.5 * width
    return Room(np.array([[-10.0, -half, length, -half], [-10.0, half, length, half]]))


def corridor_with_cupboards(length: float = 40.0, width: float = 2.0, seed: int = 0) -> Room:
    """A corridor with cupboards and door frames every metre or two, on both sides."""
    rng = np.random.default_rng(seed)
    half = 0.5 * width
    walls = [box(-3.0, -half, length, half)]
    for side in (-1.0, 1.0):
        x = -2.5
        while x < length - 1.5:
            wide, deep = rng.uniform(0.3, 1.0), rng.uniform(0.1, 0.35)
            one, other = sorted((side * half, side * (half - deep)))
            walls.append(box(x, one, x + wide, other))
            x += wide + rng.uniform(0.6, 1.6)
    return Room(np.vstack(walls))


def around(x: Floats, y: Floats, seed: int = 0, margin: float = 1.0) -> Room:
    """A furnished room around a path that keeps clear of the path.

    `margin` is the least distance from the path to a wall [m]; cupboards take up to half of it.
    """
    rng = np.random.default_rng([seed, 80])
    wide = margin + rng.uniform(0.0, 0.6, 4)
    left, lower = x.min() - wide[0], y.min() - wide[1]
    right, upper = x.max() + wide[2], y.max() + wide[3]
    walls = [box(left, lower, right, upper)]
    for begin, end, wall, inwards, along_x in (
        (left, right, lower, 1.0, True),
        (left, right, upper, -1.0, True),
        (lower, upper, left, 1.0, False),
        (lower, upper, right, -1.0, False),
    ):
        at = begin + rng.uniform(0.2, 0.8)
        while at < end - 0.8:
            size, deep = rng.uniform(0.3, 1.0), inwards * rng.uniform(0.15, 0.5) * margin
            one = box(at, wall, at + size, wall + deep)
            walls.append(one if along_x else one[:, [1, 0, 3, 2]])
            at += size + rng.uniform(0.4, 1.5)
    return Room(np.vstack(walls))


def box(left: float, lower: float, right: float, upper: float) -> Floats:
    """Four sides of a rectangle, shape (4, 4)."""
    corners = np.array([(left, lower), (right, lower), (right, upper), (left, upper)])
    return np.hstack([corners, np.roll(corners, -1, axis=0)])
