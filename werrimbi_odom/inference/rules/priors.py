# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Prior knowledge of robots and references, before any measurement."""

from __future__ import annotations

import numpy as np

TYPICAL_WHEEL_NOISE, WHEEL_NOISE_SPREAD = 5e-4, 1.2
"""Log-normal prior of a rolling wheel's noise: median [m^0.5] and standard deviation of the
logarithm.

Chong and Kleeman measured 4.0e-4 and 5.8e-4. Wheels that roll lie between 1e-4 (hard, narrow, on a
workshop floor) and 3e-3 (soft, wide, on tiles), which is the median times or over e^1.7, so about
five robots of six are within one and a half standard deviations. A drive with n degrees of freedom
determines ln k to 1/sqrt(2 n): with twenty legs the prior is worth 2 % of what is known then, with
sixty runs out and back 0.6 %; but k of 0.02, forty times the median, costs as much as a deviation
of 3.1 sigma.
"""

TYPICAL_STAMP_NOISE, STAMP_NOISE_SPREAD = 3e-3, 0.6
"""Log-normal prior of the jitter of a gyro's stamps relative to the encoders' [s]: messages at 50
to 200 Hz wait for one another by some milliseconds; 1 and 10 ms are two standard deviations off."""

MOST_STAMP_NOISE = 0.02
"""Estimate of that jitter [s] above which a delay may stand behind it (`reference_delay`): two
intervals of 100 Hz. Weighed by it, the legs that would show the delay hardly count, so that a fit
of the delay begins with the typical jitter instead."""

DELAYS_TRIED = 0.005 * 2.0 ** (0.5 * np.arange(13))
"""Delays [s] from which the best is a start, of either sign: a fit finds the rest, from below what
a message takes to where the set-up's search of clocks begins. Each second one is enough but for
coarse counters, between whose steps the likelihood has minima of its own."""

STRANGE_NOISE = 0.01
"""Wheel noise [m^0.5] above which it is no rolling wheel's: 1 cm after 1 m, three times that of the
softest (`TYPICAL_WHEEL_NOISE`). A larger estimate means that something else is missing. No fit goes
beyond it: in 8.7 m of a Lego robot, seen by positions alone, a noise of 2 cm explained away a base
entered 17 % too small, and every effect with it."""

MOST_WHEEL_NOISE = 3e-3
"""The noise of the softest wheels that roll [m^0.5] (see `TYPICAL_WHEEL_NOISE`)."""

UNLIKE_WHEELS = MOST_WHEEL_NOISE / TYPICAL_WHEEL_NOISE
"""Ratio of the noise of two wheels above which they are not two of one robot on one floor: as the
softest on tiles to a typical one, six (`TYPICAL_WHEEL_NOISE`). Chong and Kleeman's two are 1.45. A
reference's error makes it, whatever it is, only if errors along the path and in heading are
correlated by (6² - 1) / (6² + 1) = 0.95; of one that wanders they are independent."""

PAIR_OF_WHEELS = 2.0
"""Ratio of the noise of two wheels above which, surely, errors are told of one of them. Chong and
Kleeman's two are 1.45, so twice is still a pair."""

STRETCHES, LASTS_ALONG = 60, 2.0
"""Stretches into which drives are cut to see whether errors add up along the path; and by how much
more their variance grows than that of errors to the side, if they are no noise of wheels: over such
ways the covariance is then too small by half. With sixty stretches chance shows that in one case in
two hundred (Fisher's F). Ten minutes are stretches of ten seconds."""

LEAST_WHEEL_NOISE = 1e-5
"""Least start value of a fit [m^0.5]: a tenth of the least noise of a rolling wheel, if the robot
file has none. Without noise the first step would have no weights."""

NOISE_NUMBERS = 30
"""Fewest measured coordinates for an estimate of the noise; with fewer it is as given. Thirty
determine the logarithm of one standard deviation to 13 %, and of four to a quarter each: as much as
a verdict needs. What two of them share is divided by the prior."""

NOISE_TOLD = 0.5
"""Relative standard deviation above which a noise is not determined: both twice the noise and none
are then within two standard deviations."""

NOISE_UNTOLD = 1e-4
"""Curvature of minus two log-likelihoods in a log variance up to which nothing is told of it: its
standard deviation would be above a hundred, while all that a noise can be spans forty."""

MOTION_CAPTURE_INTERVAL, MOTION_CAPTURE_XY, MOTION_CAPTURE_YAW = 0.05, 1e-3, 2e-3
"""Interval of poses [s], noise of a position [m] and of a heading [rad] of motion capture, the best
reference for robots: 1 mm at each of two markers 0.7 m apart is 2 mrad. Fits start there, and it is
the better reference with which hidden effects are searched for."""

