# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that decide whether a match of two scans counts, each with its reason."""

FEWEST_POINTS = 40
"""Echoes that lie on a line of the map, below which a match is none: a pose has three numbers, and
one person before the robot is 20 echoes of 218."""

LEAST_SHARE = 0.35
"""Share of the echoes that must agree with the map (mean weight of the fit). A limit of 0.5 called
up to nine tenths of good matches of a poor lidar bad (15 mm), one of 0.35 none; nonsense while a
robot was carried stayed below it."""

WEAK = 0.03
"""How much weaker one direction may be held than the other (ratio of eigenvalues): along a bare
corridor it is a thousandth, in rooms a tenth and more, in corridors with cupboards and doors a
twentieth."""

LARGEST_SIGMA = 0.01
"""Standard deviation of a match [m, rad] beyond which it is none: the matches of rooms have 1 to
4 mm, and ten times the noise of the others would decide nothing anyway."""

FASTEST, FASTEST_TURN = 3.0, 8.0
"""Speeds [m/s, rad/s] that no robot with wheels on an indoor floor drives: a match that wants more
has found a wrong place."""

LOST_AFTER = 5
"""Matches that fail one after the other, after which the path is cut and a new map begun: with a
person walking past up to three fail; where all five do, the map was left behind."""

LONGEST_HOLE = 1.0
"""Seconds without a scan after which the path is cut: at a brisk 1 m/s the gate of the matches
holds for a third of that, and a guess from the last motion for the rest."""

FEWEST_POSES = 20
"""Poses of an unbroken piece, below which it is left out: two seconds hold no leg."""

FLOOR = 2e-4
"""Least standard deviation of a match [m, rad]: walls are not straighter. No simulated room comes
below it but a corridor's heading by 681 beams (docs/scans.md); what a real lidar errs beside its
echoes' noise is read off each drive (`path.common_noise`)."""

COMMON = 1.5
"""By how much more than the matches state (ratio of variances) poses must scatter about their own
course for a noise that is common to all echoes of a scan: without one it is 0.9 to 1.4 in simulated
rooms; with a real LD08, whose turns begin anywhere, 5 to 15."""

CALM = 0.25
"""Share of a drive in which speeds change least, where that scatter is looked for: of short hops
with hard starts and stops half is neither."""

LONGEST_SWEEP = 1.0
"""A turn that takes longer was stated in another unit [s]: its beams count as seen at once."""

ORDER_TURNING = 0.1
"""Rate of turning [rad/s] from which on a scan tells in which order its beams were seen: a wall 2 m
away is bent by 2 cm in a tenth of a second, and by 4 cm if it is deskewed the wrong way."""

ORDER_FEWEST, ORDER_SURE = 30, 5.0
"""Such scans that are asked, at the least, and by how many standard deviations more often than not
their echoes must lie nearer to the walls one way. Scans in a row see the same walls: if four of
them told alike, five deviations would be two and a half."""

ORDER_MOST = 400
"""Scans after which, if they have not told, the order of the messages is believed."""
