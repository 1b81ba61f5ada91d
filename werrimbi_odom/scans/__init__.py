# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of a 2-D lidar from its scans alone: no wheels, no map, numpy and scipy.

Begin with `path`: scans in, poses with covariances out, cut where the lidar was lost. One scan is a
`Sweep` (`sweep`). It is matched (`matching`) with line elements (`elements`) of the last metres
(`local_map`), twice (`scan_odometry`); before that, `beam_order` finds in which order the beams of
a turn were taken. `limits` has the numbers that decide.
"""
