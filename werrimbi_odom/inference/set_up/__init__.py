# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The global search for set-up mistakes, which are too large to be found from a derivative.

Reading order: `search`, `clock_offset_search`, `records` (cuts that need no scale), `regression`
(wheels, base and mount in closed form), `explanation` and `misentered_values` (the simplest
mistake).
"""
