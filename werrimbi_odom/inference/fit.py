# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Maximum likelihood of calibration and noise from any driving with a reference.

Two blocks that hardly disturb each other are fitted in turn: the three multipliers by Gauss-Newton
on the whitened innovations, and the four variances (two wheels, the reference's position and
heading) on their likelihood. What the driving does not excite is left as it was.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.likelihood import (
    Innovations,
    ReferenceKind,
    Variances,
    innovations,
)
from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.inference.prediction import calibration_changes, predict, sensitivity
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

MULTIPLIERS = (
    "wheel_separation_multiplier",
    "left_wheel_radius_multiplier",
    "right_wheel_radius_multiplier",
)
NOISES = ("left_wheel_noise", "right_wheel_noise", "reference_sigma_xy", "reference_sigma_yaw")

UNDETERMINED = 0.05
"""Standard deviation of a multiplier above which the data say less than the nominal value does."""

PLAUSIBLE = (0.5, 2.0)
"""Multipliers beyond these are no calibration errors; a fit that runs against them is refused."""

JUMP = 40.0
"""Squared deviation, in units of what is usual for the run, above which the reference jumped."""

_MEDIAN_CHI2_3 = 2.366
_TAIL = 4.0  # degrees of freedom of the Student-t that weighs legs until the jumps are known


@dataclass(frozen=True, slots=True)
class Estimate:
    """A fitted number with its standard deviation; `determined` is False where data were mute."""

    value: float
    std: float
    determined: bool


@dataclass(frozen=True, slots=True)
class CalibrationFit:
    """What a fit found."""

    robot: Robot
    """With everything that was determined put in."""
    multipliers: dict[str, Estimate]
    noises: dict[str, Estimate]
    """k_L, k_R [m^0.5] and the reference's sigmas [m, rad]."""
    correlation: Floats
    """Of the determined multipliers, in the order of `multipliers`."""
    excluded: tuple[NDArray[np.bool_], ...]
    """For each run, the legs on which the reference jumped."""
    start_yaw: tuple[float | None, ...]
    """Fitted start headings of runs whose reference has no heading [rad]."""


@dataclass(frozen=True, slots=True)
class _Point:
    """Where the fit stands."""

    robot: Robot
    variances: Variances
    start_yaw: tuple[float | None, ...]
    excluded: tuple[NDArray[np.bool_], ...]


def fit_calibration(
    runs: Sequence[MatchedRun],
    robot: Robot,
    kind: ReferenceKind = "absolute",
    *,
    sigma_xy: float | None = None,
    sigma_yaw: float | None = None,
) -> CalibrationFit:
    """Fit multipliers and noise to all runs at once.

    Parameters
    ----------
    sigma_xy, sigma_yaw : float, optional
        The reference's noise where it is known [m, rad]; else it is estimated.
    """
    guess = Variances(
        *(
            np.array([value**2])
            for value in (
                max(robot.left_wheel_noise, 1e-5),
                max(robot.right_wheel_noise, 1e-5),
                sigma_xy or 1e-3,
                sigma_yaw or 2e-3,
            )
        )
    )
    point = _Point(
        robot,
        guess,
        tuple(_first_heading(robot, run) for run in runs),
        tuple(np.zeros(run.legs, dtype=np.bool_) for run in runs),
    )
    point = _robustly(runs, point, kind, list(MULTIPLIERS))
    held = (sigma_xy is not None, sigma_yaw is not None)
    if held[0]:
        point = replace(point, variances=replace(point.variances, xy=guess.xy))
    if held[1]:
        point = replace(point, variances=replace(point.variances, yaw=guess.yaw))
    for _ in range(3):
        point = replace(point, variances=_likeliest(runs, point, kind, held))
        free, covariance = _determined(runs, point, kind)
        kept = {name: getattr(robot, name) for name in MULTIPLIERS if name not in free}
        point = replace(point, robot=replace(point.robot, **kept))
        point = _gauss_newton(runs, point, kind, free)
    return _result(runs, point, kind, robot, free, covariance, held)


def _robustly(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind, free: list[str]
) -> _Point:
    """Come near the answer whatever the reference's jumps, then find these once."""
    for _ in range(12):
        white, slopes = _stacked(runs, point, kind, free)
        deviation = np.sum(white**2, axis=-1)
        counted = deviation > 0.0
        scale = float(np.median(deviation[counted])) / _MEDIAN_CHI2_3 if counted.any() else 1.0
        point = replace(point, variances=_scaled(point.variances, scale))
        weight = (_TAIL + 3.0) / (_TAIL + deviation / scale)
        step = _solve(white / np.sqrt(scale), slopes / np.sqrt(scale), weight)
        point = _moved(point, free, step)
        if np.abs(step).max(initial=0.0) < 1e-5:
            break
    return replace(point, excluded=_jumps(runs, point, kind))


