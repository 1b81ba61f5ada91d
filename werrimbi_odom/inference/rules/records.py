# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What counts of a recording: poses, legs, and the parts that drives are cut into."""

from __future__ import annotations

import math

# --------------------------------------------------------------------------------- poses and legs

POSE_ROWS = 0.5
"""Share of a reference's rows that must hold a position and a heading, for the others to be left
out and poses to be compared: most of them, as the name of what was measured should be."""

POSE_ROWS_OF_SET_UP = 0.3
"""The same in the search for set-up mistakes. Chosen, less than for a comparison: poses tell every
mistake in closed form, positions alone not, and a third of the rows is enough for regressions."""

FEW_POSES, MOMENT = 10, 1.0
"""Of fewer reference poses those count too that lie outside the ticks' time by no more than this
[s]. Chosen: by tape one pose is taken before the recording is begun and one after its end."""

QUARTER_TURN = 0.5 * math.pi
"""Turning [rad] that is worth a leg of path, whatever the leg's length: the corner of a square
divides its sides."""

CUT_ANEW = 3.0
"""Factor by which a size of the robot file is off, beyond which a fit cuts its legs by what the
size was found to be. An angle in degrees makes legs of 57 m of those of 1 m, a dozen in ten
minutes, and a radius told to 0.13 % where 0.005 % are in the drives. A factor of 2 in the base
stays: a drive of half a minute has few legs then, and what is fitted is judged on the same ones."""

PARTS_OF_A_LEG = 4
"""Fits use legs this much shorter than those that are judged. Noise grows with the root of the way
and drift with the way, so over four times the length they part by a factor of 2."""

EDGE = 0.3
"""Time at both ends of a run whose legs are not counted [s]. Chosen: clocks that are synchronised
over a network differ by less; what is later than that the search for set-up mistakes finds."""

EDGE_LEGS = 20
"""Legs of a run up to which none is left out at its ends: two of twenty are a tenth of what is
measured, and two poses a drive are all there is."""

# ----------------------------------------------------------------- drives that are put together

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

FOLD_TELLS = 0.5
"""Share of what all legs tell of a number above which one fold knows it better than the others. Of
a number of which the others tell q, carried over to a fold that tells p, the noise costs 1 + p / q
on average: the two of `USELESS_NUMBER` where both tell half, and a thousand where a drive's first
heading, seen by positions alone, is asked of the drive's end (a robot in a labyrinth)."""

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

# ------------------------------------------------- references that are made from the wheels

CIRCLE_WAY, CIRCLE_FEWEST = 0.25, 20
"""Longest ways [m] over which a reference is compared with the wheels, and how many there must be;
where a drive is shorter than so many, they are. Longer than the way between two stamps that jitter,
and short enough for the wheels' own errors to be small."""

CIRCLE_DELAYS = tuple(0.01 * step for step in range(-30, 31))
"""Delays [s] of the reference that are tried: filters are later than wheels by some messages."""

CIRCLE_EXACT = 0.1
"""Share of what the counters round off, below which a reference was made from the same counts.
Somebody who looks at the robot sees the part of a count that was rounded off, and so is off by all
of it: the median of 20 such errors is below a tenth of what is usual less than once in 10^7
times."""

CIRCLE_FINEST = 3e-4
"""Share of a way, below which a reference was made from the wheels where their angles are no whole
counts. What looks at the robot differs by more: 75 um in 0.25 m is below a motion capture's noise,
and wheels' own, of k = 4e-4 m^½, is 0.2 mm. Odometry from the same angles comes to 1e-15, and
to 2e-4 where it was sent between two of them."""

CIRCLE_APART = 0.012
"""Usual difference of a way [m], beyond which even what is called odometry is no odometry of these
wheels. Stamps that jitter by 40 ms at 0.3 m/s, or the lag of a filter, make as much; what differs
by more was measured."""

CIRCLE_STEPS, CIRCLE_WHOLE = 10.0, 0.02
"""Steps of a counter that are no integers, in units of their smallest difference, that are
asked whether they are whole, and how much a unit may be off: angles of 32 bits are whole but for a
hundredth of a count at a thousand turns. What is not whole rounds nothing off: `CIRCLE_FINEST`
is asked then."""

EVEN_LEAST = 0.02
"""Share of the time between two messages by which their stamps must be off (rms) to be put right.
A reference with a clock of its own sees a wheel that is stamped 4 ms late of 50 lie 2 mm behind and
slower before: a slip that is none. With less it is below what any reference errs."""

EVEN_LEAST_TOGETHER, EVEN_TOGETHER = 0.1, 0.5
"""The same where one packet brings the wheels and the reference, a gyro: it errs alike, and would
err against wheels that were put right alone; more moves a wheel by a tenth of what it goes. And how
closely the stamps of both must go together (correlation) to be of one packet: half of what is late
in one is in the other."""

EVEN_MESSAGES, EVEN_WINDOW = 50, 51
"""Messages that tell whether stamps say when counters were read: with fewer, chance does. And how
many the middle of their lateness is taken over: few seconds, in which two clocks part by 0.1 ms,
and enough to be right to a sixth of the scatter of one stamp."""

EVEN_SHARE, EVEN_SURE = 0.5, 3.0
"""Share of what stamps are off that counts may follow, for their timer to be believed in place of
the stamps: half way between a timer that is uneven but told truly (1) and one that is even (0). And
standard deviations of it that must be between: coarse counts tell neither."""

EVEN_HALF_BASE = 0.1
"""Of the two wheels that a path by scans is told by [m]: as large as a small robot's, so that way
and turning both count. Chosen; any robot's would do."""

EVEN_HOLE = 1.7
"""Times the way of a step beside it, from which on a scan is missing in between: nearer to two than
to one, and beyond what noise of some millimetres and a start make of one."""

EVEN_MOST = 0.4
"""Share of a turn of the lidar that scans may be put back by (rms). What is late by anything up to
a turn is so by 0.29; where scans by the dozen are missing, and are not told, it comes to 0.45."""
