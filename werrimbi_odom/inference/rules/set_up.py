# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is set up wrongly: counters, sizes, mounts, clocks and units."""

from __future__ import annotations

import math

# ------------------------------------------------------------- which explanation is the simplest

# How a wiring is weighed: minus log10 of how often robots are set up so, where each mistake alone
# is made on one robot in ten. That tenth is chosen: only ratios of the four numbers count.

BOTH_REVERSED = 1.6
"""Weight of two counters of the wrong sign: one convention makes both, so it is one robot in 40 and
not the one in 100 of two mistakes that have nothing to do with each other."""

ASKEW = 0.3
"""Mounts turned by less [rad] are left to the fits, where a derivative finds them: the sine is a
line to 1.5 % up to there. Turned by more is a mistake, of weight 1."""

ASKEW_BY = 0.15
"""Weight of each radian of a mount (an exponential law of its angle, of mean 2.9 rad). It decides
between explanations that have as many mistakes: a mount that looks astern is had a third as often
as one that looks ahead, 10^(-0.15 pi)."""

TWIN_WITHIN = 0.7
"""Difference of weights up to which another explanation is told as a twin: it is the likelier one
on one robot in six (odds of 10^0.7 = 5)."""

# -------------------------------------------------------------------------------- sizes and units

NEAR = 1.13
"""A value within this ratio of a simple factor is taken for it: pi and 4, the nearest two, are 1.27
apart, and sqrt(4 / pi) = 1.128 is half way."""

ORDINARY = 1.3
"""A value within this ratio of 1 is a matter of calibration, not of set-up. The nearest simple
factors are 2 and 1/2, half way to which is sqrt(2) = 1.41; a loaded tyre or a skidding base is
seldom off by more."""

MOST_OF_A_SKID = 2.5
"""Effective over true base up to which robots are found that skid round a turn (Jackal 1.5, Husky
1.875 by their makers' parameter files): a matter of four wheels, no mistake."""

WIDE = 1.5
"""A finding makes the typical error at least this much smaller. Chosen: the
smallest mistake, a factor of 1.3, errs by a third of the way where a calibrated robot errs by
parts in a hundred, so a right finding gains far more wherever the drives show it."""

ONE_WHEEL_FACTOR = 5.0
"""Factors below this (and above one in it) are tried for one wheel alone: with a factor of 57 or
1000 on one side the robot spins, which nobody would still call odometry."""

LONGEST_ARM = 5.0
"""Longest lever arm that is told [m]: what the bounds of `reference_lever_arm` allow."""

# ---------------------------------------------------------------------- what regressions must show

CUTS, MOST_CUTS = 300, 8000
"""Cuts of a whole session. Where half turns of the wheel make fewer than 300, cuts are shorter (so
many tell a size to 6 % of a cut's scatter), and longer where they make more than 8000 (time)."""

FEWEST_CUTS = 20
"""Cuts, or rows of a reference, that a regression is trusted with: five numbers at the most, and
fifteen left to tell the scatter to 18 %."""

SURE_SIZE = 8.0
"""Standard deviations that a wheel's or the base's size must lie from zero to be one. Chosen: its
sign decides of the wiring, and neighbouring cuts err alike, which makes deviations too small by
some times."""

MOST_CREEP = 0.35
"""Rate [rad/s] at which a gyro creeps at the most: 20 degrees a second are what the cheapest state
before they are calibrated. Without a limit a robot that drives straight at one speed on a reversed
wheel is one that spins before a gyro that is off by just that rate."""

ARM_TOLD = 0.02
"""Relative standard deviation of the base up to which a lever arm is fitted beside it: on circles
base and arm are one, and neither would be told."""

# ---------------------------------------------------------------------- positions in millimetres

MILLIMETRES_FROM = 100.0
"""Factor from which on base and radii are both too small because the reference is in millimetres.
Chosen: beyond 57.3, which is radians for degrees, and ten times below 1000."""

# --------------------------------------------------------------------------------- yaw in degrees

DEGREES_RANGE = 2.1 * math.pi
"""Range of the recorded yaw from which on it may be degrees: in radians, wrapped, it is 2 pi at the
most, and a robot that turned by less than that many degrees never turned."""

