# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Many robots at once: each diagnosed by itself, here or on a cluster, told in one table.

Reading order: `robot_task` (a robot's diagnosis, whatever happens), `members` (the robots of a
folder), `process_pool` (on the processors of this machine), `parcel` and `cluster` (on a Dask
cluster).
"""
