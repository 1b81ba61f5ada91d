# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the model fails, before any name is given to it: what the errors depend on.

Under a complete model the whitened innovations depend on nothing. Each cell of the evidence map
asks whether the error of one channel (left, right, along, sideways, heading) goes with one measured
variable, as a line or as any smooth curve. It is a score test: the pattern that such a dependence
would leave in the innovations, less what the model can turn already, against what is there.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.chances import chi2_above
from werrimbi_odom.inference.diagnosis.variables import (
    CONSTANT,
    Form,
    Variable,
    floor_cells,
    functions_of,
    variables_of,
)
from werrimbi_odom.inference.fitting.candidates import of_each_run, unexplained
from werrimbi_odom.inference.fitting.design import Point, unexpected
from werrimbi_odom.inference.fitting.knobs import Knob
from werrimbi_odom.inference.fitting.prediction import DrivenPath, path_of, predict_all
from werrimbi_odom.inference.fitting.together import Together
from werrimbi_odom.inference.linear import Nuisance, ScoreTest, score_test_of_products
from werrimbi_odom.inference.rules import FLOOR_CELL, NEIGHBOUR
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.view import View

BATCH = 2_000_000
"""Numbers of legs times columns that go through the filter at once."""

CHANNELS = ("left", "right", "along", "sideways", "heading")


@dataclass(frozen=True, slots=True)
class Amount:
    """What an error is in proportion to, beside its variable."""

    channel: str
    """left, right, along (both wheels alike), sideways or heading."""
    per: str
    """travel (signed), path (unsigned), turn or duration."""


AMOUNTS = (
    Amount("left", "travel"),
    Amount("right", "travel"),
    Amount("along", "travel"),
    Amount("along", "path"),
    Amount("along", "turn"),
    Amount("sideways", "travel"),
    Amount("sideways", "path"),
    Amount("sideways", "turn"),
    Amount("heading", "turn"),
    Amount("heading", "travel"),
    Amount("heading", "path"),
    Amount("heading", "duration"),
)


@dataclass(frozen=True, slots=True)
class Dependence:
    """One cell of the evidence map."""

    amount: Amount
    variable: Variable
    form: Form
    coefficients: Floats
    """Of the form's functions; (k,), or (runs, k) where each run has its own zero."""
    gain: float
    """Fall of the squared innovations, in their own variances."""
    degrees: int
    p_value: float
    """Corrected for the number of cells looked at (Bonferroni)."""

    @property
    def channel(self) -> str:
        """Which error."""
        return self.amount.channel

    @property
    def name(self) -> str:
        """What it goes with: the variable, or where it depends on none, what it is per."""
        return self.amount.per if self.variable.name == CONSTANT else self.variable.name


def place_of(cell: Dependence) -> tuple[float, float]:
    """Where on the floor most of an error is, in the reference's frame [m].

    The floor's cell of the most certain error, and its neighbours with an error of the same sign:
    the middle of them all, each by its certainty. That is finer than a cell is wide.
    """
    x, y = cell.variable.left, cell.variable.right
    cells = floor_cells(x, y)
    steps = cells.sum(axis=0)
    middle = np.stack([cells.T @ x, cells.T @ y], axis=-1) / steps[:, None]
    certain = cell.coefficients**2 * steps
    first = int(np.argmax(certain))
    area = np.ptp(x) * np.ptp(y) / steps.size
    near = np.hypot(*(middle - middle[first]).T) < NEIGHBOUR * max(np.sqrt(area), FLOOR_CELL)
    same = np.sign(cell.coefficients) == np.sign(cell.coefficients[first])
    weight = certain * (near & same)
    px, py = weight @ middle / weight.sum()
    return float(px), float(py)


def dependences(
    runs: Together, point: Point, kind: ReferenceKind, knobs: Sequence[Knob]
) -> tuple[Dependence, ...]:
    """All cells of the map for a model, the most certain first.

    `knobs` are what the model can turn: what they can explain is no evidence.
    """
    prediction = predict_all(point.model, runs)
    frame, rest = unexplained(runs, point, kind, knobs, prediction)
    found: list[tuple[Amount, Variable, Form, Floats, float, int]] = []
    path = path_of(point.model, runs)
    levers = {amount: _levers(runs, pushes_of(runs, path, amount, point)) for amount in AMOUNTS}
    for cells_of in _batches(runs, variables_of(runs, point.model), levers):
        change = np.concatenate([block for *_, block in cells_of], axis=-1)
        marks = unexpected(runs, point, kind, change, prediction).whitened()[1]
        first = 0
        for amount, variable, form, block in cells_of:
            own = marks[..., first : first + block.shape[-1]]
            first += block.shape[-1]
            if variable.per_run:
                own = of_each_run(runs, own)
            tested = _tested(own.reshape(rest.size, -1), frame, rest)
            if tested is not None:
                solution, gain, degrees = tested.coefficients, tested.gain, tested.degrees
                found.append((amount, variable, form, solution, gain, degrees))
    cells = [
        Dependence(
            amount,
            variable,
            form,
            solution.reshape(len(runs.runs), -1) if variable.per_run else solution,
            gain,
            degrees,
            min(1.0, chi2_above(gain, degrees) * len(found)),
        )
        for amount, variable, form, solution, gain, degrees in found
    ]
    return tuple(sorted(cells, key=lambda cell: (cell.p_value, -cell.gain / cell.degrees)))


