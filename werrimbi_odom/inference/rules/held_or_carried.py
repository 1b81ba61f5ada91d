# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Stretches that are no driving: a robot held while its wheels turn, or moved while they do not."""

from __future__ import annotations

import math

# -------------------------------------------------------- a reference whose clock gains or loses

CLOCK_IN_STEP = 0.8
"""Correlation of how much the wheels and the reference move from which on their clocks go alike: of
a drive without it another rate is tried, and taken where it reaches this."""

CLOCK_USUAL = 20.0
"""Time about a moment whose mean motion is subtracted for that [s]: several turns and stops."""

CLOCK_RATE = 0.025
"""Largest rate that is tried [s/s]: a microcontroller's clock without a crystal is a hundredth or
two off, and `reference_clock_drift` has that bound."""

CLOCK_COARSE = 0.5
"""What two rates differ by at the end of a drive [s], when they are tried first: half a window."""

CLOCK_TIMES, CLOCK_RATES = 40000, 1000
"""Most times at which the two are correlated, and most rates that are tried either way: enough for
an hour at 10 Hz and for five hours; of a longer drive the small rates, so that it takes seconds."""

CLOCK_WINDOWS = 300
"""Fewest windows to tell a rate from a delay: at two per cent, half a minute moves the stamps by
no more than half a window."""

# ----------------------------------------------------------- how wheels and reference go together

AGREE_WITHIN = 0.2
"""Deviation from a law up to which a window agrees with it, as a share of the most that both wheels
could do in it. Chosen: no effect of the library in its realistic range changes a wheel's travel by
more than 6 %, and one wheel of two moves the robot by half of that; the friction of a hand causes
more."""

AGREE_BETTER = 1.15
"""Factor by which the support for a law must be larger at another lag of the reference, to prefer
that lag: at 10 Hz the windows of two lags overlap, and the smaller lag is the likelier."""

AGREE_LAGS = 0.8
"""Share of all evidence for a law, from which on no other lag is tried, and no other law is
preferred to the robot file's."""

AGREE_LAG_STEP = 0.2
"""Step between trial lags [s], less than half a window; then the neighbours of the best one are
tried."""

AGREE_LATEST = 3.0
"""Longest trial lag of a reference [s]. Chosen: a longer one means another clock, which the set-up
search reports; then no stretches are searched for here."""

AGREE_SHARE = 0.3
"""Share of the windows with turning wheels that must agree with a law for it to be the robot's: in
the worst ordinary recordings (a student's tests with a robot that was lifted again and again) 31 %
do. Of two equally frequent laws the file's is taken."""

AGREE_SHARE_OF_FILE = 0.12
"""The same share for the law of the robot file. Chosen, less than half of the other: the file is
evidence by itself, and the drive need not find the law."""

AGREE_OWN = 0.25
"""Agreement with the robot file's law, relative to that of the most frequent law, from which on the
file's is taken. A robot that is held, half held or on a slippery floor turns too little in many
ways, and seldom by exactly what its file says."""

AGREE_ENOUGH, AGREE_FEWEST = 2.0, 10
"""Seconds, and windows, that must agree with a law. Chosen: a quarter turn at half a radian a
second with its start and end takes four; ten windows of two numbers leave eight degrees of
freedom."""

AGREE_TURN, AGREE_WAY = 1.0, 0.3
"""Turn [rad] and travel [m] that must agree: several times what must be in doubt for a stretch."""

AGREE_TURN_OF_FILE = 0.4
"""The same turn for the law of the robot file [rad]. Chosen, less than half of the other, as with
the shares: the file is evidence by itself. A TurtleBot3 that ran against something after three
seconds of turning, and then turned by 0.4 of what its wheels did, had turned by 0.54 rad."""

STANDS = 0.05
"""Share of the median travel of the wheels in a window, below which they stand: a motor that holds
its position jitters by a count or two."""

TREMBLES = 1e-3
"""Share of the median speed by distance, up to which wheels only tremble: far less than any motor
drives, far more than the last digits of an angle in single precision."""

MOSTLY = 0.3
"""Travel of the robot relative to that of the wheels, below which it turns on the spot: there the
reference's lever arm is observable by itself, without the travel."""

# ---------------------------------------------------------------------------- what is no driving

NO_DRIVING_WINDOW = 0.5
"""Length of the windows [s]; with slower messages two intervals. Its middle is known to half of it
or better, and the ends of stretches should be found within half a second."""

