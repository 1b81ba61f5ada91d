# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The numeric core: numpy alone; no ROS, no files, no plots. Units are SI (REP-103).

Reading order: `motion` (travel to displacement), `covariance` (one piece in closed form),
`uncertainty` and `exact_moments` (along a path), `encoder_online` (counters to travel),
`end_of_piece` (where a piece ends), `odometer` (all of it, message by message). `encoder_recorded`,
`pieces_recorded` and `trajectory` do the same for a whole run at once. `robot` holds the parameters
of a robot. `effect` defines an effect, `drive` the quantities that it may read; `effects_over_run`
and `measured_poses` give effects the poses that result.
"""
