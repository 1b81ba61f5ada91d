# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Many robots at once: each diagnosed by itself, here or on a cluster, told in one table.

Reading order: `one` (a robot's diagnosis, whatever happens),
`members` (the robots of a folder), `spread` (on the processors of this machine), `parcel`, `code`
and `cluster` (on a Dask cluster).
"""
