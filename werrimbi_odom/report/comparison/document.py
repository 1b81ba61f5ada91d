# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of a comparison: where the model fails, and whether its covariance is consistent."""

from __future__ import annotations

import math

from werrimbi_odom.files.run import by_hand
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.compare import KINDS, Comparison, LegFigures, OfLength
from werrimbi_odom.inference.comparison.dependence import ByVariable
from werrimbi_odom.inference.comparison.verdict import Verdict, verdict_of
from werrimbi_odom.report.comparison.figures import (
    NAMES,
    legs_by_motion_figure,
    measured_channels,
    nees_figure,
)
from werrimbi_odom.report.comparison.measured_path_figure import path_figure
from werrimbi_odom.report.comparison.over_variable import error_against_figure, variables_of
from werrimbi_odom.report.comparison.phrases import length_of
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.document import Document, Part, Shown, Table, paragraphs
from werrimbi_odom.report.phrases import leg_words
from werrimbi_odom.report.style import Figure

_RUNS = 40  # runs with a figure of their own; more would make the file too large to mail


def document_of(comparison: Comparison, command: str = "", fit: str = "") -> Document:
    """The complete report.

    `command` is the full command of the next step, `fit` that of a calibration, where the drives
    are measured too seldom to be judged.
    """
    verdict = verdict_of(comparison)
    return Document(
        title="Model against measurement",
        words=words_of(comparison, verdict=verdict, command=command, fit=fit),
        tables=tables_of(comparison, verdict),
        draw=lambda: _figures(comparison),
    )


def _figures(comparison: Comparison) -> list[Shown]:
    paths = Shown(
        "path",
        "Where the model fails",
        f"Each dot is a leg of {comparison.main.leg:g} m where it was driven, larger and "
        "stronger in colour the more the model errs on it. Choose one drive to see where the "
        "model alone would have ended, and whether the truth lies inside its ellipses.",
        _paths(comparison),
        "Drive:",
    )
    if not measured_channels(comparison):  # no leg
        return [paths]
    against = {name: error_against_figure(comparison, name) for name in variables_of(comparison)}
    return [
        paths,
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


def _paths(comparison: Comparison) -> dict[str, Figure]:
    """Figures of all drives together, and of each drive."""
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


_MOST = 3  # variables with their own table
_FIGURES = ("legs", "position", "heading", "NEES", "inside 95 %")


def tables_of(comparison: Comparison, verdict: Verdict) -> tuple[Part, ...]:
    """All tables with their headings."""
    length = leg_words(comparison.median_length, comparison.main.leg)
    tables: list[Part] = [_motions(comparison.main, length), _lengths(comparison)]
    first = comparison.runs[0]
    if (
        len(comparison.runs) > 1
        or math.isfinite(first.end_error_m)
        or by_hand(first.run.no_driving)
    ):
        tables.append(_runs(comparison))
    said = list(dict.fromkeys(item.variable for item in verdict.depends))
    by_name = {item.name: item for item in comparison.variables}
    tables += [_variable(by_name[name]) for name in said[:_MOST]]
    calm = [item.name.split(" [")[0] for item in comparison.variables if not _depends(item)]
    if calm:
        tables += paragraphs([f"The errors are not seen to go with: {', '.join(calm)}."])
    return tuple(tables)


def _depends(item: ByVariable) -> bool:
    return any(p_value < rules.SURE_OF_LEGS for p_value in item.p_values.values())


def _motions(main: OfLength, leg: str) -> Table:
    rows = [
        [NAMES[kind], *_cells(main.by_motion[kind])]
        for kind in KINDS
        if main.by_motion[kind].figures.count
    ]
    rows.append(["all", *_cells(main.all)])
    return Table(f"Errors of legs of {leg} m (rms)", ("by motion", *_FIGURES), rows)


def _lengths(comparison: Comparison) -> Table:
    rows = [[length_of(item), *_cells(item.all)] for item in comparison.lengths]
    return Table("Errors by length of leg (rms)", ("leg", *_FIGURES), rows)


def _cells(figures: LegFigures) -> list[str]:
    item = figures.figures
    return [
        str(item.count),
        length_told(item.rmse_position_m),
        angle_told(item.rmse_yaw_rad),
        _number(item.nees),
        _percent(item.coverage_95),
    ]


def _runs(comparison: Comparison) -> Table:
    rows = [
        [
            _short(item.run.name),
            f"{item.distance_m:.1f} m",
            f"{item.duration_s:.0f} s",
            length_told(item.end_error_m),
            angle_told(abs(item.end_error_rad)),
            length_told(item.legs.figures.rmse_position_m),
            _number(item.legs.figures.nees),
        ]
        for item in comparison.runs
    ]
    return Table(
        "Runs, dead reckoning begun at the first pose of the reference",
        ("run", "driven", "time", "end error", "heading", "legs", "NEES"),
        rows,
    )


def _short(name: str) -> str:
    return name if len(name) <= 26 else f"{name[:23]}..."


def _variable(item: ByVariable) -> Table:
    name, _, unit = item.name.partition(" [")
    unit = unit.rstrip("]")
    with_it = [channel for channel, p in item.p_values.items() if p < rules.SURE_OF_LEGS]
    angles = item.name.startswith("heading")
    rows = []
    for part in item.bins:
        low, high = part.low, part.high
        if angles:
            low, high = math.degrees(low), math.degrees(high)
        rows.append(
            [
                f"{low:.3g} to {high:.3g}",
                str(part.figures.count),
                length_told(part.mean[0], signed=True),
                length_told(part.mean[1], signed=True),
                angle_told(part.mean[2], signed=True),
                _number(part.figures.nees),
            ]
        )
    heads = ("degrees" if angles else unit or name, "legs", "along", "sideways", "heading", "NEES")
    title = f"Mean errors by {name} ({', '.join(with_it)} {'go' if len(with_it) > 1 else 'goes'}"
    return Table(f"{title} with it)", heads, rows)


def length_told(value: float, *, signed: bool = False) -> str:
    """A length [m] in m or mm; a dash if it is not measured."""
    if not math.isfinite(value):
        return "-"
    sign = "+" if signed else ""
    if abs(value) >= 1.0:
        return f"{value:{sign}.2f} m"
    return f"{1e3 * value:{sign}.1f} mm"


def angle_told(value: float, *, signed: bool = False) -> str:
    """An angle [rad] in degrees; a dash if it is not measured."""
    if not math.isfinite(value):
        return "-"
    return f"{math.degrees(value):{'+' if signed else ''}.2f}°"


def _number(value: float) -> str:
    if not math.isfinite(value):
        return "-"
    return f"{value:.2f}" if value < 100.0 else f"{value:.0f}" if value < 1e5 else f"{value:.0e}"


def _percent(value: float) -> str:
    return f"{100.0 * value:.0f} %" if math.isfinite(value) else "-"
