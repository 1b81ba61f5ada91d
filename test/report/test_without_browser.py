# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A picture where there is no browser: lines, areas, marks and bars are in it."""

from __future__ import annotations

import logging
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("plotly.graph_objects")

from matplotlib.image import imread

from werrimbi_odom.report.adding.document import ErrorOfModel, error_falling_figure
from werrimbi_odom.report.path_figure import PathDrawing, path_figure
from werrimbi_odom.report.save import save_pictures, save_simple_png
from werrimbi_odom.report.style import BLUE, GREEN, ORANGE


def share(path: Path, colour: str) -> float:
    """Of the picture, that has a colour."""
    wanted = np.array([int(colour[at : at + 2], 16) for at in (1, 3, 5)]) / 255.0
    pixels = imread(path)[:, :, :3]
    return float((np.abs(pixels - wanted).max(axis=2) < 0.02).mean())


def test_bars_are_as_high_as_their_numbers(tmp_path: Path) -> None:
    found = []
    for after in (0.002, 0.004):
        steps = [ErrorOfModel("as given", 0.004, 0.004), ErrorOfModel("+ castor", 0.002, after)]
        assert save_simple_png(error_falling_figure(steps, 0.002), tmp_path / "bars.png")
        found.append(share(tmp_path / "bars.png", BLUE))
    assert found[1] / found[0] == pytest.approx(8.0 / 6.0, rel=0.03)
    assert share(tmp_path / "bars.png", GREEN) > 1e-3


def test_a_path_and_its_ellipses(tmp_path: Path) -> None:
    x = np.linspace(0.0, 2.0, 50)
    drawing = PathDrawing(x, np.sin(9.0 * x), np.array([n * 1e-4 * np.eye(2) for n in range(50)]))
    assert save_simple_png(path_figure(drawing), tmp_path / "path.png")
    assert share(tmp_path / "path.png", BLUE) > 1e-3
    assert share(tmp_path / "path.png", ORANGE) > 1e-3


def test_pictures_leave_the_users_logging_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    drawn = SimpleNamespace(write_fig_from_object_sync=lambda figures, kopts: None)
    monkeypatch.setitem(sys.modules, "kaleido", drawn)
    logging.disable(logging.WARNING)
    try:
        save_pictures([])
        assert logging.root.manager.disable == logging.WARNING
    finally:
        logging.disable(logging.NOTSET)
