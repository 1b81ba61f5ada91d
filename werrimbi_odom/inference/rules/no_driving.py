# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is no driving: a robot that is held while its wheels turn, or moved while they do not."""

from __future__ import annotations

import math

# ----------------------------------------------------------- how wheels and reference go together

AGREE_WITHIN = 0.2
"""Share of what both wheels could do in a window, by which what is measured may be off and keep to
a law. Chosen: no effect of the library in its realistic range moves a wheel by more than 6 %, and a
wheel of two moves the robot by half of that; friction that a hand adds is beyond it."""

AGREE_BETTER = 1.15
"""Times as much must keep to the law at another lag of the reference, to be preferred: at 10 Hz the
windows of two lags overlap, and the smaller lag is the likelier."""

AGREE_LAGS = 0.8
"""Share of all that speaks for a law, from which on no other lag is tried, and no other law taken
for being the robot file's."""

AGREE_LAG_STEP = 0.2
"""Between two lags that are tried [s], less than half a window; then the best one's neighbours."""

AGREE_LATEST = 3.0
"""Longest lag of a reference that is tried [s]. Chosen: what is later is another clock, and the
search for set-up mistakes says so; there nothing is looked for here."""

AGREE_SHARE = 0.3
"""Share of the windows in which wheels turn, that must keep to a law for it to be the robot's: of
the worst ordinary recordings (a student's tests with a robot that was lifted again and again) 31 %
do. Of two that are as common as each other the file's is taken."""

AGREE_SHARE_OF_FILE = 0.12
"""The same of the law of the robot file. Chosen, less than half of the other: the file says so by
itself, and the drive need not find it."""

AGREE_OWN = 0.25
"""Part of those that keep to the commonest law, that must keep to the robot file's for that to be
taken. A robot that is held, half held or on a slippery floor turns less than it should in many
ways, and seldom just as much as its file says."""

AGREE_ENOUGH, AGREE_FEWEST = 2.0, 10
"""Seconds, and windows, that must keep to a law. Chosen: a quarter turn at half a radian a second
and its start and end take four; ten windows of two numbers leave eight degrees of freedom."""

AGREE_TURN, AGREE_WAY = 1.0, 0.3
"""What must have been turned [rad] and gone [m] in accord: several times what must be in doubt."""

STANDS = 0.05
"""Share of the median way of the wheels in a window, below which they stand: a motor that holds its
place jitters by a count or two."""

TREMBLES = 1e-3
"""Share of the speed below which half of all way is gone, up to which wheels only tremble: far less
than any motor drives, far more than the last digits of an angle in single precision."""

MOSTLY = 0.3
"""Share of the wheels' way, below which a robot turns on the spot: there the reference's arm is
seen by itself, and not the way."""

# ---------------------------------------------------------------------------- what is no driving

NO_DRIVING_WINDOW = 0.5
"""Length of the windows [s]; of slower messages two intervals. Its middle is known to half of it
and better, and ends of stretches should be found within half a second."""

NO_DRIVING_ENDS = 0.4
"""How far from where it is told a stretch may end [s]: no leg comes nearer. By a gyro its ends are
known to half a window, by a localiser that is late to 0.4; what is left of it at either end is as
wrong as its middle, and a drive has few of them."""

NO_DRIVING_SILENCE = 3.0
"""Times the usual interval, across which nothing is said of a window: a lost message is bridged."""

NO_DRIVING_POSES, NO_DRIVING_SPANS = 30, 5
"""Poses, and windows side by side, below which nobody knows how the robot drives."""

NO_DRIVING_OFF = 0.36
"""Share of what both wheels could do, beyond which it is no driving. On the strongest simulated
spot of oil both wheels lose 0.3; a skidding robot of the recordings is off by 0.38 for a window now
and then, and a TurtleBot that a hand slows down by 0.4 for seconds. One that is held by all."""

NO_DRIVING_ROUGH = 8.0
"""Times the usual share by which windows are off that keep to the law, that is too far at the
least: of Gaussian noise 5.4 sigma. A scan matcher that fails in corridors is no hand that holds."""

NO_DRIVING_STOPPED, NO_DRIVING_STOPPED_FOR = 0.1, 1.5
"""Share of what the wheels should show, below which nothing moves at all, and seconds for which: a
slow turn is a small part of what both wheels could do, so that a robot which is held in one is not
off by much. The most that any effect of the library takes of a turn is a third. For three windows,
so that no stamps that wander and no kick can be it."""

NO_DRIVING_EDGE = 0.25
"""The same for windows beside such ones: at the ends of a stretch a window is half driven."""

