# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Search for effects: which are scored, fitted and accepted, and when none explains the errors."""

from __future__ import annotations

import math

# ---------------------------------------------------------------------------- what is worth a fit

ROUNDS = 4
"""Most effects that are searched for, one after the other. More at once were never seen on a
robot."""

REFITTED = 5
"""Candidates that are fitted in full in each round, a second or so each. Chosen: scores are of
first order, and a right effect that is not linear in its parameters is still among the first."""

SHORTLISTED = 2 * REFITTED
"""Candidates by score, from which those to fit are taken: twice as many, as the next two rules
leave some out."""

WORTH_A_FIT = 0.25
"""Gain of a candidate relative to the best, above which it is fitted. A score is the quadratic
approximation at null: a law that bends may gain some times its score in a fit. Chosen: four times
is allowed for."""

SCORE_FLOOR = 8.0
"""Gain of a score above its degrees of freedom, below which it is not fitted. Chance exceeds it in
0.3 % of candidates with one degree of freedom and in 0.7 % with two, and `SURE` needs 18.5 for one
among 60."""

SCORE_FLOOR_BESIDE_WANDER = 3.0
"""The same where the reference's error wanders: its size was fitted without the effect, and took up
most of it (a mount askew by 0.03 rad has a score of 8.2 where a fit gains 28). Chance exceeds it in
5 % of candidates, so some more are fitted."""

HALF_PAID = 0.5
"""Share of the penalty of its numbers that the gain of a score must reach, for a fit to be worth
it. The floors above are passed by chance where each drive has an angle of its own, as of a bump of
a tread. In eight sets of the engine twelve such scores were 0.26 to 0.34 of their penalty, and the
fits gained 0.98 to 1.07 times as much; twice is allowed for. (The largest ratio of all, 2.6, was
that of a score of 690.) It asks hardly more than the floors of one number or two."""

SAME_BY_RUN = 0.5
"""Gain of another variant of an effect (a phase in each run, or one for all; a bump or a flat of a
tread) relative to the best, above which it is fitted as well. Chosen: one with half the gain may
still be the cheaper model, as it has fewer parameters to pay for."""

EXCHANGED = 0.5
"""Share of what an effect explained in its round that another must have explained there, to be
tried in its place once more are found. Chosen: a bump by itself explains a tenth more of a wheel
that is oval and off its centre than the axle does; what explains less than half costs fits."""

INSTEAD_FITTED = 8
"""Effects that are fitted in place of a calibration. Chosen: each costs a fit, and on one circle at
one speed some eight effects do what unequal radii do."""

STILL = 0.02
"""Step of a fit in standard deviations, below which it has converged."""

# --------------------------------------------------------------- whether it lasts: Fisher's F

LASTING_PARTS = 28
"""Approximate number of parts of all runs, enough for their disagreement to be known. One parameter
is then tested with 27 degrees of freedom, for which F must be 13.6 where chi-squared needs 10.8."""

LASTING_FEWEST, LASTING_MOST = 4, 12
"""Fewest and most parts of one run. With three degrees of freedom F would have to be 167, so fewer
than four are hardly ever significant by themselves (short drives: `LASTING_NOISE`); more than
twelve of one drive are shorter than the correlation of errors."""

LASTING_LEGS = 5
"""Fewest legs of a part of a short drive, as of one turn; with fewer in a whole drive (two poses)
errors have no time to be correlated."""

LASTING_NOISE = 6
"""Parts of short drives, with fewer than which the noise by the likelihood stands for those that
are missing, as if they showed nothing else. Derived: the least with which four parts, of which two
know nearly all, show an effect of 25 standard deviations beyond one in a thousand with 79
candidates (6e-4; with five 5e-3, with none 4e-2). More would make surer what parts draw anew: with
two beside the nine parts of a sound Kobuki, three arcs that err alike made an effect."""

LASTING_HEARD = 0.1
"""Share of a pattern's norm that a part must have, to count in the scatter that widens a standard
deviation, or as what other drives show: a hundredth of what the pattern explains, as compared with
the 28th that a part has on average. With more parts the share shrinks in proportion, and with fewer
it grows: of 60 drives none had a tenth, and an effect of 20 standard deviations was put down to
chance."""

LASTING_SPREADS = (1e-2, 1e12, 85)
"""Least and greatest variance of what each part of the drives draws anew, and their number, in
units of what all parts together know: from a hundredth of the noise to a pattern of a million
standard deviations, six to a decade. Simulated with the shares of a Kobuki's nine parts, of three
among nine, two among four, of 28 that are alike or fall as 1 / k: what each draws anew, of 0, 3, 30
or 1000 standard deviations, is told to last in 0.9 % of cases at one in a hundred, at most 3 %."""

DRIVES_TO_LEAVE_ONE = 3
"""Fewest drives for one to be called unlike the others: with two neither is."""

OTHER_DRIVES = 0.5
"""Share of a pattern's norm that the other drives must have, for its absence in them to be
evidence: of the functions by which the one drive shows it (of a floor, the places where that drive
errs). Of a barely significant dependence (chi-squared of 60 for 14 parameters) they then show 37
for 12, once in 5000 by chance, and are tested at a hundredth (`SURE_WHEN_ASKED`)."""

