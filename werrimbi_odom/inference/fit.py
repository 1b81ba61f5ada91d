# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum likelihood of calibration, effects and noise from any driving with a reference.

Two blocks that hardly disturb each other are fitted in turn: the knobs (multipliers, parameters of
effects, nuisances of runs) by Gauss-Newton on the whitened innovations, and the four variances on
their likelihood. What the driving does not excite is left as it was.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.knobs import (
    CALIBRATION,
    HEADING_AT_START,
    START_YAW,
    Knob,
    Model,
)
from werrimbi_odom.inference.likelihood import (
    Innovations,
    ReferenceKind,
    Variances,
    innovations,
)
from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.inference.noise import held_variances, likeliest
from werrimbi_odom.inference.prediction import Prediction, predict, relative_poses, seen
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

JUMP = 40.0
"""Squared deviation, in units of what is usual for the run, above which the reference jumped."""

_MEDIAN_CHI2_3 = 2.366
_TAIL = 4.0  # degrees of freedom of the Student-t that weighs legs until the jumps are known


@dataclass(frozen=True, slots=True)
class Point:
    """Where a fit stands: the model, its noise, and the legs on which the reference jumped."""

    model: Model
    variances: Variances
    excluded: tuple[NDArray[np.bool_], ...]


@dataclass(frozen=True, slots=True)
class ModelFit:
    """What a fit found."""

    point: Point
    free: tuple[Knob, ...]
    """Shared knobs that the driving determines, and that were fitted."""
    covariance: Floats
    """Of the values of `free`."""
    mute: tuple[Knob, ...]
    """Shared knobs that the driving does not determine; left alone."""
    at_bound: tuple[Knob, ...]
    """Fitted knobs that ran against what is physically possible."""
    minus_two_log_likelihood: float

    @property
    def robot(self) -> Robot:
        """With everything put in that was determined."""
        return self.point.model.robot


def start_point(
    runs: Sequence[MatchedRun],
    robot: Robot,
    sigma_xy: float | None = None,
    sigma_yaw: float | None = None,
) -> Point:
    """Where a fit begins: the robot as given, no leg excluded, headings from the first legs."""
    guess = (
        max(robot.left_wheel_noise, 1e-5),
        max(robot.right_wheel_noise, 1e-5),
        sigma_xy or 1e-3,
        sigma_yaw or 2e-3,
    )
    own = []
    for run in runs:
        heading = _first_heading(robot, run)
        own.append({} if heading is None else {START_YAW: heading})
    return Point(
        Model(robot, tuple(own)),
        Variances(*(np.array([value**2]) for value in guess)),
        tuple(np.zeros(run.legs, dtype=np.bool_) for run in runs),
    )


def fit_model(
    runs: Sequence[MatchedRun],
    point: Point,
    kind: ReferenceKind = "absolute",
    knobs: Sequence[Knob] = CALIBRATION,
    *,
    sigma_xy: float | None = None,
    sigma_yaw: float | None = None,
    find_jumps: bool = True,
    rounds: int = 3,
) -> ModelFit:
    """Fit knobs and noise to all runs at once.

    Parameters
    ----------
    knobs
        What may be turned; those of the runs' own among them.
    sigma_xy, sigma_yaw : float, optional
        The reference's noise where it is known [m, rad]; else it is estimated.
    find_jumps : bool
        Find the legs on which the reference jumped. Once for a set of runs: what is compared with
        this fit later must leave the same legs out.
    """
    given = point.model
    if find_jumps:
        point = _robustly(runs, point, kind, knobs)
    point = replace(point, variances=held_variances(point.variances, sigma_xy, sigma_yaw))
    held = (sigma_xy is not None, sigma_yaw is not None)
    free, covariance = _shared(knobs), np.zeros((0, 0))
    for _ in range(rounds):
        point = replace(point, variances=likeliest(Costs(runs, point, kind), point.variances, held))
        free, covariance = _determined(runs, point, kind, knobs)
        mute = {knob.name: given.value(knob) for knob in _shared(knobs) if knob not in free}
        point = replace(point, model=point.model.turned(mute, [{}] * len(runs)))
        point = _gauss_newton(runs, point, kind, [*free, *_own(knobs)])
    costs = Costs(runs, point, kind)
    return ModelFit(
        point,
        tuple(free),
        covariance,
        tuple(knob for knob in _shared(knobs) if knob not in free),
        tuple(knob for knob in free if _at_bound(point.model.value(knob), knob)),
        float(costs(point.variances)[0]),
    )


def _shared(knobs: Sequence[Knob]) -> list[Knob]:
    return [knob for knob in knobs if not knob.per_run]


def _own(knobs: Sequence[Knob]) -> list[Knob]:
    return [knob for knob in knobs if knob.per_run]


