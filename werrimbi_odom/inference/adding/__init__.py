# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects added to a robot's model: fitted with all calibration, judged on held-out drives.

Reading order: `adding` (the whole of it), `start_values`, `fits`, `objection` (evidence
for and against an effect).
"""
