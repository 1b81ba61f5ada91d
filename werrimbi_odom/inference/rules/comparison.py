# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Comparison: how many legs it takes, and limits for errors, covariance and reference noise."""

from __future__ import annotations

# ------------------------------------------------------------------------------ how many legs

FEWEST_LEGS = 10
"""Fewest legs for any verdict: with ten, 30 coordinates, the NEES of a consistent covariance is
anywhere between 0.29 and 2.3 (`HONEST_CHANCE`)."""

MANY_LEGS = 30
"""Legs from which on the wheel noise is reported at their length: its standard deviation is then
known to 7 % (1 / sqrt(2 * 90))."""

LEG_LENGTHS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
"""Lengths of legs that are judged, in units of the requested one: doubled as far as the drives
allow. Over a doubling, noise and drift differ by a factor of sqrt(2)."""

LEGS_OF_A_LENGTH, LEGS_OF_A_RUN = 8, 2
"""Legs that another length must have, in all and on average in each run, to be judged."""

DRIFT_LEGS = 3
"""Legs of a run from which on a gyro's drift is estimated before its legs are judged: with fewer,
the median is one of them, whose error would then be zero."""

LEGS_OF_A_PART = 6
"""Legs beyond the fitted parameters, for systematic parts and for the wheel noise: Student's t with
five degrees of freedom must be 11 for `SURE_OF_LEGS`, so fewer are never significant."""

# --------------------------------------------------------------------------- systematic parts

WORTH_SAYING = 0.2
"""Systematic part that is worth a report, as a share of the predicted standard deviation of a leg:
together they are sqrt(1 + 0.2^2) = 1.02 of the prediction, so less changes nothing."""

OF_MOST = 0.5
"""Share of a slope that must remain when a few bad legs are down-weighted (Huber's estimate), for
it to be a slope of most legs."""

BENT_BY_HEADING = 0.75
"""Upper limit of an error sideways or along that is explained by the heading, as a multiple of
heading error times leg. A heading error that grows evenly displaces the end of the leg by 0.5, one
that is there from its start by 1."""

WRONG_SHARE = 0.15
"""Relative error of travel or turn above which the set-up is wrong, not the calibration. Chosen:
tyres, loads and tapes are off by a few percent, and no simple factor is nearer to 1 than 2."""

UNLIKE = 2.0
"""Times the error of the fitted drives from which that of the held-out ones is not called noise
alike. By chance it is as much larger in 1.8 % of cases with two measured coordinates held out, and
in 0.3 % with four."""

WRONG_OF_A_LEG = 0.1
"""Median position error, as a share of the leg, above which the set-up is wrong. A base that is 13
% wrong (`NEAR`) does that to a leg with a quarter turn: half of 0.13 pi / 2."""

WRONG_NEES = 6.0
"""NEES of all legs above which the set-up may be wrong: errors of 2.4 times the prediction. If a
reference errs by as much as the length of a leg (GPS, whose error is twice the stated one), the
relative errors of legs are its own. Half and twice the radius exceed this with positions of 0.1 m
over legs of 1 m."""

SHORTEST_OF_POSITIONS, LEG_OF_POSITIONS = 5.0, 10.0
"""Length of a leg in multiples of the noise of positions: below the first it has no information,
the second is enough. The chord of a leg gives its heading to 0.3 rad and to 0.14 rad."""

WORST_OF = 20
"""One leg in this many is among the worst, whose share of all squared errors is reported. For
normal errors the worst twentieth has about a fifth (of two coordinates)."""

FEW_HOLD = 0.6
"""Share of the squared errors that the worst twentieth of the legs must have, for the others to be
called far better. Chosen: with normal errors it has 0.20 to 0.28, with Student's t with three
degrees of freedom 0.50 to 0.58. Beyond that the few legs are outliers, no scatter."""

# ------------------------------------------------------------------- by a variable, by a place

LEGS_IN_A_BIN, BINS = 8, 5
"""Legs in a bin of a variable, and most bins: Welch's test needs the variance in each bin, which
eight legs give to a half; fifths of the legs show any rise, peak or trough."""

SECTORS = 8
"""Sectors of the heading: of two waves (a floor that slopes, wheels that crab) each has four."""

CELLS_ACROSS = 8
"""Most cells across the floor: 64 in all, for the Bonferroni correction."""

