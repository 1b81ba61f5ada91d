# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads and writes robot files and recorded runs. Every error names file, place and remedy.

Reading order: `robot_file` and `parameters` (the robot), `run` and `read_run` (a drive), then
`run_folder` (CSV) or `run_bag` with `bag_ticks` and `bag_reference` (bags). `evaluation_options`
has the options for evaluating drives. `own_odometry` and `derived_references` recognise references
that are odometry under another name.
"""
