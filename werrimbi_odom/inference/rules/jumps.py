# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is a leap of a counter, and what a jump of the reference."""

# ------------------------------------------------------------------------------ leaps of counters

LEAP_USUAL, LEAP_TIMES = 0.9, 10.0
"""Share of the intervals with travel whose wheel speed is below the usual one, and times of that
beyond which no wheel goes for a moment. A robot that creeps for nine tenths of its drive and then
goes ten times as fast does so for longer than `LEAP_LASTS` intervals."""

LEAP_SPEED = 10.0
"""Turns a second that every wheel is believed to reach. Chosen: 2 m/s on wheels of 3 cm, 20 m/s on
wheels of 30 cm, where nearly all robots are slower."""

LEAP_LASTS, LEAP_FEWEST = 3, 20
"""Intervals in a row that a leap may last, and those with travel below which nobody knows what is
usual. To a wrong reading and back are two intervals; what lasts longer is driving."""

# ------------------------------------------------------------------------- jumps of the reference

JUMP_SCATTER = 12.0
"""Times the usual scatter of an interval, beyond which its error may be a jump of the reference.
Chosen: by Chebyshev's inequality no distribution whatever reaches it in more than 0.7 % of
intervals, and `JUMP_SHARE` is asked beside it."""

JUMP_RARE = 0.1
"""Share of the intervals of a run that may be jumps; an error that more of them have is usual.
Chosen: scan matchers that are used fail in 2 to 4 % (the recorded Khepera's)."""

JUMP_RARE_SIGMAS = 1.645
"""Standard deviations that a tenth of normal errors are beyond (`JUMP_RARE`, both sides)."""

JUMP_SHARE = 0.5
"""Share of the motion about an interval that its error must be beyond to be a jump. A base or a
radius that is off by half is a mistake of the set-up, which errs like that in every interval."""

JUMP_SHARE_OF_A_GYRO = 1.5
"""The same of a heading by itself. A gyro does not lose its place; what is late by more than an
interval errs by all that the robot turns in it (a share of 1), and a start looks like a leap until
base and clock are right."""

JUMP_LEAST_OF_A_GYRO = 0.02
"""Least jump of a heading by itself [rad]: 1.3 % of a quarter turn. Less spoils no leg, and where a
gyro has hardly any noise (a simulator's) every error of the model is beyond its usual scatter."""

JUMP_LATE = 0.5
"""Time [s] within which motion may be that of an interval, the reference's clock being off: above
the `EDGE` that is left to the fits."""

JUMP_NEIGHBOURS, JUMP_FEWEST = 3, 8
"""Intervals to either side whose median is usual, and the least number in which any jump is told:
their window of seven, and one more."""

JUMP_LASTS = 0.2
"""Share of a run's largest jump that must be left at a leg's end for it to be spoilt. Chosen: a
spike goes back to within the noise, and a lost place stays."""

JUMP_OF_A_LEG = 40.0
"""Squared deviation of a leg, in units of what is usual for its run, above which the reference
jumped: chi-squared of three degrees is beyond it in one leg of 10^8."""
