# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is known of robots and references before any measurement."""

from __future__ import annotations

import numpy as np

TYPICAL_WHEEL_NOISE, WHEEL_NOISE_SPREAD = 5e-4, 1.2
"""Median [m^0.5], and standard deviation of the logarithm, of what is known of a rolling wheel's
noise before any drive.

Chong and Kleeman measured 4.0e-4 and 5.8e-4. Wheels that roll lie between 1e-4 (hard, narrow, on a
workshop floor) and 3e-3 (soft, wide, on tiles), which is the median times or over e^1.7, so about
five robots of six are within one and a half standard deviations. A drive with n degrees of freedom
tells ln k to 1/sqrt(2 n): of twenty legs the prior is worth 2 % of what is known then, of sixty
runs out and back 0.6 %; but k of 0.02, forty times the median, costs as much as a
deviation of 3.1 sigma."""

TYPICAL_STAMP_NOISE, STAMP_NOISE_SPREAD = 3e-3, 0.6
"""The same of the stamps of a gyro against the encoders' [s]: messages at 50 to 200 Hz wait for one
another by some milliseconds; 1 and 10 ms are two standard deviations off. What asks for more than
20 ms is a clock that is late (`reference_delay`), and must not pass for its scatter."""

STRANGE_NOISE = 0.01
"""A wheel noise [m^0.5] above this (1 cm after 1 m) is no rolling wheel's: three times what the
softest have (`TYPICAL_WHEEL_NOISE`). What a fit would call so is something else that is missing.
No fit goes further: in 8.7 m of a Lego robot, seen by positions alone, a noise of 2 cm explained a
base entered 17 % too small away, and every effect with it."""

MOST_WHEEL_NOISE = 3e-3
"""The noise of the softest wheels that roll [m^0.5] (see `TYPICAL_WHEEL_NOISE`)."""

LEAST_WHEEL_NOISE = 1e-5
"""A fit begins with no less [m^0.5]: a tenth of the least that a rolling wheel has, where the robot
file says none; with no noise at all the first step would have no weights."""

NOISE_NUMBERS = 30
"""Fewer measured coordinates than this cannot tell the noise; it is then taken as it was given.

Thirty tell the logarithm of one standard deviation to 13 %, and of four to a quarter each: as much
as a verdict needs. What two of them share is told apart by what is known of wheels."""

NOISE_TOLD = 0.5
"""Relative standard deviation from which on a noise is not determined: twice it and none at all
are then both within two standard deviations."""

MOTION_CAPTURE_INTERVAL, MOTION_CAPTURE_XY, MOTION_CAPTURE_YAW = 0.05, 1e-3, 2e-3
"""Time between two poses [s], noise of a position [m] and of a heading [rad] of motion capture, the
best reference that robots are measured with: 1 mm at each of two markers 0.7 m apart is 2 mrad.
Fits begin there, and an effect that the user's reference hides is looked for with it."""

TAPE_XY, TAPE_YAW = 2e-3, 5e-3
"""Noise by tape and straightedge [m, rad]: assumed where poses are too few to tell. Chosen:
a mark on the floor is hit to 2 mm, and two of them, 0.57 m apart on the robot, give 5 mrad."""

UNKNOWN_HEADING = 1.0
"""Variance of a heading fitted to the positions of a drive, before the first of them counts
[rad²]: a radian, so that nothing rests on it."""

CALIBRATION_BOUNDS = (0.25, 4.0)
"""Multipliers of base and radii that a robot can have: wheels that skid turn it as if they stood
1.5 (Jackal) to 2 times (four driven wheels on carpet) as far apart, and a radius entered for a
diameter is 2. Beyond four a number was entered in another unit, which the set-up search names."""

CALIBRATION_KNOWN = 0.05
"""Relative standard deviation from which on drives say less of a radius or a base than is known
beforehand. Chosen: a tape tells either to 5 % on any wheel, tyre or track."""

TYPICAL_GYRO_WALK, GYRO_WALK_SPREAD = 3e-4, 0.8
"""The same of a gyro's random walk [rad/s^0.5]: 1 degree per root hour, as data sheets of gyros for
robots have it; 0.2 to 5 are two standard deviations off."""

TYPICAL_MATCH, MATCH_SPREAD = (2e-3, 2e-3), 1.5
"""The same of the noise of each pose of a localiser, or of a matcher on a local map [m, rad]: on
simulated lidars a match is good to 1 to 9 mm and 1.4 to 5 mrad; 0.1 and 40 are two standard
deviations off."""

TYPICAL_WALK, WALK_SPREAD = (5e-3, 3e-3, 1.0 / 15.0), np.array([1.5, 1.5, 1.0])
"""The same of the walk of its error [m/s^0.5, rad/s^0.5], and of the rate at which that error is
drawn back to nothing [1/s]. Chosen: a matcher in a room wanders by 1 mm and 1 mrad in a second, a
particle filter with its cells of 5 cm by 2 cm and 10 mrad, which lie within one standard deviation.
The error of either is forgotten when the robot sees other walls, after some metres: in 2 s to
2 min, which are two off."""

LOST_XY, LOST_YAW = 0.2, 0.1
"""How far off a localiser may be after the robot was carried, held or out of sight [m, rad], beside
what it wandered before. Chosen: it follows the robot by what it sees, and lags by a few cells of
its map (5 cm) and some degrees until it has converged; one that is off by more jumps back, and is
seen to."""

LAID_YAW, LAID_SCALE, LAID_DRIFT = 0.03, 0.03, 1e-3
"""How well a gyro's headings are laid upon a localiser's, drive by drive: angle [rad], the gyro's
scale, and a steady drift [rad/s]; standard deviations. Chosen: a localiser errs by a degree for a
quarter of a minute, and after a jump by five, so the mean of a minute's is good to a degree or two,
and its slope to that over half a minute. Gyros of robots are made to 1 to 3 %; each drive says that
much and no more, for what some drives of one robot say together is not each drive's own."""

FAR_ABOVE_NOISE = 2.5
"""How many times what noise promises, with the softest wheels there are, the errors of legs must be
for a model to be wrong whatever its likelihood says. Errors of ten legs that are noise are as large
once in 10^16; a base that is 17 % wrong makes 2.8 times in a short drive with positions of 14 mm
alone."""
