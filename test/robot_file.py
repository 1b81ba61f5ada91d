# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The shortest robot file there is."""

from __future__ import annotations

BARE = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.35
    wheel_radius: 0.05
    left_ticks_per_revolution: 2000.0
    right_ticks_per_revolution: 2000.0
"""
