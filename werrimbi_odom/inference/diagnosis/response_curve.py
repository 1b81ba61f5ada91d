# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Response curve: the remaining error in each bin of a variable's range, with error bars.

A leg of a quarter of a metre spans most of a wheel's turn, so an error that depends on the wheel's
angle averages out in it. As in the evidence map, the estimate is therefore the error of the single
steps, constant in each bin, that explains the innovations of the legs best, with the calibration as
nuisance. A curve of bins assumes no law, so it shows any law as it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.effect_support import support_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence, summed_over_legs
from werrimbi_odom.inference.diagnosis.forward_selection import tried_with
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount, step_jacobians
from werrimbi_odom.inference.diagnosis.variables import CONSTANT
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, FreeParameter, Model
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.prediction import path_of, predict_all
from werrimbi_odom.inference.fitting.score_tests import residual_innovations
from werrimbi_odom.inference.fitting.whitened_innovations import Point, unexpected
from werrimbi_odom.inference.linear import SILENT
from werrimbi_odom.model.pose import Floats

PARTS = 12
_UNTOLD = 10.0  # times the median error bar: a bin in which next to nothing was driven
_BLURRED = 3e-3  # of the best determined pattern of bins: worse ones would only add noise
_SAME = 1e-9  # of the range: values nearer than this are equal


@dataclass(frozen=True, slots=True)
class Response:
    """Error per unit of its amount, over a variable; arrays of shape (parts,)."""

    centre: Floats
    value: Floats
    """Measured minus predicted."""
    std: Floats


def parts_of(left: Floats, right: Floats, *, turns: bool) -> Floats:
    """Edges of the bins: equal bins of a turn, else quantiles."""
    if turns:
        return np.linspace(0.0, 2.0 * np.pi, PARTS + 1)
    pooled = left if left is right else np.concatenate([left, right])
    edges = np.quantile(pooled, np.linspace(0.0, 1.0, PARTS + 1))
    wide = np.diff(edges) > _SAME * max(float(np.ptp(pooled)), 1e-300)
    return np.asarray(edges[np.concatenate([[True], wide])])


def response(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    amount: Amount,
    values: tuple[Floats, Floats],
    edges: Floats,
) -> Response:
    """Estimate the remaining error over a variable.

    `numbers`: nuisance parameters, which are projected out. `amount`: error channel, and what the
    error is proportional to. `values` (n,): the variable at every step, for left and right wheel.
    `edges` (parts + 1,): edges of the bins.
    """
    prediction = predict_all(point.model, runs)
    frame, rest = residual_innovations(runs, point, numbers, prediction)
    path = path_of(point.model, runs)
    of_left, of_right = step_jacobians(runs, path, [amount], point)
    left, right = (_marks(side, edges) for side in values)
    change = summed_over_legs(runs, left, of_left) + summed_over_legs(runs, right, of_right)
    marks = unexpected(runs, point, prediction).marks(change)
    flat = marks[..., : change.shape[-1]].reshape(rest.size, -1)
    length = np.sqrt(np.sum(flat**2, axis=0))
    heard = length > SILENT
    scale, free = length[heard], frame.residual(flat[:, heard])
    normal = (free / scale).T @ (free / scale)
    # Patterns that nuisances explain as well (mostly a constant) are left out, not amplified.
    inverse = np.linalg.pinv(normal, rcond=_BLURRED, hermitian=True)
    solution = -(inverse @ ((free / scale).T @ rest)) / scale
    excess = max(float(np.mean(rest**2)), 1.0)  # errors larger than the noise model: wider bars
    spread = np.sqrt(np.maximum(np.diag(inverse), 0.0) * excess) / scale
    centre = np.array([_centre(values, edges, part) for part in range(edges.size - 1)])
    told = spread <= _UNTOLD * np.median(spread)
    return Response(centre[heard][told], solution[told], spread[told])


def _marks(values: Floats, edges: Floats) -> Floats:
    """Indicator of the bin of each step, (n, parts)."""
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    return np.asarray(part[:, None] == np.arange(edges.size - 1), dtype=np.float64)


def _centre(values: tuple[Floats, Floats], edges: Floats, part: int) -> float:
    low, high = edges[part], edges[part + 1]
    inside = [side[(side >= low) & (side <= high)] for side in values]
    every = np.concatenate(inside)
    return float(every.mean()) if every.size else 0.5 * float(low + high)


_FOR_CALIBRATION = {
    "track_width": (Amount("heading", "turn"), ("yaw_rate", "yaw_rate_size")),
    "unequal_wheel_radii": (Amount("heading", "travel"), ("speed", "distance")),
    "wheel_radius_scale": (Amount("along", "travel"), ("speed", "distance")),
}
"""Error and variables in which a wrong size shows as a straight line."""


