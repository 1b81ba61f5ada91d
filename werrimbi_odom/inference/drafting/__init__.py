# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An effect written from the evidence, if the library has none that explains the errors.

Reading order: `draft` (the whole of it), `laws` (forms in one variable), `of_two` with `terms` and
`regression` (laws of two variables), `source` and `package` (the files written).
"""
