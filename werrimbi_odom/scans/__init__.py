# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Scan matching odometry: poses of a 2-D lidar from its scans alone, with numpy and scipy.

Begin with `three_pass_odometry`: it takes scans and returns poses with covariances, cut where
tracking was lost. One scan is a `Sweep` (`sweep`). It is matched (`matching`) with line elements
(`line_features`) of a local map (`local_map`); `scan_odometry` is one pass. Before that,
`beam_order` finds the order in which the beams of a turn were measured, and `room_odometry` leaves
out echoes of the floor and of the robot itself, which `body_fixed` finds. `limits` has the
thresholds.
"""
