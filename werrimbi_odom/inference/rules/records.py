# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings: which poses and legs count, and the parts that drives are cut into."""

from __future__ import annotations

import math

# --------------------------------------------------------------------------------- poses and legs

POSE_ROWS = 0.5
"""Share of a reference's rows with position and heading, above which the other rows are left out
and poses are compared: most of them, so that the report names what was measured."""

POSE_ROWS_OF_SET_UP = 0.3
"""The same share in the set-up search. Chosen, less than for a comparison: poses show every mistake
in closed form, positions alone do not, and a third of the rows is enough for regressions."""

FEW_POSES, MOMENT = 10, 1.0
"""With fewer reference poses than the first, poses outside the ticks' time by up to the second [s]
count too. Chosen: by tape one pose is taken before the recording starts and one after its end."""

QUARTER_TURN = 0.5 * math.pi
"""Turn [rad] that counts as a leg of path, whatever the leg's length: the corners of a square
divide its sides."""

CUT_ANEW = 3.0
"""Error factor of a size in the robot file above which a fit cuts its legs by the size found. An
angle in degrees makes legs of 57 m of those of 1 m, a dozen in ten minutes, and a radius known to
0.13 % where the drives have 0.005 %. A base that is off by 2 keeps the legs: a drive of half a
minute would have few otherwise, and what is fitted is judged on the same ones."""

PARTS_OF_A_LEG = 4
"""Ratio of the judged legs to the shorter legs of fits. Noise grows with the root of the way and
drift with the way, so over four times the length they differ by a factor of 2."""

MOST_PARTS_OF_A_LEG, LEGS_OF_A_FIT = 50, 5000
"""Most short legs of a fit to a judged one, and how many there may be in all to have more than
`PARTS_OF_A_LEG`: where the errors of a reference are independent, each further pose tells as much
as the one before, and an effect is seen at half to a third of the size. Chosen: 2 cm of 1 m, the
way from pose to pose at 10 to 25 Hz; a fit of 5000 legs takes less than twice as long as one of
500, and an hour of driving has as many anyway."""

COUNTS_UNSEEN = 0.25
"""Largest variance of a reading of the counters, of that of a measured pose, for this: half of its
deviation. The step of a counter errs alike in all poses until the next one."""

EDGE = 0.3
"""Time at both ends of a run whose legs are not used [s]. Chosen: clocks synchronised over a
network differ by less; a longer delay is found by the set-up search."""

EDGE_LEGS = 20
"""Legs of a run up to which none is left out at its ends: two of twenty are a tenth of the data,
and two poses a drive are all there is."""

# ----------------------------------------------------------------- drives that are put together

GROSS = 3.0
"""Error of a drive in multiples of the fitted drives' median, above which its own set-up is
examined. A manoeuvre that excites an effect errs more than others by as much, so this alone is no
finding."""

OWN_GAIN = 3.0
"""Factor by which its own set-up must lower such a drive's typical error: twice the 1.5 of a whole
session, because one drive is less than a session."""

FOLDS = 5
"""Folds of the cross-validation: a model is fitted to four fifths and judged on the rest, five
times."""

FOLD_PARTS = 4
"""Parts of a drive in each fold: 20 parts of a drive of a minute are three seconds each, longer
than the correlation of errors of neighbouring legs."""

FOLD_TELLS = 0.5
"""Share of the information about a parameter above which one fold has more than the others. If the
others have q and the fold p, carrying the estimate over costs 1 + p / q on average by the noise:
the two of `USELESS_NUMBER` if both have half, and a thousand if a drive's first heading, seen by
positions alone, is carried to the drive's end (a robot in a labyrinth)."""

HALF_PARTS = 10
"""Parts of a drive, dealt to odd and even halves in turn."""

SET_ASIDE_BLOCKS, SET_ASIDE = 8, (1, 5)
"""Stretches into which every drive is cut if no held-out drives are given, and those that are held
out: a quarter, from both halves of the drive."""

