# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs as Python functions (`import werrimbi_odom as wo`): drives in, results out.

Command line, workbench and fleet use these functions and nothing else. Reading order: `verbs`
(compare, diagnose, add), `drives` (what goes in, and the options), `result` (what comes out: words,
JSON, figures, a page). Each other verb has a file of its own name.
"""
