# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Clusters of legs within which errors are correlated, and cluster-robust standard errors.

Standard deviations from the curvature of the likelihood hold if the model does. If an effect is
missing, each part of the drives pulls the estimates its own way, and the overall estimate is only
as good as the parts agree.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.linear import SILENT, covariance_of
from werrimbi_odom.model.pose import Floats


def parts_of(run: NDArray[np.intp], most: int = rules.LASTING_MOST) -> NDArray[np.intp]:
    """Index of the part (cluster) of each leg, numbered over all runs, (m,).

    `run` (m,): index of each leg's run, in order. `most`: most parts of one run.
    """
    each = min(
        max(math.ceil(rules.LASTING_PARTS / np.unique(run).size), rules.LASTING_FEWEST), most
    )
    first = np.searchsorted(run, run, side="left")
    count = np.bincount(run)[run]
    part = (np.arange(run.size) - first) * each // count
    return np.asarray(each * run + part)


def parts_of_innovations(runs: Concatenated, white: Floats) -> NDArray[np.intp] | None:
    """Index of the part of each innovation, (3 m,); -1 where nothing was measured.

    None where legs with data are so long that each is independent, or where all runs together have
    too few of them for parts that could be compared. `runs`: the runs of the legs. `white` (3 m,):
    innovations; all three of an excluded leg are zero.
    """
    known = np.abs(white.reshape(-1, 3)).max(axis=1) > SILENT
    run = runs.run_of_leg[known]
    most = run.size // (rules.LASTING_LEGS * len(runs.runs))
    if most == 0:
        return None
    parts = np.full(known.size, -1)
    most = most if most < rules.LASTING_FEWEST else rules.LASTING_MOST
    parts[known] = np.unique(parts_of(run, most), return_inverse=True)[1]
    return np.repeat(parts, 3) if parts.max() + 1 >= rules.LASTING_FEWEST else None


def few_parts(runs: Concatenated, parts: NDArray[np.intp]) -> bool:
    """Whether runs are too short for parts that could show how much they disagree."""
    return int(parts.max()) + 1 < rules.LASTING_FEWEST * len(runs.runs)


def least_informative_share(parts: NDArray[np.intp]) -> float:
    """Share of a pattern's norm that a part must hold to be informative.

    It is in proportion to what a part holds on average.
    """
    return rules.LASTING_HEARD * math.sqrt(rules.LASTING_PARTS / (parts.max() + 1))


def effective_freedom(runs: Concatenated, white: Floats, own: Floats) -> float:
    """Degrees of freedom in which the parts tell the scatter of one number (Satterthwaite).

    With the shares `w` of what they know of it, 1 / sum(w^2) - 1: that of the parts, less one,
    where all know as much, and fewer where few drives or turns show it (Bell and McCaffrey, Surv.
    Methodol. 28, 2002). Infinite where there are no parts. `own` (3 m,): derivative of the
    innovations in the number, with all others projected out.
    """
    parts = parts_of_innovations(runs, white)
    if parts is None or not own.any():
        return math.inf
    shares = np.bincount(parts[parts >= 0], own[parts >= 0] ** 2)
    return max(float(shares.sum() ** 2 / np.sum(shares**2)) - 1.0, 1.0)


def widening(white: Floats, flat: Floats, moves: Floats, runs: Concatenated) -> Floats:
    """Factor on the standard deviations for disagreement between parts, (p,).

    This is the ratio of the sandwich estimator (Huber 1967; clustered: Liang and Zeger, Biometrika
    73, 1986) to the inverse information, where parts disagree significantly. It is 1 where they
    agree, since 28 parts determine a deviation only to 13 %. `white` (n,): whitened innovations at
    the fit. `flat` (n, p): their Jacobian. `moves` (p, q): directions of the columns that were
    free. `runs`: the runs of the legs.
    """
    wide = np.ones(moves.shape[0])
    parts = parts_of_innovations(runs, white)
    if parts is None or not moves.any():
        return wide
    columns = flat @ moves
    inverse = covariance_of(columns)
    influence = moves @ inverse
    usual = np.sum((influence @ (columns.T @ columns)) * influence, axis=1)
    moved, expected = [], []
    for part in range(parts.max() + 1):
        here = columns[parts == part]
        moved.append(influence @ (here.T @ white[parts == part]))
        expected.append(np.sum((influence @ (here.T @ here)) * influence, axis=1))
    squares, shares = np.square(moved), np.array(expected)
    for column in np.flatnonzero(moves.any(axis=1)):
        known = shares[:, column] > least_informative_share(parts) ** 2 * usual[column]
        freedom = int(known.sum()) - 1
        if freedom < 1:
            continue
        disagreement = float(np.sum(squares[known, column] / shares[known, column]))
        if chi2_survival(disagreement, freedom) < rules.SURE:
            count = len(squares) / (len(squares) - 1)
            wide[column] = math.sqrt(
                max(count * float(np.sum(squares[:, column])) / usual[column], 1.0)
            )
    return wide
