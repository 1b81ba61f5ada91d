# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration by UMBmark and by drives out and back: how many drives, and how well driven."""

from __future__ import annotations

# ---------------------------------------------------------------------------- squares of UMBmark

LEAST_SQUARES, ADVISED_SQUARES = 2, 5
"""Squares in each sense, at least and recommended: one alone has no scatter; the paper drives
five."""

MORE_THAN_SCATTER = 3.0
"""Offset of the squares' ends in what their scatter alone leaves of it, above which words do not
put it down to scatter. Chosen: two squares a sense know their scatter to a factor of two."""

LARGEST_OFFSET = 2.0
"""Offset of a lap [sides] above which the square was not meant to close: corners of 56 degrees in
place of 90 make it (`LARGEST_MISTAKE` makes 1.3)."""

LARGEST_MISTAKE = 0.25
"""Error of the base or of the ratio of radii above which it is a typing mistake, no matter of
calibration. Less than `ORDINARY`, since the paper's equations are of first order, and who drives
squares has measured the robot."""

TURN_TOLERANCE = 0.6
"""Deviation of a lap's turn from a whole turn [rad], by odometry that may be off by 10 % of it."""

LEG_TOLERANCE = 0.1
"""Relative deviation of a leg from the side: a radius may be off by as much."""

LAP_TOLERANCE = 0.25
"""Distance from the start of a lap to its end, as a share of the side, by odometry or by the
reference: four corners of 85 degrees make it."""

# ---------------------------------------------------------------------------- drives out and back

LEAST_RUNS, ADVISED_RUNS = 5, 30
"""Runs, at least and recommended. Four determine a covariance of three coordinates, and one more
tests whether a model fits it. Thirty determine k to 13 % (1 / sqrt(2 * 29))."""

UNKNOWN_SPLIT = 0.5
"""Standard deviation above which the split (k_R² - k_L²) / (k_R² + k_L²) is unknown: it lies within
±1, which is then within two standard deviations."""

LEAST_KNOWN = 0.5
"""Largest relative standard deviation of a noise that is used. Above it the noise is not
determined, and the curvature no longer describes its distribution."""