def _jumps(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind
) -> tuple[NDArray[np.bool_], ...]:
    found = []
    for index, run in enumerate(runs):
        white, _ = _unexpected(run, index, point, kind, []).whitened()
        deviation = np.sum(white**2, axis=-1)
        usual = max(float(np.median(deviation)) / _MEDIAN_CHI2_3, 1.0)
        found.append(deviation > JUMP * usual)
    return tuple(found)


def _gauss_newton(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind, free: list[str]
) -> _Point:
    for _ in range(6):
        white, slopes = _stacked(runs, point, kind, free)
        step = _solve(white, slopes, np.ones(white.shape[0]))
        point = _moved(point, free, step)
        if np.abs(step).max(initial=0.0) < 1e-9:
            break
    return point


def _unexpected(
    run: MatchedRun, index: int, point: _Point, kind: ReferenceKind, free: list[str]
) -> Innovations:
    changes = calibration_changes(point.robot, run)
    return innovations(
        point.robot,
        run,
        predict(point.robot, run),
        point.variances,
        kind,
        change=sensitivity(point.robot, run, [changes[name] for name in free]),
        excluded=point.excluded[index],
        start_yaw=point.start_yaw[index],
    )


def _stacked(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind, free: list[str]
) -> tuple[Floats, Floats]:
    """Whitened innovations of all legs (M, 3) and derivatives (M, 3, p + nuisances of runs)."""
    fitted = [index for index, yaw in enumerate(point.start_yaw) if yaw is not None]
    values, slopes = [], []
    for index, run in enumerate(runs):
        white, slope = _unexpected(run, index, point, kind, free).whitened()
        wide = np.zeros((*slope.shape[:2], len(free) + len(fitted)))
        wide[..., : len(free)] = slope[..., : len(free)]
        if index in fitted:
            wide[..., len(free) + fitted.index(index)] = slope[..., -1]
        values.append(white)
        slopes.append(wide)
    return np.concatenate(values), np.concatenate(slopes)


def _solve(white: Floats, slopes: Floats, weight: Floats) -> Floats:
    """Weighted least squares step; directions that nothing excites are not moved."""
    root = np.sqrt(weight)[:, None]
    design = (slopes * root[..., None]).reshape(-1, slopes.shape[-1])
    return -np.linalg.lstsq(design, (white * root).ravel(), rcond=1e-8)[0]


def _moved(point: _Point, free: list[str], step: Floats) -> _Point:
    changes = {
        name: float(np.clip(getattr(point.robot, name) + move, *PLAUSIBLE))
        for name, move in zip(free, step, strict=False)
    }
    rest = iter(step[len(free) :])
    yaws = tuple(None if yaw is None else yaw + float(next(rest)) for yaw in point.start_yaw)
    return replace(point, robot=replace(point.robot, **changes), start_yaw=yaws)


def _scaled(variances: Variances, factor: float) -> Variances:
    return Variances(
        variances.left * factor,
        variances.right * factor,
        variances.xy * factor,
        variances.yaw * factor,
    )


def _determined(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind
) -> tuple[list[str], Floats]:
    """Multipliers that the driving determines, and their covariance."""
    free = list(MULTIPLIERS)
    while free:
        _, slopes = _stacked(runs, point, kind, free)
        flat = slopes.reshape(-1, slopes.shape[-1])
        information = flat.T @ flat
        covariance = np.linalg.pinv(information, hermitian=True, rcond=1e-12)
        spread = np.sqrt(np.diag(covariance))[: len(free)]
        mute = np.diag(information)[: len(free)] <= 1e-12
        spread[mute] = np.inf
        worst = int(np.argmax(spread))
        if spread[worst] <= UNDETERMINED:
            return free, covariance[: len(free), : len(free)]
        free.pop(worst)
    return free, np.zeros((0, 0))


def _likeliest(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind, held: tuple[bool, bool]
) -> Variances:
    """Variances of greatest likelihood, the robot being given."""
    from scipy.optimize import minimize

    cost = _Cost(runs, point, kind, held)
    start = np.log(
        np.concatenate(
            [point.variances.left, point.variances.right, point.variances.xy, point.variances.yaw]
        )[cost.moving]
    )
    bounds = [(np.log(1e-14), np.log(10.0))] * start.size
    found = minimize(
        cost.with_gradient,
        start,
        jac=True,
        method="L-BFGS-B",
        bounds=bounds,
        options={"maxiter": 40, "ftol": 1e-9},
    )
    return cost.variances(found.x[None, :])


