# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every number that decides a verdict, with its derivation or the reason why it was chosen.

By how much right and wrong verdicts stood off them is plotted in docs/evidence.md.
"""

from __future__ import annotations

# ---------------------------------------------------------------- how sure a finding must be

SURE = 1e-3
"""An effect is believed when chance would show as much in fewer cases than this, all candidates
counted (Bonferroni): one false name in a thousand sound robots."""

VERY_SURE = 1e-5
"""The same for a dependence on a measured variable. All cells of the map are counted too; but an
effect is a law that somebody found true before, and a dependence has nothing behind it, so a
hundred times as much is asked of it."""

PENALTY_FLOOR = 6.0
"""The least that a free number must lower minus two log-likelihood by. BIC asks ln n, which is less
where n is below 403; chi-squared of one degree is above 6 in 1.4 % of cases, so that of few data a
number is not had for less than of many."""

RIVAL = 10.0
"""Difference of costs up to which two models cannot be told apart: a Bayes factor of 150, "very
strong" from there on (Kass and Raftery, J. Am. Stat. Assoc. 90, 1995)."""

SIMPLER = 3.0
"""By how much an effect must cost less than the calibration it would replace, to be its rival: a
Bayes factor of 4.5, "positive". Calibration is what every robot needs, so it is believed first."""

CALIBRATION_WORTH = 2.0
"""Penalties that one number of the calibration must be worth to be called a finding, and not only
fitted: once it is in every fit, twice it is news."""

# ------------------------------------------------------- what no effect of the library explains

LAW_SHARE = 0.75
"""Share of what a plain dependence on a measured variable is worth (fall of the cost less penalty)
that the best effect must be worth, for its name to be given. Laws are first-order physics: of 33
hidden sets the strongest dependence was worth at most 0.97 of the right effect, and 1.5 times the
best wrong one where the library does not hold what is hidden; 1 / 0.75 = 1.33 is amid the two."""

OWN_LAW_SHARE = 0.5
"""The same where the dependence is on what the effect itself looks at, in the channel on which it
acts: that is the effect's own law, freer in shape. A law that explains most of it is right in kind,
and that it does not fit fully is said."""

CELLS_ASKED = 20
"""Dependences, the most certain, of which it is asked whether they last: each costs a pass of the
filter, and one that lasts is among the first few or nowhere."""

ROUNDS = 4
"""Effects that are looked for, one after the other. More at once was never seen on a robot."""

# --------------------------------------------------------------- drives that are put together

GROSS = 3.0
"""Times the median error of the fitted drives, beyond which a drive is looked at by itself. A
manoeuvre that shows an effect errs more than others by as much, so this alone is no finding."""

OWN_GAIN = 3.0
"""Times by which its own set-up must lower such a drive's typical error: twice the 1.5 that a whole
session must show, because one drive is less than a session."""

FOLDS = 5
"""Of the cross-validation: a model is fitted on four fifths and judged on the rest, five times."""

FOLD_PARTS = 4
"""Of a drive in each fold: 20 parts of a drive of a minute are three seconds each, longer than
errors of neighbouring legs are alike."""

HALF_PARTS = 10
"""Of a drive, that go to odd and even halves in turn."""

SET_ASIDE_BLOCKS, SET_ASIDE = 8, (1, 5)
"""Stretches into which every drive is cut where no held-out drives are given, and those of them
that are put aside: a quarter, from both halves of the drive."""

SET_ASIDE_ROWS = 80
"""Poses that a drive must have for it, ten a stretch; else whole drives are put aside."""

RATE_OF_FIT = 50.0
"""Steps a second of recorded driving that a fit works with, at the least [Hz]; of faster messages
some are taken together (two at 100 Hz, four at 200 Hz).

A robot that brakes at 1 m/s^2 while it turns at 2 rad/s leaves the arc of a step of 20 ms by 1.3
um, and laws are the same however a drive is split into steps; speeds, which come in counts a step,
are told the better. The ends of legs are where they were, counted from all messages."""

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

# ------------------------------------------------------------------ what is told, and drafted

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

# ------------------------------------------------------- what is known before any measurement

TYPICAL_WHEEL_NOISE, WHEEL_NOISE_SPREAD = 5e-4, 1.2
"""Median [m^0.5], and standard deviation of the logarithm, of what is known of a rolling wheel's
noise before any drive.

Chong and Kleeman measured 4.0e-4 and 5.8e-4. Wheels that roll lie between 1e-4 (hard, narrow, on a
workshop floor) and 3e-3 (soft, wide, on tiles), which is the median times or over e^1.7, so about
five robots of six are within one and a half standard deviations. A drive with n degrees of freedom
tells ln k to 1/sqrt(2 n): of twenty legs the prior is worth 2 % of what is known then, of sixty
runs out and back 0.6 %; but k of 0.02, forty times the median, costs as much as a
deviation of 3.1 sigma."""

TYPICAL_STAMP_NOISE, STAMP_NOISE_SPREAD = 3e-3, 0.6
"""The same of the stamps of a gyro against the encoders' [s]: messages at 50 to 200 Hz wait for one
another by some milliseconds; 1 and 10 ms are two standard deviations off. What asks for more than
20 ms is a clock that is late (`reference_delay`), and must not pass for its scatter."""

TYPICAL_GYRO_WALK, GYRO_WALK_SPREAD = 3e-4, 0.8
"""The same of a gyro's random walk [rad/s^0.5]: 1 degree per root hour, as data sheets of gyros for
robots have it; 0.2 to 5 are two standard deviations off."""

CALIBRATION_BOUNDS = (0.25, 4.0)
"""Multipliers of base and radii that a robot can have: wheels that skid turn it as if they stood
1.5 (Jackal) to 2 times (four driven wheels on carpet) as far apart, and a radius entered for a
diameter is 2. Beyond four a number was entered in another unit, which the set-up search names."""

STRANGE_NOISE = 0.01
"""A wheel noise [m^0.5] above this (1 cm after 1 m) is no rolling wheel's: three times what the
softest have (`TYPICAL_WHEEL_NOISE`). What a fit calls so is something else that is missing."""

MOST_WHEEL_NOISE = 3e-3
"""The noise of the softest wheels that roll [m^0.5] (see `TYPICAL_WHEEL_NOISE`)."""

FAR_ABOVE_NOISE = 2.5
"""How many times what noise promises, with the softest wheels there are, the errors of legs must be
for a model to be wrong whatever its likelihood says. Errors of ten legs that are noise are as large
once in 10^16; a base that is 17 % wrong makes 2.8 times in a short drive with positions of 14 mm
alone."""

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
