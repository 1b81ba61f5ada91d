# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Thresholds that decide whether a scan match is accepted, each with its reason."""

FEWEST_POINTS = 40
"""Least number of echoes on lines of the map. A pose has three parameters, and one person before
the robot accounts for 20 echoes of 218."""

LEAST_MATCHED = 0.3
"""Least share of a scan's echoes that lie on lines of the map. In rooms and corridors they are 0.46
and more, also where a fast robot sees new walls; of a robot that was carried elsewhere 0.17 to
0.29, on some of which a pose may settle by chance."""

LEAST_SHARE = 0.35
"""Least share of the echoes that agree with the map (mean weight of the fit). A limit of 0.5
rejected up to nine tenths of the good matches of a poor lidar (15 mm); one of 0.35 rejected none.
Matches while a robot was carried stayed below it."""

LEAST_AGREED = 0.5
"""The same of the echoes that tell the position in its weakest direction, each by as much as it
tells. In rooms it is 0.73 and more, in a corridor with cupboards 0.6 and more. Where one riser of
stairs goes and the next one comes, in one scan, it falls to 0.3, while the walls beside agree. With
0.35 legs of 1 m erred by 0.15 and 0.25 m in two drives of 14."""

ALONE = 0.85
"""Share of what tells the position in its weakest direction, above which the place that tells it
(`matching.PLACE`) is all that does: whether it is the same one as before, nothing else says. Before
stairs at the end of a bare corridor it is 0.86 and more, in rooms less than 0.7; in a corridor with
cupboards and for a brisk robot in a large room up to 0.89, in 19 of 20 matches less than 0.8."""

LEAP = 0.075
"""Largest distance from where the last motion leads to, where one place alone tells [m]: a quarter
of the depth of a step. A robot that changes its speed by 5 m/s^2 errs by 0.05 m at 10 Hz. With 0.1
a piece of a drive before stairs began with an error of 0.12 m."""

FEIGNED = 10.0
"""Least information on the position in its weakest direction, in units of what the lines'
directions feign there: those of a bare wall point a little this way and that, by the noise of the
echoes and by the lidar's own dents (`matching.BENT`). Along bare corridors and beside a single
wall it is 0.5 to 4 of these (also with a poor lidar of 15 mm, and 4 m wide), in corridors with
cupboards and doors 10 to 160, in rooms hundreds. A least ratio to the strongest direction (0.03)
rejected an eighth of the matches in corridors with cupboards."""

LARGEST_SIGMA = 0.01
"""Largest standard deviation of a match [m, rad]. Matches in rooms have 1 to 4 mm, and a match with
ten times that noise would contribute almost nothing."""

FASTEST, FASTEST_TURN = 3.0, 8.0
"""Largest speeds of a match [m/s, rad/s]. No wheeled robot drives faster on an indoor floor, so a
faster match has converged to a wrong place."""

LOST_AFTER = 5
"""Consecutive failed matches after which the path is cut and a new map begun. A person who walks
past makes up to three fail; if five fail, the robot has left the map."""

LONGEST_HOLE = 1.0
"""Time without scans after which the path is cut [s]. At a brisk 1 m/s the gate of the matches
covers a third of it, and the extrapolated motion the rest."""

LOST_AFTER_ALONE = 1
"""The same where one place alone tells. With two, legs of 1 m before stairs erred by 0.05 to 0.25 m
in three drives of six: while echoes of two steps mix, the next one takes the place of the last."""

FEWEST_POSES = 20
"""Fewest poses of an unbroken section of the path: two seconds hold no leg."""

FLOOR = 1e-4
"""Least standard deviation of a match [m, rad]: a millimetre in ten metres, walls are not
straighter. Of the simulated rooms only a corridor's heading with 681 beams comes near it
(docs/scans.md). Further errors of a real lidar are estimated from each drive
(`pose_noise.common_noise`)."""

