# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Statistics of a fitted design: its dispersion, the covariance of its values, Wald tests."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.identifiable import Directions
from werrimbi_odom.inference.fitting.whitened_innovations import Design, Point
from werrimbi_odom.inference.linear import SILENT, nuisance
from werrimbi_odom.model.effect import Effect, applied_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def scatter_of(runs: Concatenated, design: Design) -> float:
    """Dispersion of the innovations where few data determine the noise; else 1."""
    return max(1.0, float(np.sum(design.white**2)) / residual_degrees_of(runs, design))


def residual_degrees_of(runs: Concatenated, design: Design) -> float:
    """Residual degrees of freedom for the noise; infinite where there are enough data."""
    if runs.tells_noise:
        return math.inf
    return float(max(runs.data - len(design.columns), 1))


def inflation_by_neighbours(runs: Concatenated, design: Design, effect: str) -> float:
    """Factor on the gain that an effect makes of innovations which depend on their neighbours.

    Legs of an incremental reference are judged each by itself. Where its increments come from poses
    with an error each, two legs share that of the pose between them, with opposite signs: a pattern
    that changes its sign from leg to leg (an oval wheel) fits such noise, by up to twice as much as
    independent noise. This is the largest eigenvalue of the gain's covariance with the correlation
    of next neighbours, in each axis, as the innovations have it (Newey, West, Econometrica 55,
    1987).
    """
    own = [number.name.rpartition(".")[0] == effect for number, _ in design.columns]
    if not any(own):
        return 1.0
    _, flat = design.flat()
    free = nuisance(flat[:, np.logical_not(own)]).residual(flat[:, own])
    basis, values, _ = np.linalg.svd(free, full_matrices=False)
    heard = basis[:, values > SILENT * max(values[0], 1.0)].reshape(*design.white.shape, -1)
    after = np.flatnonzero(runs.run_of_leg[1:] == runs.run_of_leg[:-1]) + 1
    shared = np.sum(design.white[after] * design.white[after - 1], axis=0)
    correlation = shared / np.maximum(np.sum(design.white**2, axis=0), 1e-12)
    beside = np.einsum(
        "ma,mai,maj->ij",
        np.broadcast_to(correlation, (after.size, 3)),
        heard[after],
        heard[after - 1],
    )
    together = np.eye(heard.shape[-1]) + beside + beside.T
    return max(1.0, float(np.linalg.eigvalsh(together).max(initial=0.0)))


def covariance_of(design: Design, ways: Directions) -> Floats:
    """Covariance of the least-squares estimate; 1e12 where the data determine nothing."""
    covariance = ways.covariance(design.flat()[1])
    untold = ~ways.matrix.any(axis=1)
    covariance[untold, untold] = 1e12
    return np.asarray(covariance)


def grain_of(design: Design, robot: Robot) -> Floats:
    """Variances (p,) that laws leave open for the robot's own values (`Parameter.grain`).

    These lie anywhere in a stretch about the fitted value: a uniform distribution. Whether an
    effect is there at all is no question of it.
    """
    declared = {
        f"{item.name}.{name}": item.effect.parameters[name].grain * float(np.mean(value))
        for item in robot.effects
        for name, value in item.values.items()
    }
    widths = np.array([declared.get(number.name, 0.0) for number, _ in design.columns])
    return np.asarray(widths**2 / 12.0)


def wald_statistic(name: str, design: Design, covariance: Floats, point: Point) -> float:
    """Rise of the cost without an effect, by the curvature at the fit (Wald statistic)."""
    effect = applied_of(point.model.robot.effects, name).effect
    freed = [key for key in effect.parameters if effect.has_null(key)]
    return wald_test(effect, freed, design, covariance, point)[0]


def wald_test(
    effect: Effect, freed: Sequence[str], design: Design, covariance: Floats, point: Point
) -> tuple[float, int]:
    """Wald statistic of some parameters of an effect being null, and their number in all runs."""
    chosen, away = [], []
    for index, (number, run) in enumerate(design.columns):
        name, _, parameter = number.name.rpartition(".")
        if name == effect.name and parameter in freed:
            chosen.append(index)
            away.append(point.model.value(number, max(run, 0)) - effect.nulls[parameter])
    if not chosen:
        return 0.0, 0
    spread = covariance[np.ix_(chosen, chosen)]
    # Each in its own standard deviation: beside one that is not determined others are rounding.
    stds = np.sqrt(np.where(np.diag(spread) > 0.0, np.diag(spread), 1.0))
    values = np.array(away) / stds
    correlation = spread / np.outer(stds, stds)
    return float(values @ np.linalg.pinv(correlation, hermitian=True) @ values), len(chosen)
