# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Gaps of a record: silences with more travel than usual."""

GAP_INTERVALS = 10.0
"""Length of a gap in multiples of the median interval.

Of messages at random times with a constant rate, one interval in 1000 is as long (an exponential
variable exceeds ten medians with a probability of 2^-10); of periodic messages none is.
"""

GAP_WAYS = 3.0
"""Travel in a gap in multiples of the median travel of an interval.

A localiser that reports every quarter of a metre is silent as long as the robot stands, and its
next interval has the usual travel: that is its habit, no gap.
"""

GAP_LEG = 0.25
"""Travel in a gap as a share of a leg: less makes no leg longer than others are."""

GAP_FEWEST = 20
"""Fewest intervals with travel for a median: with fewer, poses were taken by hand."""
