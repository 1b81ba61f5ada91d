# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Set-up mistakes: counters, sizes, mounts, clocks and units."""

from __future__ import annotations

import math

# ------------------------------------------------------------- which explanation is the simplest

# Prior of a wiring: its weight is minus log10 of its frequency among robots, where each single
# mistake is on one robot in ten. That tenth is chosen: only ratios of the four numbers count.

BOTH_REVERSED = 1.6
"""Weight of two counters with the wrong sign: one convention causes both, so it is one robot in 40
and not the one in 100 of two independent mistakes."""

ASKEW = 0.3
"""Angle [rad] of a mount below which it is left to the fits, where a derivative finds it: the sine
is linear to 1.5 % up to there. A larger one is a mistake, of weight 1."""

ASKEW_BY = 0.15
"""Weight of each radian of a mount (exponential distribution of its angle, with mean 2.9 rad). It
decides between explanations with the same number of mistakes: a mount that looks astern has a third
of the prior of one that looks ahead, 10^(-0.15 pi)."""

ONE_SIZE_OFF = 2.3
"""Weight of one wheel that is beyond `ORDINARY` of the other by the file: a mistake, 1, and one of
some twenty factors, 1.3. Exchanged counters ask for it where each counts otherwise and they are
not exchanged."""

TWIN_WITHIN = 0.7
"""Difference of weights up to which another explanation is reported as a twin: it is the right one
on one robot in six (odds of 10^0.7 = 5)."""

# -------------------------------------------------------------------------------- sizes and units

NEAR = 1.13
"""Ratio to a simple factor within which a value is taken for it: pi and 4, the nearest two, are
1.27 apart, and sqrt(4 / pi) = 1.128 is half way."""

ORDINARY = 1.3
"""Ratio to 1 within which a value is a matter of calibration, not of set-up. The nearest simple
factors are 2 and 1/2, half way to which is sqrt(2) = 1.41; a loaded tyre or a skidding base is
seldom off by more."""

MOST_OF_A_SKID = 2.5
"""Largest ratio of effective to true base of robots that skid in turns (Jackal 1.5, Husky 1.875 by
their makers' parameter files): a property of four wheels, no mistake."""

WIDE = 1.5
"""Least factor by which a finding lowers the typical error. Chosen: the smallest mistake, a factor
of 1.3, errs by a third of the way where a calibrated robot errs by parts in a hundred, so a right
finding gains far more if the drives show it."""

ONE_WHEEL_FACTOR = 5.0
"""Factors below this (and above its inverse) are tried for one wheel alone: with a factor of 57 or
1000 on one side the robot spins, which nobody would call odometry."""

LONGEST_ARM = 5.0
"""Longest lever arm that is reported [m]: the bounds of `reference_lever_arm`."""

# ---------------------------------------------------------------------- what regressions must show

CUTS, MOST_CUTS = 300, 8000
"""Cuts of a whole session. If half turns of the wheel make fewer than 300, cuts are shorter (so
many determine a size to 6 % of a cut's scatter), and longer if they make more than 8000 (for
time)."""

FEWEST_CUTS = 20
"""Fewest cuts, or rows of a reference, for a regression: five parameters at most, and fifteen left
to determine the scatter to 18 %."""

SURE_SIZE = 8.0
"""Standard deviations of a wheel's or the base's size from zero, for it to be accepted. Chosen: its
sign decides the wiring, and errors of neighbouring cuts are correlated, which makes standard
deviations several times too small."""

MOST_CREEP = 0.35
"""Largest bias of a gyro [rad/s]: the cheapest state 20 degrees a second before calibration.
Without a limit, a robot that drives straight at one speed with a reversed wheel would equal one
that spins before a gyro with just that bias."""

ARM_TOLD = 0.02
"""Relative standard deviation of the base up to which a lever arm that is not sure (`SURE_SIZE`) is
fitted beside it too. Above, an arm that is not seen would only make the base that is seen worse."""

# ---------------------------------------------------------------------- positions in millimetres

UNIT_NEAR = 1.02
"""Ratio of both sizes to a unit of length within which the positions are in it: feet (3.28) and pi
are 1.044 apart."""

COUNTS_NEAR = 1.05
"""Ratio of the counts of a turn to those of a unit (radians, degrees, metres) within which the unit
is named: a radius that was entered from a drawing is off by less."""

MOST_COUNTS = 1.13e3
"""Factor on the radius above which the counters are in a unit and a fit would be ill-conditioned:
`NEAR` times the largest simple factor."""

MILLIMETRES_FROM = 110.0
"""Factor from which on base and radii are both too small because the reference is in millimetres.
Chosen: beyond centimetres, and nine times below 1000."""

# --------------------------------------------------------------------------------- yaw in degrees

DEGREES_RANGE = 2.1 * math.pi
"""Range of the recorded yaw above which it may be in degrees: in radians, wrapped, it is 2 pi at
most, and a robot that turned by less than that many degrees never turned."""

DEGREES_WRAPS, RADIANS_WRAPS = (300.0, 361.0), (4.0, 7.0)
"""Steps of a yaw that are wraps, in degrees and in radians: a whole turn, less the robot's turn in
one interval (60 degrees; 2.3 rad)."""

