# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS 2 node: a thin shell that reads counters, asks the model, and says what it answers.

`odom_node.OdomNode` holds the wires; `inputs` and `wheel_side` make two counters of any input,
`messages`, `markers` and `status` put an estimate into messages, `health` keeps /diagnostics,
`parameters` takes the robot file, and `rehearsal` tries it. What comes as a pose is judged in
`planar`, who else is there in `graph`. No physics is here.
"""
