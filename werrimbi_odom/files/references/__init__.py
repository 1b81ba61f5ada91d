# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""References by their own values: what was held, resampled, turned or made of the wheels.

Each file is one thing that a reference may be; `merged_reference` makes one of two, `start_pose`
takes the start of a run from it.
"""
