# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Diagnosis of many robots, each on its own, on this machine or a cluster, in one table.

Reading order: `robot_task` (the diagnosis of one robot, which never raises), `members` (the robots
of a folder), `process_pool` (on this machine), `worker_archive` and `cluster` (on a Dask cluster).
"""
