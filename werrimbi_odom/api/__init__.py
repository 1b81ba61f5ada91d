# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs for Python (`import werrimbi_odom as wo`): drives in, results out."""
