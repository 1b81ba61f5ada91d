# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Where the model fails, before any name is given to it: what the errors depend on.

Under a complete model the whitened innovations depend on nothing. Each cell of the evidence map
asks whether the error of one channel (along, sideways, heading) goes with one measured variable of
the leg. It is a score test: the pattern that such a dependence would leave in the innovations, less
what recalibration could explain of it, against what is there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.design import stacked, unexpected
from werrimbi_odom.inference.fit import ModelFit
from werrimbi_odom.inference.knobs import Knob
from werrimbi_odom.inference.likelihood import ReferenceKind
from werrimbi_odom.inference.matching import MatchedRun
from werrimbi_odom.inference.prediction import Prediction, predict_all
from werrimbi_odom.inference.together import Together, together
from werrimbi_odom.model.pose import Floats

CHANNELS = ("along", "sideways", "heading")


@dataclass(frozen=True, slots=True)
class Dependence:
    """One cell of the evidence map."""

    channel: str
    """along, sideways or heading: which error."""
    variable: str
    """What it goes with."""
    slope: float
    """Error per unit of the variable [m or rad per unit]."""
    p_value: float
    """Corrected for the number of cells looked at (Bonferroni)."""


def dependences(
    runs: Sequence[MatchedRun], fit: ModelFit, kind: ReferenceKind, knobs: Sequence[Knob]
) -> tuple[Dependence, ...]:
    """All cells of the map for a fitted model, the most certain first.

    `knobs` are what the fit could turn: what they can explain is no evidence.
    """
    from scipy.stats import chi2

    point, laid = fit.point, together(runs)
    plain = [knob for knob in knobs if knob.per_run or knob in fit.free]
    white, basis = stacked(laid, point, kind, plain).flat()
    prediction = predict_all(point.model, laid)
    variables = leg_variables(laid, prediction)
    names = list(variables)
    marks = np.zeros((laid.count, 3, 3 * len(variables)))
    for column, of_legs in enumerate(variables.values()):
        for channel in range(3):
            marks[:, channel, 3 * column + channel] = of_legs
    patterns = unexpected(laid, point, kind, marks, prediction).whitened()[1]
    patterns = patterns[..., :-1].reshape(-1, marks.shape[-1])
    unexplained = _less(white[:, None], basis)[:, 0]
    marks = _less(patterns, basis)
    strength = np.sum(marks**2, axis=0)
    usable = strength > 1e-9 * np.sum(patterns**2, axis=0)
    score = marks.T @ unexplained
    cells = []
    for column in np.flatnonzero(usable).tolist():
        statistic = score[column] ** 2 / strength[column]
        cells.append(
            Dependence(
                CHANNELS[column % 3],
                names[column // 3],
                float(-score[column] / strength[column]),
                float(min(1.0, chi2.sf(statistic, 1) * int(usable.sum()))),
            )
        )
    return tuple(sorted(cells, key=lambda cell: cell.p_value))


def leg_variables(runs: Together, prediction: Prediction) -> dict[str, Floats]:
    """What a leg's error may go with; arrays of shape (m,), named with their units."""
    duration = runs.duration
    ends = np.cumsum(duration)
    elapsed = ends - duration - (ends - duration)[runs.legs[:-1]][runs.run_of_leg]
    heading = np.nan_to_num(runs.start[:, 2])
    travel, turn = prediction.along, prediction.turn
    return {
        "travel [m]": travel,
        "path length [m]": prediction.length,
        "turn [rad]": turn,
        "size of the turn [rad]": np.abs(turn),
        "travel × turn [m·rad]": travel * turn,
        "speed × turn [m·rad/s]": travel * turn / duration,
        "path towards the reference's x axis [m]": prediction.length * np.cos(heading),
        "path towards the reference's y axis [m]": prediction.length * np.sin(heading),
        "path × time since the start [m·s]": prediction.length * elapsed,
        "duration [s]": duration,
    }


def _less(columns: Floats, basis: Floats) -> Floats:
    """Columns less what the basis can explain of them."""
    if basis.shape[-1] == 0:
        return columns
    return np.asarray(columns - basis @ np.linalg.lstsq(basis, columns, rcond=1e-10)[0])
