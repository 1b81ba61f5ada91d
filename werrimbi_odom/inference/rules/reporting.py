# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is reported of a finding, which law is drafted, and what to drive next."""

from __future__ import annotations

# ------------------------------------------------------------------------------ what is added

ONE_WHEEL = 0.05
"""Error of one wheel relative to the other's, below which it is not reported: a wheel that is 3 %
larger beside one that is 0.1 % smaller is one cause on the robot, a tyre."""

HELD_OUT_FALL = 1e-4
"""Relative fall of the held-out error that counts as a fall: fits that stop a little earlier differ
by as much. Whether a rise is significant is tested leg by leg (`SURE_WHEN_ASKED`)."""

OUTDATED_FALL = 0.01
"""Relative fall of the held-out error from which on values of the robot file are told to be off.
With less, what they are off by is below a seventh (the square root of 1 - 0.99²) of what a leg errs
by."""

SHAPES_FITTED = 3
"""Trial shapes of an effect (threshold, length of a lag) that are fitted in full when it is added.
Chosen: of neighbours on the grid of shapes the best by score is among the first."""

UNUSUAL_PROMISE = 25.0
"""Variance of a leg in multiples of the median, five of its deviation, above which it is left out
of the predicted error: it begins with an unknown heading (`UNKNOWN_HEADING`)."""

MOVED_BY_ODOMETRY = 0.02
"""Relative error of the base from which on a localiser, moved by this odometry, is told to err by
it: AMCL turns by odometry for 0.2 rad until a scan corrects it, and 2 % of that are 4 mrad, twice
the noise of a match (`TYPICAL_MATCH`)."""

# ---------------------------------------------------------------------------- what is drafted

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

# ---------------------------------------------------------------- what a law of two is made of

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

# ---------------------------------------------------------------------------- what to drive next

NEARLY_AS_MUCH = 0.9
"""Gain relative to the best dependence, above which another one may be the better name: what
depends on the speed depends slightly on the distance too; the reverse is rare."""

HIDDEN_FROM = 3.0
"""Detection limit in multiples of the typical size, above which an effect counts as hidden. Chosen:
typical sizes are hardly known to better."""

LONGEST_DRIVE = 30.0
"""Most minutes of driving that are proposed: half a battery of a small robot."""

MINUTES_OF_A_LAW, MINUTES_OF_PLACES, MINUTES_OF_TIME = 2.0, 4.0, 10.0
"""Minutes of driving for an unknown error: over the range of a variable; at several places or
values of a channel, twice as long; and until something warms up or drifts."""

APART_POSITION, APART_HEADING = 5e-4, 0.02
"""Difference of two rivals on a short leg above which it is reported [m, degrees]: half a
millimetre and 0.35 mrad, which motion capture resolves after some legs."""

WAY_WORTH_SAYING, TURN_WORTH_SAYING = 0.05, 20.0
"""Travel [m] and turn [degrees] in a gap above which they are reported: if one is below, the other
says enough."""

# ----------------------------------------------------------------------- drives that are imagined

TAPED_INTERVALS = 3
"""Intervals of a drive's reference up to which it is by tape: predicted drives then have a pose at
the start and one at the end."""

PACE_UNKNOWN = 0.3
"""Assumed speed of the wheels [m/s] of a robot without recorded motion: a slow walk."""

SLOWEST_PACE, FASTEST_PACE = 0.02, 20.0
"""Limits of the speed of predicted drives [m/s]: recordings beyond them have a wrong unit."""

HARD_START = 2.5
"""Acceleration of a hard start, over the speed [1/s]: 0.4 s to full speed."""

# ------------------------------------------------------------------- what a recording can show

LEGS_ENOUGH, SHORT_LEG = 30, 0.25
"""Legs of a metre or a quarter turn, below which shorter ones are proposed, and tried where they
leave a verdict *ambiguous*, and their length [m].
Chosen: three times the fewest that are judged, as a part of them is held out."""

TURN_SHOWS, WAY_SHOWS = 3.14, 2.0
"""Turn [rad], and travel [m], above which a recording can show base and radii. Chosen: half a turn
and two metres show them to a percent, with a reference good to a degree and to 2 cm."""

ONE_CURVE = 0.995
"""Correlation of turn and way, second by second, above which a drive is one curve. Chosen: base and
ratio of the radii are then ten times less sure than of a drive whose turn and way go apart."""

SEEN_IN_FULL = 0.9
"""Share of the driving that the reference measured, below which `info` tells it beside the whole.
Chosen: a reference that begins a little later than the wheels, or ends before, loses less."""

LONGER_LEG = 1.5
"""Length of the legs in multiples of what was asked for, above which their own is told. Chosen: a
leg ends at the first pose after that length, so poses twice a leg make it half as long again."""
