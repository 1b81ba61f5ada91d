# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Figures of the page: paths, legs on the floor, decrease of the error; light and dark.

They are functions from values to figures, testable without a page. Long drives are drawn with fewer
points; all statistics are of the complete data.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import Comparison
from werrimbi_odom.inference.comparison.dead_reckoning import headings_alone, middles
from werrimbi_odom.inference.distributions import CHI2_95
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.report import style
from werrimbi_odom.report.adding.document import ErrorOfModel, error_falling_figure
from werrimbi_odom.report.comparison.document import angle_told, length_told
from werrimbi_odom.report.comparison.phrases import leg_when
from werrimbi_odom.workbench.session import ModelVersion

BUTTONS = ["select2d", "lasso2d", "autoScale2d", "toImage"]
"""Buttons of plotly's tool bar that are removed."""

_COLOURS = re.compile("|".join(style.IN_THE_DARK), re.IGNORECASE)
WIDTH, HEIGHT, EDGE = 720.0, 400.0, 24.0
"""Size and margin of the drawing of the measured paths [pixels]."""

YELLOW = "#E69F00"
CHI2_9999 = np.array([np.inf, 15.136705226623606, 18.420680743952367, 21.107513466160785])
"""99.99 % quantiles of chi-squared, by degrees of freedom."""

CLASSES = (
    ("as promised", style.BLUE, 2.0, "solid"),
    ("more than promised (outside 95 %)", YELLOW, 4.0, "solid"),
    ("far more (outside 99.99 %)", style.ORANGE, 6.5, "solid"),
    ("left out: the reference jumped", style.GREY, 2.0, "dot"),
)

_POINTS = 6000
"""Limit of drawn points of all paths."""

_LEGS = 2000
"""Limit of drawn legs of each class; beyond it (some hours of driving) a regular selection."""

_TEXTS = style.MARKS
"""Limit of legs with hover texts; beyond it those with the largest errors."""


def classes_of(comparison: Comparison) -> NDArray[np.intp]:
    """Index into `CLASSES` of every leg, shape (m,)."""
    errors = comparison.legs.errors
    deviation = np.nan_to_num(errors.deviation)
    grade = (deviation > CHI2_95[errors.freedom]).astype(np.intp)
    grade += deviation > CHI2_9999[errors.freedom]
    return np.asarray(np.where(comparison.legs.outlier, 3, grade))


def floor_figure(comparison: Comparison, which: NDArray[np.bool_] | None = None) -> style.Figure:
    """The legs on the floor, classified by their error relative to the covariance.

    If `which` is given, these legs are highlighted and the rest is faint. Colour, width and dash
    are redundant, so that colour vision is not needed.
    """
    figure = empty_floor()
    lines = _lines(comparison)
    grade = classes_of(comparison)
    if which is not None:
        line: dict[str, object] = {"color": "rgba(128, 128, 128, 0.35)", "width": 1.5}
        style.plot(figure, *_joined(lines, np.flatnonzero(~which)), "other legs", line=line)
    chosen = np.ones(grade.size, dtype=np.bool_) if which is None else which
    for index, (name, colour, width, dash) in enumerate(CLASSES):
        members = np.flatnonzero(chosen & (grade == index))
        if members.size == 0:
            continue
        line = {"color": colour, "width": width, "dash": dash}
        style.plot(figure, *_joined(lines, members), f"{name}: {members.size}", line=line)
    _add_texts(figure, comparison, chosen, grade)
    return figure


def empty_floor() -> style.Figure:
    """An empty floor plan with equal scales, which can be panned."""
    figure = style.from_above(style.blank(), 480, zeroline=False)
    return figure.update_layout(dragmode="pan", margin={"l": 60, "r": 10, "t": 10, "b": 50})


def _add_texts(
    figure: Any, comparison: Comparison, chosen: NDArray[np.bool_], grade: NDArray[np.intp]
) -> None:
    """Add invisible lines through the middles of the legs, with hover texts.

    A line instead of marks is a single element of the page.
    """
    middle = middles(comparison)
    told = np.flatnonzero(chosen & np.isfinite(middle))
    if told.size > _TEXTS:
        told = told[np.argsort(-grade[told], kind="stable")[:_TEXTS]]
    style.plot(
        figure,
        *style.places(middle[told]),
        shown=False,
        hover="%{text}",
        text=[leg_told(comparison, int(index)) for index in told],
        line={"width": 0, "color": "rgba(0, 0, 0, 0)"},
    )


def leg_told(comparison: Comparison, index: int) -> str:
    """Hover text of one leg in two lines."""
    legs = comparison.legs
    run = comparison.runs[legs.run[index]].run.name
    told = ", ".join(f"{name} {size}" for name, size in errors_told(comparison, index).items())
    return (
        f"{style.escaped(run)}, {leg_when(comparison, index)}, {legs.errors.kind[index]}<br>"
        f"measured − predicted: {told}"
    )


def errors_told(comparison: Comparison, index: int) -> dict[str, str]:
    """Errors of one leg by their names, but for what was not measured of any."""
    errors = comparison.legs.errors.error
    told = (("along", length_told), ("sideways", length_told), ("heading", angle_told))
    measured = np.any(np.isfinite(errors), axis=0).tolist()
    return {
        name: words(float(size), signed=True)
        for (name, words), size, known in zip(told, errors[index], measured, strict=True)
        if known
    }