SET_ASIDE_ROWS = 80
"""Fewest poses of a drive for that, ten in a stretch; otherwise whole drives are held out."""

RATE_OF_FIT = 50.0
"""Least rate of the steps that a fit uses [Hz]; faster messages are combined (two at 100 Hz, four
at 200 Hz).

A robot that brakes at 1 m/s^2 while it turns at 2 rad/s leaves the arc of a step of 20 ms by 1.3
um, and laws do not depend on how a drive is split into steps; speeds, which come in counts a step,
are even more precise. The ends of legs stay where they were, counted from all messages.
"""

# ------------------------------------------------- references that are made from the wheels

CIRCLE_WAY, CIRCLE_FEWEST = 0.25, 20
"""Longest spans [m] over which a reference is compared with the wheels, and how many there must be;
in a drive that is shorter than so many, they are shorter. Longer than the way between two stamps
with jitter, and short enough for the wheels' own errors to be small."""

CIRCLE_DELAYS = tuple(0.01 * step for step in range(-30, 31))
"""Trial delays [s] of the reference: filters are later than wheels by some messages."""

CIRCLE_EXACT = 0.1
"""Error as a share of the rounding of the counters, below which a reference was made from the same
counts; of ways and of headings. An independent measurement does not share the rounding (in four
recorded sets its headings differ by 9.7 times that and more), so its error has all of it: the
median of 20 such errors is below a tenth of the typical one less than once in 10^7 times."""

CIRCLE_FINEST = 3e-4
"""Error as a share of the way, below which a reference was made from the wheels if their angles are
no whole counts. An independent measurement differs by more: 75 um in 0.25 m is below a motion
capture's noise, and the wheels' own, with k = 4e-4 m^½, is 0.2 mm. Odometry from the same angles
differs by 1e-15, and by 2e-4 if it was sent between two of them."""

CIRCLE_WHEELS = 1e-4
"""Noise of the best wheels that roll [m^½] (`TYPICAL_WHEEL_NOISE`). A measurement differs from the
wheels by that, by its own noise and by the counts' rounding; one that differs by less shares the
wheels' errors."""

CIRCLE_APART = 0.012
"""Typical difference over a span [m], above which even what is called odometry is no odometry of
these wheels. Jitter of 40 ms at 0.3 m/s, or the lag of a filter, makes as much; a larger difference
was measured."""

CIRCLE_STEPS, CIRCLE_WHOLE = 10.0, 0.02
"""Test of a counter that is no integer: its steps up to this many times the smallest one must be
whole multiples of it, to within this share: angles of 32 bits are whole to a hundredth of a count
at a thousand turns. Without whole counts there is no rounding, and `CIRCLE_FINEST` applies."""

EVEN_LEAST = 0.02
"""Jitter of stamps (rms), as a share of the interval of messages, above which stamps are evened. By
a reference with its own clock, a wheel message stamped 4 ms late of 50 seems 2 mm behind and the
wheel slower before: a false slip. Less jitter is below the error of any reference."""

EVEN_LEAST_TOGETHER, EVEN_TOGETHER = 0.1, 0.5
"""The same if one packet has the wheels and the reference, a gyro: both have the same error, and
wheels that were corrected alone would disagree with it; above this limit a wheel's error is a tenth
of its travel. And the correlation of both stamps above which they come from one packet: half of the
delay of one is in the other."""

EVEN_TRAVEL = 0.75
"""Travel in all intervals in which messages seem lost, as a share of what it is then, up to which
none were: half way between all of it and that of single intervals, where one is lost at a time."""

EVEN_ONE_PACKET = 0.25
"""Distance of the stamps of wheels and reference from one another, as a share of what those of the
wheels are off by, below which one packet brings both. The Kobuki's driver stamps its gyro 0.37 ms
after its counters, to a tenth of what these are off by; of two timers that are alike it would be
two thirds."""

