# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of `diagnose`; begin with `document`, then `words` and `unknown`."""
