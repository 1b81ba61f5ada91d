# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Somebody holds the robot while its wheels turn, or carries it while it stands: in its path."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .engine import PERIOD, Floats, TruePath
from .recording import Happened

HELD, CARRIED = 4.0, 5.0
"""Durations of holding and carrying the robot [s]."""

TURN = 2.0 * math.pi
"""One revolution of a wheel [rad]."""

AT_PACE = 0.5
"""Time in which the carrying hand reaches its speed [s]."""


def later(event: Happened, *inserted: Sequence[float]) -> Happened:
    """The event after times were inserted into the drive, given by their begin and end [s]."""
    for begin, end in inserted:
        if event.t_s > begin:
            event = replace(event, t_s=event.t_s + end - begin)
    return event


def _inserted(path: TruePath, row: int, more: Floats) -> TruePath:
    """The path with rows (x, y, yaw, left, right) inserted after a row; later rows are delayed."""
    table = np.column_stack(
        [path.x_m, path.y_m, path.yaw_rad, path.left_angle_rad, path.right_angle_rad]
    )
    table = np.vstack([table[: row + 1], more, table[row + 1 :]])
    time = np.asarray(PERIOD * np.arange(len(table)), dtype=np.float64)
    return TruePath(time, *np.ascontiguousarray(table.T))


def held_in(path: TruePath, rng: np.random.Generator) -> tuple[TruePath, list[float]]:
    """Insert a time in which somebody holds the robot: its wheels turn, it does not move.

    They turn by whole revolutions at about the same speed as before, because the rest of the drive
    was recorded with certain wheel angles, and effects of unround wheels depend on these.
    """
    speed = np.abs(np.gradient(path.left_angle_rad + path.right_angle_rad))
    row = _somewhere(speed > 0.5 * speed.max(), (0.2, 0.45), rng)
    steps = round(HELD / PERIOD)
    gone = [TURN * round((angle[row] - angle[row - 1]) * steps / TURN) for angle in _angles(path)]
    share = np.arange(1, steps + 1) / steps
    turned = [angle[row] + more * share for angle, more in zip(_angles(path), gone, strict=True)]
    still = np.tile([path.x_m[row], path.y_m[row], path.yaw_rad[row]], (steps, 1))
    longer = _inserted(path, row, np.column_stack([still, *turned]))
    on = row + 1 + steps  # wheel angles of the rest of the drive are larger by this
    left, right = longer.left_angle_rad.copy(), longer.right_angle_rad.copy()
    left[on:] += gone[0]
    right[on:] += gone[1]
    longer = replace(longer, left_angle_rad=left, right_angle_rad=right)
    return longer, [float(longer.t_s[row]), float(longer.t_s[row + steps])]


def _angles(path: TruePath) -> tuple[Floats, Floats]:
    return path.left_angle_rad, path.right_angle_rad


def carried_in(path: TruePath, rng: np.random.Generator) -> tuple[TruePath, list[float]]:
    """Insert a time in which somebody lifts the robot at rest and puts it down elsewhere."""
    speed = np.abs(np.gradient(path.left_angle_rad)) + np.abs(np.gradient(path.right_angle_rad))
    row = _somewhere(speed <= np.quantile(speed, 0.02), (0.55, 0.9), rng)
    steps = round(CARRIED / PERIOD)
    pace = np.minimum(np.arange(1, steps + 1), np.arange(steps, 0, -1)) * PERIOD / AT_PACE
    share = np.cumsum(np.minimum(pace, 1.0))
    share /= share[-1]
    away = rng.uniform(0.5, 1.5) * np.exp(1j * rng.uniform(-np.pi, np.pi))
    turn = float(rng.uniform(0.5, 2.5) * rng.choice([-1.0, 1.0]))
    here = complex(path.x_m[row], path.y_m[row])
    there = here + share * away
    yaw = path.yaw_rad[row] + share * turn
    stopped = np.tile([angle[row] for angle in _angles(path)], (steps, 1))
    longer = _inserted(path, row, np.column_stack([there.real, there.imag, yaw, stopped]))
    on = row + 1 + steps
    place = longer.x_m + 1j * longer.y_m
    place[on:] = here + away + (place[on:] - here) * np.exp(1j * turn)
    heading = longer.yaw_rad.copy()
    heading[on:] += turn
    longer = replace(
        longer, x_m=np.ascontiguousarray(place.real), y_m=place.imag.copy(), yaw_rad=heading
    )
    return longer, [float(longer.t_s[row]), float(longer.t_s[row + steps])]


def _somewhere(where: NDArray[np.bool_], part: Sequence[float], rng: np.random.Generator) -> int:
    """A random row where a condition holds in a part of the drive; else its middle row."""
    first, last = (int(share * where.size) for share in part)
    rows = np.flatnonzero(where[first:last])
    return first + int(rng.choice(rows) if rows.size else (last - first) // 2)
