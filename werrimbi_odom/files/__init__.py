# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reads and writes robot files and recorded runs. Every error names file, place and remedy.

Reading order: `robot_files` (the robot), `run` and `read_run` (a drive), then `run_folder` (CSV,
with `tables`) or `run_bag` (with `bags`). What a reference may be, by its own values, is in
`references`; `robot_descriptions` makes a first robot file. `recordings` are all drives of one
question, `evaluation_options` how they are judged.
"""