def _tested(flat: Floats, frame: Nuisance, rest: Floats) -> ScoreTest | None:
    """Score test of some columns; with no copy of them less the nuisances, for there are many."""
    cross = frame.basis.T @ flat
    size = np.sqrt(np.sum(flat**2, axis=0))
    # The rest is clear of the nuisances already.
    return score_test_of_products(flat.T @ flat - cross.T @ cross, flat.T @ rest, size)


Cell = tuple[Amount, Variable, Form, Floats]


def _batches(
    runs: Together, variables: Sequence[Variable], levers: Mapping[Amount, _Levers]
) -> Iterator[list[Cell]]:
    """Cells with their changes of the legs, as many as memory bears at once."""
    batch: list[Cell] = []
    width = 0
    for variable in variables:
        for amount, form, block in _blocks(runs, variable, levers):
            batch.append((amount, variable, form, block))
            width += block.shape[-1]
        if width * runs.count > BATCH:
            yield batch
            batch, width = [], 0
    if batch:
        yield batch


def _blocks(
    runs: Together, variable: Variable, levers: Mapping[Amount, _Levers]
) -> Iterator[tuple[Amount, Form, Floats]]:
    """Changes of the legs (m, 3, k) for each amount and form."""
    steps = runs.inside
    for form, (left, right) in functions_of(variable).items():
        alike = left is right
        of_left = left[steps]
        of_right = of_left if alike else right[steps]
        for amount, lever in levers.items():
            if alike:
                yield amount, form, _summed(lever.both, of_left)
            elif amount.channel in ("left", "right", "along"):
                yield amount, form, _summed(lever.left, of_left) + _summed(lever.right, of_right)


class _Levers(NamedTuple):
    """Sums over each leg's steps as sparse matrices (m, steps in legs), for x, y and yaw."""

    left: list[Any]
    right: list[Any]
    both: list[Any]


def _levers(runs: Together, pushes: tuple[Floats, Floats]) -> _Levers:
    steps = runs.inside
    left, right = (_sums(runs, part[steps]) for part in pushes)
    return _Levers(left, right, _sums(runs, pushes[0][steps] + pushes[1][steps]))


def _sums(runs: Together, pushes: Floats) -> list[Any]:
    from scipy.sparse import csr_array

    ends = np.concatenate([[0], np.cumsum(runs.end - runs.begin)])
    columns, shape = np.arange(pushes.shape[0]), (runs.count, pushes.shape[0])
    return [csr_array((part, columns, ends), shape=shape) for part in pushes.T.copy()]


def _summed(sums: list[Any], functions: Floats) -> Floats:
    return np.stack([part @ functions for part in sums], axis=1)


def legs_pushed(runs: Together, functions: Floats, pushes: Floats) -> Floats:
    """Sums over each leg's steps of functions (n, k) times pushes (n, 3), as (m, 3, k)."""
    steps = runs.inside
    return _summed(_sums(runs, pushes[steps]), functions[steps])


def pushes_of(
    runs: Together, path: DrivenPath, amount: Amount, point: Point
) -> tuple[Floats, Floats]:
    """What a unit error of a step does to its leg's relative pose: of left and right wheel, (n, 3).

    Where the amount belongs to the robot, the second is zero.
    """
    robot = point.model.robot
    travel, motion = path.travel, path.motion
    none = np.zeros(motion.turn.size)
    view = view_of(robot.effects)
    if amount.channel in ("left", "right", "along") and amount.per != "turn":
        left = travel.left if amount.per == "travel" else np.abs(travel.left)
        right = travel.right if amount.per == "travel" else np.abs(travel.right)
        of_left = _seen(runs, path, view, 0.5 * left, none, -left / robot.track)
        of_right = _seen(runs, path, view, 0.5 * right, none, right / robot.track)
        if amount.channel == "left":
            return of_left, 0.0 * of_right
        if amount.channel == "right":
            return 0.0 * of_left, of_right
        return of_left, of_right
    base = {
        "travel": motion.along,
        "path": np.abs(motion.along),
        "turn": motion.turn,
        "duration": runs.drive(robot).duration,
    }[amount.per]
    if amount.channel == "along":
        moved = _seen(runs, path, view, base, none, none)
    elif amount.channel == "sideways":
        moved = _seen(runs, path, view, none, base, none)
    else:
        moved = _seen(runs, path, view, none, none, base)
    return moved, 0.0 * moved


def _seen(
    runs: Together, path: DrivenPath, view: View, along: Floats, sideways: Floats, turn: Floats
) -> Floats:
    """Errors of steps (n,) as they move the end of their leg, in its start's frame, (n, 3)."""
    count = along.size
    leg = np.clip(np.searchsorted(runs.begin, np.arange(count), side="right") - 1, 0, None)
    facing = np.exp(-1j * (path.yaw[runs.begin[leg]] + view.yaw))
    middle = np.exp(1j * (path.yaw[:-1] + 0.5 * path.motion.turn))
    end = runs.end[leg]
    marker = path.position[end] + complex(view.ahead, view.left) * np.exp(1j * path.yaw[end])
    moved = facing * (
        middle * (along + 1j * sideways)
        + 1j * turn * (marker - 0.5 * (path.position[:-1] + path.position[1:]))
    )
    return np.stack([moved.real, moved.imag, turn], axis=-1)
