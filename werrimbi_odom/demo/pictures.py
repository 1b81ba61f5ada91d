# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A figure as a page, and as a picture whether a browser is there or not."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.report.save import save_page, save_png
from werrimbi_odom.report.without_browser import save_simple_png

if TYPE_CHECKING:
    import plotly.graph_objects as go


def save_and_tell(figure: go.Figure, path: Path) -> None:
    """Write `path`.html and `path`.png, and say so."""
    page, picture = path.with_suffix(".html"), path.with_suffix(".png")
    save_page(figure, page)
    print(f"\npicture: {page} (interactive)")
    if save_png(figure, picture):
        print(f"         {picture}")
    elif save_simple_png(figure, picture):
        print(f"         {picture} (a plain one: the pages' own look needs Chrome or Chromium)")
    else:
        print("         (no PNG: it needs Chrome or Chromium, or matplotlib)")
