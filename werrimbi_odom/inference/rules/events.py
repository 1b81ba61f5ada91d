# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is an event: sudden, large, rare, and no law's."""

from __future__ import annotations

EVENT_INTERVAL = 0.03
"""Time between the poses that are looked at, at the least [s]. An event's time is wanted to 0.2 s,
and poses of 20 Hz (and of 30 Hz, with stamps that wander) are then all looked at."""

SURE_OF_EVENT = 1e-3
"""How often chance may show an event in a set of drives, all instants and all kinds counted
(Bonferroni): `SURE`, as of an effect."""

EVENT_LARGE = 3.5
"""Times the noise of the pose over that interval, which an event must be large. Events of five
times the noise are wanted, and their size is measured to a half of it: with 3.5 all but one in a
hundred of them are told."""

EVENT_JOIN = 0.3
"""Time within which several steps are one event [s]: it takes its time (0.1 s, of which poses at
20 Hz see two or three), and a pose or two more may be needed to tell when."""

EVENT_SLOW = 1.0
"""Time to either side over which an error that grows evenly is no event [s]: it must be seen beside
one. Chosen: five times the 0.2 s that an event may last."""

EVENT_BESIDE = 4.0
"""Standard deviations that it must be from none beside such a growing error. This is asked of few,
which `SURE_OF_EVENT` chose; of those chance makes one in 16000."""

MOST_EVENTS = 60
"""Steps that are looked for in one set of drives. Chosen: more are no events but a missing law."""

RARE = 5.0
"""Time for each event on average, at the least, for events to be events [s]. Chosen: a robot that
is pushed every five seconds is not being measured."""

EVENT_STEP = 1.0
"""Variance of the pose over a leg in which something happened [m², rad²]: nothing is known of what
it did, so that its step is a number of its own, which the data tell alone."""

EVENT_SPAN = 0.1
"""Time to either side of an event that is left to it [s]: it is known to 0.03 s where it is large,
and takes 0.1 s itself."""

EVENT_ROUNDS = 2
"""Times that everything is searched anew without the events, at the most. Chosen: with noise that
they no longer swell a few smaller ones are seen, and with these left out no more."""

JOLT = 50.0
"""Acceleration that nothing moves a robot with [m/s^2]: what was measured with more jumped itself.
Chosen: five times gravity; a push of 30 mm in 0.1 s has 6, one in a single interval of 20 Hz 24."""

AT_REVERSAL = (-0.3, 0.8)
"""Time after a reversal, a start or a stop at which an event is its own [s]. A castor swings round
over 4 cm, which takes 0.4 s at 0.1 m/s; an event is told to 0.1 s, and so is a reversal."""

NEAR_BAND, NEAR_PLACE = 0.15, 0.3
"""Distance from a line across the floor, and from a place, within which events are at it [m]: half
a robot's length, at which its first or its last wheel meets a threshold, and a robot's."""

EVENTS_ALIKE, ALIKE_SHARE = 4, 0.6
"""Events that must have something in common for it to be said, and what share of all they must be.
Chosen: of three two are at the same place too easily; and what is told of all holds for most."""

NOISE_TRIMMED = 25.0
"""Squared deviation of a leg, in units of the usual, above which it says nothing of the noise:
chi-squared of three degrees is beyond it in one leg of 60000, and its loss makes no noise less."""