NO_DRIVING_ENDS = 0.4
"""Uncertainty of the ends of a stretch [s], within which no leg is used. By a gyro they are known
to half a window, by a localiser with a delay to 0.4. What is left of a stretch at either end is as
wrong as its middle, and a drive has few of them."""

NO_DRIVING_SILENCE = 3.0
"""Silence in multiples of the median interval, above which a window is not judged; shorter ones are
bridged, as for a lost message."""

NO_DRIVING_POSES, NO_DRIVING_SPANS = 30, 5
"""Fewest poses, and fewest consecutive windows, for a law of how the robot drives."""

NO_DRIVING_OFF = 0.36
"""Deviation above which a window is no driving, as a share of the most that both wheels could do.
On the strongest simulated spot of oil both wheels lose 0.3; a skidding robot of the recordings is
off by 0.38 for a window now and then, and a TurtleBot slowed down by a hand by 0.4 for seconds. A
robot that is held loses all."""

NO_DRIVING_ROUGH = 8.0
"""Deviation in multiples of the typical deviation of agreeing windows, below which no window is
no driving: 5.4 sigma of Gaussian noise. A scan matcher that fails in corridors is no hand that
holds."""

NO_DRIVING_STOPPED, NO_DRIVING_STOPPED_FOR = 0.1, 1.5
"""Motion relative to what the wheels should cause, below which nothing moves at all, and the
seconds for which. A slow turn is a small part of what both wheels could do, so a robot that is held
in one deviates little in that measure. The most that any effect of the library takes of a turn is a
third. The time is three windows, so that neither jitter of stamps nor a kick can cause it."""

NO_DRIVING_EDGE = 0.25
"""The deviation for windows beside such ones: at the ends of a stretch a window is half driven."""

NO_DRIVING_SLOWED = 0.06
"""Share of the most that both wheels could do, by which the robot must turn too little, in sum, for
the time beside a stretch to belong to it: no effect of the library in its realistic range changes a
wheel's travel by more. A hand that let a TurtleBot go slowed it by 0.12 to 0.24 for another second;
in that second the robot went aside too, and the lidar was found 7 mm beside its place."""

NO_DRIVING_NOISE = 5.0
"""Least deviation in multiples of the typical scatter: five times the median of Gaussian noise is
3.4 sigma, beyond which is one window in 1300, and a stretch is many windows."""

NO_DRIVING_GENTLE = 0.25
"""Share of the windows that keep to a law, the slowest ones, whose scatter is that of a robot at
rest. Chosen: a law that is off by a twelfth (an arm that no turn has shown) scatters by that of
what is driven, five times which is more than a slow carry goes in half a second."""

NO_DRIVING_TURNS = math.radians(3.0)
"""Slowest turn [rad/s] that counts as one: a cheap gyro drifts by less than a degree a second."""

NO_DRIVING_GOES = 0.1
"""Least travel in a window that counts as motion, as a share of the typical one: a localiser
wanders while the robot stands."""

NO_DRIVING_LATE = 0.1
"""Jitter of stamps [s]: what the wheels did this long before or after counts too. Over USB and
wireless networks stamps are late by tens of milliseconds, now and then by a tenth. With twice as
much, a robot that is held while it is told to go to and fro would not be found."""

NO_DRIVING_FEWEST, NO_DRIVING_MORE = 6, 3
"""Consecutive windows of the shortest stretch, and the windows by which it is longer than one: at
10 Hz and more 0.8 s. A jump of the reference touches as many windows as one has steps, and one
more."""

NO_DRIVING_FIRM, NO_DRIVING_FEWEST_FIRM = 0.6, 4
"""Deviation from all of a stretch shorter than that, as a share of what both wheels could do, and
fewest windows of it. At five readings a second six windows are 1.5 s, and a robot that was stopped
for a moment is free again by then. Nearly twice `NO_DRIVING_OFF`: beyond the jitter that is allowed
for, no robot rolls as badly."""

NO_DRIVING_LEAP, NO_DRIVING_LEAP_WITHIN = 2.0, 0.15
"""Step of the reference from one pose to the next above which it is a jump, in multiples of the
wheels' motion or of the reference's a moment before and after; and longest typical step [s] for
that test. Chosen: stamps with a jitter of half an interval make 1.5 of one, and a hand does not
move a robot within three steps of 0.15 s."""

