# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What to drive next, so that rivals are told apart, and what these drives could have shown.

Reading order: `library` (the manoeuvres), `imagined` (one as this robot would record it), `rivals`
and `proposal` (which to drive), `by_hand` (if no drive can tell), `detection_limits`.
"""