@dataclass(frozen=True, kw_only=True)
class BeforeAfter:
    """Contents of the figure."""

    effect: str | None
    """None: no effect of the library, only the dependence."""
    cell: Dependence
    before: Response
    after: Response | None
    turns: bool
    aligned: bool
    """Whether the angle of each run was shifted by its fitted phase."""


def before_after(diagnosis: Diagnosis) -> BeforeAfter | None:
    """The error over the variable of the first effect found that has one; None where none has.

    Set-up mistakes have a figure of their own: see `set_up_figure`.
    """
    mistakes = {finding.effect for finding in diagnosis.set_up.findings}
    shown: tuple[str | None, ...] = diagnosis.found or diagnosis.rivals[:1] or (None,)
    if mistakes & set(shown[:1]):
        return None
    cells = ((name, _own_cell(diagnosis, name)) for name in shown)
    effect, cell = next(((name, own) for name, own in cells if own is not None), (None, None))
    if cell is None or cell.form == "place":
        return None
    start = diagnosis.rounds[0].before
    point, numbers = start.point, (*CALIBRATION, *start.numbers)
    if effect in CALIBRATED:
        own = tuple({} for _ in point.model.own) if not start.numbers else point.model.own
        point = replace(point, model=Model(diagnosis.set_up.robot, own))
        numbers = start.numbers
    after = _after(diagnosis, effect) if effect is not None else None
    values, aligned = _values(diagnosis, cell, effect, after)
    turns = cell.form == "turns"
    edges = parts_of(*values, turns=turns)

    def at(where: Point, free: tuple[FreeParameter, ...]) -> Response:
        return response(diagnosis.runs, where, free, cell.amount, values, edges)

    return BeforeAfter(
        effect=effect,
        cell=cell,
        before=at(point, numbers),
        after=None if after is None else at(after, numbers),
        turns=turns,
        aligned=aligned,
    )


def _own_cell(diagnosis: Diagnosis, effect: str | None) -> Dependence | None:
    """Cell of the evidence map that the effect is about; without an effect, the strongest cell."""
    cells = [cell for cell in diagnosis.depends_on if cell.variable.name != CONSTANT]
    by_worth = sorted(cells, key=lambda cell: 2 * cell.degrees - cell.gain)
    if not by_worth:
        return None
    if effect is None:
        return by_worth[0] if diagnosis.verdict == "unknown" else None
    if effect in _FOR_CALIBRATION:
        amount, names = _FOR_CALIBRATION[effect]
        of_it = (cell for name in names for cell in by_worth if cell.variable.name == name)
        return next((cell for cell in of_it if cell.amount == amount), None)
    for this in diagnosis.rounds:
        for score in this.scores:
            if score.candidate.name != effect:
                continue
            drive = diagnosis.runs.drive(this.before.point.model.robot)
            support = support_of(score.candidate, drive)
            own = [
                cell
                for cell in by_worth
                if cell.channel in support.outputs
                and set(cell.variable.looks_at) & support.inputs
                and cell.form != "place"
            ]
            return own[0] if own else None
    return None


def _after(diagnosis: Diagnosis, effect: str) -> Point | None:
    """The fitted model with the effect."""
    if effect in diagnosis.final.names or effect in diagnosis.found:
        return diagnosis.final.point
    tried = tried_with(diagnosis.rounds, effect)
    return tried[0].point if tried else None


def _values(
    diagnosis: Diagnosis, cell: Dependence, effect: str | None, after: Point | None
) -> tuple[tuple[Floats, Floats], bool]:
    """The variable at every step; angles are counted from the fitted phase of each run."""
    variable = cell.variable
    if cell.form != "turns":
        return (variable.left, variable.right), False
    run = diagnosis.runs.run_of_step
    shift = np.zeros(run.size)
    aligned = False
    if variable.per_run and effect is not None and after is not None:
        for applied in after.model.robot.effects:
            if applied.name == effect and applied.effect.quadrature is not None:
                phase = applied.effect.quadrature[1]
                key, shared = f"{effect}.{phase}", applied.values[phase]
                own = [mine.get(key, shared) for mine in after.model.own]
                shift, aligned = np.array(own)[run], True
    if variable.per_run and not aligned:
        waves = np.atleast_2d(cell.coefficients)
        peaks = np.arctan2(waves[:, 1], waves[:, 0]) / variable.harmonic
        shift, aligned = -peaks[run], True
    angle = np.mod(variable.left + shift, 2.0 * np.pi)
    return (angle, angle), aligned