NO_DRIVING_LEAP_OF_DIGITS = 1.5
"""Step, in units of the last digit of the reference, up to which it is none: a value that is
rounded steps by one unit more or less than it moved. Chosen: the midpoint between one unit and two.
It holds where more than half of the steps are as usual to the last digit; the unit is then the
median of the steps that are not zero."""

NO_DRIVING_AT_ONCE = 0.75
"""Largest share of what is in doubt that may be in one window: a lost track or a failed match is
over within one (a share of 1), and is found as a jump. A hand that moved a robot ever faster, until
the reference lost it, did three fifths of it in the last window."""

NO_DRIVING_QUICK = 2.0
"""Motion in multiples of the most that both wheels could do meanwhile, above which a hand moved the
robot, however quickly: to pick it up and put it down elsewhere may take half a second. Chosen: no
slip does as much, and a reference jumps from one pose to the next (`NO_DRIVING_LEAP`)."""

NO_DRIVING_MOST = 4.0
"""Turn in multiples of the most that both wheels could cause by the robot file, above which it was
not the wheels, if a drive does not show its law: no base or radius is off by more
(`CALIBRATION_BOUNDS`)."""

NO_DRIVING_TURN, NO_DRIVING_WAY = math.radians(3.0), 0.03
"""Least error for a stretch to be left out [rad, m]: more than any castor kicks (0.03 rad in
simulation), and no more than spoils a leg."""

NO_DRIVING_FOLLOWS = 0.25
"""Share of the squared turns by the wheels that the measured ones may leave unexplained, below
which the heading follows the wheels: it then turns by half or more of what they say, where that of
a robot that is held by none (a share of 1)."""

NO_DRIVING_WENT = 0.5
"""Share of what the wheels say that the robot moved in a stretch, above which it did not stand: a
gyro that goes up to 0.6 rad/s shows 0.6 of a spin at 1 rad/s. Simulated robots that were held went
0 to 0.18 of it (44 stretches), with the moments in which they stop and go on."""

NO_DRIVING_JOINED, NO_DRIVING_SILENT = 1.0, 3.0
"""Time [s] between two stretches, or to an end of the drive, that is left out with them: always,
and if no window in between agrees with the wheels. To hold a robot takes time."""

SILENT_TO_MOVE = 2.0
"""Shortest silence of the reference [s], also ten of its intervals (`GAP_INTERVALS`), in which a
robot whose wheels stand may be put elsewhere. Chosen: to lift it and set it down takes as long;
less is a jump of the reference."""

NO_DRIVING_SPLIT = 1.5
"""Shortest part of a stretch [s] that is reported by itself, as held or as carried."""

NO_DRIVING_SET_DOWN = 0.3
"""Extension of a carry at its ends [s], while the wheels stand: a robot is set down gently, and
windows of half a second cannot show the last of it. To leave out a rest costs nothing, and times
are reported within half a second."""

NO_DRIVING_TREMBLES = 1e-3
"""Travel of a wheel [m] up to which it stands: the counts of a lifted wheel tremble by less."""

NOISY_PHASE, NOISY_PHASE_LASTS = 3.0, 5.0
"""Scatter of the reference relative to the rest of the drive, above which it is in a phase of its
own, and the time [s] over whose poses that is asked. Chosen: errors three times as large have nine
times the variance, which no one noise of a drive describes. The median of twenty-one poses in both
coordinates is known to a quarter, so three times is far beyond its chance, and its root, to which a
phase reaches, is three of its standard deviations."""

REST_LASTS = 0.5
"""Shortest rest [s] that is reported as standing: less is a change of direction."""

# ------------------------------------------------------------------------------- a gyro at rest

BIAS_REST = 1.0
"""Least time of one rest, without its edges, that tells a gyro's bias [s]. In shorter pauses the
robot may still be coming to rest: those of a sound simulated drive, 1.4 s in all, told 3°/s."""

BIAS_EDGE = 0.25
"""Time at the beginning and the end of a rest that does not count [s]: twice by how much gyros
were late in recordings, so that no turning is in it."""

BIAS_SURE = 4.0
"""Standard deviations from none that a bias must be to be taken off: 6 of 100,000 without one."""

NO_DRIVING_STUCK = 0.7
"""Share of the poses of a held stretch that repeat the one before to the last digit, from which on
it was the reference that stood still. Chosen: half a window at both ends is of the motion before
and after, which is a third of the shortest stretch."""
