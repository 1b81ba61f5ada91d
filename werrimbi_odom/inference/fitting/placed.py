# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The score of what lies in one place round a wheel: how large it is, and where in each run.

A law that swings once in a turn is a line in its amplitude times the cosine and the sine of its
phase; one that is local is no line in its place. So its derivative in the size is taken at a few
places round the wheel, and between them by trigonometric interpolation; the places that explain
most, with one size for all runs, are its score. Of a bump and of a flat each the best: in the first
harmonic they are one, half a turn apart, and only what is left of it tells which.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from werrimbi_odom.inference.linear import SILENT
from werrimbi_odom.model.pose import Floats

FINE = 96
"""Places that are looked at: 4 degrees apart, of laws whose parts are no narrower than 30."""

_ROUNDS = 4
"""In which size and places are found in turn; they hardly move after the second."""


class Placed(NamedTuple):
    """The best of one sign."""

    gain: float
    """Fall of the squared innovations."""
    size: float
    """In steps of the size."""
    places: Floats
    """Of each block [rad]."""


def best_placed(tries: Floats, free: Floats, rest: Floats, blocks: int) -> list[Placed]:
    """The best places and size, of a positive size and of a negative one; those without gain out.

    Parameters
    ----------
    tries : ndarray, shape (k,)
        Places at which derivatives were taken, evenly round the wheel [rad].
    free : ndarray, shape (n, blocks * k)
        Derivatives of the innovations in the size at each place, clear of the nuisances.
    rest : ndarray, shape (n,)
        Innovations clear of them.
    blocks : int
        Runs with a place of their own; 1: one place for all.
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
            best = Placed(gain, size, at[chosen])
            chosen = np.argmax(2.0 * size * alike - size * size * energy, axis=-1)
        else:
            found.append(best)
    return found


def _interpolation(tries: Floats, at: Floats) -> Floats:
    """Weights (q, k) of values at even places round a circle for the values at others."""
    count = tries.size
    apart = at[:, None] - tries
    orders = np.arange(1, (count - 1) // 2 + 1)
    weights = 1.0 + 2.0 * np.sum(np.cos(orders * apart[..., None]), axis=-1)
    if count % 2 == 0:
        weights += np.cos(0.5 * count * apart)
    return np.asarray(weights / count)
