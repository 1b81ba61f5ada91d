# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Bags: what is in them, and how their messages become counters and poses.

`bag` opens one (`driver_messages` and `standard_forms`: drivers' own types), `bag_contents` lists
it. Wheels: `bag_wheels`, then `bag_ticks`, `bag_joints` and `bag_odometry`. References:
`reference_choice`, then `bag_reference`, `bag_chain` (transforms) and `bag_laser_scans`.
`own_odometry` and `derived_references` recognise odometry under another name; `stamps` says when
messages were sent.
"""
