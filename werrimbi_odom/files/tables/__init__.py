# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Tables of numbers, and columns that hold something else than their names say.

`csv_table` reads one, and `bad_cells` tells what in it is no number; `mislabelled_columns`,
`units_of_time`, `standing_reference`, `counter_columns` and `compared_ways` judge what is in it.
"""
