# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is a gap in a record: a silence in which more was driven than is usual."""

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
