# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drive a manoeuvre within limits: plain functions and objects, without ROS and without a clock.

Reading order: `limits` (limits set by the user, and checks while driving), `plan` (the moves),
`manoeuvres` (the library), `path_following` (the controller), `driver` (when the robot moves and
stops). `werrimbi_odom.ros.drive_node` is the node around it.
"""
