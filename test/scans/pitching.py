# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a lidar sees as its robot pitches: the floor, and one step of stairs after the other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.simulation import rooms
from werrimbi_odom.simulation.engine import TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, Sweeps, scanned

HEIGHT = 0.17
"""Of the lidar above the floor [m], as a TurtleBot3's."""
LIDAR = Lidar()
RISE, TREAD, RISERS = 0.17, 0.3, 6
"""Of stairs [m]: a lidar that is level looks at the edge of the first step."""
SPOT = 0.01
"""An echo is mixed if the beam passes an edge by less [m]."""


def pitched(
    sweeps: Sweeps, pitch: Callable[[Floats], Floats], aside: float = 0.0
) -> tuple[Sweeps, float]:
    """Scans of a lidar that looks down by an angle [rad], by time; and the floor's share.

    It looks down ahead, or to the left by an angle `aside` [rad].
    """
    falls, slant = _falls(sweeps, pitch, aside)
    floor = np.where(falls > 1e-6, HEIGHT / np.maximum(falls, 1e-6), np.inf)
    sigma = np.hypot(LIDAR.noise, LIDAR.noise_share * np.minimum(floor, LIDAR.farthest))
    noise = sigma * np.random.default_rng(0).standard_normal(floor.shape)
    ranges = np.minimum(slant, floor + noise)
    ranges[ranges > LIDAR.farthest] = np.inf
    return replace(sweeps, ranges=ranges), float((floor < slant).mean())


def _falls(
    sweeps: Sweeps, pitch: Callable[[Floats], Floats], aside: float
) -> tuple[Floats, Floats]:
    """By how much each beam falls on its way, and how far it goes to what stands upright [m]."""
    beams = sweeps.ranges.shape[1]
    turn = np.arange(beams) / beams
    angle = 2.0 * np.pi * turn - aside
    down = pitch(sweeps.time[:, None] + turn / LIDAR.rate_hz)
    slant = sweeps.ranges / np.hypot(np.cos(angle) * np.cos(down), np.sin(angle))
    return np.cos(angle) * np.sin(down), slant


def swaying(seed: int, degrees: float = 1.5, every: float = 0.15) -> Callable[[Floats], Floats]:
    """A pitch [rad] that is another one every so often [s], of a standard deviation."""
    knots = np.radians(degrees) * np.random.default_rng([seed, 3]).standard_normal(4000)
    return lambda time: np.interp(time, every * np.arange(knots.size), knots)


def room_beside_stairs() -> Room:
    """The room of 6 x 5 m; 2 m of a wall lack, as where stairs go down: nothing is seen there."""
    walls = rooms.living_room_with_glass().walls
    return Room(walls[(walls[:, [0, 2]] > -5.4).all(axis=1)])


def corridor_to_stairs() -> Room:
    """Bare; its other end is beyond the lidar's range."""
    return Room(np.array([[-3.0, side, 80.0, side] for side in (-1.0, 1.0)]))


def before_stairs_up(
    path: TruePath, room: Room, lidar: Lidar, seed: int, every: float = 0.15
) -> Sweeps:
    """Stairs go up where the wall lacks, between walls; the robot sways as it drives.

    A beam meets the first riser that is above it. At an edge its echo lies between two.
    """
    end = -3.0 - TREAD * RISERS
    beside = [[-3.0, side, end, side] for side in (-1.0, 1.0)]
    sway, random = swaying(seed, every=every), np.random.default_rng([seed, 4])

    def seen(riser: int) -> Sweeps:
        x = -3.0 - TREAD * riser
        walls = np.vstack([room.walls, beside, [[x, -1.0, x, 1.0]]])
        return scanned(path, Room(walls), lidar, seed)

    sweeps = seen(RISERS - 1)
    ranges = np.minimum(sweeps.ranges, 1e3)
    for riser in reversed(range(RISERS - 1)):
        near = np.minimum(seen(riser).ranges, 1e3)
        falls, slant = _falls(replace(sweeps, ranges=near), sway, 0.0)
        over = HEIGHT - falls * slant - RISE * (riser + 1)
        between = near + random.random(near.shape) * (ranges - near)
        ranges = np.where(np.abs(over) < SPOT, between, np.where(over > 0.0, ranges, near))
    ranges[ranges > lidar.farthest] = np.inf
    return pitched(replace(sweeps, ranges=ranges), sway)[0]
