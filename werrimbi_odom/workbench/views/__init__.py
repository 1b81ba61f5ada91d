# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the page shows: a file for each of the four steps, and the strip that is always in view."""
