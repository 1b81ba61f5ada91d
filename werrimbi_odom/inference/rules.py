# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that decide what is said of a recording, each with the reason why it is what it is."""

from __future__ import annotations

# ------------------------------------------------------------------------- gaps of a recording

GAP_INTERVALS = 10.0
"""Times the usual interval, from which on a silence is a gap.

Of messages that come at random with a steady mean one interval in 1000 is as long (an exponential
variable is above ten medians with a chance of 2^-10); of those that come at a rate none is.
"""

GAP_WAYS = 3.0
"""Times the usual way of an interval, that must have been gone in a gap.

A localisation that speaks every quarter of a metre is silent for as long as the robot stands, and
its next interval is as long a way as any: that is its habit, no gap.
"""

GAP_LEG = 0.25
"""Share of a leg that must have been gone in a gap: less makes no leg longer than others are."""

GAP_FEWEST = 20
"""Intervals with travel in them, below which nobody knows what is usual: poses taken by hand."""

# ------------------------------------------------------------------------- honest covariances

HONEST_WITHIN = 1.5
"""Times one, and part of one, between which the NEES of an honest covariance lies.

Errors are then within 22 % of what is promised: a fuser weighs the odometry about as it should, and
the noise of no wheel is known better than to that. A rule without it would call any covariance
wrong, were there legs enough.
"""

HONEST_CHANCE = 0.9999
"""Share of samples of an honest covariance that chance leaves within its bounds.

Some ten numbers are looked at in a comparison, and the node's window slides over thousands of legs.
"""

ALIKE = 1.3
"""Times by which intervals of the noise at short and at long legs must be apart to be two."""
