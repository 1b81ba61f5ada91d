# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Events: limits for sudden, large and rare errors that no law explains."""

from __future__ import annotations

EVENT_INTERVAL = 0.03
"""Least time between the examined poses [s]. The time of an event should be known to 0.2 s, and
poses at 20 Hz (and at 30 Hz with jitter) are then all examined."""

SURE_OF_EVENT = 1e-3
"""Significance level of an event in a set of drives, with a Bonferroni correction for all instants
and kinds: `SURE`, as for an effect."""

EVENT_LARGE = 3.5
"""Size of an event in multiples of the noise of the pose over that interval. Events of five times
the noise should be found, and their size is measured to a half of it: with 3.5 all but one in a
hundred of them are reported."""

EVENT_JOIN = 0.3
"""Time within which several steps are one event [s]: it lasts 0.1 s, of which poses at 20 Hz see
two or three, and a pose or two more may be needed to tell when."""

EVENT_SLOW = 1.0
"""Time to either side [s] over which an evenly growing error is a drift, no event: an event must be
significant beside it. Chosen: five times the 0.2 s that an event may last."""

EVENT_BESIDE = 4.0
"""Standard deviations of an event from zero beside such a drift. Only the few steps significant by
`SURE_OF_EVENT` are tested, of which chance passes one in 16000."""

MOST_EVENTS = 60
"""Most steps that are searched for in one set of drives. Chosen: more are no events but a missing
law."""

RARE = 5.0
"""Least average time between events [s]. Chosen: a robot that is pushed every five seconds is not
being measured."""

EVENT_STEP = 1.0
"""Variance of the pose over a leg with an event [m², rad²]: its step is unknown, so it is a free
parameter that only the data determine."""

EVENT_SPAN = 0.1
"""Time to either side of an event that is left out with it [s]: its time is known to 0.03 s if it
is large, and it lasts 0.1 s itself."""

EVENT_ROUNDS = 2
"""Most repetitions of the search without the events. Chosen: without them the noise is smaller, so
a few smaller ones are found; with these left out no more are."""

BESIDE_LOST = 2.0
"""Time from a stretch in which a lidar was lost, within which a step may as well be its own [s]: a
match that slides does so before none is found, and again until the map is new. In a hall, behind a
person, poses erred for 0.8 s before and 1.5 s after."""

JOLT = 50.0
"""Acceleration that nothing gives to a robot [m/s^2]: a measurement with more jumped itself.
Chosen: five times gravity; a push of 30 mm in 0.1 s has 6, one in a single interval at 20 Hz 24."""

AT_REVERSAL = (-0.3, 0.8)
"""Time relative to a reversal, a start or a stop [s] at which an event is caused by it. A castor
swings round over 4 cm, which takes 0.4 s at 0.1 m/s; the times of an event and of a reversal are
known to 0.1 s."""

NEAR_BAND, NEAR_PLACE = 0.15, 0.3
"""Distance from a line across the floor, and from a place, within which events are there [m]: half
a robot's length, at which its first or its last wheel meets a threshold, and a robot's length."""

EVENTS_ALIKE, ALIKE_SHARE = 4, 0.6
"""Events with a common cause that it takes to report it, and their share of all events. Chosen: two
of three are at the same place too easily; and the cause must hold for most events."""

NOISE_TRIMMED = 25.0
"""Squared deviation of a leg, relative to the median, above which it is left out of the noise
estimate: chi-squared with three degrees of freedom exceeds it in one leg of 60000, so nothing is
lost."""
