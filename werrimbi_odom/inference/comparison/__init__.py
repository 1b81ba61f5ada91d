# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model against measurement, leg by leg: errors, dependences, consistency of the covariance."""
