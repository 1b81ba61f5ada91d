# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A run on one clock, and its legs: steps split at reference poses.

A reference pose falls between two tick messages. Steps are split there, in counts, so that
splitting a step changes neither its motion nor its noise. Everything that is fitted later (radii,
base, effects, noise) acts on these counts. So a run is split once, and again only when the
reference's clock is shifted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Reference
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.legs.count_interpolation import Counters, nodes_at
from werrimbi_odom.inference.legs.gaps import LeftOut, touched
from werrimbi_odom.model.drive import Span
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View


@dataclass(frozen=True, slots=True)
class AlignedRun:
    """A run on one clock: counters, r usable reference poses, excluded stretches."""

    name: str
    counters: Counters
    measured: Reference
    """Usable poses, shape (r,), at the times at which they were seen."""
    delay: float
    """Delay of the reference by the robot that the run is cut by, which its times are free of
    [s]."""
    gap: NDArray[np.bool_]
    """Excluded intervals between poses, shape (r - 1,)."""
    stray: NDArray[np.bool_]
    """Poses that are wrong for themselves alone, at which no leg begins or ends; shape (r,)."""
    left_out: tuple[LeftOut, ...]
    sigma_xy: float | None
    """Stated standard deviation of the usable poses' position [m]."""
    sigma_yaw: float | None
    """Stated standard deviation of their heading [rad]."""
    happened: tuple[tuple[float, float], ...] = ()
    """See `Run.happened`; free of the delay, as `measured`."""
    at_rest: tuple[float, float, float] | None = None
    """See `Run.at_rest`."""
    lost: tuple[tuple[float, float], ...] = ()
    """Stretches in which the reference was lost, free of the delay: `Run.taken_out` but for what
    is put aside."""
    noise_shares: tuple[float, float] = (1.0, 1.0)
    """Noise of its positions and headings, in shares of the noisiest run's beside it."""


@dataclass(frozen=True, slots=True)
class MatchedRun:
    """A run on common nodes: n steps, m legs."""

    record: AlignedRun
    rows: NDArray[np.intp]
    """Poses of the record at which legs begin and end, shape (m + 1,)."""
    measured: Reference
    """These poses."""
    gap: NDArray[np.bool_]
    """Legs that are gaps, as they overlap an excluded stretch; shape (m,)."""
    delay: float
    """Delay of the reference: what it stamps t was seen at t - delay, but for `clock_drift` [s]."""
    time: Floats
    """Stamps of the nodes, shape (n + 1,), [s]."""
    left: Floats
    """Counts of the left wheel in each step, shape (n,)."""
    right: Floats
    """Counts of the right wheel in each step, shape (n,)."""
    ends: NDArray[np.intp]
    """Nodes at which legs begin and end, shape (m + 1,)."""
    channels: Mapping[str, Span[Floats]]
    """Extra measured channels, at the start and end of each step."""
    clock_drift: float = 0.0
    """Growth of that delay along the drive [s/s] (`View.late`)."""

    @property
    def name(self) -> str:
        """Name of the run."""
        return self.record.name

    @property
    def counters(self) -> Counters:
        """Encoder counts."""
        return self.record.counters

    @property
    def sigma_xy(self) -> float | None:
        """Stated standard deviation of the reference's position [m]."""
        return self.record.sigma_xy

    @property
    def sigma_yaw(self) -> float | None:
        """Stated standard deviation of the reference's heading [rad]."""
        return self.record.sigma_yaw

    @property
    def intervals(self) -> Floats:
        """Reference intervals in each leg, shape (m,): each adds an incremental error."""
        return np.diff(self.rows).astype(np.float64)

    @property
    def stepped(self) -> NDArray[np.bool_]:
        """Legs with an abrupt event, whose end pose may therefore be anything; shape (m,)."""
        return touched(self.measured.time, self.record.happened)

    @property
    def lost(self) -> NDArray[np.bool_]:
        """Gaps in which the reference may have lost the robot; shape (m,).

        It has not where a stretch was only taken out, to be judged by.
        """
        parts = [(part.begin, part.end) for part in self.record.left_out]
        return self.gap & touched(self.measured.time, parts)

    @property
    def legs(self) -> int:
        """Number of legs, including those marked as gaps."""
        return self.ends.size - 1


