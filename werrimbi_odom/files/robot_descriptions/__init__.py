# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A first robot file, and which joints are its wheels, from what a robot says of itself.

`first_robot` makes the file of a URDF (`urdf_wheels`) or of a controller's parameters
(`controller_wheels`); `wheel_joints` finds the wheels among the joints of a recording.
"""
