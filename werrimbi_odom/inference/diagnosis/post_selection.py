# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Post-selection inference: covariances that allow for the choice of the free parameters.

Which sizes differ from the given file's, and which parameters an effect needs, is chosen on the
same drives by penalised likelihood. In about one set of drives in twenty, a parameter that is truly
null is chosen by chance. Its estimate is then three of its standard deviations from the truth,
however well the rest is known.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Sequence
from itertools import chain, combinations, product

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.calibration_selection import FreeSizes, choices
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, value_of
from werrimbi_odom.inference.fitting.whitened_innovations import Design
from werrimbi_odom.inference.linear import SILENT, admitted, covariance_of, nuisance
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

Law = dict[str, float]
"""Optional parameters of an effect, of which at least one is kept, with their null values."""


def model_averaged_covariance(
    fit: Fitted,
    given: Robot,
    wanted: Collection[str],
    told: FreeSizes,
    laws: Sequence[Law] = (),
    design: Design | None = None,
) -> tuple[list[str], Floats]:
    """Names and covariance (p, p) of shared parameters, averaged over the possible choices.

    Each choice of free parameters has its own estimates with their covariance, and a probability by
    its cost and penalty. The mean product of deviations from the reported values, over all choices,
    is the covariance (Bayesian model averaging: Hoeting and others, Statistical Science 14, 1999).
    So both radii are as little known as a scale that was left alone, and their ratio is not.
    `fit`: the fit whose values are reported. `given`: Robot with the sizes of the file. `wanted`:
    calibration effects whose sizes are free in every choice. `told`: the chosen sizes, about which
    deviations are taken; of `laws`, the parameters in `fit`. `laws`: optional parameters of
    effects. `design`: design with all parameters of `laws`; by default that of the fit.
    """
    robot = fit.point.model.robot
    names, marks, rest = _shared(design or fit.design)
    now = np.array([value_of(robot, name) for name in names])
    fitted = {
        number.name: row for (number, _), row in zip(fit.design.columns, fit.moves, strict=True)
    }
    matrix = np.array([fitted.get(name, np.zeros(fit.moves.shape[1])) for name in names])
    nulls = {name: null for law in laws for name, null in law.items()}
    chosen = np.isin(names, [*MULTIPLIERS, *nulls])
    others = matrix[:, matrix.any(axis=0) & ~matrix[chosen].any(axis=0)]
    absent = np.zeros(len(names))
    for index, name in enumerate(names):
        if name in MULTIPLIERS:
            absent[index] = -now[index] * math.log(now[index] / getattr(given, name))
        elif name in nulls:
            absent[index] = nulls[name] - now[index]
    limit = {number.name: number.undetermined for number, _ in (design or fit.design).columns}
    kept_now = tuple(name for name in nulls if name in fitted and fitted[name].any())
    sized = [names.index(name) for name in MULTIPLIERS]
    found, there_now = [], np.zeros(len(names))
    every = {each.parts: each for each in (*choices(wanted), told)}
    for sizes, kept in product(every.values(), dict.fromkeys([*_subsets(laws), kept_now])):
        is_told = sizes.parts == told.parts and kept == kept_now
        moves = np.zeros((len(names), sizes.free + len(kept)))
        moves[sized, : sizes.free] = sizes.directions * now[sized, None]
        moves[[names.index(name) for name in kept], range(sizes.free, moves.shape[1])] = 1.0
        moves = np.concatenate([moves, others], axis=1)
        heard = np.sum((marks @ moves) ** 2, axis=0) > SILENT**2
        limits = [rules.CALIBRATION_KNOWN] * sizes.free + [limit[name] for name in kept]
        moves, columns = moves[:, heard], marks @ moves[:, heard]
        mine = columns.shape[1] - int(heard[len(limits) :].sum())
        # Headings know the wheels' size over the base alone: half of each is no estimate of either.
        beside = nuisance(columns[:, mine:])
        if not is_told and len(admitted(columns[:, :mine], beside)) < len(limits):
            continue
        covariance = covariance_of(columns)
        if not is_told and not np.all(np.sqrt(np.diag(covariance))[: len(limits)] < limits):
            continue  # parameters that the data do not determine say nothing about the others
        left = rest + marks @ absent
        step = -covariance @ (columns.T @ left)
        there = absent + moves @ step
        cost = float(np.sum((left + columns @ step) ** 2)) / fit.scatter
        cost += fit.penalty_of_one * (sizes.free + len(kept))
        there_now = there if is_told else there_now
        found.append((cost, there, moves @ covariance @ moves.T))
    least = min(cost for cost, *_ in found)
    weights = np.array([math.exp(-0.5 * (cost - least)) for cost, *_ in found])
    products = [
        inside + np.outer(there - there_now, there - there_now) for _, there, inside in found
    ]
    if not fit.design.sized:
        alike = np.eye(len(names))
        alike[np.ix_(sized, sized)] = _in_the_scale_of(told, now[sized])
        products = [alike @ product @ alike.T for product in products]
    widened = {
        number.name: by for (number, _), by in zip(fit.design.columns, fit.widening, strict=True)
    }
    doubt = np.array([widened.get(name, 1.0) for name in names])
    return names, np.average(products, axis=0, weights=weights) * np.outer(doubt, doubt)


def _in_the_scale_of(told: FreeSizes, now: Floats) -> Floats:
    """Map (3, 3) of the multipliers' deviations to sizes that headings tell apart from `told`.

    A robot of twice the size turns alike. Of a left wheel that is 2 % smaller and a right one that
    is 2 % larger, with a base to match, headings alone are the same: no deviation of one from the
    other. So the common scale is taken off that leaves alone what `told` leaves alone, if it can.
    """
    common = np.ones((len(MULTIPLIERS), 1))
    scale = np.linalg.pinv(np.column_stack([told.directions, common]))[-1:]
    return np.asarray((np.eye(len(MULTIPLIERS)) - common @ scale) * now[:, None] / now)


def _shared(design: Design) -> tuple[list[str], Floats, Floats]:
    """Names, Jacobian and innovations of the shared parameters, with per-run ones projected out."""
    white, flat = design.flat()
    common = np.array([run < 0 for _, run in design.columns])
    own = nuisance(flat[:, ~common])
    joined = np.column_stack([own.residual(flat[:, common]), own.residual(white)])
    corner = np.asarray(np.linalg.qr(joined, mode="r"))  # has the same least squares
    names = [number.name for number, run in design.columns if run < 0]
    return names, corner[:, :-1], corner[:, -1]


def _subsets(laws: Sequence[Law]) -> Iterator[tuple[str, ...]]:
    """Subsets of the parameters, with at least one of each law."""
    each = [
        [kept for size in range(1, len(law) + 1) for kept in combinations(law, size)]
        for law in laws
    ]
    return (tuple(chain(*kept)) for kept in product(*each))