TAPE_XY, TAPE_YAW = 2e-3, 5e-3
"""Noise by tape and straightedge [m, rad]: assumed if poses are too few for an estimate. Chosen: a
mark on the floor is hit to 2 mm, and two of them, 0.57 m apart on the robot, give 5 mrad."""

UNKNOWN_HEADING = 1.0
"""Prior variance of a heading that is fitted to the positions of a drive [rad²]: a radian, so that
it has no influence. The largest of one that aligns a drive with them."""

CALIBRATION_BOUNDS = (0.25, 4.0)
"""Bounds of the multipliers of base and radii. Skidding wheels turn a robot as on a base of 1.5
(Jackal) to 2 times the true one (four driven wheels on carpet), and a radius entered for a diameter
is 2. Beyond four a number was entered in another unit, which the set-up search names."""

CALIBRATION_KNOWN = 0.05
"""Relative standard deviation above which drives tell less about a radius or a base than the prior.
Chosen: a tape measures either to 5 % on any wheel, tyre or track."""

CLOSED = 0.03
"""Distance between poses as a share of the way, in all legs together, up to which drives end where
they began, and tell no length: by a base that is off by ε a square ends 1.2 ε of its way beside its
start, and smaller wheels make that smaller too. So they tell a radius only where the base is known
to some 2 % already."""

TYPICAL_GYRO_WALK, GYRO_WALK_SPREAD = 3e-4, 0.8
"""Log-normal prior of a gyro's random walk [rad/s^0.5]: 1 degree per root hour, as in data sheets
of gyros for robots; 0.2 to 5 are two standard deviations off."""

TYPICAL_MATCH, MATCH_SPREAD = (2e-3, 2e-3), 1.5
"""Log-normal prior of the white noise of poses from a localiser, or from a matcher on a local map
[m, rad]: with simulated lidars a match is good to 1 to 9 mm and 1.4 to 5 mrad; 0.1 and 40 are two
standard deviations off."""

TYPICAL_WALK, WALK_SPREAD = (5e-3, 3e-3, 1.0 / 15.0), np.array([1.5, 1.5, 1.0])
"""Log-normal prior of the random walk of their correlated error [m/s^0.5, rad/s^0.5], and of the
rate at which that error decays [1/s] (Ornstein-Uhlenbeck process). Chosen: a matcher in a room
wanders by 1 mm and 1 mrad in a second, a particle filter with its cells of 5 cm by 2 cm and 10
mrad, which are within one standard deviation. Either forgets its error when the robot sees other
walls, after some metres: in 2 s to 2 min, which are two off."""

LOST_XY, LOST_YAW = 0.2, 0.1
"""Error of a localiser after the robot was carried, held or out of sight [m, rad], in addition
to its earlier error. Chosen: it follows the robot by what it sees, and lags by a few cells of
its map (5 cm) and some degrees until it has converged; a larger error ends in a jump back, which
is found."""

BIAS_OF_A_DRIVE = 3e-3
"""Standard deviation of a gyro's bias in a drive without a rest from what rests of other drives
tell [rad/s]: 0.2 degrees a second, as data sheets of gyros for robots state from one time of
switching on to the next."""

LAID_YAW, LAID_SCALE, LAID_DRIFT = 0.03, 0.03, 1e-3
"""Standard deviations of the alignment of a gyro's headings with a localiser's, drive by drive:
angle [rad], the gyro's scale, and a constant drift [rad/s]. Chosen: a localiser errs by a degree
for a quarter of a minute, and after a jump by five, so the mean of a minute is good to a degree
or two, and its slope to that over half a minute. Gyros of robots are made to 1 to 3 %. The prior
holds for each drive by itself, as what some drives of one robot have in common is not each
drive's own. By headings alone the drift is how a gyro's bias while the robot drives differs from
that at rest: 0.06 degrees a second, above the 0.01 or less by which a bias wanders in minutes, as
the motors shake it and it warms up."""

COURSE_DRIFT = 1e-2
"""Standard deviation of the drift of a gyro's headings that were laid upon the direction of a path
[rad/s], so wide that it has no influence: the positions that laid them tell it once more
(`UNKNOWN_HEADING` is that of their angle). They are refused where both together are off by a fifth
of a radian at an end of the drive, which in half a minute is two thirds of this."""

FAR_ABOVE_NOISE = 2.5
"""Errors of legs relative to those by the noise of the softest wheels, above which a model is wrong
whatever its likelihood, if it is beyond chance (`SURE`). With ten legs, noise that is known exceeds
this once in 10^16, noise that 30 differences told (`FREEDOM_OF_A_DIFFERENCE`) once in 100. A base
that is 17 % wrong makes 2.7 times in a short drive with positions of 14 mm alone."""