def _at_bound(value: float, knob: Knob) -> bool:
    low, high = knob.bounds
    margin = 1e-6 * (high - low)
    return value <= low + margin or value >= high - margin


def _robustly(
    runs: Sequence[MatchedRun], point: Point, kind: ReferenceKind, knobs: Sequence[Knob]
) -> Point:
    """Come near the answer whatever the reference's jumps, then find these."""
    for _ in range(12):
        white, slopes, columns = stacked(runs, point, kind, knobs)
        deviation = np.sum(white**2, axis=-1)
        counted = deviation > 0.0
        scale = float(np.median(deviation[counted])) / _MEDIAN_CHI2_3 if counted.any() else 1.0
        point = replace(point, variances=_scaled(point.variances, max(scale, 1e-6)))
        weight = (_TAIL + 3.0) / (_TAIL + deviation / scale)
        step = _solve(white / np.sqrt(scale), slopes / np.sqrt(scale), weight)
        point = replace(point, model=_moved(point.model, columns, step))
        if _small(columns, step):
            break
    return replace(point, excluded=_jumps(runs, point, kind))


def _jumps(
    runs: Sequence[MatchedRun], point: Point, kind: ReferenceKind
) -> tuple[NDArray[np.bool_], ...]:
    found = []
    for index, run in enumerate(runs):
        white, _ = unexpected(run, index, point, kind, np.zeros((run.legs, 3, 0))).whitened()
        deviation = np.sum(white**2, axis=-1)
        usual = max(float(np.median(deviation)) / _MEDIAN_CHI2_3, 1.0)
        found.append(deviation > JUMP * usual)
    return tuple(found)


def _gauss_newton(
    runs: Sequence[MatchedRun], point: Point, kind: ReferenceKind, knobs: Sequence[Knob]
) -> Point:
    for _ in range(6):
        white, slopes, columns = stacked(runs, point, kind, knobs)
        step = _solve(white, slopes, np.ones(white.shape[0]))
        point = replace(point, model=_moved(point.model, columns, step))
        if _small(columns, step):
            break
    return point


def _small(columns: Sequence[tuple[Knob, int]], step: Floats) -> bool:
    scales = np.array([knob.scale for knob, _ in columns])
    return bool(np.all(np.abs(step) < 1e-4 * scales))


@dataclass(frozen=True, slots=True)
class Costs:
    """Minus two log-likelihood of sets of variances, the model being given."""

    runs: Sequence[MatchedRun]
    point: Point
    kind: ReferenceKind

    def predictions(self) -> list[Prediction]:
        """Of all runs."""
        model = self.point.model
        return [
            predict(model.of_run(index), run, model.start_yaw(index))
            for index, run in enumerate(self.runs)
        ]

    def __call__(self, sets: Variances, predictions: list[Prediction] | None = None) -> Floats:
        """Cost of each set."""
        model, total = self.point.model, np.zeros(sets.left.size)
        for index, prediction in enumerate(predictions or self.predictions()):
            robot = model.of_run(index)
            total += innovations(
                robot,
                seen(self.runs[index], view_of(robot.effects)),
                prediction,
                sets,
                self.kind,
                excluded=self.point.excluded[index],
                start_yaw=model.start_yaw(index),
            ).minus_two_log_likelihood()
        return total


def unexpected(
    run: MatchedRun, index: int, point: Point, kind: ReferenceKind, change: Floats
) -> Innovations:
    """Innovations of one run, and their derivatives for changes of its relative poses."""
    robot = point.model.of_run(index)
    heading = point.model.start_yaw(index)
    return innovations(
        robot,
        seen(run, view_of(robot.effects)),
        predict(robot, run, heading),
        point.variances,
        kind,
        change=change,
        excluded=point.excluded[index],
        start_yaw=heading,
    )


def slopes_of_run(run: MatchedRun, index: int, model: Model, knobs: Sequence[Knob]) -> Floats:
    """Derivatives of a run's relative poses in knobs, shape (m, 3, p), by central differences."""
    heading = model.start_yaw(index)
    nothing: list[dict[str, float]] = [{} for _ in model.own]
    columns = []
    for knob in knobs:
        now = model.value(knob, index)
        low, high = knob.bounds
        ahead, behind = min(now + knob.scale, high), max(now - knob.scale, low)
        poses = []
        for value in (ahead, behind):
            if knob.per_run:
                own = [*nothing[:index], {knob.name: value}, *nothing[index + 1 :]]
                tried = model.turned({}, own)
            else:
                tried = model.turned({knob.name: value}, nothing)
            poses.append(relative_poses(tried.of_run(index), run, heading))
        columns.append((poses[0] - poses[1]) / (ahead - behind))
    return np.stack(columns, axis=-1) if columns else np.zeros((run.legs, 3, 0))


