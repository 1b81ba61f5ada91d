# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wrong poses of a reference, one or two at a time, as of a tracker that mistook its marker.

Poses between two that agree with one another, from which no robot could have come back in time, are
wrong whatever model is true. So no leg begins or ends there; the next pose tells as much. Taken for
noise, one such pose in two hundred makes a reference of 2 mm one of 30 mm.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter

from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.model.pose import Floats


def stray_poses(measured: Reference, gap: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Poses that are wrong in position while those before and after are right, shape (n,).

    `measured`: poses, shape (n,), in strictly ascending time. `gap` (n - 1,): intervals that no leg
    may span: a pose beside one is not judged by the pose beyond.
    """
    found = np.zeros(measured.time.size, dtype=np.bool_)
    if found.size < rules.JUMP_FEWEST or not measured.has_position.all():
        return found
    place = measured.x + 1j * measured.y
    off, _, _ = _beside(measured.time, place, 1)
    usual = np.maximum(_usual(off[0]), np.median(off[0]))
    least = rules.JUMP_SCATTER * MEDIAN_TO_SIGMA * np.pad(usual, 1, mode="edge")
    step = _usual(np.abs(np.diff(place)))
    spanned = np.concatenate([[0], np.cumsum(gap)])
    for count in range(1, rules.STRAY_AT_ONCE + 1):
        off, took, chord = _beside(measured.time, place, count)
        rows = np.arange(off.shape[1])
        wrong = spanned[rows + count + 1] == spanned[rows]
        for number, (away, square) in enumerate(zip(off, took, strict=True), start=1):
            wrong &= (away > least[rows + number]) & (away > 0.5 * rules.JOLT * square)
            wrong &= np.abs(chord - (count + 1) * step[rows]) < rules.JUMP_LASTS * away
        for number in range(1, count + 1):
            found[rows[wrong] + number] = True
    return found if found.mean() < rules.JUMP_RARE else np.zeros_like(found)


def _beside(
    time: Floats, place: NDArray[np.complex128], count: int
) -> tuple[Floats, Floats, Floats]:
    """How far `count` poses in a row are from the line between the poses before and after them.

    Result: of shapes (count, m), (count, m) and (m,): distance from the line [m]; time since its
    beginning times time to its end [s^2], which half of an even acceleration turns into that
    distance; length of the line [m].
    """
    rows = np.arange(time.size - count - 1)
    last = rows + count + 1
    across = place[last] - place[rows]
    off, took = [], []
    for inside in range(1, count + 1):
        before, after = time[rows + inside] - time[rows], time[last] - time[rows + inside]
        off.append(np.abs(place[rows + inside] - place[rows] - before / (before + after) * across))
        took.append(before * after)
    return np.stack(off), np.stack(took), np.abs(across)


def _usual(values: Floats) -> Floats:
    reach = 4 * rules.JUMP_NEIGHBOURS + 1  # four wrong steps, of two poses, are no half of it
    return np.asarray(median_filter(values, reach, mode="nearest"))