COMMON, COMMON_SURE = 1.5, 3.0
"""Ratio of the variance of the poses about a smooth course to that stated by the matches, above
which more noise than theirs is assumed. Without such noise the ratio is 0.5 to 1.7 in simulated
rooms, and with a real LD08 0.6 to 2.0. And standard deviations of that ratio, of which short drives
tell little (25 s to 0.3)."""

MOVING = 0.02
"""Way [m] or turn [rad] of ten scans from which on the lidar moves, there and back counted: ten
times the noise of a match, and 2 cm/s."""

CALM = 0.25
"""Share of the motion of a drive, with the smallest changes of speed, in which that scatter is
measured. In short moves with hard starts and stops, half of it would not be calm enough."""

LONGEST_SWEEP = 1.0
"""Longest plausible turn [s]: a longer one is in another unit, and its beams count as
simultaneous."""

ORDER_TURNING = 0.1
"""Least yaw rate [rad/s] at which a scan shows the order of its beams. A wall 2 m away is bent by
2 cm in a tenth of a second, and by 4 cm if it is deskewed in the wrong sense."""

ORDER_FEWEST, ORDER_SURE = 30, 5.0
"""Fewest such scans for a decision, and the standard deviations of the sign test that it needs.
Consecutive scans see the same walls: if only every fourth is independent, five standard deviations
are two and a half."""

ORDER_STRETCH, ORDER_STRETCHES = 5.0, 3
"""Length [s] of a stretch within which scans see the same walls from new places, as while a robot
is carried, and stretches that must agree before another order than the stated one is believed. One
carry lasts about as long, and lies in two at most."""

ORDER_MOST = 400
"""Scans without a decision after which the stated order is kept."""

FIXED_SCANS, FIXED_ECHOES = 30, 6
"""Fewest scans that see a line which is said to go with the robot, and echoes of it in each: three
seconds at 10 Hz, and a sixth of a radian with 218 beams."""

FIXED_SHARE = 0.5
"""Fewest echoes of such a line in a scan that tells whether it turns, over those of its usual scan.
What else comes near its place has no direction: a robot that drove along a wall and turned from it
had 6 to 12 echoes there, of 41, and the wall seemed to turn by 0.10 ± 0.04 of what it did, with
them left out by 0.58 ± 0.08. Of 16,594 stretches of 79 real recordings none is then the floor."""

FIXED_SHARP = 0.3
"""Largest median distance of echoes from such a line, over the width in which they are sought (6 %
of its distance). Echoes that fill that width have 0.5; the floor has 0.07 by the noise of
5 mm and 0.5 %, and by that of 15 mm and 2 % it would have 0.25."""

FIXED_BENT = 0.25
"""Largest bend of such a line, over four standard deviations of its echoes: the wall of a round
room stays before a lidar that turns, and so does a round pillar that it goes around."""

FIXED_BEHIND = 0.03
"""Largest number of echoes behind such a line, over those on it. Behind the floor there are none
(of 4000 and more two at most); behind lines that many scans of a room have in one place, as the
robot turns, there are 0.1 to 5 times as many as on them. A wall along a corridor hides what is
behind it as well, while the robot turns a little: that one is told by `FIXED_SURE`."""

FIXED_TURNED = 0.015
"""Least change of the heading while such a line is seen (rms) [rad]: four times the noise of a
heading by a poor lidar. To a lidar at rest all lines stay, while its heading scatters."""

FIXED_SURE = 5.0
"""Standard deviations by which it must be sure that such a line turns less than half as much as a
wall does. By 10 to 20 s of corridors in which the heading changes by 30 mrad (rms) walls turn by
0.75 to 1 of what the lidar does, the floor by 0.00 ± 0.02 to ± 0.04."""

FIXED_STANDS = 0.1
"""Range of all places up to which a lidar stands, by its scans [m]: ten times the noise of the
poorest match. What goes with a robot is all that lets a drive look so."""
