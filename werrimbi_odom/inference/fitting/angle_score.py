# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Score of an effect local to one angle round a wheel: its size, and its angle in each run.

A law of one cycle per turn is linear in amplitude times cosine and sine of its phase. A local law
is not linear in its angle. So the derivative in its size is taken at a few angles, with
trigonometric interpolation between them, and the score is the largest gain over the angles with one
size for all runs. Bump and flat are scored separately: their first harmonics are the same, half a
turn apart, and only higher ones tell them apart.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.linear import SILENT
from werrimbi_odom.model.pose import Floats

FINE = 96
"""Number of trial angles: 4 degrees apart, for laws with features no narrower than 30."""

_ROUNDS = 4
"""Alternations between size and angles; they hardly move after the second."""


class LocalScore(NamedTuple):
    """Best fit of one sign."""

    gain: float
    """Fall of the squared innovations."""
    size: float
    """Size, in finite-difference steps."""
    places: Floats
    """Angle in each block [rad]."""


def best_angles(tries: Floats, free: Floats, rest: Floats, blocks: int) -> list[LocalScore]:
    """Best angles and size for a positive and for a negative size; those without gain left out.

    `tries` (k,): angles of the derivatives, evenly spaced round the wheel [rad]. `free` (n, blocks
    * k): derivatives of the innovations in the size at each angle, nuisances projected out. `rest`
    (n,): innovations, nuisances projected out. `blocks`: number of runs with an angle of their own;
    1 for one common angle.
    """
    count = tries.size
    at = tries[0] + 2.0 * np.pi * np.arange(FINE) / FINE
    between = _interpolation(tries, at)
    square, cross = free.T @ free, -(free.T @ rest)
    own = [slice(block * count, (block + 1) * count) for block in range(blocks)]
    alike = np.stack([between @ cross[part] for part in own])
    energy = np.stack([np.sum((between @ square[part, part]) * between, axis=-1) for part in own])
    heard = energy > np.maximum(SILENT, 1e-6 * energy.max(initial=0.0))
    scaled = np.where(heard, alike / np.sqrt(np.where(heard, energy, 1.0)), 0.0)
    found = []
    for sign in (1.0, -1.0):
        chosen = np.argmax(sign * scaled, axis=-1)
        for _ in range(_ROUNDS):
            weights = between[chosen].ravel()
            likeness, power = float(weights @ cross), float(weights @ square @ weights)
            if sign * likeness <= 0.0 or power <= SILENT:
                break
            size = likeness / power
            gain = likeness * size
            best = LocalScore(gain, size, at[chosen])
            chosen = np.argmax(2.0 * size * alike - size * size * energy, axis=-1)
        else:
            found.append(best)
    return found


def _interpolation(tries: Floats, at: Floats) -> Floats:
    """Trigonometric interpolation weights (q, k) from evenly spaced angles to others."""
    count = tries.size
    apart = at[:, None] - tries
    orders = np.arange(1, (count - 1) // 2 + 1)
    weights = 1.0 + 2.0 * np.sum(np.cos(orders * apart[..., None]), axis=-1)
    if count % 2 == 0:
        weights += np.cos(0.5 * count * apart)
    return np.asarray(weights / count)
