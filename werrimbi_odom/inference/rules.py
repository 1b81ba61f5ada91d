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

LASTS = 1e-3
"""How often the disagreement of the parts of the drives may show as much as what is told to be left
beside all that was found: as for an effect. A few kicks at a few places do not last."""

LEFT_ASKED = 5
"""Dependences of which it is asked whether they last: one of the first does, or none is told."""

MOST_FITTED = 3
"""Drafts that are fitted in full, each for a second or two: the answer is there while one waits."""

NEIGHBOUR = 1.6
"""Widths of a floor's cell within which another cell is its neighbour: corners touch at 1.4, and
steps are seldom in the very middle of their cell."""

STILL = 0.02
"""Standard deviations that a step of a fit must move something by, to be worth another one."""
