# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives whose truth is known, seen by a simulated lidar, and what was made of its scans."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.scan_odometry import motion_between
from werrimbi_odom.scans.sweep import Sweep, sweep_of
from werrimbi_odom.scans.three_pass_odometry import ScanMatcher, ScanPath
from werrimbi_odom.simulation import free
from werrimbi_odom.simulation.engine import PERIOD, TruePath
from werrimbi_odom.simulation.lidar import Lidar, Room, Sweeps, scanned


def in_circles(duration: float, speed: float = 0.25) -> TruePath:
    """Three seconds' rest, then bends of both senses, turning up to 1 rad/s."""
    t = np.arange(0.0, duration, PERIOD)
    lead = np.clip(t - 3.0, 0.0, 1.0)
    return _path(
        t, speed * lead * (0.75 + 0.25 * np.sin(0.5 * t)), lead * (0.25 + 0.8 * np.sin(0.556 * t))
    )


def ahead(duration: float, speed: float = 0.3) -> TruePath:
    """Along x, from the origin on."""
    t = np.arange(0.0, duration, PERIOD)
    lead = np.clip(t - 3.0, 0.0, 1.0)
    return _path(t, speed * lead, 0.05 * lead * np.cos(t), middle=False)


def to_and_fro(duration: float, start: float = -1.6) -> TruePath:
    """Along x at 0.3 m/s, 12.5 s ahead and 12.5 s back."""
    t = np.arange(0.0, duration, PERIOD)
    lead = np.clip(t - 3.0, 0.0, 1.0)
    speed = 0.3 * lead * np.clip(3.0 * np.sin(0.08 * np.pi * (t - 3.0)), -1.0, 1.0)
    path = _path(t, speed, 0.05 * lead * np.cos(t), middle=False)
    return replace(path, x_m=path.x_m + start)


def hops(duration: float) -> TruePath:
    """Half a second ahead and half a second back, with hard starts and stops, again and again."""
    t = np.arange(0.0, duration, PERIOD)
    return _path(t, 0.4 * np.clip(3.0 * np.sin(np.pi * t), -1.0, 1.0), 0.0 * t)


def at_rest(duration: float) -> TruePath:
    """Nothing moves."""
    t = np.arange(0.0, duration, PERIOD)
    return _path(t, 0.0 * t, 0.0 * t)


def brisk(duration: float, seed: int) -> TruePath:
    """By joystick, at up to 0.8 m/s and 2 rad/s, with starts and stops of up to 6 rad/s^2."""
    knots = np.array(free(duration, seed=seed, speed=0.8, yaw_rate=2.0, acceleration=1.5).knots)
    t = np.arange(0.0, duration, PERIOD)
    speed, turning = (np.interp(t, knots[:, 0], knots[:, row]) for row in (1, 2))
    return _path(t, speed, turning)


def _path(t: Floats, speed: Floats, turning: Floats, middle: bool = True) -> TruePath:
    yaw = PERIOD * np.cumsum(turning)
    x, y = (PERIOD * np.cumsum(speed * f(yaw)) for f in (np.cos, np.sin))
    if middle:
        x, y = x - x.mean(), y - y.mean()
    nothing = np.zeros(t.size)
    return TruePath(t, x, y, yaw, nothing, nothing)


