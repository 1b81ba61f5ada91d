# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements back to the robot; knows no ROS and no plot.

Each folder stands on those after it: `drafting` (an effect written from the evidence), `adding`
(one put in and judged), `manoeuvres` (what to drive next), `calibration` (the paper's, and any
driving), `changes` (from drive to drive), `diagnosis` (what is missing), `set_up` (mistakes that no
derivative sees), `comparison` (errors of legs), `events` (at an instant), `fitting`, `legs` (where
drives are cut), `rules` (every number that decides something).
"""
