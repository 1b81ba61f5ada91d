# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is told of a robot's history: words, JSON, a page with a panel for each number."""
