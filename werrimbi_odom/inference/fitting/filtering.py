# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A Kalman filter from reference pose to reference pose, over many stretches of legs side by side.

A long run is cut into stretches: where the reference gives a full pose, the filter may start anew
from it at the price of one leg's worth of knowledge in many. So an hour of driving takes as many
rounds of the loop as a minute.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats, wrap_all

STRETCH = 100
"""Legs, at the least, after which the filter starts anew where it can."""

SIDE_BY_SIDE = 50
"""Stretches into which a long record is cut, about."""

UNMEASURED = 1e6
"""Variance [m², rad²] that stands for a coordinate that was not measured."""


class Legs(NamedTuple):
    """What the filter is to be told of m legs, for g sets of variances and w parameters."""

    relative: Floats
    """Predicted relative pose, (m, 3), each in the frame of its own start."""
    noise: Floats
    """Covariance of it, (g, m, 3, 3)."""
    slopes: Floats
    """Its derivatives in parameters, (m, 3, w)."""
    start: Floats
    """Measured pose at the legs' starts, (m, 3), NaN where not measured."""
    finish: Floats
    """Measured pose at their ends."""
    reading: Floats
    """Covariance of the measured pose at each leg's end, (g, m, 3, 3); (g, 1, 3, 3) if all alike.

    It stands for that at its start too."""
    begins: NDArray[np.bool_]
    """Where the filter must start anew: first legs of runs, (m,)."""
    skip: NDArray[np.bool_]
    """Legs on which the reference jumped, and gaps, (m,)."""
    heading: Floats
    """Heading at the start of a run where it was not measured, at the run's first leg, (m,)."""


class Unexpected(NamedTuple):
    """Innovations in the frame of the robot at each leg's start."""

    value: Floats
    """(g, m, 3), zero where nothing was measured."""
    covariance: Floats
    """(g, m, 3, 3)."""
    change: Floats
    """Derivatives for the first set, (m, 3, w + 1); the last one in the run's start heading."""


def stretches(legs: Legs) -> NDArray[np.intp]:
    """First legs of the stretches."""
    length = max(STRETCH, legs.begins.size // SIDE_BY_SIDE)
    full = np.all(np.isfinite(legs.start), axis=-1).tolist()
    starts = []
    bounds = np.append(np.flatnonzero(legs.begins), legs.begins.size)
    for begin, end in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        starts.append(begin)
        for wanted in range(begin + length, end - length // 2, length):
            if full[wanted]:
                starts.append(wanted)
    return np.array(starts, dtype=np.intp)


def filtered(legs: Legs) -> Unexpected:
    """Filter all stretches at once."""
    sets, count, width = legs.noise.shape[0], legs.relative.shape[0], legs.slopes.shape[-1] + 1
    first = stretches(legs)
    length = np.diff(np.append(first, count))
    order = np.argsort(-length, kind="stable")
    first, length = first[order], length[order]
    finite_start, finite_end = np.isfinite(legs.start), np.isfinite(legs.finish)
    start, finish = np.nan_to_num(legs.start), np.nan_to_num(legs.finish)
    free = ~finite_start[first, 2]
    state = np.where(finite_start[first], start[first], 0.0)
    state[:, 2] = np.where(free, np.nan_to_num(legs.heading[first]), state[:, 2])
    state = np.repeat(state[None], sets, axis=0)
    alike = legs.reading.shape[1] == 1
    spread = (legs.reading if alike else legs.reading[:, first]) * _both(finite_start[first])
    slope = np.zeros((first.size, 3, width))
    slope[free, 2, -1] = 1.0
    values = np.zeros((sets, count, 3))
    covariances = np.empty((sets, count, 3, 3))
    turns = np.empty((sets, count, 3, 3))
    changes = np.zeros((count, 3, width))
    identity = np.eye(3)
    for step in range(int(length[0])):
        active = int(np.searchsorted(-length, -step))
        leg = first[:active] + step
        state, spread, slope = state[:, :active], spread[:, :active], slope[:active]
        turn = _turns(state[..., 2])
        turns[:, leg] = turn
        move = (turn @ legs.relative[leg][..., None])[..., 0]
        lever = np.zeros_like(turn) + identity
        lever[..., 0, 2], lever[..., 1, 2] = -move[..., 1], move[..., 0]
        state = state + move
        spread = lever @ spread @ lever.swapaxes(-1, -2)
        spread = spread + turn @ legs.noise[:, leg] @ turn.swapaxes(-1, -2)
        slope = lever[0] @ slope
        slope[..., :-1] += turn[0] @ legs.slopes[leg]
        known = finite_end[leg]
        reading = legs.reading if alike else legs.reading[:, leg]
        total = spread + reading + UNMEASURED * _diagonal(~known)
        covariances[:, leg] = total
        new = np.where(known, finish[leg] - state, 0.0)
        new[..., 2] = wrap_all(new[..., 2])
        change = np.where(known[..., None], -slope, 0.0)
        gain = spread @ np.linalg.inv(total)
        values[:, leg], changes[leg] = new, change
        jumped = legs.skip[leg]
        anew_slope = np.where(known[..., None], 0.0, slope)
        # What was measured at the leg's end is all that is known of it; the rest (the heading,
        # where positions alone are measured) is as well known as the wheels carried it there.
        anew_state = np.where(known, finish[leg], state)
        anew_spread = np.where(_both(known), reading, 0.0)
        anew_spread = np.where(_both(~known), spread, anew_spread)
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ spread
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        slope = slope + gain[0] @ change
        if jumped.any():
            values[:, leg[jumped]], changes[leg[jumped]] = 0.0, 0.0
            state = np.where(jumped[:, None], anew_state, state)
            spread = np.where(jumped[:, None, None], anew_spread, spread)
            slope = np.where(jumped[:, None, None], anew_slope, slope)
    back = turns.swapaxes(-1, -2)
    return Unexpected(
        (back @ values[..., None])[..., 0], back @ covariances @ turns, back[0] @ changes
    )


def _turns(yaw: Floats) -> Floats:
    """Rotations of (x, y, yaw) by angles of shape (g, s)."""
    turn = np.zeros((*yaw.shape, 3, 3))
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn[..., 0, 0] = turn[..., 1, 1] = cos
    turn[..., 0, 1], turn[..., 1, 0] = -sin, sin
    turn[..., 2, 2] = 1.0
    return turn


def _diagonal(rows: NDArray[np.bool_]) -> Floats:
    return np.asarray(rows[..., None] * np.eye(3))


def _both(known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Which entries of a covariance are of two known coordinates."""
    return known[..., :, None] & known[..., None, :]