@dataclass(frozen=True)
class Matched:
    """A path by scans, and the truth at its poses, shape (n, 3)."""

    path: ScanPath
    truth: Floats
    sweeps: Sweeps

    def steps(self) -> tuple[Floats, Floats]:
        """Errors of steps from pose to pose (k, 3), and the NEES of each over 3."""
        rows = np.flatnonzero(np.diff(self.path.piece) == 0)
        return self._between(rows, rows + 1)

    def legs(self, length: float = 1.0) -> tuple[Floats, Floats]:
        """The same of legs of a length [m], of which none spans a cut."""
        return self._between(*self._ends(length))

    def stated_legs(self, length: float) -> tuple[Floats, Floats, Floats]:
        """Their errors (k, 3), the covariances of both matches (k, 3, 3), and the walks (k, 2)."""
        begin, end = self._ends(length)
        walked = self.path.walked[end] - self.path.walked[begin]
        return self._errors(begin, end), self._covariances(begin, end), walked

    def _ends(self, length: float) -> tuple[np.ndarray, np.ndarray]:
        way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(self.truth[:, :2], axis=0).T))])
        ends = np.searchsorted(way, way + length)
        rows = np.flatnonzero(ends < way.size)
        rows = rows[self.path.piece[rows] == self.path.piece[ends[rows]]]
        return rows, ends[rows]

    def _between(self, begin: np.ndarray, end: np.ndarray) -> tuple[Floats, Floats]:
        errors = self._errors(begin, end)
        whitened = np.linalg.solve(self._covariances(begin, end), errors[..., None])
        return errors, np.einsum("ni,ni->n", errors, whitened[..., 0]) / 3.0

    def _covariances(self, begin: np.ndarray, end: np.ndarray) -> Floats:
        # An error of the heading at the beginning moves the end aside.
        carried = np.tile(np.eye(3), (begin.size, 1, 1))
        way = self.path.poses[end] - self.path.poses[begin]
        carried[:, 0, 2], carried[:, 1, 2] = -way[:, 1], way[:, 0]
        first, last = self.path.covariances[begin], self.path.covariances[end]
        both = carried @ first @ carried.transpose(0, 2, 1) + last
        turned = np.array([_axes(yaw) for yaw in self.path.poses[end, 2]]).reshape(-1, 3, 3)
        return np.asarray(turned @ both @ turned.transpose(0, 2, 1))

    def _errors(self, begin: np.ndarray, end: np.ndarray) -> Floats:
        true, found = self.truth, self.path.poses
        return np.array(
            [
                motion_between(
                    motion_between(true[one], true[other]),
                    motion_between(found[one], found[other]),
                )
                for one, other in zip(begin, end, strict=True)
            ]
        ).reshape(-1, 3)


def _axes(yaw: float) -> Floats:
    cos, sin = np.cos(yaw), np.sin(yaw)
    return np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])


def rms(errors: Floats) -> tuple[float, float]:
    """Of positions, an axis [mm], and of headings [mrad]."""
    square = (errors**2).mean(axis=0)
    return 1e3 * float(np.sqrt(square[:2].mean())), 1e3 * float(np.sqrt(square[2]))


def seen(path: TruePath, room: Room, lidar: Lidar, seed: int = 0) -> tuple[Sweeps, list[Sweep]]:
    """What a lidar saw, as the matcher takes it."""
    sweeps = scanned(path, room, lidar, seed)
    return sweeps, taken(sweeps, lidar)


def taken(sweeps: Sweeps, lidar: Lidar) -> list[Sweep]:
    """Scans as the matcher takes them."""
    angles = lidar.increment * np.arange(lidar.beams, dtype=np.float64)
    return [
        sweep_of(time, ranges, angles, lidar.beam_interval, lidar.nearest, lidar.farthest)
        for time, ranges in zip(sweeps.time, sweeps.ranges, strict=True)
    ]


def matched(path: TruePath, room: Room, lidar: Lidar, seed: int = 0) -> Matched:
    """The path by scans of a drive in a room."""
    return of_sweeps(scanned(path, room, lidar, seed), lidar)


def of_sweeps(sweeps: Sweeps, lidar: Lidar) -> Matched:
    """The path by scans."""
    given = taken(sweeps, lidar)
    matcher = ScanMatcher()
    for sweep in given:
        matcher.take(sweep)
    found = matcher.path()
    middle = np.array([sweep.time for sweep in given])
    rows = np.searchsorted(middle, found.time - 1e-6)
    return Matched(found, sweeps.truth[rows], sweeps)
