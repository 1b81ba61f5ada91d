# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration by UMBmark and by drives out and back: how many, how well driven, what they tell."""

from __future__ import annotations

# ---------------------------------------------------------------------------- squares of UMBmark

LEAST_SQUARES, ADVISED_SQUARES = 2, 5
"""Squares a sense: one alone has no scatter; the paper drives five."""

LARGEST_OFFSET = 2.0
"""Offsets larger than this, in sides, are not those of a square that was meant to close: corners of
56 degrees for 90 make it (`LARGEST_MISTAKE` makes 1.3)."""

LARGEST_MISTAKE = 0.25
"""A base or a ratio of radii off by more is a slip of the pen, not a matter of calibration. Less
than `ORDINARY`: the paper's equations are of first order, and who drives squares has measured."""

TURN_TOLERANCE = 0.6
"""A lap turns by a whole turn to within this [rad], by odometry that may be off by 10 % of it."""

LEG_TOLERANCE = 0.1
"""Legs are as long as the side to within this share of it: a radius may be off by as much."""

LAP_TOLERANCE = 0.25
"""A lap ends where it began, by odometry or by the reference, to within this share of the side:
four corners of 85 degrees put it there."""

# ---------------------------------------------------------------------------- drives out and back

LEAST_RUNS, ADVISED_RUNS = 5, 30
"""Runs: four make a covariance of three coordinates, and one more tells whether a model fits it;
thirty give k to 13 % (1 / sqrt(2 * 29))."""

UNKNOWN_SPLIT = 0.5
"""The split (k_R² - k_L²) / (k_R² + k_L²) lies within ±1: with a standard deviation of this, the
whole of that is within two, and it is unknown."""

LEAST_KNOWN = 0.5
"""Share of a noise that its standard deviation counts for at the most: beyond it the noise is not
determined, and its law no longer told by its curvature."""
