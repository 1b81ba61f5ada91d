# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A manoeuvre driven within limits: plain functions and objects, without ROS and without a clock.

Reading order: `limits` (what the user allows), `plan` (what is to be driven), `manoeuvres` (the
library), `path_following` (the controller), `watch` (what must not happen), `driver` (when the
robot moves, and when it stops). `werrimbi_odom.ros.drive_node` is the shell around it.
"""
