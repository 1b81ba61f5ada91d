# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: recorded ticks through the real node, then the whole procedure in simulation.

Reading order: `through_node` (first act), `simulated_procedure` (second act), `node_processes`
(node processes and ROS domain).
"""
