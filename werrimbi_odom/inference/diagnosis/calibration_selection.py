# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Selection of the sizes that differ from the given file; all others are reset to it.

A fit frees base, left radius and right radius together. The part of it that pays its penalty may be
the base alone, one wheel, both wheels alike, or one against the other. The cheapest of these is
kept, and everything else is fitted again with the other sizes as in the file.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    MULTIPLIERS,
    Model,
    changed,
    own_of,
    shared_of,
)
from werrimbi_odom.inference.fitting.gauss_newton import moved
from werrimbi_odom.inference.fitting.whitened_innovations import Costs, Design, stacked
from werrimbi_odom.inference.linear import nuisance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

_BOUNDS = {number.name: number.bounds for number in CALIBRATION}
_BASE = {"": (), "base": ((1.0, 0.0, 0.0),)}
_RADII: dict[str, tuple[tuple[float, float, float], ...]] = {
    "": (),
    "left": ((0.0, 1.0, 0.0),),
    "right": ((0.0, 0.0, 1.0),),
    "scale": ((0.0, 1.0, 1.0),),
    "ratio": ((0.0, -0.5, 0.5),),
    "both": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
}
_MOVES = {
    "track_width": ("base",),
    "unequal_wheel_radii": ("left", "right", "ratio", "both"),
    "wheel_radius_scale": ("left", "right", "scale", "both"),
}
"""Parts that move a calibration effect."""


@dataclass(frozen=True, slots=True)
class FreeSizes:
    """Free sizes, as directions in the logarithms of the three multipliers."""

    parts: tuple[str, str]
    """Free parts of the base and of the radii; "" for none."""
    directions: Floats
    """Shape (3, k)."""

    @property
    def free(self) -> int:
        """Number of free parameters."""
        return int(self.directions.shape[1])


def sizes_needed(
    fit: Fitted, given: Robot, wanted: Collection[str], at_file: Collection[str] = ()
) -> FreeSizes:
    """The cheapest set of sizes that may differ from the given file's.

    To first order, with everything else fitted again. The penalty of a parameter is that of all
    model selection (`Fitted.penalty_of_one`). `wanted`: calibration effects that are free
    regardless of their gain. `at_file`: multipliers that stay as given.
    """
    marks, rest = _at_given(fit.design, fit.point.model.robot, given)
    stay = [MULTIPLIERS.index(name) for name in at_file]
    weighed = []
    for sizes in choices(wanted):
        if sizes.directions[stay].any():
            continue
        away = _solved(marks, sizes, rest)
        gained = float(np.sum((marks @ sizes.directions @ away) ** 2))
        penalty = fit.penalty_of_one * sizes.free + _surprise(sizes.directions @ away)
        weighed.append((penalty - gained / fit.scatter, sizes))
    return min(weighed, key=lambda item: item[0])[1]


def _surprise(logs: Floats) -> float:
    """Minus two log prior density of multipliers (3,) at this distance from the given.

    The prior of a tape measurement is Cauchy's distribution. Where two choices explain as much, as
    on a circle, the one that moves the robot less is the likelier. Where the data decide, it has no
    influence.
    """
    return float(2.0 * np.sum(np.log1p((logs / rules.CALIBRATION_KNOWN) ** 2)))


