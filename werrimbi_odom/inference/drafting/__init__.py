# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drafting of a new effect from the evidence, if no effect of the library explains the errors.

Reading order: `draft` (the whole of it), `law_forms` (laws of one variable), `two_variables` with
`terms` and `regression` (laws of two variables), `source` and `package` (the files written).
"""
