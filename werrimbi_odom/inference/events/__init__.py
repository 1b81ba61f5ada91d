# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What happened at an instant and is no law's: a push, a kick, a slip, a reference that jumped.

Reading order: `noise` (of most legs), `steps` (where the innovations jump, and how), `events`
(which of it is sudden, large and rare), `common_cause` (what they have in common).
"""