class _Cost:
    """Minus two log-likelihood as a function of the logarithms of the variances."""

    def __init__(
        self,
        runs: Sequence[MatchedRun],
        point: _Point,
        kind: ReferenceKind,
        held: tuple[bool, bool],
    ) -> None:
        self._runs, self._point, self._kind = runs, point, kind
        self.moving = np.array([True, True, not held[0], not held[1]])
        self._predictions = [predict(point.robot, run) for run in runs]

    def variances(self, logs: Floats) -> Variances:
        """Of rows of logarithms, shape (g, free)."""
        now = self._point.variances
        base = np.array([now.left[0], now.right[0], now.xy[0], now.yaw[0]])
        table = np.tile(base, (logs.shape[0], 1))
        table[:, self.moving] = np.exp(logs)
        return Variances(*table.T)

    def values(self, logs: Floats) -> Floats:
        """Costs of rows of logarithms."""
        sets = self.variances(logs)
        total = np.zeros(logs.shape[0])
        for index, run in enumerate(self._runs):
            total += innovations(
                self._point.robot,
                run,
                self._predictions[index],
                sets,
                self._kind,
                excluded=self._point.excluded[index],
                start_yaw=self._point.start_yaw[index],
            ).minus_two_log_likelihood()
        return total

    def with_gradient(self, logs: Floats) -> tuple[float, Floats]:
        """Cost and gradient, by central differences taken in one pass."""
        step = 1e-4
        moves = step * np.eye(logs.size)
        costs = self.values(np.concatenate([logs[None], logs + moves, logs - moves]))
        ahead, behind = costs[1 : logs.size + 1], costs[logs.size + 1 :]
        return float(costs[0]), (ahead - behind) / (2.0 * step)

    def hessian(self, logs: Floats) -> Floats:
        """Second derivatives, by differences of gradients."""
        step = 0.05
        rows = []
        for index in range(logs.size):
            move = np.zeros(logs.size)
            move[index] = step
            ahead, behind = self.with_gradient(logs + move)[1], self.with_gradient(logs - move)[1]
            rows.append((ahead - behind) / (2.0 * step))
        matrix = np.array(rows)
        return 0.5 * (matrix + matrix.T)


def _result(
    runs: Sequence[MatchedRun],
    point: _Point,
    kind: ReferenceKind,
    given: Robot,
    free: list[str],
    covariance: Floats,
    held: tuple[bool, bool],
) -> CalibrationFit:
    spread = np.sqrt(np.diag(covariance))
    multipliers = {}
    for name in MULTIPLIERS:
        if name in free:
            multipliers[name] = Estimate(
                float(getattr(point.robot, name)), float(spread[free.index(name)]), True
            )
        else:
            multipliers[name] = Estimate(float(getattr(given, name)), float("inf"), False)
    noises = _noise_estimates(runs, point, kind, held)
    changes = {name: item.value for name, item in multipliers.items()}
    for name in ("left_wheel_noise", "right_wheel_noise"):
        if noises[name].determined:
            changes[name] = noises[name].value
    outer = np.outer(spread, spread)
    return CalibrationFit(
        replace(given, **changes),
        multipliers,
        noises,
        covariance / np.where(outer > 0.0, outer, 1.0),
        point.excluded,
        point.start_yaw,
    )


def _noise_estimates(
    runs: Sequence[MatchedRun], point: _Point, kind: ReferenceKind, held: tuple[bool, bool]
) -> dict[str, Estimate]:
    now = point.variances
    sigmas = np.sqrt([now.left[0], now.right[0], now.xy[0], now.yaw[0]])
    cost = _Cost(runs, point, kind, held)
    logs = 2.0 * np.log(sigmas[cost.moving])
    covariance = 2.0 * np.linalg.pinv(cost.hessian(logs), hermitian=True)
    share = np.full(4, 0.0)
    share[cost.moving] = 0.5 * np.sqrt(np.maximum(np.diag(covariance), 0.0))
    return {
        name: Estimate(float(sigma), float(sigma * part), bool(part < 0.5))
        for name, sigma, part in zip(NOISES, sigmas, share, strict=True)
    }


def _first_heading(robot: Robot, run: MatchedRun) -> float | None:
    """Start heading that turns the first legs onto the measured positions; None where measured."""
    if run.measured.has_yaw[0]:
        return None
    relative = predict(robot, run).relative
    pose, heading, predicted = 0j, 0.0, [0j]
    for x, y, turn in relative:
        pose += np.exp(1j * heading) * complex(x, y)
        heading += turn
        predicted.append(pose)
    measured = run.measured.x + 1j * run.measured.y
    usable = np.flatnonzero(run.measured.has_position)[:12]
    if usable.size < 2:
        return 0.0
    shape = np.array(predicted)[usable] - predicted[usable[0]]
    seen = measured[usable] - measured[usable[0]]
    return float(np.angle(np.sum(np.conj(shape) * seen)))
