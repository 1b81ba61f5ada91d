# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Report of `werrimbi odom` on a run: distance, pieces, last pose, and its error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.files.start_pose import StartPose
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.pose import Floats, Pose, between, compose, wrap
from werrimbi_odom.model.reference_measurement import Path as ShownPath
from werrimbi_odom.model.trajectory import Trajectory
from werrimbi_odom.report.document import Document, Shown, Table
from werrimbi_odom.report.numbers import counted, picked
from werrimbi_odom.report.path_figure import PathDrawing, path_figure, spread_along_path

KINDS = ("line", "arc", "spin")
_NO_MOTION = 1e-3
"""Travel [m] or turn [rad] below which motion is not reported."""


@dataclass(frozen=True)
class EndError:
    """Error of odometry at the last measured pose of the reference; NaN if not measured."""

    time: float
    """Time of that pose [s]."""
    measured: Pose
    position: float
    """Position error [m]."""
    heading: float
    """Heading error, measured minus odometry [rad]."""
    position_sigmas: float
    """Mahalanobis distance of the position error."""
    heading_sigmas: float


@dataclass(frozen=True)
class Reckoning:
    """A dead-reckoned run, with its results."""

    run: Run
    start: StartPose
    driven: Trajectory
    shown: ShownPath
    """Predicted output of the reference along the path."""
    end_error: EndError | None
    remarks: tuple[str, ...]

    @property
    def distance(self) -> float:
        """Travel of the axle's midpoint, forwards and backwards added [m]."""
        return math.fsum(length for kind in self._pieces.values() for length, _ in kind)

    @property
    def duration(self) -> float:
        """Time between used rows, without steps of a clock that was set back [s]."""
        return float(np.sum(np.maximum(np.diff(self.driven.time), 0.0)))

    @property
    def final(self) -> Pose:
        """The last pose; yaw wrapped to half a turn."""
        driven = self.driven
        return Pose(float(driven.x[-1]), float(driven.y[-1]), wrap(float(driven.yaw[-1])))

    @property
    def covariance(self) -> PoseCovariance[float]:
        """Covariance of the last pose."""
        return PoseCovariance(*(float(entry[-1]) for entry in self.driven.covariance))

    @property
    def sigmas(self) -> tuple[float, float, float]:
        """Standard deviations along the heading and across it [m], and of the heading [rad]."""
        cos, sin = math.cos(self.final.yaw), math.sin(self.final.yaw)
        p = self.covariance
        along = cos * cos * p.xx + 2.0 * cos * sin * p.xy + sin * sin * p.yy
        across = sin * sin * p.xx - 2.0 * cos * sin * p.xy + cos * cos * p.yy
        along, across, yaw = (math.sqrt(max(each, 0.0)) for each in (along, across, p.yawyaw))
        return along, across, yaw

    @cached_property
    def _pieces(self) -> dict[str, list[tuple[float, float]]]:
        """Absolute length [m] and turn [rad] of every piece, by kind."""
        found: dict[str, list[tuple[float, float]]] = {kind: [] for kind in KINDS}
        for piece in self.driven.pieces:
            found[piece.kind].append((abs(piece.length), abs(piece.turn)))
        return found

    def as_json(self) -> dict[str, Any]:
        """Complete result for --json."""
        return {
            **picked(self, "run:run.path distance_m:distance duration_s:duration"),
            "pieces": {
                kind: {
                    "count": len(pieces),
                    "length_m": math.fsum(length for length, _ in pieces),
                    "turn_rad": math.fsum(turn for _, turn in pieces),
                }
                for kind, pieces in self._pieces.items()
            },
            "start": {**picked(self.start.pose, _POSE), "says": self.start.told},
            "final": {
                "t_s": float(self.driven.time[-1]),
                **picked(self.final, _POSE),
                **dict(zip(_SIGMAS, self.sigmas, strict=True)),
                "covariance": self.covariance._asdict(),
            },
            "rows": self.driven.tally.as_dict(),
            **_end_json(self.end_error),
            "notes": [*self.run.notes, *self.remarks],
        }

    def rows(self) -> Iterator[tuple[str, str]]:
        """Rows of the table on the terminal."""
        yield "distance", f"{self.distance:.3f} m in {self.duration:.1f} s"
        counts = (counted(len(pieces), kind) for kind, pieces in self._pieces.items())
        yield "pieces", ", ".join(counts)
        yield "start", f"{_told(self.start.pose)}: {self.start.told}"
        yield "final pose", _told(self.final)
        along, across, heading = self.sigmas
        yield (
            "its 1σ",
            f"{1e3 * along:.1f} mm along, {1e3 * across:.1f} mm across, "
            f"{math.degrees(heading):.2f}° in heading",
        )
        yield "rows of ticks", _rows_told(self.driven.tally.as_dict())
        end = self.end_error
        if end is not None:
            yield "measured", f"{_told(end.measured)} at {end.time:.3f} s"
            yield "error", "; ".join(_errors_told(end))
        for note in (*self.run.notes, *self.remarks):
            yield "note", note


