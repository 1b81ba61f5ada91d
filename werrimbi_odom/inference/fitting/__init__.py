# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Models fitted to recorded drives by maximum likelihood.

Reading order: `concatenated_runs` (drives laid end to end), `prediction` (of every leg),
`filtering` and `likelihood` (innovations), `design` (how they change), `identifiable` (what they
hold), `noise` with `fisher_scoring` (the variances), `fit` (all of it).
"""
