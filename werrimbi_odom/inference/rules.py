# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers that decide, each with its reason."""

from __future__ import annotations

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

FAR_ABOVE_NOISE = 5.0
"""How many times what noise promises the errors of legs must be for the model to be wrong whatever
the likelihood says: a wheels' noise five times too small is that of another floor, and the robot
file's stated noise is seldom wrong by more."""
