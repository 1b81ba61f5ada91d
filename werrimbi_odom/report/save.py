# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Save reports and figures: pages always, pictures if a browser is installed to draw them.

Without one, matplotlib draws lines, marks and bars of a figure, but no heat maps.
"""

from __future__ import annotations

import html
import logging
import re
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.report.document import Document
from werrimbi_odom.report.html_page import drawing_program, write_page
from werrimbi_odom.report.style import KEPT_HERE, Figure

PAGES, PICTURES = (".html", ".htm"), (".pdf", ".png")
"""Suffixes of reports."""

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")


def find_browser() -> str | None:
    """Path of a Chrome or Chromium, or None."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


def save_page(figure: Figure, path: Path) -> None:
    """Save one self-contained interactive page, which opens without a network."""
    path.parent.mkdir(parents=True, exist_ok=True)
    page = figure.to_html(include_plotlyjs=False, full_html=True, config=dict(KEPT_HERE))
    program = drawing_program().read_text(encoding="utf-8")
    with replacing(path) as file:
        file.write(page.replace("<head>", f"<head><script>{program}</script>", 1))


def save_png(figure: Figure, path: Path) -> bool:
    """Save a PNG; False without a browser, which kaleido needs, and then nothing is written."""
    if find_browser() is None:
        return False
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(path.stem + ".part.png")
    _draw([(figure, temporary, {"scale": 1.5})])
    temporary.replace(path)
    return True


def _draw(pictures: Iterable[tuple[Figure, Path, Mapping[str, object]]]) -> None:
    """Draw figures to files with one browser, each with its own options."""
    import kaleido

    drawn = [
        {"fig": figure, "path": path, "opts": {"format": path.suffix[1:].lower(), **options}}
        for figure, path, options in pictures
    ]
    # Kaleido logs a harmless traceback if the browser's first output is truncated.
    before = logging.root.manager.disable
    logging.disable(logging.CRITICAL)
    try:
        kaleido.write_fig_from_object_sync(drawn, kopts={"path": find_browser()})
    finally:
        logging.disable(before)


def refuse_report(path: Path) -> None:
    """Check the path of a report before any work is done.

    InputError if the suffix is not one of a report, or no browser is installed for pictures.
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
    """Save a report as a page (.html), or its main figures as pictures for a paper (.pdf, .png).

    Each figure is a file of its own: the first has the requested name, the others have the key of
    the figure appended. InputError if a file cannot be written, its suffix is another one, or no
    browser is installed.
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
        [(next(iter(each.figures.values())), file) for each, file in zip(main, files, strict=True)]
    )
    return files


def save_pictures(pictures: Sequence[tuple[Figure, Path]]) -> None:
    """Save figures in their light colours, drawn by one browser; .pdf has vector graphics.

    InputError if a file cannot be written.
    """
    with tempfile.TemporaryDirectory(prefix="werrimbi-") as folder:
        drawn = [
            Path(folder) / f"{number}{file.suffix}" for number, (_, file) in enumerate(pictures)
        ]
        size = {"scale": 2.0, "width": 1000}
        _draw(
            (figure, part, {**size, "height": int(figure.layout.height or 600)})
            for (figure, _), part in zip(pictures, drawn, strict=True)
        )
        for (_, file), part in zip(pictures, drawn, strict=True):
            try:
                beside = file.with_name(f".{file.name}.part")
                beside.write_bytes(part.read_bytes())
                beside.replace(file)
            except OSError as error:
                raise InputError(f"{file} cannot be written: {error.strerror}") from error


_DASHES = {"dash": "--", "dot": ":", "dashdot": "-."}
_MARKS = {"circle": "o", "square": "s", "x": "x", "diamond": "D"}
_INCH = 100.0
"""Pixels per inch for plotly's sizes."""


def save_simple_png(figure: Figure, path: Path) -> bool:
    """Save a PNG with matplotlib; False if it is not installed, and then nothing is written."""
    if find_spec("matplotlib") is None:
        return False
    from matplotlib.figure import Figure as Canvas

    layout = figure.layout
    size = (float(layout.width or 1000) / _INCH, float(layout.height or 600) / _INCH)
    canvas = Canvas(figsize=size, layout="constrained")
    axes = canvas.add_subplot()
    bars = [trace for trace in figure.data if trace.type == "bar"]
    for number, trace in enumerate(bars):
        _bars(axes, trace, number, len(bars))
    for trace in figure.data:
        if trace.type == "scatter":
            _scatter(axes, trace)
    for shape in layout.shapes:
        if shape.type == "line" and shape.y0 == shape.y1:  # plotly's add_hline
            axes.axhline(shape.y0, **_line(shape.line))
    axes.set_xlabel(_said(layout.xaxis.title.text))
    axes.set_ylabel(_said(layout.yaxis.title.text))
    axes.set_title(_said(layout.title.text), loc="left")
    if layout.yaxis.range:
        axes.set_ylim(layout.yaxis.range)
    if layout.yaxis.scaleanchor:
        axes.set_aspect("equal", adjustable="datalim")
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    canvas.legend(loc="outside lower left", ncols=3, frameon=False)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.savefig(path, dpi=150)
    return True


def _bars(axes: Any, trace: Any, number: int, count: int) -> None:
    """Draw one of `count` series of bars."""
    width = 0.65 / count
    places = np.arange(len(trace.x)) + (number - 0.5 * (count - 1)) * width
    drawn = axes.bar(places, trace.y, width, color=trace.marker.color, label=trace.name)
    if trace.text is not None:
        axes.bar_label(drawn, trace.text, label_type="center", color=trace.textfont.color)
    axes.set_xticks(np.arange(len(trace.x)), [_said(name) for name in trace.x])


def _scatter(axes: Any, trace: Any) -> None:
    """Draw a line, an area or marks; in the legend unless plotly excludes them."""
    label = trace.name if trace.showlegend is not False else None
    x, y = (
        np.array([np.nan if value is None else value for value in part], dtype=np.float64)
        for part in (trace.x, trace.y)
    )
    if trace.fill == "toself":
        axes.fill(x, y, color=trace.line.color, alpha=0.16, label=label, linewidth=0)
        axes.plot(x, y, **_line(trace.line))
        return
    look: dict[str, Any] = {"alpha": trace.opacity, "label": label}
    if "lines" in (trace.mode or "lines"):
        look |= _line(trace.line)
    else:
        look |= {"linestyle": "none", "color": trace.marker.color}
    if "markers" in (trace.mode or ""):
        look |= {"marker": _MARKS.get(trace.marker.symbol, "o"), "color": trace.marker.color}
    axes.plot(x, y, **look)


def _line(line: Any) -> dict[str, Any]:
    return {
        "color": line.color,
        "linewidth": 0.7 * (line.width or 2.0),
        "linestyle": _DASHES.get(line.dash, "-"),
    }


def _said(text: str | None) -> str:
    """Text without plotly's markup."""
    return html.unescape(re.sub(r"<[^>]*>", "", (text or "").replace("<br>", "\n")))
