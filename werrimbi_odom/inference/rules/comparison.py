# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a comparison says: of how few legs nothing, of errors what, of a covariance what."""

from __future__ import annotations

# ------------------------------------------------------------------------------ how many legs

FEWEST_LEGS = 10
"""Legs, below which nothing is judged: of ten, 30 coordinates, the NEES of an honest covariance
is anywhere between 0.29 and 2.3 (`HONEST_CHANCE`)."""

MANY_LEGS = 30
"""Legs from which on the wheels' noise is told at their length: their scatter is then known to
8 % (1 / sqrt(2 * 90))."""

LEG_LENGTHS = (0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0)
"""Lengths of legs that are judged, in units of the one asked for: by doubles, over which noise and
drift part by a root of 2, as far as a drive has them."""

LEGS_OF_A_LENGTH, LEGS_OF_A_RUN = 8, 2
"""Legs that another length must give, in all and of each run on average, to be looked at."""

DRIFT_LEGS = 3
"""Legs of a run from which the drift of a gyro is told before its legs are judged: of fewer the
median is one of them, which would then err by nothing at all."""

LEGS_OF_A_PART = 6
"""Legs beyond what is fitted to them, for systematic parts and for the wheels' noise: Student's t
of five degrees must be 11 for `SURE_OF_LEGS`, so fewer never tell."""

# --------------------------------------------------------------------------- systematic parts

WORTH_SAYING = 0.2
"""Share of what the covariance promises for a leg that a systematic part must be: together they
make sqrt(1 + 0.2^2) = 1.02 of the promise, so less changes nothing."""

OF_MOST = 0.5
"""Share of a slope that is left when a few bad legs cannot carry it (Huber's estimate), for most
legs to have it."""

BENT_BY_HEADING = 0.75
"""Of heading error times leg: what an error sideways or along may be and still be that heading's.
One that grows evenly displaces the leg's end by 0.5, one that is there from its start by 1."""

WRONG_SHARE = 0.15
"""Share of travel or turn beyond which no calibration, but the set-up, is wrong. Chosen: tyres,
loads and tapes are off by a few percent, and no simple factor is nearer to 1 than 2."""

WRONG_OF_A_LEG = 0.1
"""Share of the leg that position errors have in the median, for the same. A base that is
13 % wrong (`NEAR`) does that to a leg with a quarter turn: half of 0.13 pi / 2."""

WRONG_NEES = 6.0
"""NEES of all legs beyond which they may be: errors 2.4 times what is promised. Where a reference
errs by as much as a leg is long (GPS, which is off by twice what it states), shares of a leg are
its own. Half and twice the radius are beyond it by positions of 0.1 m over legs of 1 m."""

SHORTEST_OF_POSITIONS, LEG_OF_POSITIONS = 5.0, 10.0
"""Times the noise of positions alone, below which a leg tells nothing, and which is enough: the
chord of a leg gives its heading, to 0.3 rad and to 0.14 rad."""

WORST_OF = 20
"""One leg in so many is among the worst, of whose share of all squared errors is told. Of a normal
scatter the worst twentieth has about a fifth (of two coordinates)."""

FEW_HOLD = 0.6
"""Share of the squared errors that a twentieth of the legs must hold for the rest to be called far
better. Chosen: of normal errors the worst twentieth holds 0.20 to 0.28, of Student's t with three
degrees of freedom 0.50 to 0.58; beyond that the few legs make the error, and no scatter."""

# ------------------------------------------------------------------- by a variable, by a place

LEGS_IN_A_BIN, BINS = 8, 5
"""Legs in a range of a variable, and the most ranges: Welch's test needs each range's variance,
which eight legs tell to a half; fifths of the legs show any rise, peak or trough."""

SECTORS = 8
"""Of the heading: two waves of it (a floor that slopes, wheels that crab) have four in each."""

CELLS_ACROSS = 8
"""Squares across the floor, at the most: 64 are corrected for."""

LEGS_IN_A_CELL = 4
"""Legs in such a square: Student's t of three degrees must then be 89 for `SURE_OF_LEGS` of
64, which a door sill makes it and no scatter."""

# -------------------------------------------------------------------------- honest covariances

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

NOISE_FACTOR_TOLD = 100.0
"""Upper over lower end of the interval of a variance's factor, up to which it is told: to better
than a factor of ten of the variance either way, three of the noise."""

# ------------------------------------------------------------------- noise of the reference

DIFFERENCES = 30
"""Third differences of a reference, below which their scatter is not told: so many tell it to 21 %
(1.17 / sqrt(30), of a median of sizes)."""

DIFFERENCE_REACH = 0.3
"""Path [m], or turning [rad], that such a difference may span: third differences take off what
grows with the way up to its square, and beyond that the model's error bends."""

VARIANCE_GROWS = 1.25
"""Times that their variance must grow from the shortest span to the longest for a line to be drawn
to no span: of 1000 differences chance does that in 4 % of cases (simulated)."""

TURNS_ENOUGH = 0.1
"""Turn rate [rad/s] above which a reference's headings show how its stamps scatter.
Chosen: below it stamps that scatter by 3 ms move a heading by less than 0.3 mrad."""

NOISE_LEFT = 0.25
"""Share of the shortest differences' variance that is taken for noise at least: half of their
standard deviation. Where growth outruns the noise the line is not to be trusted down to nothing."""

FACING_POSES = 10
"""Positions to either side of a pose whose chord tells its heading, where positions are all there
is: noise counts for a tenth of what it is between two neighbours."""

OTHER_DRIVE, OTHER_DRIVE_LEGS = 0.5, 4
"""Share of the square of what was driven that errors must keep, at every length of leg with so many
legs, for a reference to be of another drive. Two ways that have nothing in common leave one of them
or both (1 to 2); where something is told, a length is found at which far less is left. Four legs
all have such errors by chance in one case of 16 or less."""

OTHER_DRIVE_TURN = 0.2
"""Turn of a usual leg [rad] from which on headings are asked as well: lines hold hardly any, and an
effect that turns the robot on lines would pass for another drive."""
