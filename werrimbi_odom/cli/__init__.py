# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The command line: one verb a module, heavy imports inside the verb, exits here alone."""