def _lines(comparison: Comparison) -> list[tuple[Floats, Floats]]:
    """The path of every leg, thinned out: measured, or the model's where only headings are."""
    legs, paths, unseen = comparison.legs, comparison.paths, headings_alone(comparison)
    total = sum(path.measured.size for path in paths)
    every = max(1, total // _POINTS)
    lines = []
    for run, begin, end in zip(legs.run, legs.start_time, legs.end_time, strict=True):
        path = paths[int(run)]
        way = path.predicted if int(run) in unseen else path.measured
        first, last = np.searchsorted(path.time, [begin, end])
        places = np.unique(np.append(np.arange(first, last + 1, every), last))
        points = way[places[places < way.size]]
        points = points[np.isfinite(points)]
        lines.append((points.real, points.imag))
    return lines


def _joined(
    lines: list[tuple[Floats, Floats]], which: NDArray[np.intp]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Lines in sequence, separated by NaN."""
    gap = np.array([np.nan])
    if which.size > _LEGS:
        which = which[np.linspace(0, which.size - 1, _LEGS).astype(np.intp)]
    parts = [lines[int(index)] for index in which]
    if not parts:
        return style.small(np.empty(0)), style.small(np.empty(0))
    return (
        style.small(np.concatenate([piece for x, _ in parts for piece in (x, gap)])),
        style.small(np.concatenate([piece for _, y in parts for piece in (y, gap)])),
    )


def gain_figure(steps: Sequence[ModelVersion]) -> style.Figure:
    """Errors of held-out and fitted drives, and the error of the former by noise alone."""
    added = steps[-1].added
    floor = added.noise_alone(added.holdout) if added and added.explained else math.nan
    errors = [
        ErrorOfModel(
            step.name if step.added is None else f"+ {step.name}",
            step.look.train_error,
            step.look.holdout_error,
            step.look.unit,
        )
        for step in steps
    ]
    return error_falling_figure(errors, floor).update_layout(height=380, dragmode=False)


def measured_drawing(runs: Sequence[Run]) -> str | None:
    """The paths from above (SVG) with a scale bar; None if no positions were measured.

    It needs no JavaScript, so it is visible while plotly.js loads.
    """
    paths = [places for run in runs if (places := _places(run)).size]
    if not paths:
        return None
    every = np.concatenate(paths)
    low = complex(every.real.min(), every.imag.min())
    size = complex(every.real.max(), every.imag.max()) - low
    scale = min(
        (WIDTH - 2 * EDGE) / max(size.real, 1e-9), (HEIGHT - 3 * EDGE) / max(size.imag, 1e-9), 1e6
    )
    left = 0.5 * (WIDTH - scale * size.real)
    most = max(style.FEWEST, _POINTS // 2 // len(paths))
    lines = "".join(
        f"M{' '.join(f'{x:.1f} {y:.1f}' for x, y in _drawn(places, most, low, scale, left))}"
        for places in paths
    )
    bar = _round(0.25 * WIDTH / scale)
    end = EDGE + bar * scale
    return (
        f'<svg class="measured" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" '
        'aria-label="The measured paths from above" fill="none" stroke-linejoin="round" '
        f'font-size="14"><path d="{lines}" stroke="var(--grey)" stroke-width="1.5"/>'
        f'<path d="M{EDGE:g} {HEIGHT - 10:g}H{end:.1f}" stroke="currentColor" stroke-width="3"/>'
        f'<text x="{end + 8:.1f}" y="{HEIGHT - 5:g}" fill="currentColor">{bar:g} m</text></svg>'
    )


def _places(run: Run) -> NDArray[np.complex128]:
    if run.reference is None:
        return np.empty(0, dtype=np.complex128)
    places = run.reference.x + 1j * run.reference.y
    return np.asarray(places[np.isfinite(places)], dtype=np.complex128)


def _drawn(
    places: NDArray[np.complex128], most: int, low: complex, scale: float, left: float
) -> list[tuple[float, float]]:
    at = scale * (places[style.along_path(places, most)] - low)
    y = HEIGHT - 2 * EDGE - at.imag
    return list(zip((left + at.real).tolist(), y.tolist(), strict=True))


def _round(length: float) -> float:
    """Largest of 1, 2 or 5 times a power of ten that is not longer."""
    ten = 10.0 ** math.floor(math.log10(length))
    return next(step * ten for step in (5.0, 2.0, 1.0) if step * ten <= length * (1.0 + 1e-9))


def shown(figure: style.Figure | str, dark: bool) -> dict[str, Any]:
    """A figure (or its JSON) for plotly.js; in the dark theme its colours are replaced."""
    words = figure if isinstance(figure, str) else str(figure.to_json())
    if dark:
        words = _COLOURS.sub(lambda found: style.IN_THE_DARK[found.group().upper()], words)
    drawn: dict[str, Any] = json.loads(words)
    if dark:
        for name, axis in drawn["layout"].items():
            if name.startswith("coloraxis") and not axis.get("meta"):
                axis["reversescale"] = True  # the high end of the scale contrasts with the page
    drawn["config"] = {
        "displaylogo": False,
        **style.KEPT_HERE,
        "responsive": True,
        "modeBarButtonsToRemove": BUTTONS,
        "scrollZoom": True,
    }
    return drawn
