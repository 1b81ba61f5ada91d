# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between drives: which parameter changed, when, by how much, and how significant that is.

Reading order: `parameter_groups` (what may change), `information_of_drives`,
`shapes` (a step, one drive alone, a trend, and the gain of each), `change_points` (their
selection), `change_evidence`, `between_drives` (changes within one diagnosis), `history` (drives
over months).
"""