def at_edges(runs: Sequence[MatchedRun]) -> tuple[NDArray[np.bool_], ...]:
    """Legs of each run that a clock shift could move outside the ticks; all False if legs are few.

    Beyond the ends of the record the motion is unknown. If it begins or ends in motion, these legs
    would count against a delay even if that is true. By headings alone they stay where it begins or
    ends at rest: a rest is what tells a gyro's drift from a robot that veers.
    """
    found = []
    for run in runs:
        first, last = run.counters.time[0], run.counters.time[-1]
        begin, end = run.measured.time[:-1], run.measured.time[1:]
        gyro = not run.measured.has_position.any()
        early, late = (
            not gyro or _moves(run.counters, begun) for begun in (first, last - rules.EDGE)
        )
        outside = (early & (begin < first + rules.EDGE)) | (late & (end > last - rules.EDGE))
        found.append(outside if run.legs > rules.EDGE_LEGS else np.zeros(run.legs, dtype=np.bool_))
    return tuple(found)


def _moves(counters: Counters, begin: float) -> bool:
    """Whether a wheel turns by more than its rounding within `EDGE` from a time on."""
    turned = np.diff(counters.at(np.array([begin, begin + rules.EDGE])), axis=0)
    return bool(np.abs(turned).max() > 1.0)


def divided(record: AlignedRun, rows: NDArray[np.intp]) -> MatchedRun:
    """Cut a record at the given reference poses."""
    measured = _poses_at(record.measured, rows)
    time, left, right, ends, channels = nodes_at(record.counters, measured.time)
    gap = _gaps_between(record, rows)
    return MatchedRun(record, rows, measured, gap, record.delay, time, left, right, ends, channels)


def joined(run: MatchedRun, rows: NDArray[np.intp]) -> MatchedRun:
    """Merge legs: keep the nodes, with legs between the given poses only."""
    return replace(
        run,
        rows=rows,
        measured=_poses_at(run.record.measured, rows),
        gap=_gaps_between(run.record, rows),
        ends=run.ends[np.searchsorted(run.rows, rows)],
    )


def delayed(run: MatchedRun, delay: float, clock_drift: float = 0.0) -> MatchedRun:
    """Same legs with another delay of the reference [s], and another growth of it [s/s]."""
    if (delay, clock_drift) == (run.delay, run.clock_drift):
        return run
    counters = run.counters
    stamps = run.measured.time + run.record.delay
    late = View(delay=delay, clock_drift=clock_drift).late(stamps - counters.time[0])
    seen = np.clip(stamps - late, counters.time[0], counters.time[-1])
    time, left, right, ends, channels = nodes_at(counters, np.maximum.accumulate(seen))
    return replace(
        run,
        delay=delay,
        clock_drift=clock_drift,
        time=time,
        left=left,
        right=right,
        ends=ends,
        channels=channels,
    )


def _gaps_between(record: AlignedRun, rows: NDArray[np.intp]) -> NDArray[np.bool_]:
    before = np.concatenate([[0], np.cumsum(record.gap)])
    return np.asarray(np.diff(before[rows]) > 0)


def _poses_at(reference: Reference, rows: NDArray[np.intp]) -> Reference:
    return reference.chosen(rows) if rows.size < reference.time.size else reference


def typical_sigma(sigma: Floats | None) -> float | None:
    """Root mean square of a stated noise; None if there is none."""
    if sigma is None or not np.isfinite(sigma).any():
        return None
    return float(np.sqrt(np.nanmean(np.square(sigma))))
