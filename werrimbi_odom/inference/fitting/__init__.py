# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Models fitted to recorded drives: legs, predictions, a filter of innovations, least squares."""
