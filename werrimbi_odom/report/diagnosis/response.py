# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is left of an error in each part of a variable's range, with error bars.

A leg of a quarter of a metre runs through most of a wheel's turn, so an error that goes with the
wheel's angle averages out in it. As the evidence map does, this asks which error of the single
steps, constant in each part of the range, explains the legs' innovations best, beside all that
calibration can explain; but it asks for parts, not for a law, so that it shows any law as it is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.diagnosis.evidence import Amount, legs_pushed, pushes_of
from werrimbi_odom.inference.fitting.candidates import unexplained
from werrimbi_odom.inference.fitting.design import Point, unexpected
from werrimbi_odom.inference.fitting.knobs import Knob
from werrimbi_odom.inference.fitting.prediction import path_of, predict_all
from werrimbi_odom.inference.fitting.together import Together
from werrimbi_odom.inference.linear import SILENT
from werrimbi_odom.model.pose import Floats

PARTS = 12
_UNTOLD = 10.0  # times the usual error bar: a part in which next to nothing was driven
_BLURRED = (
    3e-3  # of the best told pattern of parts: one told worse would swing the curve for nothing
)
_SAME = 1e-9  # of the range: values nearer than this are one


@dataclass(frozen=True, slots=True)
class Response:
    """Error for each unit of its amount, over a variable; arrays of shape (parts,)."""

    centre: Floats
    value: Floats
    """Measured minus predicted."""
    std: Floats


def unit_of(amount: Amount) -> tuple[str, float]:
    """Unit in which an error for each unit of its amount is told, and the factor to it."""
    degree = math.degrees(1.0)
    if amount.channel == "heading":
        return {
            "turn": ("% of the turn", 100.0),
            "duration": ("° per s", degree),
        }.get(amount.per, ("° per m", degree))
    return ("mm per radian turned", 1e3) if amount.per == "turn" else ("mm per m", 1e3)


def parts_of(left: Floats, right: Floats, *, turns: bool) -> Floats:
    """Edges of the parts: equal ones of a turn, else such that each holds as many steps."""
    if turns:
        return np.linspace(0.0, 2.0 * np.pi, PARTS + 1)
    pooled = left if left is right else np.concatenate([left, right])
    edges = np.quantile(pooled, np.linspace(0.0, 1.0, PARTS + 1))
    wide = np.diff(edges) > _SAME * max(float(np.ptp(pooled)), 1e-300)
    return np.asarray(edges[np.concatenate([[True], wide])])


def response(
    runs: Together,
    point: Point,
    kind: ReferenceKind,
    knobs: Sequence[Knob],
    amount: Amount,
    values: tuple[Floats, Floats],
    edges: Floats,
) -> Response:
    """What is left of an error over a variable.

    Parameters
    ----------
    knobs
        What the model could turn: what they can explain is taken off.
    values : (ndarray, ndarray), shape (n,) each
        The variable at every step, for left and right wheel.
    edges : ndarray, shape (parts + 1,)
    """
    prediction = predict_all(point.model, runs)
    frame, rest = unexplained(runs, point, kind, knobs, prediction)
    path = path_of(point.model, runs)
    of_left, of_right = pushes_of(runs, path, amount, point)
    left, right = (_marks(side, edges) for side in values)
    change = legs_pushed(runs, left, of_left)
    if values[0] is not values[1] or amount.channel in ("left", "right", "along"):
        change = change + legs_pushed(runs, right, of_right)
    marks = unexpected(runs, point, kind, prediction).marks(change)
    flat = marks[..., : change.shape[-1]].reshape(rest.size, -1)
    length = np.sqrt(np.sum(flat**2, axis=0))
    heard = length > SILENT
    scale, free = length[heard], frame.residual(flat[:, heard])
    normal = (free / scale).T @ (free / scale)
    # What the knobs explain as well (a constant, mostly) is no part of it: left out, not blown up.
    inverse = np.linalg.pinv(normal, rcond=_BLURRED, hermitian=True)
    solution = -(inverse @ ((free / scale).T @ rest)) / scale
    excess = max(float(np.mean(rest**2)), 1.0)  # errors larger than promised: wider bars
    spread = np.sqrt(np.maximum(np.diag(inverse), 0.0) * excess) / scale
    centre = np.array([_centre(values, edges, part) for part in range(edges.size - 1)])
    told = spread <= _UNTOLD * np.median(spread)
    return Response(centre[heard][told], solution[told], spread[told])


def _marks(values: Floats, edges: Floats) -> Floats:
    """In which part each step is, (n, parts)."""
    part = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, edges.size - 2)
    return np.asarray(part[:, None] == np.arange(edges.size - 1), dtype=np.float64)


def _centre(values: tuple[Floats, Floats], edges: Floats, part: int) -> float:
    low, high = edges[part], edges[part + 1]
    inside = [side[(side >= low) & (side <= high)] for side in values]
    every = np.concatenate(inside)
    return float(every.mean()) if every.size else 0.5 * float(low + high)
