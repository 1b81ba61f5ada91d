# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Views of the page: a module for each of the four steps, and the bar that is always visible."""
