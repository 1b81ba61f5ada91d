# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`make demo`: recorded ticks through the real node, then the whole loop on a simulated robot.

Reading order: `through_node` (first act), `second_act`, `stage` (the nodes' processes and domain).
"""
