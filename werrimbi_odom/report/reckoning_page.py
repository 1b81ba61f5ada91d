# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of dead reckoning: the path with its ellipses, against what was measured."""

from __future__ import annotations

import numpy as np

from werrimbi_odom.report.page import Page, Shown
from werrimbi_odom.report.path_figure import PathDrawing, path_figure, spread_along_path
from werrimbi_odom.report.reckoning import Reckoning
from werrimbi_odom.report.text import pairs

_POINTS = 2000  # of the path, that are drawn


def reckoning_page(found: Reckoning) -> Page:
    """The report as a page."""
    driven, reference = found.driven, found.run.reference
    some = np.concatenate([[0], spread_along_path(driven.x, driven.y, _POINTS)])
    drawing = PathDrawing(
        driven.x[some],
        driven.y[some],
        driven.covariance.matrix()[some][:, :2, :2],
        None if reference is None else reference.x,
        None if reference is None else reference.y,
    )
    title = f"{found.run.name}: wheel odometry"
    see = (
        "Ellipses hold the robot 95 times in 100, if the model is right: what was measured should "
        "lie in them."
    )
    shown = Shown("path", "The path, and how sure it is", see, {"": path_figure(drawing)})
    return Page(title, pairs(title, list(found.rows())), [shown])