LEGS_IN_A_CELL = 4
"""Legs in a cell: Student's t with three degrees of freedom must be 89 for `SURE_OF_LEGS` of 64,
which a door sill reaches and scatter does not."""

# -------------------------------------------------------------------------- honest covariances

HONEST_WITHIN = 1.5
"""Factor above and below one within which the NEES of a consistent covariance lies.

Errors are then within 22 % of the prediction. With that, sensor fusion weights the odometry about
as it should, and no wheel's noise is known better. Without this tolerance a test with enough legs
would reject any covariance.
"""

HONEST_CHANCE = 0.9999
"""Share of the samples of a consistent covariance that lies within its bounds.

Some ten numbers are tested in a comparison, and the node's window slides over thousands of legs.
"""

ALIKE = 1.3
"""Factor between the intervals of the noise at short and at long legs, above which they differ."""

WHEELS_SHARE, WHEELS_GROWTH = 0.1, 0.5
"""Share of the wheels in the promised variance of legs, up to which the reference makes nearly all
of it; then what a larger noise of the wheels adds to NEES grows with at least the length of a leg,
and with the power `WHEELS_GROWTH` or less it is none (halfway to what the reference adds: the same
at every length)."""

NOISE_FACTOR_TOLD = 100.0
"""Ratio of the ends of the interval of a variance's factor, up to which it is reported: the
variance is then known to a factor of ten either way, the noise to three."""

# ------------------------------------------------------------------- noise of the reference

OWN_NOISE = 1.2
"""Errors of legs relative to what the reference's own noise makes of them, up to which that is what
is left: a law that explained all the rest would lower them by a sixth."""

DIFFERENCES = 30
"""Fewest third differences of a reference for an estimate of its noise: they give it to 21 % (1.17
/ sqrt(30), for a median of absolute values)."""

FREEDOM_OF_A_DIFFERENCE = 0.2
"""Degrees of freedom that each measured coordinate adds to such an estimate of a variance: 0.20 to
0.21 with 18 to 200 poses of white noise (simulated). A median of absolute values has 0.37 of those
of a mean square, and overlapping differences are correlated."""

UNLIKE_NOISE = 3.0
"""Ratio of standard deviations from which two drives' references are not given one noise: it is
then wrong by root 3 either way. What is less than that of motion capture counts as that: small
differences of a better one are of the drive (a robot under OptiTrack, from 0.1 mm where it is slow
to 0.5 mm), and such drives would decide alone."""

DIFFERENCE_REACH = 0.3
"""Path [m], or turn [rad], that such a difference may span: third differences remove errors that
grow with the way up to its square; beyond that the model's error is no longer a parabola."""

VARIANCE_GROWS = 1.25
"""Factor by which their variance must grow from the shortest to the longest span, for an
extrapolation to a span of zero: with 1000 differences chance does that in 4 % of cases
(simulated)."""

TURNS_ENOUGH = 0.1
"""Turn rate [rad/s] above which the headings of a reference show the jitter of its stamps. Chosen:
below it, a jitter of 3 ms moves a heading by less than 0.3 mrad."""

NOISE_LEFT = 0.25
"""Least share of the shortest differences' variance that is taken for noise: half of their standard
deviation. Where growth exceeds the noise, the extrapolation cannot be trusted down to zero."""

FACING_POSES = 10
"""Positions to either side of a pose by whose chord its heading is told, if only positions are
measured: noise counts for a twentieth of what it is between two neighbours."""

OTHER_DRIVE, OTHER_DRIVE_LEGS = 0.5, 4
"""Squared error relative to the squared motion, at every length with so many legs, above which the
reference is of another drive. Two unrelated paths leave one of them or both (1 to 2); a related
reference has far less at some length. Four legs all have such errors by chance in one case of 16 or
less."""

OTHER_DRIVE_TURN = 0.2
"""Turn of a typical leg [rad] above which headings are tested as well: straight lines have hardly
any, and an effect that turns the robot on lines would pass for another drive."""

NO_TURN = 0.05
"""Turn of a reference of headings, relative to that of the wheels, below which it showed none. By
the headings of another drive it is about one; of a dead gyro its noise and what is left of its bias
remain: next to nothing where the robot turned."""
