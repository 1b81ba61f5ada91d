# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Evidence map: which measured variables the errors depend on, before any effect is named.

Under a complete model the whitened innovations are independent of everything. Each cell of the map
tests whether the error of one channel (left, right, along, sideways, heading) depends on one
measured variable, as a line or as a smooth curve. It is a score test: the pattern of such a
dependence in the innovations, with the nuisance parameters projected out, is compared with the
innovations.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.quarter_turns import Turning, turning_of
from werrimbi_odom.inference.diagnosis.step_jacobians import (
    AMOUNTS,
    BLOCK,
    Amount,
    StepJacobian,
    shares_of_steps,
    step_jacobians,
)
from werrimbi_odom.inference.diagnosis.straight_steps import TURN, is_turn, straight_steps
from werrimbi_odom.inference.diagnosis.variables import (
    CONSTANT,
    Form,
    Variable,
    floor_cells,
    functions_of,
    variables_of,
)
from werrimbi_odom.inference.distributions import bonferroni, fisher_survival
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter
from werrimbi_odom.inference.fitting.prediction import path_of
from werrimbi_odom.inference.fitting.whitened_innovations import Point, stacked, unexpected
from werrimbi_odom.inference.linear import ScoreTest, nuisance, score_test_of_products
from werrimbi_odom.model.pose import Floats

BATCH = 500_000
"""Legs times columns that the filter processes at once."""


@dataclass(frozen=True, slots=True)
class Dependence:
    """One cell of the evidence map."""

    amount: Amount
    variable: Variable
    form: Form
    coefficients: Floats
    """Coefficients of the form's functions; (k,), or (runs, k) where each run has its own zero."""
    gain: float
    """Test statistic: fall of the whitened squared innovations."""
    degrees: int
    p_value: float
    """Corrected for the number of cells tested (Bonferroni)."""
    shares: tuple[Floats, Floats] | None = None
    """Size of the quantity `amount.per` in each step, for left and right wheel, (n,). An error per
    metre is zero while the robot stands. None: the same in each step."""
    turning: Turning | None = None
    """That of the drives, for an error of the place per radian."""

    @property
    def channel(self) -> str:
        """Error channel."""
        return self.amount.channel

    @property
    def name(self) -> str:
        """Name of the variable; for a constant error, of what it is proportional to."""
        return self.amount.per if self.variable.name == CONSTANT else self.variable.name


def place_of(cell: Dependence) -> tuple[float, float]:
    """Place on the floor where most of an error is, in the frame of the reference [m].

    It is the mean of the most certain floor cell and of its neighbours with an error of the same
    sign, weighted by certainty. That is finer than the width of a cell.
    """
    x, y = cell.variable.left, cell.variable.right
    cells = floor_cells(x, y)
    steps = cells.sum(axis=0)
    middle = np.stack([cells.T @ x, cells.T @ y], axis=-1) / steps[:, None]
    certain = certainty_of_places(cell)
    first = int(np.argmax(certain))
    area = np.ptp(x) * np.ptp(y) / steps.size
    near = np.hypot(*(middle - middle[first]).T) < rules.NEIGHBOUR * max(
        np.sqrt(area), rules.FLOOR_CELL
    )
    same = np.sign(cell.coefficients) == np.sign(cell.coefficients[first])
    weight = certain * (near & same)
    px, py = weight @ middle / weight.sum()
    return float(px), float(py)


def certainty_of_places(cell: Dependence) -> Floats:
    """Certainty of the error in each floor cell, (cells,).

    An error per radian is known where the robot turned, and hardly where it drove straight.
    """
    cells = floor_cells(cell.variable.left, cell.variable.right)
    sides = [side**2 for side in cell.shares or () if side.size]
    known = cells.T @ sum(sides) if sides else cells.sum(axis=0)
    return np.asarray(cell.coefficients**2 * known)


def dependences(
    runs: Concatenated, point: Point, numbers: Sequence[FreeParameter]
) -> tuple[Dependence, ...]:
    """The evidence map of a model: all cells, most significant first.

    `numbers` are the nuisance parameters: what they can explain is no evidence. Where too few data
    determine the noise, the tests are Fisher's, as those of the effects are (`p_values.chance`).
    """
    runs.cache.forget_steps()
    path = path_of(point.model, runs)
    straight = straight_steps(runs, point, path)
    told = unexpected(runs, point)
    white, basis = stacked(runs, point, numbers).flat()
    if straight.any():
        turns, _ = step_jacobians(runs, path, [TURN], point)
        feigned = told.marks(summed_over_legs(runs, straight[:, None].astype(np.float64), turns))
        basis = np.column_stack([basis, feigned[..., :-1].reshape(white.size, -1)])
    frame = nuisance(basis)
    rest = frame.residual(white)
    found: list[tuple[Amount, Variable, Form, ScoreTest]] = []
    known = np.concatenate([frame.basis, rest[:, None]], axis=-1)
    for cell, change in _changes(runs, point, straight):
        own = np.ascontiguousarray(told.marks(change)[..., :-1].reshape(rest.size, -1).T)
        parts = 3 * (runs.legs if cell.variable.per_run else runs.legs[[0, -1]])
        rows = [slice(*pair) for pair in itertools.pairwise(parts.tolist())]
        products = np.stack([own[:, part] @ known[part] for part in rows])
        width = own.shape[0] // len(cell.amounts)
        for number, amount in enumerate(cell.amounts):
            here = slice(number * width, (number + 1) * width)
            tested = _tested([own[here, part] for part in rows], products[:, here])
            if tested is not None:
                found.append((amount, cell.variable, cell.form, tested))
    spare = math.inf if runs.tells_noise else runs.data - frame.basis.shape[1]
    whole = float(rest @ rest)
    shares = shares_of_steps(path, runs.drive(point.model.robot).duration)
    turning = turning_of(runs, path.motion.turn)
    cells = [
        Dependence(
            amount,
            variable,
            form,
            test.coefficients.reshape(len(runs.runs), -1)
            if variable.per_run
            else test.coefficients,
            test.gain,
            test.degrees,
            bonferroni(len(found), p_value_of_score(test.gain, test.degrees, whole, spare)),
            shares[amount],
            turning if amount.per == "turn" and amount.channel != "heading" else None,
        )
        for amount, variable, form, test in found
    ]
    return tuple(sorted(cells, key=lambda cell: (cell.p_value, -cell.gain / cell.degrees)))


