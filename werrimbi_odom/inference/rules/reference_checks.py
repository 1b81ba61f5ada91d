# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What of a reference is suspect: no wheel does it, or nothing that rolls."""

from __future__ import annotations

import math

SUSPECT_CUT, SUSPECT_STRETCH = 0.25, 2.0
"""Lengths in legs: of a cut, over which direction and length of the reference's path are read, and
of a stretch, of whose cuts the median counts. Eight cuts a stretch: three failed matches do not
move their median."""

SUSPECT_CUTS = 4
"""Cuts that a stretch must have, for their scatter to be told (to 40 %)."""

SUSPECT_STRAIGHT = 0.3
"""Most turn of a cut [rad]: its chord is then its arc to 0.4 %, and what a lever arm makes of it
goes with the turn by a straight line, which is taken off."""

SUSPECT_STILL = 0.25
"""Share of the wheels' way below which, and one over it above which, a cut is no driving: held,
lifted, a jump. That is told as such."""

SUSPECT_SHARE = 0.1
"""Share by which the path of a stretch must differ from what is usual for these drives. Chosen: of
all that wheels do by themselves, lost counts at speed reach 5 %, drift of the radii 2 %."""

SUSPECT_ANGLE = 0.052
"""Angle [rad] between path and heading that is told: 3 degrees. Chosen: axles and markers that are
mounted by eye are askew by 1 to 2 degrees, floors that slope by 2 % make 1 degree."""

SUSPECT_SIGMA = 4.0
"""Standard deviations beyond which a stretch is another one: chance does it in one stretch of
16,000, and two are asked for."""

SUSPECT_WANDER = 0.03
"""The most [rad] that a localiser's heading is believed to wander by, when its own noise says so.
Chosen: particle filters and matchers are within 2 degrees once they have converged; what is beyond
four times that is told, for a wrong heading would pass for a wander of any size."""

SUSPECT_STRETCHES = 2
"""Stretches that must be so: one is an event (a collision, a failed match), and told as such."""

SUSPECT_DRIFT_LEFT = 0.5
"""Share of the angle's scatter between stretches that a steady change with time may leave, to be
told as such."""

SUSPECT_METRE = 0.03
"""Share by which radii and base must both be off to speak of the reference's metre. Chosen: worn
tyres make 1 to 2 %, and a base that is off by the same is no wear."""

SUSPECT_TURNS_AGREE = 0.01
"""Share within which turns agree then: a quarter turn to 1 degree."""

SUSPECT_TURNED = 2.0 * math.pi
"""Turning of all drives [rad] from which on that is judged: of a whole turn 1 % is 4 degrees, more
than references of metres err by."""
