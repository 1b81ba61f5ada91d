# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration: the paper's (squares, out and back), and maximum likelihood from any driving."""
