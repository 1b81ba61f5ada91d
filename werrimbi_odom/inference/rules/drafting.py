# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How laws are drafted for errors that no effect explains."""

from __future__ import annotations

# ---------------------------------------------------------------------------------- what is drafted

DRAFTED_TOO = 0.8
"""Gain of another dependence relative to the best, above which it is drafted too, for comparison.
Chosen: the law of the right variable may score this much less for its form (a line in place of a
square)."""

MOST_DRAFTED = 3
"""Most dependences that are drafted, each in some five forms of law."""

WORTH_FITTING = 30.0
"""Deficit of a draft's score to the best one's, up to which it is fitted in full: a fit differs
from its score by a few units if the law is not linear in its parameters."""

MOST_FITTED = 3
"""Most drafts that are fitted in full, each for a second or two: the answer is there while one
waits."""

SPOT_OFF, SPOT_RADII = 0.2, (0.2, 0.35, 0.6)
"""Search range about the likeliest place of a spot on the floor, and its trial radii [m]: cells of
`FLOOR_CELL` give its middle to less than half of one, and a spot in one cell is no wider."""

SPOT_FAR = 1000.0
"""Bounds of the place of a spot, beyond the origin and the place where it was found [m]: another
drive may be elsewhere on the same map."""

WIDER_THAN_FITTED = 20.0
"""Bounds of a draft in multiples of the fitted value: the next robot may have more of it."""

# --------------------------------------------------------------------- what a law of two is made of

MOST_TERMS, FIRST_TERMS = 3, 10
"""Most terms of a law of two variables, and terms from which its search starts in turn. Chosen: one
product and what either of its variables does alone, since nobody reads a fourth term; ten starts
cost a few milliseconds, and include a right term that is not the best alone."""

CLEAR_OF_ZERO = 0.05
"""Least value of a divisor, as a share of its largest. Chosen: below it the ratio of a noisy
measurement is its noise; a tyre without pressure is not driven."""

GATE_SPEEDS = (0.25, 0.5, 0.75)
"""Quantiles of the driven speeds at which a law may set in. Chosen: at least a quarter of the
driving is on either side, and a true threshold between them is no farther from one of the three
than an eighth."""

GATE_WIDTH = 0.05
"""Width over which a law sets in, as a share of the highest speed. Chosen: nearly a step, but
smooth, so that a law does not switch with the noise for a robot at just that speed."""

SEARCHES = 2
"""Repetitions of the search for laws of two variables. Chosen: in the first search the wheel noise
is inflated by the missing law, which hides differences between laws; in the second it is the noise
of the first fit."""

ROLLS_BACKWARDS = 0.01
"""Speed [m/s] above which a wheel or robot rolls backwards for a law that acts only then: a
settling motor goes to and fro by less."""