def reckoning_of(
    run: Run, start: StartPose, driven: Trajectory, shown: ShownPath, learnt: tuple[str, ...] = ()
) -> Reckoning:
    """Results of a run that was dead reckoned from `start`.

    Parameters
    ----------
    shown : ShownPath
        Predicted output of the reference.
    learnt : tuple of str
        Remarks on what was estimated from the reference.
    """
    reference, remarks, end = run.reference, [*learnt], None
    if reference is not None:
        known = np.flatnonzero(reference.has_position | reference.has_yaw)
        if known.size:
            remarks += _late_or_early(reference, known, driven)
            last = _last_row(reference, known, driven)
        if known.size == 0:
            remarks.append("the reference measured nothing")
        elif driven.tally.clock_jumps:
            remarks.append("the ticks' clock was set back, so poses of one time cannot be compared")
        elif last is None:
            remarks.append("reference and ticks have no time in common; are both clocks the same?")
        else:
            end = _end_error(reference, start.shown, shown, int(known[0]), last)
    return Reckoning(run, start, driven, shown, end, tuple(remarks))


def _last_row(reference: Reference, known: Any, driven: Trajectory) -> int | None:
    """The last measured row during the ticks; if there is none, one after their end."""
    time = reference.time[known]
    if known.size < 2 or time[-1] < driven.time[0] or time[0] > driven.time[-1]:
        return None
    during = known[(time <= driven.time[-1]) & (time > time[0])]
    return int(during[-1] if during.size else known[-1])


def _end_error(
    reference: Reference, start: Pose, driven: ShownPath, first: int, last: int
) -> EndError:
    """Error relative to the first row of the reference, which may start late."""
    measured = Pose(*(float(part[last]) for part in (reference.x, reference.y, reference.yaw)))
    moved = between(_pose_at(driven, reference.time[first]), _pose_at(driven, reference.time[last]))
    reckoned = compose(start, moved)
    error = np.array(measured) - np.array(reckoned)
    heading = wrap(float(error[2])) if math.isfinite(error[2]) else math.nan
    at = max(int(np.searchsorted(driven.time, reference.time[last], side="right")) - 1, 0)
    covariance = np.asarray(driven.covariance.matrix()[at])
    return EndError(
        float(reference.time[last]),
        measured,
        float(np.hypot(error[0], error[1])),
        heading,
        _sigmas(error[:2], covariance[:2, :2]),
        _sigmas(np.array([heading]), covariance[2:, 2:]),
    )


def _pose_at(path: Trajectory | ShownPath, time: float) -> Pose:
    return Pose(*(float(np.interp(time, path.time, part)) for part in (path.x, path.y, path.yaw)))


def _sigmas(error: Floats, covariance: Floats) -> float:
    """Mahalanobis distance; NaN for missing measurements or a singular covariance."""
    if not np.isfinite(error).all():
        return math.nan
    spread, axes = np.linalg.eigh(covariance)
    if spread[-1] <= 0.0 or spread[0] <= 1e-12 * spread[-1]:
        return math.nan
    return float(np.sqrt(np.sum(np.square(error @ axes) / spread)))


def _late_or_early(reference: Reference, known: Any, driven: Trajectory) -> Iterator[str]:
    """Remarks if the first measured pose is not at the first row of ticks."""
    begin = float(reference.time[known[0]])
    before = between(_pose_at(driven, driven.time[0]), _pose_at(driven, begin))
    if max(math.hypot(before.x, before.y), abs(before.yaw)) > _NO_MOTION:
        yield (
            f"the reference begins {begin - driven.time[0]:.2f} s after the ticks, when the robot "
            f"had gone {math.hypot(before.x, before.y):.3f} m; its first pose stands at the first "
            "row all the same"
        )
    early = known[reference.has_position[known] & (reference.time[known] <= driven.time[0])]
    if early.size:
        begin_and_end = early[[0, -1]]
        carried = np.hypot(*(np.ptp(part[begin_and_end]) for part in (reference.x, reference.y)))
        if carried > 10.0 * _NO_MOTION:
            yield f"the reference moved {carried:.3f} m before the first row of ticks"


def _rows_told(tally: dict[str, int]) -> str:
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
    table = Table(f"{title} of {robot}", (), list(found.rows()))
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