PACKED = 0.45
"""Share of the messages that have the stamp of the next one, above which they are sent in packets:
half of them in pairs, less a few that are left over."""

PACKED_APART, PACKET_APART, PACKET_PAUSE = 0.6, 0.1, 1.0
"""The same for stamps of arrival: two of three messages, less a few. An interval within a packet,
as a share of the mean one: a serial line at 115200 baud takes 1 ms for a message, of 20. And what a
longer interval counts for in that mean [s]: a robot that stands, and tells nothing meanwhile, sends
no packets."""

EVEN_MESSAGES, EVEN_WINDOW = 50, 51
"""Fewest messages for a decision whether stamps tell when counters were read, as chance decides
with fewer; and window of the running median of their delays: a few seconds, in which two clocks
drift by 0.1 ms, and enough to be right to a sixth of the jitter of one stamp. Where the windows of
a drive scatter no more than chance has it about one pace (analysis of variance, `SURE_WHEN_ASKED`),
all messages tell it, and stamps are right to 2 / root n of the jitter: 0.2 ms of 4 ms in 70 s at 20
Hz. By windows alone they wandered by 0.75 ms, at each start and stop another: a reference whose
stamps were even seemed to be of a clock that drifts (0.9 ms, 14 millionths), at 1e-4."""

EVEN_QUEUE, EVEN_QUEUED, EVEN_AT_ONCE, EVEN_IN_TIME = 400, 0.25, 0.5, 0.5
"""Most messages that wait in a queue, and still are put back. Chosen: some ten seconds of a busy
computer; a period that is wrong by a thousandth is off by less than a half of itself over them. The
wait from which one is in a queue that is a period long somewhere, in periods: less is the jitter of
single stamps, which is evened as such. The interval in which a queue empties, in periods: half way
between messages at their own pace and at once. And what the message before a queue is late by those
that follow it, in periods: half way between in time and a wrong number, by which all are late."""

EVEN_SHARE, EVEN_SURE = 0.5, 3.0
"""Slope of the counts on the jitter of the stamps, up to which the timer is trusted in place of the
stamps: half way between an uneven timer with true stamps (1) and an even one (0). And standard
deviations within that range that the slope must have: coarse counts show neither."""

EVEN_SPREAD = 1.0
"""Standard deviation of the stamps about the timer, in periods, from which on there is none: two of
three messages that wait for the third have half a period, those that a busy recorder let queue up
for seconds 0.6 (a skid steer's). A program that asks, waits for the answer and asks again over a
poor radio wanders, by 1.5 (a Neato's): it has no timer that knows better than its stamps."""

EVEN_HALF_BASE = 0.1
"""Half the base [m] of the two virtual wheels of a path by scans: as large as a small robot's, so
that travel and turn both count. Chosen; any robot's would do."""

EVEN_HOLE = 1.7
"""Travel of a step relative to its neighbour, above which a scan is missing in between: nearer to
two than to one, and more than noise of some millimetres and a start make of one."""

EVEN_MOST_LOST = 0.12
"""Share of a timer's messages that may be lost, and its period still be looked for. Chosen: of a
recording that loses more, other things are wrong."""

EVEN_KNOWN, EVEN_WINDOWS, EVEN_BESIDE = 0.25, 4, 5
"""Mean resultant length of the stamps, as angles of the timer, from which on lost messages are
counted by them: of stamps anywhere 51 make 0.12, of a normal scatter of a quarter of a period 0.3,
and one such stamp in twenty is nearer to another period. Windows of stamps for which it is a mean:
of four, chance does not reach 0.25. And messages of which the median roughly tells the period: two
that waited do not matter."""

