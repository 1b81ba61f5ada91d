# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect written from the evidence: its law (`laws`, `law_of_two`), its file (`source`)."""
