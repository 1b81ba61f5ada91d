# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning of a run with its results: distance, pieces, last pose, and its error."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from werrimbi_odom.files.references.start_pose import StartPose
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.model.covariance import PoseCovariance, carried, sigmas_along_and_across
from werrimbi_odom.model.pose import Floats, Pose, between, compose, wrap
from werrimbi_odom.model.reference_measurement import Path as ShownPath
from werrimbi_odom.model.trajectory import Trajectory

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
        return math.fsum(length for kind in self.pieces.values() for length, _ in kind)

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
        along, across = sigmas_along_and_across(self.covariance, self.final.yaw)
        return along, across, math.sqrt(max(self.covariance.yawyaw, 0.0))

    @cached_property
    def pieces(self) -> dict[str, list[tuple[float, float]]]:
        """Absolute length [m] and turn [rad] of every piece, by kind."""
        found: dict[str, list[tuple[float, float]]] = {kind: [] for kind in KINDS}
        for piece in self.driven.pieces:
            found[piece.kind].append((abs(piece.length), abs(piece.turn)))
        return found


def reckoning_of(
    run: Run, start: StartPose, driven: Trajectory, shown: ShownPath, learnt: tuple[str, ...]
) -> Reckoning:
    """Results of a run that was dead reckoned from `start`.

    `shown` is the predicted output of the reference, and `learnt` are remarks on what was estimated
    from the reference.
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
        elif last == known[0]:
            remarks.append("the reference measured one pose, at which the way is begun, and no end")
        else:
            end = _end_error(reference, start.shown, shown, int(known[0]), last)
    return Reckoning(run, start, driven, shown, end, tuple(remarks))


def _last_row(reference: Reference, known: Any, driven: Trajectory) -> int | None:
    """The last measured row during the ticks; if there is none, one after their end."""
    time = reference.time[known]
    if time[-1] < driven.time[0] or time[0] > driven.time[-1]:
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
    begin, end = (float(reference.time[row]) for row in (first, last))
    covariance = _gained(driven, begin, end, start.yaw)
    return EndError(
        float(reference.time[last]),
        measured,
        float(np.hypot(error[0], error[1])),
        heading,
        _sigmas(error[:2], covariance[:2, :2]),
        _sigmas(np.array([heading]), covariance[2:, 2:]),
    )


def _gained(path: ShownPath, begin: float, end: float, yaw: float) -> Floats:
    """Covariance that the way between two times adds, begun exactly and with heading `yaw`."""
    rows = np.searchsorted(path.time, (begin, end), side="right") - 1
    first, last = np.maximum(rows, 0).tolist()
    before = PoseCovariance(*(float(entry[first]) for entry in path.covariance))
    moved = (float(part[last] - part[first]) for part in (path.x, path.y))
    added = path.covariance.matrix()[last] - carried(before, *moved).matrix()
    turn = yaw - float(path.yaw[first])
    frame = np.eye(3)
    frame[:2, :2] = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
    return np.asarray(frame @ added @ frame.T)


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
