# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Cutting recorded drives into legs: a common clock for ticks and reference, gaps, leg ends."""
