# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""plotly.js, which draws the figures of all pages: the part of it that they need (plotly_js/)."""

from __future__ import annotations

from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.resources.abc import Traversable


def drawing_program() -> Traversable:
    """Where it is; 1.5 MB of JavaScript."""
    return files("werrimbi_odom.report") / "plotly_js" / "plotly-cartesian.min.js"