DEGREES_WRAPS, RADIANS_WRAPS = (300.0, 361.0), (4.0, 7.0)
"""Leaps of a yaw by itself that are wraps, in degrees and in radians: a whole turn, less what the
robot turns in one interval (60 degrees; 2.3 rad)."""

DEGREES_BETTER = 2.0
"""Times by which poses must fit better for their yaw to be degrees. Chosen: the wrong unit is 57
times off, so the right one gains far more on any drive with turns."""

# ------------------------------------------------------------------ a clock that is off by seconds

DELAY_WINDOW = 0.5
"""Seconds over which turns and ways are compared. A robot turns and drives off in about as long;
and stamps of a slow driver, which wander by a tenth or two and together, have their lateness in
common at lag zero from one reading to the next, over half a second a fifth as much."""

DELAY_LONGEST = 5.0
"""Lags looked at, both ways [s]: the bounds of `reference_delay`."""

DELAY_SHORTEST = 0.25
"""Smaller ones are left to the fits [s]: a derivative finds them, for a turn lasts longer."""

DELAY_BETTER = 1.1
"""How many times less another lag must leave unexplained to be called better. Chosen: with less to
gain than a tenth the drives show no turn that any lag could suit."""

DELAY_EVIDENCE = 15.0
"""Logarithm of that over all independent seconds: a log-likelihood. Of the 101 lags chance shows as
much in 101 exp(-15) = 3e-5 of sessions."""

DELAY_SPANS = 4
"""Times the longest lag that a run must last: so that three quarters of it are left to compare
with at that lag, on either side."""

DELAY_ROWS = 100
"""Rows of the grid (ten seconds) that all runs must have together to speak of a lag."""

DELAY_UNEXPLAINED = 1e-3
"""Share of the variance that no lag explains at the least: so that a record without noise, of a
simulation, is not infinitely sure of the lag that is nearest."""

DELAY_TAMED = 3.0
"""Times the ninth decile that a step counts for at the most: a failed match may be a hundred."""

# ----------------------------------------------------------------------------- positions alone

POSITION_CUTS = 60
"""Cuts of a session of positions alone, at the least: five windows."""

WINDOW = 12
"""Cuts in a window, each with a heading of its own: six turns of the wheel, two metres of a small
robot, over which its heading bends the path by more than the reference's noise."""

COARSE_WINDOWS, FINE_WINDOWS = 20, 60
"""Windows looked at, spread over all drives: over the whole range, and while refining. Chosen for
time: 1260 set-ups are tried on the first."""

POSITIONS_REFINED = 6
"""The best of those set-ups that are refined: chosen, for the right one need not be the best of
all on the coarse windows."""

GIVEN_AS_GOOD = 1.05
"""Times the best error up to which the sizes as entered are kept, and no lever arm is believed.
Chosen: a search of 1260 set-ups finds one that is a little better by chance, and on circles any arm
is as good as a base."""

POSITIONS_WIDE = 2.0
"""Times by which another set-up must make the typical error smaller than the given one. More than
`WIDE`, since every window has a heading of its own that may hide what is wrong or make it up."""

WINDOW_FLOOR = 0.01
"""Share of a cut's length below which one error of a window is as good as another."""

# ------------------------------------------------------------------------------- two poses a drive

SPARSE_CUTS, SPARSE_CUTS_MORE = 4, 16
"""Cuts a drive, and more in all, below which the reference is too rare to follow the robot: poses
at the start and the end, and two or three between; a session of one drive has twenty."""

SPARSE_SHARES = (0.002, 0.005, 0.01, 0.02, 0.04)
"""What a robot that is set up right may err by, of its path and turning; the likeliest counts. From
a calibrated robot on a hard floor to one that was measured with a tape."""

SPARSE_TURN, SPARSE_MOVE = 0.005, 0.003
"""What it may err by without having driven [rad, m]: noise of two poses by tape, each `TAPE_XY`
(2 sqrt(2) = 2.8 mm) and `TAPE_YAW`."""

SPARSE_MARGIN = 10.0
"""Log-likelihood by which a set-up must be better than the one entered: of 516 that are tried
chance makes one so in 516 exp(-10) = 2 % of sessions."""

SPARSE_APART = 5.0
"""Log-likelihood by which it must be better than any that says otherwise: a Bayes factor of 150, as
`RIVAL`, which is in units of minus two."""
