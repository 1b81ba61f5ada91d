# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 node: a thin shell that reads counters, asks the model, and says what it answers.

`odom_node.OdomNode` holds the wires; `inputs` and `wheel_side` make two counters of any input,
`messages`, `markers` and `status` put an estimate into messages, `health` keeps /diagnostics, and
`parameters` takes the robot file. No physics is here.
"""
