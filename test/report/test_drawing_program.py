# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The part of plotly.js that is shipped is of the version that plotly.py makes its figures for."""

from __future__ import annotations

import re

from plotly.offline import get_plotlyjs_version

from werrimbi_odom.report.page import drawing_program


def test_it_is_of_the_version_that_plotly_makes_figures_for() -> None:
    head = drawing_program().read_text(encoding="utf-8")[:200]
    found = re.search(r"plotly\.js \(cartesian - minified\) v([\d.]+)", head)
    assert found is not None, head
    assert found[1] == get_plotlyjs_version(), "see werrimbi_odom/report/plotly_js/README.md"
