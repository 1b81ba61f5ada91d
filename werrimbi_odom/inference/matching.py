# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Ticks and reference poses brought onto common nodes, and the run cut into legs.

A reference pose falls between two tick messages. The steps are split there, in counts, in
proportion to time: splitting a step of constant twist changes neither its motion nor its noise.
Everything that is fitted later (radii, separation, noise) acts on these counts, so this is done
once for a run.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.encoder import EncoderLimits, wheel_steps
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

if TYPE_CHECKING:
    from werrimbi_odom.files.run import Reference, Run

QUARTER_TURN = 0.5 * np.pi
"""Turning [rad] that counts as much as one leg length of path."""


@dataclass(frozen=True, slots=True)
class Measured:
    """Reference poses at the legs' ends, shape (m + 1,); NaN where not measured."""

    time: Floats
    x: Floats
    y: Floats
    yaw: Floats

    @property
    def has_position(self) -> NDArray[np.bool_]:
        """Where the position was measured."""
        return np.isfinite(self.x) & np.isfinite(self.y)

    @property
    def has_yaw(self) -> NDArray[np.bool_]:
        """Where the heading was measured."""
        return np.isfinite(self.yaw)


@dataclass(frozen=True, slots=True)
class MatchedRun:
    """One run on common nodes: n steps, m legs."""

    name: str
    time: Floats
    """Stamps of the nodes, shape (n + 1,), [s]."""
    left: Floats
    """Counts of the left wheel in each step, shape (n,)."""
    right: Floats
    """Counts of the right wheel in each step, shape (n,)."""
    ends: NDArray[np.intp]
    """Nodes at which legs begin and end, shape (m + 1,)."""
    measured: Measured
    intervals: Floats
    """Reference intervals in each leg, shape (m,): an incremental reference errs at each."""
    sigma_xy: float | None
    """Noise of the reference's position as the record states it [m]."""
    sigma_yaw: float | None
    """Noise of the reference's heading as the record states it [rad]."""

    @property
    def legs(self) -> int:
        """Number of legs."""
        return self.ends.size - 1


def match(
    run: Run, robot: Robot, leg: float = 1.0, limits: EncoderLimits | None = None
) -> MatchedRun:
    """Split the steps of a run at its reference poses and cut it into legs.

    Parameters
    ----------
    leg : float
        Length of a leg [m]; a quarter turn on the spot counts as much. A leg is at least one
        interval of the reference.

    Raises
    ------
    InputError
        When the run has no reference, or none while the ticks were recorded.
    """
    reference = run.reference
    if reference is None:
        raise InputError(
            f"{run.path}: there is no reference.csv (t_s,x_m,y_m,yaw_rad) to compare with"
        )
    steps = wheel_steps(robot, run.ticks.time, run.ticks.left, run.ticks.right, limits)
    if steps.first_row < 0 or steps.time.size == 0:
        raise InputError(f"{run.path}: fewer than two usable rows of ticks")
    node = np.concatenate([run.ticks.time[[steps.first_row]], steps.time])
    if not (np.diff(node) > 0.0).all():
        raise InputError(
            f"{run.path}: the ticks' clock was set back in mid-run; cut the run there into two"
        )
    usable = _usable(reference, node[0], node[-1])
    if usable.size < 2:
        raise InputError(
            f"{run.path}: fewer than two reference poses between the first tick "
            f"(t_s {node[0]:g}) and the last ({node[-1]:g}); are both clocks the same?"
        )
    time = np.union1d(node, reference.time[usable])
    left = np.diff(np.interp(time, node, _summed(steps.left / robot.left_tick)))
    right = np.diff(np.interp(time, node, _summed(steps.right / robot.right_tick)))
    at = np.searchsorted(time, reference.time[usable])
    chosen = _leg_ends(robot, left, right, at, leg)
    rows = usable[chosen]
    return MatchedRun(
        run.name,
        time,
        left,
        right,
        at[chosen],
        Measured(reference.time[rows], reference.x[rows], reference.y[rows], reference.yaw[rows]),
        np.diff(chosen).astype(np.float64),
        _typical(reference.sigma_xy),
        _typical(reference.sigma_yaw),
    )


def _summed(steps: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(steps)])


def _usable(reference: Reference, first: float, last: float) -> NDArray[np.intp]:
    """Rows with something measured, in the ticks' time, each later than the one before."""
    known = (np.isfinite(reference.x) & np.isfinite(reference.y)) | np.isfinite(reference.yaw)
    rows = np.flatnonzero(known & (reference.time >= first) & (reference.time <= last))
    if rows.size == 0:
        return rows
    latest = np.maximum.accumulate(reference.time[rows])
    later = np.concatenate([[True], reference.time[rows][1:] > latest[:-1]])
    return rows[later]


def _leg_ends(
    robot: Robot, left: Floats, right: Floats, at: NDArray[np.intp], leg: float
) -> NDArray[np.intp]:
    """Indices into `at` at which legs end: every time a leg's worth of travel has gone by."""
    along = 0.5 * (left * robot.left_tick + right * robot.right_tick) / leg
    turned = (right * robot.right_tick - left * robot.left_tick) / robot.track / QUARTER_TURN
    progress = _summed(np.hypot(along, turned))[at]
    progress -= progress[0]
    whole = np.arange(1.0, np.floor(progress[-1] * (1.0 + 1e-12)) + 1.0)
    chosen = np.searchsorted(progress, whole - 1e-12)
    ends = np.unique(np.concatenate([[0], chosen]))
    if ends.size == 1:  # a run shorter than a leg is one leg
        ends = np.array([0, at.size - 1])
    return ends


def _typical(sigma: Floats | None) -> float | None:
    """Root mean square of a stated noise, or None where there is none."""
    if sigma is None or not np.isfinite(sigma).any():
        return None
    return float(np.sqrt(np.nanmean(np.square(sigma))))
