# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Experiment design: what to drive next to tell rivals apart, and what the drives could have shown.

Reading order: `library` (the manoeuvres), `simulated_record` (one as this robot would record it),
`expected_evidence` and `next_manoeuvre` (which to drive, or what a hand does if no drive can tell),
`detection_limits`.
"""
