# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 nodes: thin shells that read messages, ask the model, and say what it answers.

Of the first, `odom_node.OdomNode` holds the wires; `inputs` and `wheel_side` make two counters of
any input, `messages`, `markers` and `estimate_status` put an estimate into messages, `health`
counts for /diagnostics, `parameters` takes the robot file, and `rehearsal` tries it. What comes as
a pose is judged in `planar`, who else is there in `graph`. No physics is here.
"""
