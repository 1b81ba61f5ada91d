# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The report of a comparison: where the model fails, and whether its covariance is honest."""

from __future__ import annotations

from typing import TYPE_CHECKING

from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.verdict import verdict_of
from werrimbi_odom.report.comparison.figures import legs_by_motion_figure, nees_figure
from werrimbi_odom.report.comparison.measured_path_figure import path_figure
from werrimbi_odom.report.comparison.tables import tables_of
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.document import Document, Shown
from werrimbi_odom.report.over_variable import error_against_figure, variables_of

if TYPE_CHECKING:
    import plotly.graph_objects as go

_RUNS = 40  # that can be chosen one by one: more would make the file too large to mail


def document_of(comparison: Comparison, command: str = "") -> Document:
    """Everything that is told; `command`: the whole one of the next step."""
    verdict = verdict_of(comparison)
    return Document(
        title="Model against measurement",
        words=words_of(comparison, verdict=verdict, command=command),
        tables=tables_of(comparison, verdict),
        draw=lambda: _figures(comparison),
    )


def _figures(comparison: Comparison) -> list[Shown]:
    against = {name: error_against_figure(comparison, name) for name in variables_of(comparison)}
    return [
        Shown(
            "path",
            "Where the model fails",
            f"Each dot is a leg of {comparison.main.leg:g} m where it was driven, larger and "
            "stronger in colour the more the model errs on it. Choose one drive to see where the "
            "model alone would have ended, and whether the truth lies inside its ellipses.",
            _paths(comparison),
            "Drive:",
        ),
        Shown(
            "motion",
            "Errors by type of motion",
            "Blue is what the errors were, the hatched bar what the covariance promised. Whiskers "
            "that end where the bar ends are right; a box off zero is a systematic error.",
            {"": legs_by_motion_figure(comparison)},
        ),
        Shown(
            "nees",
            "Is the covariance honest?",
            "Marks inside the grey bars are what an honest covariance gives; above them the errors "
            "are larger than promised, below them smaller. Marks that climb to the right tell of a "
            "systematic error: it grows faster with the way than noise does.",
            {"": nees_figure(comparison)},
        ),
        Shown(
            "against",
            "What the errors go with",
            "Means that leave zero together, beyond their error bars, show what the error depends "
            "on.",
            against,
            "Errors against:",
        ),
    ]


def _paths(comparison: Comparison) -> dict[str, go.Figure]:
    """All drives together, then each for itself."""
    found = {}
    count = len(comparison.runs)
    if count > 1:
        found[f"all {count} drives"] = path_figure(comparison)
    for index, item in enumerate(comparison.runs[:_RUNS]):
        name = item.run.name
        found[name if name not in found else f"{name} ({index + 1})"] = path_figure(
            comparison, index
        )
    return found
