# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which physical effect is missing: set-up, evidence map, score tests, forward search, verdict.

Reading order: `diagnosis` (the whole of it), `search` (forward selection), `evidence` (the map),
`selection` (which numbers earn their price), `cross_validation`, `homogeneity`, `rivals`. The
statistics are in docs/method.md, section 4.
"""