def with_sizes(runs: Concatenated, fit: Fitted, given: Robot, sizes: FreeSizes) -> Fitted:
    """Fit again, with only those sizes free to differ from the given file's.

    The fit itself where all are free, or where the cost rises more than the approximation promised.
    """
    if sizes.free == len(MULTIPLIERS):
        return fit
    marks, rest = _at_given(fit.design, fit.point.model.robot, given)
    away = -_solved(marks, sizes, rest)
    point = fit.point
    every = [
        *CALIBRATION,
        *own_of([*fit.numbers, *point.model.nuisance_parameters]),
        *shared_of(fit.numbers),
    ]
    for _ in range(3):
        there = _sized(given, sizes, away)
        if not all(low < there[name] < high for name, (low, high) in _BOUNDS.items()):
            return fit  # a model that is far off: the penalised comparison means nothing there
        robot = changed(point.model.robot, there)
        point = replace(point, model=Model(robot, point.model.own))
        design = stacked(runs, point, every)
        free = _free(design, robot, sizes)
        white, flat = design.flat()
        columns = flat @ free
        size = np.sqrt(np.sum(columns**2, axis=0))
        size = np.where(size > 1e-9, size, np.inf)
        step = -np.linalg.lstsq(columns / size, white, rcond=1e-9)[0] / size
        away = away + step[: sizes.free]
        others = free @ np.where(np.arange(step.size) < sizes.free, 0.0, step)
        point = replace(point, model=moved(point.model, design, others))
        if np.max(np.abs(step) * np.where(np.isfinite(size), size, 0.0), initial=0.0) < rules.STILL:
            break
    robot = changed(point.model.robot, _sized(given, sizes, away))
    point = replace(point, model=Model(robot, point.model.own))
    cost = float(Costs(runs, point)(point.variances)[0])
    if not cost < fit.cost + fit.penalty_of_one * fit.scatter * len(MULTIPLIERS) + rules.RIVAL:
        return fit
    inverse = np.linalg.pinv((columns / size).T @ (columns / size), rcond=1e-12, hermitian=True)
    covariance = free @ (inverse / np.outer(size, size)) @ free.T
    heard = np.isin(design.names, MULTIPLIERS)
    not_identifiable = ~heard & (np.sum(flat**2, axis=0) < 1e-18)
    covariance[not_identifiable, not_identifiable] = 1e12
    others = fit.moves[:, ~fit.moves[heard].any(axis=0)]
    return replace(
        fit,
        point=point,
        cost=cost,
        needless_gain=0.0,
        covariance=covariance * np.outer(fit.widening, fit.widening),
        moves=np.concatenate([free[:, : sizes.free], others], axis=1),
        design=design,
    )


def choices(wanted: Collection[str] = ()) -> Iterator[FreeSizes]:
    """All choices of free sizes that move the `wanted` effects, the fewest parameters first."""
    every = [
        FreeSizes((base, radii), np.array([*_BASE[base], *_RADII[radii]]).reshape(-1, 3).T)
        for radii in _RADII
        for base in _BASE
    ]
    for sizes in sorted(every, key=lambda sizes: sizes.free):
        if all(set(_MOVES[name]) & set(sizes.parts) for name in wanted):
            yield sizes


def _at_given(design: Design, robot: Robot, given: Robot) -> tuple[Floats, Floats]:
    """Jacobian in the logarithms of the multipliers (n, 3), and innovations (n,) at the given ones.

    Both with all other fitted parameters projected out.
    """
    names = design.names
    white, flat = design.flat()
    now = np.array([getattr(robot, name) for name in MULTIPLIERS])
    before = np.array([getattr(given, name) for name in MULTIPLIERS])
    marks = flat[:, [names.index(name) for name in MULTIPLIERS]] * now
    others = nuisance(flat[:, [name not in MULTIPLIERS for name in names]])
    marks = others.residual(marks)
    return marks, others.residual(white) - marks @ np.log(now / before)


def _solved(marks: Floats, sizes: FreeSizes, rest: Floats) -> Floats:
    """Least squares in the free directions, (k,)."""
    if sizes.free == 0:
        return np.zeros(0)
    return np.asarray(np.linalg.lstsq(marks @ sizes.directions, rest, rcond=1e-6)[0])


def _sized(given: Robot, sizes: FreeSizes, away: Floats) -> dict[str, float]:
    """Multipliers at this distance from the given ones; those that are not free stay exact."""
    logs = sizes.directions @ away
    return {
        name: float(getattr(given, name)) * float(np.exp(log))
        for name, log in zip(MULTIPLIERS, logs, strict=True)
    }


def _free(design: Design, robot: Robot, sizes: FreeSizes) -> Floats:
    """Matrix from free directions (q,) to design columns (p,): the sizes first, then all others."""
    names = design.names
    rest = [index for index, name in enumerate(names) if name not in MULTIPLIERS]
    free = np.zeros((len(names), sizes.free + len(rest)))
    for name, row in zip(MULTIPLIERS, sizes.directions, strict=True):
        free[names.index(name), : sizes.free] = row * getattr(robot, name)
    free[rest, np.arange(sizes.free, sizes.free + len(rest))] = 1.0
    return free