EVEN_LOSS, EVEN_UNLIKELY = 5.0, 7.0
"""Minus the logarithm of the chance that messages are lost before a given one: one in 150, between
good radios and bad ones. Delays and travel must tell more. And the most that a single message or
step tells: one in a thousand (e^-7) waits in a queue, however long, or is counted across a stop or
a wrap, of which the distribution of the others knows nothing."""

EVEN_BAND = 2
"""Numbers on either side of the rough one (a running median) among which the likeliest is looked
for. Three late messages of five raise the median by one, at two places at once by two."""

EVEN_MOST = 0.4
"""Largest correction of scan stamps (rms), as a share of a turn of the lidar. A delay that is
uniform over a turn has 0.29; if scans are missing by the dozen, without a report, it is 0.45."""

UNEVEN_SHARES = (0.005, 0.01, 0.02, 0.04, 0.08, 0.16)
"""Standard deviations of an uneven timer that are tried, in its periods: a quarter of a millisecond
to 8 ms of 50. Sleeps of a program are uneven by 1 or 2 ms; at more, an even timer is not found."""

UNEVEN_NEXT, UNEVEN_REST, UNEVEN_STEPS = 0.5, 0.1, 4
"""Deviation of an interval from the period up to which no reading is missing in between: half way
to two periods. What a timer leaves of the roughness of counts at least: chosen, as one wheel alone
can be made as smooth as one likes. And steps of iteratively reweighted least squares: eight leave
as much of 1, 2 and 4 ms, to a tenth."""

FEW_COUNTS = 3.0
"""Counts at once, as a rule, up to which a counter is coarse: its steps show in what is worked out
from message to message. Chosen: 20 to 60 counts in a turn, one or two at a time, made a late
clock into backlash where legs were cut at the counts; 100 counts, three at a time, did not."""

ROUNDING_SHARED = 0.78
"""How much of the rounding of two messages is independent of one another, as interpolation sees it.
Simulated: 0.2 to 10 counts a message; 1 would be independent roundings under the same weights. At
single speeds it is 0.55 (1.5 counts) to 1.1 (0.4 counts)."""

RARE_COUNTS, UNSEEN_OF_LEFT_OUT = 0.075, 0.5
"""Usual interval of messages [s] above which it is uncertain what wheels did between them, and how
much of the error at a message that was left out remains with it: half, as a change of speed within
an interval is missed in proportion to it. Simulated, with changes of speed at 0.5 to 3 m/s^2: what
is missed is 0.3 to 0.6 of what is stated, at 5 Hz in one pose of a thousand 3.5 times as much. The
interval lies between 10 Hz, where up to 6 mm are missed, and 20 Hz, where 0.1 mm (rms) is: less
than the noise of any reference."""

COUNTS_A_SPEED, MESSAGES_A_SPEED = 20.0, 5
"""Counts a message, as a rule, up to which speeds are averaged, and over how many messages.

A reading is off by its rounding d, c / root 12 of a count c, and the speed of a message of n counts
by (d - d before) / T: v / (root 6 n). A law of v dv then tells d. Of N legs its cost falls by
N p q, with p the rounding's share of the variance of a pose, and q the square of v^2 / (root 6 n)
over the rms change of v^2 / 2 in a leg. N = 5000 (`LEGS_OF_A_FIT`) legs of 2 cm at 0.1 m/s, a third
of them at 0.3 m/s^2, counts of 0.3 mm and poses of 0.3 mm make p = 0.08 and q = 0.0035 at n = 20:
1.5, about what chance makes. At n = 10 it is 6, and a clock that was late by 1 ms was named a slip;
at n = 38 (2000 counts a turn, 50 Hz) it is 0.4, and nothing is to be mended.

The speed of five messages is told by readings that are two messages from this one, beyond those
between which a pose at this one is interpolated, so it tells nothing of d. An acceleration lasts
longer than a tenth of a second. Of single messages, with 40 counts a turn, a slip that was not
there lowered the cost by 9 in the mean of eight sets, of which chance makes 1; of five by 1.5, of
nine by 1.1."""
