# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Many robots at once: each is diagnosed by itself, here or on a cluster, into one table.

Reading order: `robot_task` (the diagnosis of one robot, which always ends), `members` (the robots
of a folder), `process_pool` (on this machine), `parcel` and `cluster` (on a Dask cluster).
"""
