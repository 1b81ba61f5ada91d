# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements back to the robot: calibration and its error bars; knows no ROS and no plot."""