def stacked(
    runs: Sequence[MatchedRun], point: Point, kind: ReferenceKind, knobs: Sequence[Knob]
) -> tuple[Floats, Floats, list[tuple[Knob, int]]]:
    """Whitened innovations of all legs (M, 3), derivatives (M, 3, p), and what the p are.

    A shared knob has one column, a knob of the runs' own one for each run (with the run's index).
    """
    shared, own = _shared(knobs), [knob for knob in _own(knobs) if knob.name != START_YAW]
    columns: list[tuple[Knob, int]] = [(knob, -1) for knob in shared]
    values, blocks = [], []
    for index, run in enumerate(runs):
        mine = [knob for knob in own if knob.name in point.model.own[index]]
        change = slopes_of_run(run, index, point.model, [*shared, *mine])
        white, slope = unexpected(run, index, point, kind, change).whitened()
        values.append(white)
        blocks.append((slope, len(columns)))
        columns += [(knob, index) for knob in mine]
        if point.model.start_yaw(index) is not None:
            columns.append((HEADING_AT_START, index))
    wide = np.zeros((sum(block.shape[0] for block, _ in blocks), 3, len(columns)))
    row = 0
    for block, first in blocks:
        rows = slice(row, row + block.shape[0])
        wide[rows, :, : len(shared)] = block[..., : len(shared)]
        rest = block[..., len(shared) :]
        wide[rows, :, first : first + rest.shape[-1]] = rest
        row += block.shape[0]
    return np.concatenate(values), wide, columns


def _solve(white: Floats, slopes: Floats, weight: Floats) -> Floats:
    """Weighted least squares step; directions that nothing excites are not moved."""
    root = np.sqrt(weight)[:, None]
    design = (slopes * root[..., None]).reshape(-1, slopes.shape[-1])
    size = np.sqrt(np.sum(design**2, axis=0))
    size = np.where(size > 0.0, size, 1.0)
    return -np.linalg.lstsq(design / size, (white * root).ravel(), rcond=1e-9)[0] / size


def _moved(model: Model, columns: Sequence[tuple[Knob, int]], step: Floats) -> Model:
    shared: dict[str, float] = {}
    own: list[dict[str, float]] = [{} for _ in model.own]
    for (knob, index), move in zip(columns, step.tolist(), strict=True):
        target = shared if index < 0 else own[index]
        target[knob.name] = float(np.clip(model.value(knob, max(index, 0)) + move, *knob.bounds))
    return model.turned(shared, own)


def _scaled(variances: Variances, factor: float) -> Variances:
    return Variances(
        variances.left * factor,
        variances.right * factor,
        variances.xy * factor,
        variances.yaw * factor,
    )


def _determined(
    runs: Sequence[MatchedRun], point: Point, kind: ReferenceKind, knobs: Sequence[Knob]
) -> tuple[list[Knob], Floats]:
    """Shared knobs that the driving determines, and their covariance."""
    _, slopes, columns = stacked(runs, point, kind, knobs)
    flat = slopes.reshape(-1, slopes.shape[-1])
    kept = list(range(len(columns)))
    while True:
        size = np.sqrt(np.sum(flat[:, kept] ** 2, axis=0))
        heard = size > 1e-9
        scaled = flat[:, kept] / np.where(heard, size, 1.0)
        inverse = np.linalg.pinv(scaled.T @ scaled, rcond=1e-10, hermitian=True)
        covariance = inverse / np.outer(size, size).clip(1e-300)
        spread = np.where(heard, np.sqrt(np.diag(covariance)), np.inf)
        limits = np.array([columns[column][0].undetermined for column in kept])
        shared = np.array([columns[column][1] < 0 for column in kept])
        excess = np.where(shared, spread / limits, 0.0)
        if not kept or excess.max(initial=0.0) <= 1.0:
            count = int(shared.sum())
            names = [columns[column][0] for column in kept[:count]]
            return names, np.asarray(covariance[:count, :count])
        kept.pop(int(np.argmax(excess)))


def _first_heading(robot: Robot, run: MatchedRun) -> float | None:
    """Start heading that turns the first legs onto the measured positions; None where measured."""
    if run.measured.has_yaw[0]:
        return None
    heading, pose, predicted = 0.0, 0j, [0j]
    for x, y, turn in relative_poses(robot, run, 0.0):
        pose += np.exp(1j * heading) * complex(x, y)
        heading += turn
        predicted.append(pose)
    measured = run.measured.x + 1j * run.measured.y
    usable = np.flatnonzero(run.measured.has_position)[:12]
    if usable.size < 2:
        return 0.0
    shape = np.array(predicted)[usable] - predicted[usable[0]]
    return float(np.angle(np.sum(np.conj(shape) * (measured[usable] - measured[usable[0]]))))
