# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 nodes: thin layers over the model, without physics of their own.

`odom_node.OdomNode` is the main node. `counter_inputs` and `wheel_side` convert any input to two
counters. `odometry_messages`, `markers` and `estimate_status` convert an estimate to messages;
`input_health` counts for /diagnostics. `odom_parameters` reads the robot file, and
`parameter_trial` tests its values. `topics` publishes and subscribes, `planar` checks incoming
poses, `graph` finds other nodes, `slip` and `phase_learning` use a gyro.
"""
