# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of dead reckoning: the path with its ellipses, against what was measured."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from werrimbi_odom.report.document import Document, Shown, Table
from werrimbi_odom.report.path_figure import PathDrawing, path_figure, spread_along_path
from werrimbi_odom.report.reckoning import Reckoning

_POINTS = 2000  # of the path, that are drawn


def document_of(found: Reckoning, robot: Path) -> Document:
    """Everything that is told; `robot`: its file."""
    title = f"{found.run.name}: wheel odometry"
    return Document(
        title=title,
        words=[Table(f"{title} of {robot}", (), list(found.rows()))],
        draw=lambda: [_path(found)],
    )


def _path(found: Reckoning) -> Shown:
    driven, reference = found.driven, found.run.reference
    some = np.concatenate([[0], spread_along_path(driven.x, driven.y, _POINTS)])
    drawing = PathDrawing(
        driven.x[some],
        driven.y[some],
        driven.covariance.matrix()[some][:, :2, :2],
        None if reference is None else reference.x,
        None if reference is None else reference.y,
    )
    see = (
        "Ellipses hold the robot 95 times in 100, if the model is right: what was measured should "
        "lie in them."
    )
    return Shown("path", "The path, and how sure it is", see, {"": path_figure(drawing)})
