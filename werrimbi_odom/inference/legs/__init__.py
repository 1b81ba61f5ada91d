# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recorded drives cut into legs: one clock for ticks and reference, gaps, ends of legs."""
