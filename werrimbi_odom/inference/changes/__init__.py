# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Changes between drives: which number changed, when, by how much, and how significant that is.

Reading order: `numbers` (what may change), `drives` (what each drive tells about it), `shapes` (a
step, one drive alone, a trend, and what each would explain), `search` (which of them are needed),
`between_drives` (changes within one diagnosis), `history` (drives over months).
"""
