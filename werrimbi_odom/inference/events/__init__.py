# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Abrupt errors that no law explains: a push, a kick, a wheel slip, a jump of the reference.

Reading order: `steps` (detection of steps), `groups` (which are one event, and what they come to),
`events` (which are sudden, large and rare), `common_cause` (what they have in common).
"""
