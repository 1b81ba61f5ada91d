# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Sizes of a robot in logarithms, to put drives together.

By headings alone a robot of another scale is the same. With base and radii of each drive's own that
is another direction in each, and between them the drives would seem to tell the scale. In
logarithms it is the same direction in all. A multiplier `p` that the file gives as `g` is then
`g (1 + log(p / g))`, which is `p` near the file's. Drives that tell the scale are taken so too,
since a history may have both.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference.changes.information_of_drives import DriveNumbers
from werrimbi_odom.inference.changes.scatter import Values
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def in_logarithms(drive: DriveNumbers, values: Floats, robot: Robot) -> DriveNumbers:
    """One drive with its multipliers in logarithms.

    `values` (s,): of its parameters where it was linearised. `robot`: as the file gives it.
    """
    sized, given = _sizes(drive.names, robot)
    score = drive.information[0] @ values - drive.weighted[0]
    there, factor = values.copy(), np.ones_like(values)
    factor[sized] = values[sized] / given
    there[sized] = given * (1.0 + np.log(factor[sized]))
    information = drive.information * np.outer(factor, factor)
    return DriveNumbers(drive.names, information, information @ there - factor * score, drive.time)


def out_of_logarithms(values: Values, names: Sequence[str], robot: Robot) -> Values:
    """Estimates (R, s) with their multipliers as such again."""
    sized, given = _sizes(names, robot)
    there, factor = values.value.copy(), np.ones_like(values.value)
    factor[:, sized] = np.exp(there[:, sized] / given - 1.0)
    there[:, sized] = given * factor[:, sized]
    return Values(there, values.spread * factor[:, :, None] * factor[:, None, :])


def _sizes(names: Sequence[str], robot: Robot) -> tuple[list[int], Floats]:
    """Indices of the multipliers among the parameters, and their values in the file."""
    given = np.array([getattr(robot, name) for name in MULTIPLIERS], dtype=np.float64)
    return [list(names).index(name) for name in MULTIPLIERS], given
