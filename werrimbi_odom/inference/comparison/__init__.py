# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model against measurement, leg by leg: errors, NEES, and what is systematic in them.

Reading order: `compare` (the whole of it), `prepared_runs` (legs cut once), `leg_errors`,
`consistency` (the one rule for an honest covariance), `verdict` (what is reported).
`reference_noise`, `reference_checks` and `reference_jumps` look at the reference itself.
"""
