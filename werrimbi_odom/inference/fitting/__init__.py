# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum-likelihood fits of models to recorded drives.

Reading order: `concatenated_runs` (drives laid end to end), `prediction` (of every leg),
`filtering` and `likelihood` (Kalman filter and innovations), `design` (Jacobian), `identifiable`
(which parameters the data determine), `noise` with `fisher_scoring` (variances), `fit` (the whole
fit).
"""
