# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Which physical effect is missing: evidence map, score tests, search, verdict."""