NO_DRIVING_NOISE = 5.0
"""Times the usual scatter, below which nothing is too far: of Gaussian noise 5.7 times its median
are beyond 3.8 sigma, and a stretch is many windows."""

NO_DRIVING_GENTLE = 0.25
"""Share of the windows that keep to a law, the slowest ones, whose scatter is that of a robot at
rest. Chosen: a law that is off by a twelfth (an arm that no turn has shown) scatters by that of
what is driven, five times which is more than a slow carry goes in half a second."""

NO_DRIVING_TURNS = math.radians(3.0)
"""Slowest turning [rad/s] that is one: a cheap gyro drifts by less than a degree a second."""

NO_DRIVING_GOES = 0.1
"""Share of the usual way in a window that is one: a localisation wanders while the robot stands."""

NO_DRIVING_LATE = 0.1
"""Seconds by which stamps may wander: what the wheels did so much before or after counts too. Over
USB and wireless networks stamps are late by tens of milliseconds, now and then by a tenth. By twice
as much a robot that is held while it is told to go to and fro would not be found."""

NO_DRIVING_FEWEST, NO_DRIVING_MORE = 6, 3
"""Windows in a row of the shortest stretch, and by how many it is longer than a window: at 10 Hz
and more 0.8 s. A leap of the reference touches as many windows as one has steps, and one more."""

NO_DRIVING_FIRM, NO_DRIVING_FEWEST_FIRM = 0.6, 4
"""Share of what both wheels could do, that must be missing from all of a stretch which is shorter
than that, and windows that it must have still: of five readings a second six windows are 1.5 s, and
who stops a robot for a moment is gone by then. Nearly twice the share of `NO_DRIVING_OFF`: where a
clock that wanders has been allowed for, no robot rolls as badly."""

NO_DRIVING_LEAP, NO_DRIVING_LEAP_WITHIN = 2.0, 0.15
"""Times what wheels did, or the reference a moment before and after, beyond which a step of it from
one pose to the next is a leap; and longest usual step [s] for that to be asked. Chosen: stamps that
wander by half an interval make 1.5 of one, and three steps of 0.15 s are no hand's."""

NO_DRIVING_AT_ONCE = 0.75
"""Share of what is in doubt, that must not be in one window: a lost track or a failed match is over
within one (a share of 1), and is found as a jump. A hand that moves a robot ever faster, until the
reference lost it, did three fifths of it in the last window."""

NO_DRIVING_QUICK = 2.0
"""Times what both wheels could do meanwhile, beyond which a hand moved the robot, however quickly:
who picks it up and puts it down elsewhere may take half a second. Chosen: no slip does as much, and
a reference that leaps does so from one pose to the next (`NO_DRIVING_LEAP`)."""

NO_DRIVING_MOST = 4.0
"""Times what both wheels could turn the robot by its file, beyond which no wheels did, where a
drive says nothing of how they go together: no base, no radius is off by more
(`CALIBRATION_BOUNDS`)."""

NO_DRIVING_TURN, NO_DRIVING_WAY = math.radians(3.0), 0.03
"""What must be in doubt for a stretch to be left out [rad, m]: more than any castor kicks (0.03 rad
in simulation), and no more than spoils a leg."""

NO_DRIVING_JOINED, NO_DRIVING_SILENT = 1.0, 3.0
"""Seconds between two stretches, or to an end of the drive, that belong to them: always, and where
nothing in between is seen to move as its wheels do. Who holds a robot takes his time."""

NO_DRIVING_SPLIT = 1.5
"""Shortest part of a stretch [s] that is told by itself, as held or as carried."""

NO_DRIVING_SET_DOWN = 0.3
"""What belongs to a carry at its ends [s], where the wheels stand: who sets a robot down does it
gently, and windows of half a second see the last of it no better. A rest that is left out costs
nothing, and times are told within half a second."""

NO_DRIVING_TREMBLES = 1e-3
"""Way of a wheel [m] up to which it stands: counts of one that is lifted tremble by less."""

REST_LASTS = 0.5
"""Shortest rest [s] that is told as standing: less is a change of direction."""

# ------------------------------------------------------------------------------- a gyro at rest

BIAS_REST = 1.0
"""Least time that the wheels must stand for a gyro's bias to be told by it [s]."""

BIAS_EDGE = 0.25
"""Time at the beginning and the end of a rest that does not count [s]: twice by how much gyros
were late in recordings, so that no turning is in it."""

BIAS_SURE = 4.0
"""Standard deviations from none that a bias must be to be taken off: 6 of 100,000 without one."""
