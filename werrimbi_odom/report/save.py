# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures to files: an interactive page always, a PNG where a browser is there to draw it."""

from __future__ import annotations

import logging
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import plotly.graph_objects as go

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


def find_browser() -> str | None:
    """Path of a Chrome or Chromium, or None."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def save_page(figure: go.Figure, path: Path) -> None:
    """One self-contained interactive page; opens without a network."""
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.name + ".part")
    figure.write_html(temporary, include_plotlyjs=True, full_html=True)
    temporary.replace(path)


def save_png(figure: go.Figure, path: Path, *, scale: float = 1.5) -> bool:
    """A PNG; False, and nothing written, where no browser is installed (kaleido draws with one)."""
    browser = find_browser()
    if browser is None:
        return False
    import kaleido

    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.stem + ".part.png")
    # Its browser's first words may be cut short; it logs that with a traceback and goes on well.
    logging.disable(logging.CRITICAL)
    try:
        kaleido.write_fig_sync(
            figure,
            path=temporary,
            opts={"format": "png", "scale": scale},
            kopts={"path": browser},
        )
    finally:
        logging.disable(logging.NOTSET)
    temporary.replace(path)
    return True