DEGREES_BETTER = 2.0
"""Factor by which poses must fit better for their yaw to be in degrees. Chosen: the wrong unit is
57 times off, so the right one gains far more on any drive with turns."""

FASTEST_TURN = 4.0
"""Rate [rad/s], the mean over a drive's turning, that no robot exceeds: by their makers Kobuki,
TurtleBot3 and Create turn at 2.8 to 4.3 rad/s at most. In degrees that is a turn at 0.07 rad/s:
four degrees a second."""

# ------------------------------------------------------------------ a clock that is off by seconds

DELAY_WINDOW = 0.5
"""Time [s] over which turns and ways are compared. A robot turns and drives off in about as long.
And stamps of a slow driver have a common delay of a tenth or two, so that at lag zero their errors
agree from one reading to the next, over half a second a fifth as much."""

DELAY_LONGEST = 5.0
"""Largest trial lag, both ways [s]: the bounds of `reference_delay`."""

DELAY_SHORTEST = 0.25
"""Lag [s] below which it is left to the fits: a derivative finds it, as a turn lasts longer."""

DELAY_BETTER = 1.1
"""Factor by which another lag must lower the unexplained variance to be called better. Chosen: with
less than a tenth to gain, the drives have no turn that determines a lag."""

DELAY_EVIDENCE = 15.0
"""Logarithm of that ratio times the number of independent seconds (intervals, where poses are rarer
than that), a log-likelihood, for a lag to be found. Of the 101 lags chance exceeds it in 101
exp(-15) = 3e-5 of sessions."""

DELAY_SPANS = 4
"""Shortest run in multiples of the largest lag, so that three quarters of it are left to compare at
that lag, on either side."""

DELAY_UNEXPLAINED = 1e-3
"""Least share of the variance that is taken as unexplained by any lag, so that a simulated record
without noise does not give infinite evidence for the nearest lag."""

DELAY_TAMED = 3.0
"""Limit of a step in multiples of the ninth decile near driving (winsorising): a failed match may
be a hundred."""

# ----------------------------------------------------------------------------- positions alone

POSITION_CUTS = 60
"""Fewest cuts of a session with positions alone: five windows."""

WINDOW = 12
"""Cuts in a window, each window with its own heading: six turns of the wheel, two metres of a small
robot, over which its heading bends the path by more than the reference's noise."""

COARSE_WINDOWS, FINE_WINDOWS = 20, 60
"""Windows used, spread over all drives: for the search of the whole range, and for the refinement.
Chosen for time: 1260 set-ups are tried on the first."""

POSITIONS_REFINED = 6
"""Best of those set-ups that are refined: chosen, as the right one need not be the best of all on
the coarse windows."""

GIVEN_AS_GOOD = 1.05
"""Error relative to the best up to which the sizes as entered are kept, and no lever arm is
accepted. Chosen: a search of 1260 set-ups finds one that is slightly better by chance, and on
circles any arm is as good as a base."""

POSITIONS_WIDE = 2.0
"""Factor by which another set-up must lower the typical error. More than `WIDE`, since every window
has its own heading, which may hide or imitate a mistake."""

POSITIONS_EVIDENCE = 14.0
"""Logarithm of that factor, times two coordinates of each window beside the first: errors within a
window are its heading's and its first position's, and go together. Of two fitted sizes and n
coordinates, chance lowers the error by a factor r in r^(2 - n) of cases (the F distribution with 2
and n - 2 degrees of freedom), so by any of 1260 set-ups in 1260 exp(-14) = `SURE`. One window alone
shows nothing."""

WINDOW_FLOOR = 0.01
"""Floor of a window's error as a share of a cut's length: smaller errors are treated as equal."""

# ------------------------------------------------------------------------------- two poses a drive

SPARSE_CUTS, SPARSE_CUTS_MORE = 4, 16
"""Cuts per drive, and more in all, below which the reference is too sparse to follow the robot:
poses at the start and the end, and two or three between; a session of one drive has twenty."""

SPARSE_SHARES = (0.002, 0.005, 0.01, 0.02, 0.04, 0.08)
"""Trial error levels of a robot with the right set-up, as shares of each wheel's counts; the
likeliest counts. From a calibrated robot on a hard floor to one that loses counts."""

SPARSE_TURN, SPARSE_MOVE = 0.005, 0.003
"""Error without any driving [rad, m]: noise of two positions by tape, each `TAPE_XY` (2 sqrt(2) =
2.8 mm), and of one heading, `TAPE_YAW`. Chosen: the wheels' noise is added to either, not squared,
and makes up for the other heading's within a metre."""

SPARSE_MARGIN = 10.0
"""Log-likelihood by which a set-up must exceed the one entered: of 588 that are tried, chance makes
one exceed it in 588 exp(-10) = 3 % of sessions."""

SPARSE_APART = 5.0
"""Log-likelihood by which it must exceed any contradicting set-up: a Bayes factor of 150, as
`RIVAL`, which is in units of minus two."""
