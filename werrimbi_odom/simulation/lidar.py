# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A lidar on the robot, in rooms: each beam is measured at its own time while the robot moves."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from .engine import AxlePose, Floats, TruePath
from .sensors import WORLD

_BLOCK = 1 << 14


@dataclass(frozen=True)
class Person:
    """A person who walks to and fro between two points; the lidar sees one leg, a circle."""

    start: tuple[float, float]
    end: tuple[float, float]
    """Turning points [m]."""
    period: float = 8.0
    """Time of one return trip [s]."""
    radius: float = 0.12
    """Radius of the circle [m]."""


@dataclass(frozen=True)
class Room:
    """Obstacles for the lidar, in world axes."""

    walls: Floats
    """Line segments from x, y to x, y [m], shape (k, 4)."""
    people: Sequence[Person] = ()
    panes: Floats = field(default_factory=lambda: np.zeros((0, 4)))
    """Panes of glass, as walls: some beams see them, the others see through, shape (k, 4) [m]."""


@dataclass(frozen=True)
class Lidar:
    """A rotating lidar."""

    beams: int = 218
    """Number of beams of a turn."""
    rate_hz: float = 10.0
    """Turns per second."""
    nearest: float = 0.12
    farthest: float = 8.0
    """Range limits [m]."""
    noise: float = 5e-3
    noise_share: float = 5e-3
    """Standard deviation of a range: a length [m], and a share of the range; variances add."""
    bias: float = 0.0
    """Added to each range [m]."""
    lost: float = 0.02
    mixed: float = 0.0
    """Shares of beams without an echo, and of beams at an edge, with a range between both."""
    mount: AxlePose = WORLD
    """Ahead and to the left of the axle's midpoint [m], and yaw [rad]."""
    rotates: bool = True
    """Whether each beam has its own time; otherwise all are simultaneous, as in some simulators."""
    upside_down: bool = False
    """Whether beams go clockwise, seen from above."""
    sees_glass: float = 0.3
    """Share of the beams at a pane of glass that it reflects."""

    @property
    def increment(self) -> float:
        """Angle between two beams [rad]."""
        return 2.0 * math.pi / self.beams

    @property
    def beam_interval(self) -> float:
        """Time between two beams [s]."""
        return 1.0 / self.rate_hz / self.beams if self.rotates else 0.0


@dataclass(frozen=True)
class Sweeps:
    """Scans; n of them. Beam i has the direction i times the increment."""

    time: Floats
    """Time of the first beam [s], shape (n,)."""
    ranges: Floats
    """Ranges [m]; infinite without an echo, shape (n, beams)."""
    truth: Floats
    """Pose of the lidar in the middle of each sweep: x, y [m], yaw [rad], shape (n, 3)."""


def scanned(path: TruePath, room: Room, lidar: Lidar, seed: int) -> Sweeps:
    """Scans of a lidar along a path."""
    rng = np.random.default_rng([seed, 79])
    turn = 1.0 / lidar.rate_hz
    start = np.arange(path.t_s[0] + rng.uniform(0.0, turn), path.t_s[-1] - turn, turn)
    return sweeps_at(path, room, lidar, start, rng)


def sweeps_at(
    path: TruePath, room: Room, lidar: Lidar, start: Floats, rng: np.random.Generator
) -> Sweeps:
    """Scans of a lidar for turns that begin at `start` (n,) [s]."""
    number = np.arange(lidar.beams)
    at = (start[:, None] + lidar.beam_interval * number).ravel()
    x, y, yaw = _lidar_at(path, lidar, at)
    sense = -1.0 if lidar.upside_down else 1.0
    direction = yaw + sense * lidar.increment * np.tile(number, start.size)

    def first(obstacles: Room) -> Floats:
        blocks = [
            _distance(obstacles, *(each[row : row + _BLOCK] for each in (x, y, direction, at)))
            for row in range(0, at.size, _BLOCK)
        ]
        return np.concatenate(blocks).reshape(start.size, -1)

    true = first(room)
    if len(room.panes):
        pane = np.where(rng.random(true.shape) < lidar.sees_glass, first(Room(room.panes)), np.inf)
        true = np.minimum(true, pane)
    beside = np.roll(true, 1, axis=1)
    apart = np.zeros(true.shape)
    np.subtract(beside, true, out=apart, where=np.isfinite(true) & np.isfinite(beside))
    mixed = (rng.random(true.shape) < lidar.mixed) & (np.abs(apart) > 0.2)
    true = np.where(mixed, true + rng.random(true.shape) * apart, true)
    sigma = np.hypot(lidar.noise, lidar.noise_share * np.where(np.isfinite(true), true, 0.0))
    ranges = true + lidar.bias + sigma * rng.standard_normal(true.shape)
    unseen = (ranges < lidar.nearest) | (ranges > lidar.farthest)
    ranges[unseen | (rng.random(true.shape) < lidar.lost)] = np.inf
    middle = start + 0.5 * (lidar.beams - 1) * lidar.beam_interval
    return Sweeps(start, ranges, np.column_stack(_lidar_at(path, lidar, middle)))


def _lidar_at(path: TruePath, lidar: Lidar, at: Floats) -> tuple[Floats, Floats, Floats]:
    x, y, yaw = (np.interp(at, path.t_s, each) for each in (path.x_m, path.y_m, path.yaw_rad))
    cos, sin, mount = np.cos(yaw), np.sin(yaw), lidar.mount
    return (x + cos * mount.x - sin * mount.y, y + sin * mount.x + cos * mount.y, yaw + mount.yaw)


def _distance(room: Room, x: Floats, y: Floats, direction: Floats, at: Floats) -> Floats:
    """Distance to the nearest obstacle along each beam, shape (m,) [m]; infinite for none."""
    cos, sin = np.cos(direction)[:, None], np.sin(direction)[:, None]
    ax, ay, bx, by = room.walls.T
    dx, dy = bx - ax, by - ay
    from_x, from_y = ax - x[:, None], ay - y[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        across = cos * dy - sin * dx
        along = (from_x * dy - from_y * dx) / across
        where = (from_x * sin - from_y * cos) / across
        hit = (along > 0.0) & (where >= 0.0) & (where <= 1.0)
    nearest = np.where(hit, along, np.inf).min(axis=1, initial=np.inf)
    for person in room.people:
        share = (0.5 - 0.5 * np.cos(2.0 * math.pi * at / person.period))[:, None]
        centre = np.array(person.start) + share * (np.array(person.end) - np.array(person.start))
        to_x, to_y = centre[:, 0] - x, centre[:, 1] - y
        ahead = to_x * cos[:, 0] + to_y * sin[:, 0]
        beside = to_x * sin[:, 0] - to_y * cos[:, 0]
        depth = person.radius**2 - beside**2
        seen = (depth > 0.0) & (ahead > 0.0)
        nearest = np.where(seen, np.minimum(nearest, ahead - np.sqrt(np.abs(depth))), nearest)
    return np.asarray(nearest)
