# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Reports and figures to files: pages always, pictures where a browser is there to draw them."""

from __future__ import annotations

import logging
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.replacing import replacing
from werrimbi_odom.report.document import Document
from werrimbi_odom.report.page import drawing_program, write_page
from werrimbi_odom.report.style import KEPT_HERE

if TYPE_CHECKING:
    import plotly.graph_objects as go

PAGES, PICTURES = (".html", ".htm"), (".pdf", ".png")
"""How reports end."""

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


def find_browser() -> str | None:
    """Path of a Chrome or Chromium, or None."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def save_page(figure: go.Figure, path: Path) -> None:
    """One self-contained interactive page; opens without a network."""
    path.parent.mkdir(parents=True, exist_ok=True)
    page = figure.to_html(include_plotlyjs=False, full_html=True, config=dict(KEPT_HERE))
    program = drawing_program().read_text(encoding="utf-8")
    with replacing(path) as file:
        file.write(page.replace("<head>", f"<head><script>{program}</script>", 1))


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


def refuse_report(path: Path) -> None:
    """What can be known before there is anything to report.

    Raises
    ------
    InputError
        When no report has such an ending, or no browser is there to draw its pictures.
    """
    kind = path.suffix.lower()
    if kind not in (*PAGES, *PICTURES):
        raise InputError(f"--report {path}: a report ends in .html, .pdf or .png")
    if kind in PICTURES and find_browser() is None:
        raise InputError(
            f"--report {path}: figures are drawn by Chrome or Chromium, and none is installed "
            "(apt install chromium); a report that ends in .html needs none"
        )


def save_report(document: Document, path: Path) -> list[Path]:
    """A report as a page (.html), or its main figures as pictures for a paper (.pdf, .png).

    Pictures are a file for each figure: the first has the name that was asked for, the others have
    the figure's name added to it.

    Raises
    ------
    InputError
        When a file cannot be written, its ending is another one, or no browser is installed.
    """
    refuse_report(path)
    if path.suffix.lower() in PAGES:
        write_page(document, path)
        return [path]
    main = [shown for shown in document.draw() if shown.main and shown.figures]
    files = [
        path if number == 0 else path.with_name(f"{path.stem}-{shown.key}{path.suffix}")
        for number, shown in enumerate(main)
    ]
    save_pictures(
        [
            (next(iter(shown.figures.values())), file)
            for shown, file in zip(main, files, strict=True)
        ]
    )
    return files


def save_pictures(pictures: Sequence[tuple[go.Figure, Path]], *, scale: float = 2.0) -> None:
    """Figures as they are on white paper, drawn by one browser; .pdf is made of lines, not dots.

    Raises
    ------
    InputError
        When a file cannot be written.
    """
    import kaleido

    with tempfile.TemporaryDirectory(prefix="werrimbi-") as folder:
        drawn = [
            Path(folder) / f"{number}{file.suffix}" for number, (_, file) in enumerate(pictures)
        ]
        logging.disable(logging.CRITICAL)
        try:
            kaleido.write_fig_from_object_sync(
                [
                    {
                        "fig": figure,
                        "path": part,
                        "opts": {
                            "format": part.suffix[1:].lower(),
                            "scale": scale,
                            "width": 1000,
                            "height": int(figure.layout.height or 600),
                        },
                    }
                    for (figure, _), part in zip(pictures, drawn, strict=True)
                ],
                kopts={"path": find_browser()},
            )
        finally:
            logging.disable(logging.NOTSET)
        for (_, file), part in zip(pictures, drawn, strict=True):
            try:
                beside = file.with_name(f".{file.name}.part")
                beside.write_bytes(part.read_bytes())
                beside.replace(file)
            except OSError as error:
                raise InputError(f"{file} cannot be written: {error.strerror}") from error
