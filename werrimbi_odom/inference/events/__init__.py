# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Abrupt errors that no law explains: a push, a kick, a wheel slip, a jump of the reference.

Reading order: `steps` (detection and estimation of steps), `events` (which steps are sudden,
large and rare), `common_cause` (what they have in common).
"""
