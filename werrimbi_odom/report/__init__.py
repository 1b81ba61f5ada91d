# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Presentation of results: words, tables, figures and pages. Nothing here computes physics.

`document` defines the report of a verb; each verb has a folder that makes its document. `terminal`
prints a document, `html_page` writes it as HTML, `save` as PDF or PNG. `style` has the colours.
"""
