# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Checks of a reference for errors that neither wheels nor anything that rolls can cause."""

from __future__ import annotations

import math

SUSPECT_CUT, SUSPECT_STRETCH = 0.25, 2.0
"""Lengths in legs: of a cut, over which direction and length of the reference's path are measured,
and of a stretch, over whose cuts the median is taken. Eight cuts a stretch: three failed matches do
not move their median."""

SUSPECT_NOISE = 0.1
"""Largest noise of a position as a share of a cut, which else is longer: noise across the cut
lengthens its chord by the square of that, 1 %. By cuts of 0.25 m, positions of 0.3 m made a path
that is twice as long as the wheels' way, and a metre that is none."""

SUSPECT_CUTS = 4
"""Cuts that a stretch must have, for their scatter to be known (to 40 %)."""

SUSPECT_STRAIGHT = 0.3
"""Largest turn of a cut [rad]: its chord then equals its arc to 0.4 %, and the effect of a lever
arm is linear in the turn, so it is removed by regression."""

SUSPECT_STILL = 0.25
"""Travel relative to the wheels' below which, and above the inverse of which, a cut is no driving:
held, lifted, a jump. That is reported as such."""

SUSPECT_SHARE = 0.1
"""Relative difference of a stretch's path from the typical one of these drives. Chosen: of all
effects of wheels, counts lost at speed reach 5 %, drift of the radii 2 %."""

SUSPECT_ANGLE = 0.052
"""Angle [rad] between path and heading that is reported: 3 degrees. Chosen: axles and markers
mounted by eye are askew by 1 to 2 degrees, floors that slope by 2 % make 1 degree."""

SUSPECT_SIGMA = 4.0
"""Standard deviations above which a stretch differs: chance exceeds it in one stretch of 16,000,
and two are required."""

SUSPECT_WANDER = 0.03
"""Largest wander [rad] of a localiser's heading that its own noise estimate may claim. Chosen:
particle filters and matchers are within 2 degrees once they have converged; more than four times
that is reported, as a wrong heading would pass for wander of any size."""

SUSPECT_STRETCHES = 2
"""Stretches that must differ: one is an event (a collision, a failed match), and reported as
such."""

SUSPECT_DRIFT_LEFT = 0.5
"""Scatter of the angle between stretches, relative to the total, that a linear change with time may
leave to be reported as such."""

SUSPECT_METRE = 0.03
"""Relative error that radii and base must both have to blame the reference's metric scale. Chosen:
worn tyres make 1 to 2 %, and wear does not change the base."""

SUSPECT_TURNS_AGREE = 0.01
"""Agreement of turns that is required for that: a quarter turn to 1 degree."""

SUSPECT_TURNED = 2.0 * math.pi
"""Total turn of all drives [rad] for that test: 1 % of a whole turn is 4 degrees, more than
references with a metric scale err by."""

WANDER_OVER_DEPENDENCE = 2.0
"""How many times as much as the strongest dependence on a measured variable a wandering reference
explains (fall of the cost), beyond chance (`VERY_SURE`), above which no dependence is asked for
beside it. Chosen: an effect of two variables that the library does not hold shows about half of
itself over either, and the wander of a reference takes up some of what is left. References that
wander by centimetres explain 2.2 to 12 times as much."""

WANDERS_TRIED = (-1.0, 0.0, 1.0, 3.0)
"""Random walks of typical localisers that are tried, in deviations of their prior from its middle:
0.1 to 2 cm in a second, and the decimetres of satellites, which somebody may give as positions."""

SMALL_WANDER = 5e-3
"""Wander in the long run [m, rad] up to which neighbouring legs that are alike tell it, though
every typical localiser is worse. Chosen: the camera systems recorded wander by 0.7 mm and 3.4 mrad;
errors of 20 mm that are alike on one drive of two are no camera's."""

BESIDE_ROUNDS = 3
"""Fits in turn of a dependence and of the wander of a reference. Chosen: a wander that a dependence
was taken for shrinks in the first, and the third moves the cost by less than one."""

# ------------------------------------------------------------- wheels that go on where poses stand

AT_REST_WINDOW = 4
"""Seconds over which speeds are compared; a rest needs two more, which a late reference spoils."""

AT_REST_MOVED = 0.1
"""Speed of the reference relative to that of the wheels, below which it stands."""

AT_REST_USUAL, AT_REST_SPEEDS = 0.9, (0.01, 0.25)
"""Quantile of the speeds of a drive that is its usual one, and the range of speeds at rest relative
to it. Chosen: less changes no radius by more than a per cent, and more is a wheel that drives,
against a wall or off the floor. The robots of UTIAS have 5 %."""

AT_REST_ALIKE, AT_REST_MOST = 0.2, 0.9
"""Relative difference up to which speeds at rest are alike, and the share of all rests that must
be so: wheels that stand in one of them have no offset."""

AT_REST_RESTS = 2
"""Rests that are needed: in one a robot may have been held."""
