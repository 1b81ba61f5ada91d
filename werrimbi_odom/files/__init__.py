# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files and recorded runs, read and written. Every error names file, place and mend.

Reading order: `robot_file` and `parameters` (the robot), `run` and `read_run` (a drive), then
`run_folder` (CSV) or `run_bag` with `bag_ticks` and `bag_reference` (bags). `evaluation` has the
options with which drives are judged. `made_from_wheels` and `derived_references` recognise
references that are odometry under another name.
"""
