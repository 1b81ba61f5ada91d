# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs as Python functions (`import werrimbi_odom as wo`): drives in, results out.

Command line, workbench and fleet use only these functions. Reading order: `compare_diagnose_add`,
`drives` (inputs and options), `result` (outputs: words, JSON, figures, a page).
Each other verb has a file of its own name.
"""
