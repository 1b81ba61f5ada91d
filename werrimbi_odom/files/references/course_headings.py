# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings that were computed from the positions: the path's direction, not where a robot looks.

Standing they are noise, and in reverse they look behind: as measurements, a robot that was lifted
and turned by hand.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.references.interpolated_poses import last_digit
from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats, wrap_all

FEWEST, SHARE = 20, 0.9
"""Steps between positions whose direction must be the heading, and their share of all that are long
enough to tell. Chosen: the ends of a log are computed otherwise."""
LONG = 20.0
"""Last digits of a step that tells its direction."""
SHAKES = 0.01
"""Typical change of the turning from row to row [rad], above which it is the positions' noise. A
robot turns evenly, and its own odometry, which goes along its headings as well, is even too."""


def without_course(reference: Reference) -> tuple[Reference, str]:
    """Positions alone, if the headings are their steps' directions; and what was done, in words."""
    known = np.flatnonzero(reference.has_position & reference.has_yaw)
    if known.size < 2 * FEWEST:
        return reference, ""
    yaw = reference.yaw[known]
    if float(np.median(np.abs(wrap_all(np.diff(yaw, 2))))) < SHAKES:
        return reference, ""
    place = reference.x[known] + 1j * reference.y[known]
    digit = max(last_digit(reference.x[known]), last_digit(reference.y[known]))
    ahead, over_both = np.diff(place), place[2:] - place[:-2]
    rounding = last_digit(yaw)
    if not any(
        _are_directions(heading, steps, digit, rounding)
        for heading, steps in ((yaw[:-1], ahead), (yaw[1:], ahead), (yaw[1:-1], over_both))
    ):
        return reference, ""
    alone = replace(reference, yaw=np.full_like(reference.yaw, np.nan), sigma_yaw=None)
    return alone, (
        "its yaw_rad is the direction from one position to the next: computed from x_m and y_m, "
        "not measured (backwards it looks behind, at rest anywhere); the positions alone are judged"
    )


def _are_directions(
    heading: Floats, steps: NDArray[np.complex128], digit: float, rounding: float
) -> bool:
    """Whether headings are the directions of steps (n,) to the last digit, or their opposites."""
    size = np.abs(steps)
    long = size > LONG * digit
    off = np.abs(wrap_all(2.0 * (heading[long] - np.angle(steps[long])))) / 2.0
    same = off <= rounding + 2.0 * digit / size[long]
    return bool(same.sum() >= FEWEST and same.mean() > SHARE)
