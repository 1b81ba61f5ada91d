# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that decide something, each with its reason."""

from __future__ import annotations

ONE_WHEEL = 0.05
"""Share of one wheel's error up to which the other wheel's is not worth a word: a wheel that is 3 %
larger beside one that is 0.1 % smaller is one thing on the robot, a tyre."""

LITTLE_OF_A_LAW = 0.1
"""Share of what a law explains up to which something in its own variables is its rest. A law fitted
in another form than nature's (a line for a square, over the same range) leaves at the most that."""

REST_EXPLAINED = 0.5
"""Share of what an effect would explain beyond which a freer form of a held law takes it away, so
that the effect is no more than that law's rest: half, as both then explain the same."""

WORTH_FITTING = 30.0
"""What the linear score of a draft may lack of the best one's and still be fitted in full: a fit
gains or loses a few units against its score, where a law is not a line in its numbers."""
