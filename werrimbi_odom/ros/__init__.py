# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 nodes: thin layers over the model, without physics of their own.

`odom_node.OdomNode` is the main node. `counter_inputs` and `wheel_side` convert any input to two
counters. `odometry_messages` and `markers` convert an estimate to messages, `diagnostics` to words;
`input_health` counts for /diagnostics. `odom_parameters` reads the robot file, and
`live_odometer` tests its values. `topics` publishes, subscribes and finds other nodes, `planar`
checks incoming poses, `slip` and `phase_learning` use a gyro. What begins with "compare_",
"drive_" or "simulated_" is of the other nodes.
"""
