# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which effects are looked for, fitted, and taken; and what no effect explains."""

from __future__ import annotations

# ---------------------------------------------------------------------------- what is worth a fit

ROUNDS = 4
"""Effects that are looked for, one after the other. More at once was never seen on a robot."""

REFITTED = 5
"""Candidates that are fitted in full in each round, a second or so each. Chosen: scores are of
first order, and a right effect whose law is no line in its numbers still stands among the first."""

SHORTLISTED = 2 * REFITTED
"""Candidates, by their scores, from which those are taken: with room for as many that the next two
rules leave out."""

WORTH_A_FIT = 0.25
"""Share of the best gain from which on a candidate is worth a fit. A score is a parabola through
null: a law that bends may gain some times its score in a fit. Chosen: four times is allowed for."""

SCORE_FLOOR = 8.0
"""What a score must gain beyond its degrees of freedom for a fit. Chance gains as much in 0.3 % of
candidates of one degree and in 0.7 % of two, and `SURE` asks for 18.5 of one among 60."""

SAME_BY_RUN = 0.5
"""Share of an effect's gain from which on its other variant (a phase of its own in each run, or one
for all) is fitted as well. Chosen: one with half the gain may still be the cheaper model, for it
pays for fewer numbers."""

INSTEAD_FITTED = 3
"""Effects that are fitted in place of a calibration. Chosen: each costs a fit, and the
score of one that does in place of up to three numbers is among the first."""

STILL = 0.02
"""Standard deviations that a step of a fit must move something by, to be worth another one."""

# --------------------------------------------------------------- whether it lasts: Fisher's F

LASTING_PARTS = 28
"""Into which all runs are cut, about: so many that their disagreement is known. One number is then
held against 27 degrees of freedom, for which F must be 13.6 where chi-squared asks 10.8."""

LASTING_FEWEST, LASTING_MOST = 4, 12
"""Parts of one run. Of three degrees of freedom F would have to be 167, so fewer than four never
tell; more than twelve of one drive are shorter than errors stay alike."""

LASTING_LEGS = 5
"""Of a part, at the least; with fewer (two poses a drive) errors have no time to be alike in."""

LASTING_HEARD = 0.1
"""Share of a pattern's size that a part must hold, to say anything of it: a hundredth of what the
pattern explains, beside the 28th that a part has on average. Of more parts the same share of that:
of 60 drives none held a tenth, and an effect of 20 standard deviations was left to chance."""

DRIVES_TO_LEAVE_ONE = 3
"""Drives from which on one may be said to be unlike the others: of two neither is."""

OTHER_DRIVES = 0.5
"""Share of a pattern's size that the other drives must hold, for what they do not show to be one
drive's own. Of a dependence that is barely certain (chi-squared of 60 for 14 numbers) they then
show 37 for 12, once in 5000 by chance, and are asked for a hundredth (`SURE_WHEN_ASKED`)."""

CELLS_ASKED = 20
"""Dependences, the most certain, of which it is asked whether they last: each costs a pass of the
filter, and one that lasts is among the first few or nowhere."""

LEFT_ASKED = 5
"""The same of what is left beside all that was found: one of the first lasts, or none is told."""

# --------------------------------------------------------- what no effect of the library explains

LAW_SHARE = 0.75
"""Share of what a plain dependence on a measured variable is worth (fall of the cost less penalty)
that the best effect must be worth, for its name to be given. Laws are first-order physics: of 33
hidden sets the strongest dependence was worth at most 0.97 of the right effect, and 1.5 times the
best wrong one where the library does not hold what is hidden; 1 / 0.75 = 1.33 is amid the two."""

OWN_LAW_SHARE = 0.5
"""The same where the dependence is on what the effect itself looks at, in the channel on which it
acts: that is the effect's own law, freer in shape. A law that explains most of it is right in kind,
and that it does not fit fully is said."""

LITTLE_OF_A_LAW = 0.1
"""Share of what a law explains up to which something in its own variables is its rest. A law fitted
in another form than nature's (a line for a square, over the same range) leaves at the most that."""

REST_EXPLAINED = 0.5
"""Share of what an effect would explain beyond which a freer form of a held law takes it away, so
that the effect is no more than that law's rest: half, as both then explain the same."""

# --------------------------------------------------------------- how finely the evidence map looks

CURVE_KNOTS = 6
"""Knots of a smooth curve of a variable, at its quantiles. Chosen: a threshold, a peak or one wave
shows in five pieces, each of a fifth of the data; every knot more makes what is there less sure."""

FLOOR_CELL = 0.5
"""Width of the floor's cells [m], wider on large floors. Chosen: a carpet's edge, a cable or a ramp
is felt by a robot of this size over about that much."""

FLOOR_CELLS = 40
"""Cells of the floor, at the most: each is a number, and chi-squared of 40 degrees must be above 90
for `VERY_SURE` before all other cells of the map are counted."""

GRIP, SELDOM_BEYOND = 10.0, 0.1
"""Acceleration [m/s^2] that no wheel passes on to the floor (a friction of one, times gravity), and
share of the steps that may show more. Counts that come in bunches, or stamps that wander, make it:
where it is more, the acceleration was not measured, and nothing is said to go with it. The real
robots and the engine's are below 3 in nine steps of ten; one whose stamps wander is at 20."""

SELDOM_BACK = 0.02
"""Share of the way that must be driven backwards, and forwards, for errors to go with the sense of
driving. Chosen: wheels that settle by a count as they stop make a millimetre or two a metre, and
what is said of errors leaves out as much at either end."""

NEIGHBOUR = 1.6
"""Widths of a floor's cell within which another cell is its neighbour: corners touch at 1.4, and
steps are seldom in the very middle of their cell."""
