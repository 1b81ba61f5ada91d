# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Dead reckoning along every pose of the reference, and its difference to the measurement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import START_YAW, Model
from werrimbi_odom.inference.fitting.prediction import predicted_legs, right_handed
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats, wrap_all

Measure = Literal["pose", "position", "heading"]
"""Quantity that the reference measures at both ends of a leg."""


@dataclass(frozen=True, slots=True)
class Residual:
    """Measured and predicted path of one run, at every reference pose; arrays of shape (n,)."""

    time: Floats
    """Stamps of the reference [s]."""
    measured: NDArray[np.complex128]
    """x + iy in a right-handed frame; NaN where not measured [m]."""
    measured_yaw: Floats
    predicted: NDArray[np.complex128]
    """Dead reckoning of the reference's point from the first pose, with fitted start heading
    [m]."""
    predicted_yaw: Floats
    """In the reference's frame [rad]."""
    intervals: Floats
    """Measured minus predicted relative pose of each interval, shape (n - 1, 3)."""
    relative: Floats
    """Predicted relative pose of each interval, shape (n - 1, 3)."""

    @property
    def coordinates(self) -> tuple[int, int]:
        """Number of measured coordinates of positions, and of measured headings."""
        places, headings = (np.isfinite(each).sum() for each in (self.measured, self.measured_yaw))
        return 2 * int(places), int(headings)


def measured_alike(run: Run) -> tuple[Run, Measure]:
    """Quantity that most rows of the reference measure, and the run restricted to these rows.

    If all rows do, the run itself is returned. Positions without headings keep the heading of the
    first row if it was measured.
    """
    reference = run.reference
    if reference is None:
        return run, "pose"  # matching raises the error
    position, yaw = reference.has_position, reference.has_yaw
    both = position & yaw
    if both.sum() >= max(2, rules.POSE_ROWS * max(position.sum(), yaw.sum())):
        whole = bool(both.all())
        return run if whole else replace(run, reference=reference.chosen(both)), "pose"
    if position.sum() >= max(2, yaw.sum()):
        kept = reference.chosen(position)
        start = np.where(np.arange(kept.yaw.size) == 0, kept.yaw, np.nan)
        return replace(run, reference=replace(kept, yaw=start)), "position"
    headings = reference.chosen(yaw)
    unknown = np.full(headings.time.size, np.nan)
    return replace(run, reference=replace(headings, x=unknown, y=unknown)), "heading"


def residuals_of(
    model: Model,
    every: Concatenated,
    measure: Measure,
    pieces: Sequence[NDArray[np.intp]] | None = None,
) -> tuple[tuple[Residual, ...], Model]:
    """Dead reckoning along every reference pose and its difference to the measurement, run by run.

    `model`: the model. `every`: runs from `legs.cutting.every_pose`. `measure`: quantity that the
    reference measures. Result: residuals of each run, and the model with the start heading of
    each run. Where only positions are measured and the model has none, it is the one that best
    aligns the whole path with them. `pieces`: of each run, what its poses are of
    (`reference_jumps.pieces_between`): a jump of the reference turns no robot.
    """
    view = view_of(model.robot.effects)
    relative = predicted_legs(model, every)
    if measure == "position":
        model = _with_headings(model, every, relative, pieces)
        relative = predicted_legs(model, every)
    found = []
    for index, run in enumerate(every.runs):
        own = slice(every.legs[index], every.legs[index + 1])
        poses = np.stack([run.measured.x, run.measured.y, run.measured.yaw], axis=-1)
        poses = right_handed(poses, view)
        given = model.start_yaw(index)
        heading = float(poses[0, 2]) if given is None else given
        found.append(_residual(run.measured.time, poses, relative[own], heading, measure))
    return tuple(found), model


def _with_headings(
    model: Model,
    every: Concatenated,
    relative: Floats,
    pieces: Sequence[NDArray[np.intp]] | None,
) -> Model:
    mirror = -1.0 if view_of(model.robot.effects).mirrored else 1.0
    own: list[dict[str, float]] = []
    for index, run in enumerate(every.runs):
        known = model.start_yaw(index) is not None or np.isfinite(run.measured.yaw[0])
        legs = slice(every.legs[index], every.legs[index + 1])
        measured = run.measured.x + 1j * mirror * run.measured.y
        shape = chained(relative[legs])[0]
        of = None if pieces is None else pieces[index]
        own.append({} if known else {START_YAW: fitted_heading(shape, measured, of)})
    return model.turned({}, own)


def _residual(
    time: Floats, poses: Floats, relative: Floats, heading: float, measure: Measure
) -> Residual:
    predicted, yaw = chained(relative)
    measured = poses[:, 0] + 1j * poses[:, 1]
    begin = 0j if measure == "heading" else measured[0]
    facing = poses[:, 2]
    if measure == "position":
        facing = _facing(predicted, yaw, measured, heading)
    moved = np.exp(-1j * facing[:-1]) * np.diff(measured)
    turned = np.full(yaw.size - 1, np.nan)
    if measure != "position":
        turned = wrap_all(np.diff(poses[:, 2]) - relative[:, 2])
    return Residual(
        time,
        measured,
        poses[:, 2],
        begin + np.exp(1j * heading) * predicted,
        heading + yaw,
        np.stack([moved.real - relative[:, 0], moved.imag - relative[:, 1], turned], axis=-1),
        relative,
    )


def chained(relative: Floats) -> tuple[NDArray[np.complex128], Floats]:
    """Compose relative poses (m, 3) to positions and headings from the origin; (m + 1,)."""
    yaw = np.concatenate([[0.0], np.cumsum(relative[:, 2])])
    steps = np.exp(1j * yaw[:-1]) * (relative[:, 0] + 1j * relative[:, 1])
    return np.concatenate([[0j], np.cumsum(steps)]), yaw


def fitted_heading(
    predicted: NDArray[np.complex128],
    measured: NDArray[np.complex128],
    pieces: NDArray[np.intp] | None = None,
) -> float:
    """Start heading that best aligns the predicted path with the measured one, piece by piece."""
    of = np.zeros(measured.size, dtype=np.intp) if pieces is None else pieces
    rows = np.flatnonzero(np.isfinite(measured) & (of >= 0))
    _, first, piece = np.unique(of[rows], return_index=True, return_inverse=True)
    path, seen = (each[rows] - each[rows][first][piece] for each in (predicted, measured))
    return float(np.angle(np.sum(np.conj(path) * seen)))


def _facing(
    predicted: NDArray[np.complex128], yaw: Floats, measured: NDArray[np.complex128], heading: float
) -> Floats:
    """Heading at each pose, by the chord of the path around it.

    Where the robot reverses, that is short: there, by the longer half of it.
    """
    index = np.arange(measured.size)
    low = np.maximum(index - rules.FACING_POSES, 0)
    high = np.minimum(index + rules.FACING_POSES, index.size - 1)
    begin, end = np.stack([low, low, index]), np.stack([high, index, high])
    chord = predicted[end] - predicted[begin]
    length = np.abs(chord) * np.array([2.0, 1.0, 1.0])[:, None]
    taken = np.argmax(length, axis=0), index
    chord, seen_chord = chord[taken], (measured[end] - measured[begin])[taken]
    off = np.angle(seen_chord * np.conj(chord))
    usable = (np.abs(chord) > 0.0) & (np.abs(seen_chord) > 0.0)
    return yaw + np.where(usable, off, heading)
