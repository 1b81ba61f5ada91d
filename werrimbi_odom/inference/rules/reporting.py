# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is told of a finding, which law is drafted, and what to drive next."""

from __future__ import annotations

# ------------------------------------------------------------------------------ what is added

ONE_WHEEL = 0.05
"""Share of one wheel's error up to which the other wheel's is not worth a word: a wheel that is 3 %
larger beside one that is 0.1 % smaller is one thing on the robot, a tyre."""

HELD_OUT_FALL = 1e-4
"""Share by which the held-out error must fall to have fallen: what fits that stop a little earlier
differ by. That it rises by more than chance is asked leg by leg (`SURE_WHEN_ASKED`)."""

SHAPES_FITTED = 3
"""Shapes of an effect (where a threshold is, how long a lag) that are fitted in full when it is
added. Chosen: of neighbours on the grid of shapes the best by score is among the first."""

UNUSUAL_PROMISE = 25.0
"""Times the median variance of legs, five of their deviation, beyond which what is promised of a
leg says nothing of noise: it begins with a heading that nobody knows yet (`UNKNOWN_HEADING`)."""

# ---------------------------------------------------------------------------- what is drafted

DRAFTED_TOO = 0.8
"""Share of the best gain above which another dependence is drafted too, to be compared. Chosen: the
law of the right variable may score so much less for its form (a line for a square)."""

MOST_DRAFTED = 3
"""Dependences that are drafted, each in some five forms of law."""

WORTH_FITTING = 30.0
"""What the linear score of a draft may lack of the best one's and still be fitted in full: a fit
gains or loses a few units against its score, where a law is not a line in its numbers."""

MOST_FITTED = 3
"""Drafts that are fitted in full, each for a second or two: the answer is there while one waits."""

SPOT_OFF, SPOT_RADII = 0.2, (0.2, 0.35, 0.6)
"""How far beside the likeliest place a spot on the floor is looked for, and its radii [m]: cells of
`FLOOR_CELL` tell its middle to less than half of one, and a spot in one cell is no wider."""

WIDER_THAN_FITTED = 20.0
"""Times the fitted value that a draft's bounds reach: the next robot may have more of it."""

# ---------------------------------------------------------------- what a law of two is made of

MOST_TERMS, FIRST_TERMS = 3, 10
"""Terms of a law of two at the most, and terms that its search begins with in turn. Chosen: one
product and what either of its variables does alone, since a fourth term is read by nobody; ten
beginnings cost a few milliseconds, and a right term that is not the best alone has its turn."""

CLEAR_OF_ZERO = 0.05
"""Share of its largest value that what is divided by must keep. Chosen: below it the ratio of a
noisy measurement is its noise; a tyre without pressure is not driven."""

GATE_SPEEDS = (0.25, 0.5, 0.75)
"""Shares of the driven speeds at which a law may set in. Chosen: on either side is a quarter of the
drives at least, and a true edge between them is no farther from one of the three than an eighth."""

GATE_WIDTH = 0.05
"""Share of the highest speed over which a law sets in. Chosen: as good as at once, and smooth, so
that a robot that drives at just that speed has no law that comes and goes with its noise."""

SEARCHES = 2
"""How often laws of two are searched. Chosen: in the first search the wheels' noise stands for the
law that is missing and hides what tells laws apart; in the second it is what the first one left."""

ROLLS_BACKWARDS = 0.01
"""Speed [m/s] from which on a wheel or robot rolls backwards for a law that does so alone: a
settling motor goes to and fro by less."""

# ---------------------------------------------------------------------------- what to drive next

NEARLY_AS_MUCH = 0.9
"""Share of what the best dependence explains from which on another may be the better name for it:
what goes with the speed goes a little with the distance too, the other way round seldom."""

HIDDEN_FROM = 3.0
"""An effect that would be seen only from so many times its typical size on counts as hidden.
Chosen: typical sizes are hardly known to better."""

LONGEST_DRIVE = 30.0
"""Minutes of driving that one may ask for: half a battery of a small robot."""

MINUTES_OF_A_LAW, MINUTES_OF_PLACES, MINUTES_OF_TIME = 2.0, 4.0, 10.0
"""How long to drive for an unknown error: over the range of a variable; the same at several places,
or at several values of a channel, twice as long; and until something warms up or drifts."""

APART_POSITION, APART_HEADING = 5e-4, 0.02
"""Difference of two rivals on a short leg from which on it is told [m, degrees]: half a millimetre
and 0.35 mrad, which motion capture tells after some legs."""

WAY_WORTH_SAYING, TURN_WORTH_SAYING = 0.05, 20.0
"""Way [m] and turn [degrees] in a gap from which on they are told: the other one says enough."""

# ----------------------------------------------------------------------- drives that are imagined

TAPED_INTERVALS = 3
"""Intervals of a drive's reference up to which it is by tape: imagined drives then have a pose at
the start and one at the end."""

PACE_UNKNOWN = 0.3
"""Speed of the wheels [m/s] of a robot that was never seen to move: a slow walk."""

SLOWEST_PACE, FASTEST_PACE = 0.02, 20.0
"""Speeds [m/s] between which a robot is imagined to drive: recordings of less or more have a wrong
unit in them."""

HARD_START = 2.5
"""Acceleration of a hard start, over the speed [1/s]: 0.4 s to full speed."""

# ------------------------------------------------------------------- what a recording can show

LEGS_ENOUGH, SHORT_LEG = 30, 0.25
"""Legs of a metre or a quarter turn, below which shorter ones are proposed, and their length [m].
Chosen: three times the fewest that are judged, for a part of them is put aside."""

TURN_SHOWS, WAY_SHOWS = 3.14, 2.0
"""Turning [rad], and way [m], from which on a recording is said to show base and radii. Chosen:
half a turn and two metres show them to a percent, by a reference good to a degree and to 2 cm."""
