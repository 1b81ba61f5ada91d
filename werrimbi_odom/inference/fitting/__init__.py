# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum likelihood fits of models to recorded drives.

Reading order: `concatenated_runs` (drives laid end to end), `prediction` (of every leg),
`filtering` and `likelihood` (innovations of a Kalman filter), `whitened_innovations` (their
derivatives), `identifiable` (what the data determine), `noise` with `fisher_scoring` (the
variances), `fit` with `gauss_newton` (all of it), `score_tests` (of candidates), `candidate_starts`
and `start_headings` (where fits start).
"""