MOST_ERROR, MOST_TURN = 1.0, 2.0 * math.pi
"""Largest errors that a robot can have: 1 m per m, 1 rad per rad, and one turn per metre. Larger
ones come from steps in which the amount was almost zero."""

SHOWN_BY_THE_ROBOT = 0.6
"""Share of a dependence's gain that it has without larger errors and, one of the turn, by legs that
turn by more than the rounding of the counts (a count of each wheel at either end); below, it is
none. Chosen: one of four times the counted turn, where that is the rounding, keeps 0.44 at most (a
quarter of it, 2 / 4 - 1 / 16); of a law with an odd value where hardly anything was driven nearly
all is kept."""

CELLS_ASKED = 20
"""Most significant dependences that are tested for homogeneity: each costs a pass of the filter,
and one that lasts is among the first few or nowhere."""

LEFT_ASKED = 5
"""The same for what remains beside everything found: one of the first lasts, or none is
reported."""

# --------------------------------------------------------- what no effect of the library explains

LAW_SHARE = 0.75
"""Worth of the best effect relative to that of a plain dependence on a measured variable (fall of
the cost less penalty), above which the effect is named. Laws are first-order physics: in 33 hidden
sets the strongest dependence was worth at most 0.97 of the right effect, and 1.5 times the best
wrong one if the library does not hold the hidden one; 1 / 0.75 = 1.33 is between the two."""

OWN_LAW_SHARE = 0.5
"""The same if the dependence is on an input of the effect, in a channel on which it acts: that is
the effect's own law with a freer form. A law that explains most of it is of the right kind, and its
misfit is reported."""

LITTLE_OF_A_LAW = 0.1
"""Remainder in a law's own variables, as a share of what the law explains, up to which it is a
misfit. A law fitted in another form than the true one (a line for a square, over the same range)
leaves at most that."""

LITTLE_OF_ERRORS = 0.05
"""Remainder in any variable, as a share of the squared errors, up to which it is put down to the
form of a law that explains ten times as much (`LITTLE_OF_A_LAW`): without it errors are 2.5 % less.
The engine's play, through which a wheel coasts as it brakes hard, leaves 1 to 4 %; what the library
lacks and raises errors by a tenth has 17 %."""

REST_EXPLAINED = 0.5
"""Share of an effect's gain that a freer form of a held law must take away, for the effect to be a
misfit of that law: half, as both then explain the same. Likewise of the form's own gain, where law
and effect treat left and right alike: a slip above a force, 13 ms late by its smoothed
acceleration, left 148 to the form and 19 to a delay of 0.7 ms that was not there."""

# --------------------------------------------------------------- how finely the evidence map looks

CURVE_KNOTS = 6
"""Knots of a smooth curve, at quantiles of the variable. Chosen: a threshold, a peak or one wave
shows in five pieces, each of a fifth of the data; every further knot costs significance."""

VARIED = 3.0
"""Spread of a speed, in standard deviations of its noise from message to message, up to which it
was held, along the whole way or within a piece of a curve. Noise of counts is in the speed that an
error may depend on, and in the error: a curve that resolves it finds that, and it is no law. On
circles at one speed the spread is 1 to 2, in mixed driving 10 and more; at three, noise makes a
tenth of the variance."""

FLOOR_CELL = 0.5
"""Width of the floor's cells [m], wider on large floors. Chosen: a carpet's edge, a cable or a ramp
affects a robot of this size over about that much."""

FLOOR_CELLS = 40
"""Most cells of the floor: each is a parameter, and chi-squared with 40 degrees of freedom must
exceed 90 for `VERY_SURE`, before the correction for all other cells of the map."""

GRIP, SELDOM_BEYOND = 10.0, 0.1
"""Acceleration [m/s^2] that no wheel transmits to the floor (a friction of one, times gravity), and
largest share of the steps above it. Counts in bunches, or jitter of stamps, cause it. With a larger
share the acceleration was not measured, and nothing is reported to depend on it. The real robots
and the engine's are below 3 in nine steps of ten; one with jitter is at 20."""

SELDOM_BACK = 0.02
"""Share of the way that must be driven backwards, and forwards, for errors to depend on the
direction of driving. Chosen: wheels that settle by a count as they stop make a millimetre or two a
metre, and the reported range of a variable leaves out as much at either end."""

STRAIGHT_SIGMAS, STRAIGHT_WINDOW = 3.0, 0.5
"""A robot drives straight where it turns, by its wheels, within so many standard deviations of
their noise over the window [s]: a law of turning says as much of noise there as of turns. Chosen:
three leave one step of 370 that is noise; a robot takes half a second to turn by more."""

NEIGHBOUR = 1.6
"""Distance of neighbouring floor cells, in widths: cells that share a corner are 1.4 apart, and
steps are seldom in the very middle of their cell."""

LEGS_A_TURN = 3
"""Legs of a turn of the wheel, where what happens within a turn must be told. Derived: from end to
end of a leg of a third of a turn, what goes once round in a turn (an axle off the centre) and what
goes twice round (an oval wheel) both change by sin(60 degrees), 0.87, of the most that they can;
of half a turn, the second cancels."""

TOGETHER = 2
"""Most effects that are tried beside one on which the parts of the drives disagree. Chosen: a mount
has a place, a direction and a clock."""
