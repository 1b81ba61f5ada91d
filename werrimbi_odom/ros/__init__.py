# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 nodes: thin shells around the model. They hold no physics.

`odom_node.OdomNode` is the main node. `inputs` and `wheel_side` turn any input into two counters;
`messages`, `markers` and `estimate_status` turn an estimate into messages; `health` counts for
/diagnostics; `parameters` takes the robot file, and `rehearsal` tries it. `planar` judges incoming
poses, `graph` knows the other nodes, `slip` and `learning` listen to a gyro.

`compare_node` (the live error), `drive_node` (a manoeuvre) and `simulated_robot` (a robot in the
physics engine) are the other nodes. `running` starts and ends them all.
"""
