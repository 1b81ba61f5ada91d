# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of a 2-D lidar from its scans alone: no wheels, no map, numpy and scipy.

Begin with `path.py`: scans in, poses with covariances out, cut where the lidar was lost. One scan
is a `Sweep` (sweep.py); it is matched (matching.py) with line elements (elements.py) of the last
metres (local_map.py), twice (scan_odometry.py), and first both ways round where its beams are seen
one after the other (beam_order.py). What decides is in limits.py.
"""