def fall_of_cost(gain: float, data: int, whole: float = 0.0) -> float:
    """Cost reduction for a fall of the squared innovations, with the noise re-estimated.

    `gain`: fall of the squared innovations. `data`: number of innovations: the sum of their
    squares, where the noise was fitted to them. `whole`: that sum, where it may be larger. By few
    data the noise stays above it for its prior, and a pattern that explains nine tenths of the
    squares would be taken to explain all of them.
    """
    return -data * math.log1p(-min(max(gain / max(whole, data), 0.0), 0.999))


def p_value_of_score(gain: float, degrees: int, whole: float, spare: float) -> float:
    """P-value of a score test: by Fisher's F where few data determine the noise, else chi-squared.

    `gain`, `degrees`: fall of the squared innovations, and the parameters that cause it. `whole`:
    sum of the squared innovations before. `spare`: its degrees of freedom; infinite where the noise
    was fitted.
    """
    below = max(spare - degrees, 1.0)
    scatter = max((whole - gain) / below, 1.0)
    return fisher_survival(gain / degrees / scatter, degrees, below)


def _tested(patterns: Sequence[Floats], products: Floats) -> ScoreTest | None:
    """Score test of patterns (k, n) with separate coefficients for each part of the data.

    It works with products, without a copy of the many patterns with the nuisances projected out.
    `patterns` (k, n): the patterns in each part; zero in the others. `products` (parts, k,
    nuisances + 1): their products with the nuisance basis and, last, with the projected
    innovations.
    """
    width = products.shape[1]
    square = np.zeros((len(patterns) * width,) * 2)
    for number, own in enumerate(patterns):
        place = slice(number * width, (number + 1) * width)
        square[place, place] = own @ own.T
    flat = products.reshape(square.shape[0], -1)
    cross, size = flat[:, :-1], np.sqrt(np.diag(square))
    return score_test_of_products(square - cross @ cross.T, flat[:, -1], size)


class _Cells(NamedTuple):
    """Cells of one form of a variable."""

    variable: Variable
    form: Form
    amounts: Sequence[Amount]


def _changes(
    runs: Concatenated, point: Point, straight: NDArray[np.bool_]
) -> Iterator[tuple[_Cells, Floats]]:
    """Cells with their changes of the legs (m, 3, amounts * k), in blocks that fit into memory.

    Turns of `straight` steps are left out where both wheels err alike.
    """
    path = path_of(point.model, runs)
    of_wheels = [amount for amount in AMOUNTS if amount.of_wheels]
    both = np.empty((path.motion.turn.size, 3 * len(AMOUNTS)))
    left, right = step_jacobians(runs, path, AMOUNTS, point)
    for begin in range(0, both.shape[0], BLOCK):
        steps = np.arange(begin, min(begin + BLOCK, both.shape[0]))
        both[steps] = left(steps) + right(steps)
    both[np.ix_(straight, np.repeat([is_turn(amount) for amount in AMOUNTS], 3))] = 0.0
    for variable in variables_of(runs, point.model):
        for form, (of_left, of_right) in functions_of(variable).items():
            alike = of_left is of_right
            amounts = AMOUNTS if alike else of_wheels
            each = max(1, BATCH // (runs.count * of_left.shape[1]))
            for begin in range(0, len(amounts), each):
                chosen = amounts[begin : begin + each]
                if alike:
                    columns = both[:, 3 * begin : 3 * (begin + each)]
                    sums = summed_over_legs(runs, of_left, columns.__getitem__)
                else:
                    left, right = step_jacobians(runs, path, chosen, point)
                    sums = summed_over_legs(runs, of_left, left)
                    sums += summed_over_legs(runs, of_right, right)
                shaped = sums.reshape(runs.count, len(chosen), 3, -1).swapaxes(1, 2)
                yield _Cells(variable, form, chosen), shaped.reshape(runs.count, 3, -1)


def summed_over_legs(runs: Concatenated, functions: Floats, pushes: StepJacobian) -> Floats:
    """Sum functions (n, k) times pushes over the steps of each leg: (m, p, k)."""
    size = runs.end - runs.begin
    width = pushes(np.zeros(0, dtype=np.intp)).shape[-1]
    found = np.zeros((runs.count, width, functions.shape[1]))
    order = np.argsort(size, kind="stable")
    for alike in np.split(order, np.flatnonzero(np.diff(size[order])) + 1):
        within = np.arange(size[alike[0]])
        for begin in range(0, alike.size, max(1, BLOCK // max(within.size, 1))):
            legs = alike[begin : begin + max(1, BLOCK // max(within.size, 1))]
            steps = runs.begin[legs, None] + within
            found[legs] = pushes(steps).swapaxes(1, 2) @ functions[steps]
    return found
