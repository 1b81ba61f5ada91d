# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""axe-core's rules for who sees badly, or works with keys or a screen reader, over a page."""

from __future__ import annotations

from importlib.resources import files

import pytest

PACKAGE = "axe_playwright_python"

RUN = """axe.run(document, {resultTypes: ['violations']}).then(found =>
  found.violations.map(item => item.id + ': ' + item.help + ' ' +
    item.nodes.slice(0, 3).map(node => node.html.slice(0, 300)).join(' | ')))"""
"""JavaScript for what breaks a rule, in words; an empty list is good."""

COUNT = "axe.run(document).then(found => found.passes.length)"
"""How many rules had something to look at, and found it well."""


def axe_script() -> str:
    """axe-core itself; where its package is missing, the test is skipped."""
    pytest.importorskip(PACKAGE, reason=f"axe-core is missing: pip install {PACKAGE}")
    source = (files(PACKAGE) / "axe.min.js").read_text(encoding="utf-8")
    return f"{source}; true"
