# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two nodes that publish the same joints: the angles jump to and fro between two sequences."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats

FEWEST, SHARE = 20, 0.03
"""Messages that leap away and back, and their share, from which a second node sends them. Faults of
a counter are fewer; what is sent by a node at 1 Hz beside a driver at 30 Hz is more."""
MOSTLY = 0.5
"""Share from which both sequences take turns."""
LEAP, FASTER = 0.1, 10.0
"""Least leap, in turns of the wheel, and in usual steps from message to message."""
BACK = 0.1
"""Share of a leap to within which it leads back, and to which a sequence of its own changes."""


def leaps_to_and_fro(turns: Floats) -> int:
    """Number of messages of a second sequence among those of a wheel; 0 if there is none.

    `turns` (n,): the wheel's angle [turns], unwrapped, in order of receipt; may hold NaN. A second
    sequence is known by its values, which change little from one to the next (zero, as a rule):
    faults of a counter have any value.
    """
    known = turns[np.isfinite(turns)]
    if known.size < FEWEST:
        return 0
    first, second = np.diff(known)[:-1], np.diff(known)[1:]
    both = np.abs(first + second)
    least = np.maximum(LEAP, FASTER * float(np.median(both)))
    size = np.minimum(np.abs(first), np.abs(second))
    away: NDArray[np.bool_] = (size > least) & (both < BACK * size)
    count = int(away.sum())
    if count < max(FEWEST, SHARE * known.size):
        return 0
    alone = np.abs(np.diff(known[1:-1][away])) < BACK * np.median(size[away])
    return count if count > MOSTLY * known.size or alone.mean() > MOSTLY else 0
