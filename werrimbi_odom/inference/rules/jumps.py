# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Leaps of a counter, and jumps of the reference."""

# ------------------------------------------------------------------------------ leaps of counters

LEAP_USUAL, LEAP_TIMES = 0.9, 10.0
"""Quantile of the wheel speed over the intervals with travel, and multiple of it above which no
wheel goes for a moment. A robot that creeps for nine tenths of its drive and then goes ten times as
fast does so for longer than `LEAP_LASTS` intervals."""

LEAP_SPEED = 10.0
"""Turns a second that every wheel may reach. Chosen: 2 m/s on wheels of 3 cm, 20 m/s on wheels of
30 cm; nearly all robots are slower."""

LEAP_LASTS, LEAP_FEWEST = 3, 20
"""Longest leap in intervals, and fewest intervals with travel for a typical speed. To a wrong
reading and back are two intervals; what lasts longer is driving."""

# ------------------------------------------------------------------------- jumps of the reference

JUMP_SCATTER = 12.0
"""Error of an interval in standard deviations (1.48 medians of its size), above which it may be a
jump of the reference. Chosen: by Chebyshev's inequality whatever is distributed exceeds as many of
its own in 0.7 % of intervals at most, and `JUMP_SHARE` is required as well."""

JUMP_RARE = 0.1
"""Largest share of a run's intervals that may be jumps; more frequent errors are noise. Chosen:
scan matchers in use fail in 2 to 4 % (the recorded Khepera's)."""

JUMP_RARE_SIGMAS = 1.645
"""Standard deviations that a tenth of normal errors exceed (`JUMP_RARE`, both sides)."""

JUMP_SHARE = 0.5
"""Error of an interval relative to the motion about it, above which it is a jump. A base or a
radius that is off by half is a set-up mistake, which causes such errors in every interval."""

JUMP_SPAN = 0.05
"""Shortest time [s] whose motion `JUMP_SHARE` refers to: the interval of motion capture at 20 Hz,
on which it was chosen. A robot at 1 m/s goes 20 mm between the fixes of an RTK receiver at 50 Hz,
which scatter by 5 mm: half of that is noise."""

JUMP_SHARE_OF_A_GYRO = 1.5
"""The same limit for headings alone. A gyro does not lose its position; a delay of more than an
interval causes an error of all that the robot turns in it (a share of 1), and a start looks like a
jump until base and clock are right."""

JUMP_LEAST_OF_A_GYRO = 0.02
"""Least jump of headings alone [rad]: 1.3 % of a quarter turn. Less spoils no leg, and if a gyro
has hardly any noise (in a simulator) every error of the model exceeds the typical scatter."""

JUMP_LATE = 0.5
"""Time [s] within which motion may belong to an interval, as the reference's clock may be off: more
than the `EDGE` that is left to the fits."""

JUMP_NEIGHBOURS, JUMP_FEWEST = 3, 8
"""Intervals to either side of which the median is taken, and fewest intervals in which a jump is
found: their window of seven, and one more."""

JUMP_LASTS = 0.5
"""Share of the largest jump on a leg that must remain at its end for the leg to be spoilt. Chosen:
a spike returns to within the noise, and a lost position stays; half is the midpoint."""

JUMP_SMALL = 0.2
"""Share of a run's largest jump up to which a jump spoils no leg: beside a lost position it is
noise, and what lasts is found by itself once the model is right (an event)."""

JUMP_STEPS, JUMP_STEPS_ALIKE = 3, 1.01
"""How often the smallest change of a heading must occur to be the step in which it is given (a
compass of whole degrees), and the factor within which it does. Chosen: a jump is one change, a
spike two."""

JUMP_OF_A_LEG = 40.0
"""Squared deviation of a leg, relative to the median of its run, above which the reference jumped:
chi-squared with three degrees of freedom exceeds it in one leg of 10^8."""

JUMP_PUT_ASIDE = 10.0
"""Fall of the cost of a run above which the reference jumped within a part put aside, as the legs
after it tell. Chosen: 150 times as likely, where without a jump the cost rises (by 15, as an error
of `LOST_XY` is taken for possible that is not there)."""

STRAY_AT_ONCE = 2
"""Most wrong poses in a row at which no leg ends: single ones, and the few pairs that chance makes
of them. What lasts longer is a jump, or an event."""
