# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of `werrimbi odom` on a run: in words, as JSON, and as a figure."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.model.pose import Pose, wrap
from werrimbi_odom.report.dead_reckoning_summary import EndError, Reckoning
from werrimbi_odom.report.document import Document, Shown, Table
from werrimbi_odom.report.number_format import counted, picked
from werrimbi_odom.report.path_figure import PathDrawing, path_figure, spread_along_path


def json_of(found: Reckoning) -> dict[str, Any]:
    """Complete result for --json."""
    return {
        **picked(found, "run:run.path distance_m:distance duration_s:duration"),
        "pieces": {
            kind: {
                "count": len(pieces),
                "length_m": math.fsum(length for length, _ in pieces),
                "turn_rad": math.fsum(turn for _, turn in pieces),
            }
            for kind, pieces in found.pieces.items()
        },
        "start": {**picked(found.start.pose, _POSE), "says": found.start.told},
        "final": {
            "t_s": float(found.driven.time[-1]),
            **picked(found.final, _POSE),
            **dict(zip(_SIGMAS, found.sigmas, strict=True)),
            "covariance": found.covariance._asdict(),
        },
        "rows": found.driven.tally.as_dict(),
        **_end_json(found.end_error),
        "notes": [*found.run.notes, *found.remarks],
    }


def _rows(found: Reckoning) -> Iterator[tuple[str, str]]:
    """Rows of the table on the terminal."""
    yield "distance", f"{found.distance:.3f} m in {found.duration:.1f} s"
    counts = (counted(len(pieces), kind) for kind, pieces in found.pieces.items())
    yield "pieces", ", ".join(counts)
    yield "start", f"{_told(found.start.pose)}: {found.start.told}"
    yield "final pose", _told(found.final)
    along, across, heading = found.sigmas
    yield (
        "its 1σ",
        f"{1e3 * along:.1f} mm along, {1e3 * across:.1f} mm across, "
        f"{math.degrees(heading):.2f}° in heading",
    )
    yield "rows of ticks", rows_told(found.driven.tally.as_dict())
    end = found.end_error
    if end is not None:
        yield "measured", f"{_told(end.measured)} at {end.time:.3f} s"
        yield "error", "; ".join(_errors_told(end))
    for note in (*found.run.notes, *found.remarks):
        yield "note", note


def rows_told(tally: dict[str, int]) -> str:
    """Number of rows, how many were used, and what was wrong with how many."""
    events = {
        "duplicates": "with the stamp of the one before",
        "out_of_order": "late",
        "not_finite": "not finite",
        "implausible": "implausible",
        "clock_jumps": "clock jumps",
        "gaps": "gaps",
        "wraps": "wraps",
        "resets": "resets",
        "jumps": "jumps",
    }
    told = [f"{tally[name]} {words}" for name, words in events.items() if tally[name]]
    return ", ".join([str(tally["messages"]), f"{tally['accepted']} used", *told])


def _errors_told(end: EndError) -> Iterator[str]:
    if math.isfinite(end.position):
        yield f"{end.position:.4f} m{_in_sigmas(end.position_sigmas)}"
    if math.isfinite(end.heading):
        yield f"{math.degrees(end.heading):+.2f}°{_in_sigmas(end.heading_sigmas)} in heading"


def _in_sigmas(number: float) -> str:
    return f" ({number:.1f} σ)" if math.isfinite(number) else ""


def _told(pose: Pose) -> str:
    parts = []
    if math.isfinite(pose.x) and math.isfinite(pose.y):
        parts.append(f"x {pose.x:.3f} m, y {pose.y:.3f} m")
    if math.isfinite(pose.yaw):
        parts.append(f"heading {math.degrees(wrap(pose.yaw)):.2f}°")
    return ", ".join(parts)


_POSE = "x_m:x y_m:y yaw_rad:yaw"
_SIGMAS = ("sigma_along_m", "sigma_across_m", "sigma_yaw_rad")


def _end_json(end: EndError | None) -> dict[str, Any]:
    if end is None:
        return dict.fromkeys(("reference_last", "end_error_m", "end_error_rad"))
    return {
        "reference_last": {"t_s": end.time, **picked(end.measured, _POSE)},
        **picked(end, "end_error_m:position end_error_rad:heading"),
        **picked(end, "end_error_position_sigmas:position_sigmas"),
        **picked(end, "end_error_heading_sigmas:heading_sigmas"),
    }


_POINTS = 2000  # points of the drawn path


def document_of(found: Reckoning, robot: Path) -> Document:
    """The complete report; `robot` is the path of the robot file."""
    title = f"{found.run.name}: wheel odometry"
    table = Table(f"{title} of {robot}", (), list(_rows(found)))
    return Document(title=title, words=[table], draw=lambda: [_path(found)])


def _path(found: Reckoning) -> Shown:
    driven, reference = found.driven, found.run.reference
    some = np.concatenate([[0], spread_along_path(driven.x, driven.y, _POINTS)])
    drawing = PathDrawing(
        driven.x[some],
        driven.y[some],
        driven.covariance.matrix()[some][:, :2, :2],
        *((None, None) if reference is None else (reference.x, reference.y)),
    )
    see = (
        "Ellipses hold the robot 95 times in 100, if the model is right: what was measured should "
        "lie in them."
    )
    return Shown("path", "The path, and how sure it is", see, {"": path_figure(drawing)})
