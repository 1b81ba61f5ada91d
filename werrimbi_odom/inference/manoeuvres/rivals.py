# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""How well a drive would tell rivals apart, worked out before it is driven.

Effect A, at the size that was fitted, changes the innovations of the drive. What the rival B cannot
follow, with everything else that may be fitted, is what would tell them apart: by how much the cost
of B would exceed that of A. The drives there are already count too: they fix how large B must be.
All to first order, nothing is fitted.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference.fitting.candidates import CALIBRATED, Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.design import Point, stacked, unexpected
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter, Model
from werrimbi_odom.inference.fitting.prediction import legs_shown, predict_all
from werrimbi_odom.inference.linear import SILENT, nuisance, solved
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.pose import Floats

_RELUCTANT, _WILLING = 1.0, 0.1
"""What it costs calibrations beside a rival, and the rival itself, to do all of the target's work
[standard deviations]: less than the drives tell, where they tell the two apart, and the rival's is
there lest two coordinates that do the same grow against each other."""


@dataclass(frozen=True)
class Experiment:
    """Some drives, the model to begin from, and how all that may be fitted acts in them."""

    runs: Concatenated
    point: Point

    def whitened(self, changes: Floats) -> Floats:
        """Changes of the legs (m, 3, p) as they appear in the innovations, (3 m, p)."""
        prediction = predict_all(self.point.model, self.runs)
        found = unexpected(self.runs, self.point, prediction)
        marks = found.marks(changes)[..., : changes.shape[-1]]
        return np.asarray(marks.reshape(-1, changes.shape[-1]))

    def nuisances(self, numbers: Sequence[FreeParameter]) -> Floats:
        """Columns of what each run has of its own, and of other numbers; (3 m, q)."""
        every = [*numbers, *self.point.model.nuisance_parameters]
        return stacked(self.runs, self.point, every).flat()[1]

    def marks(self, candidate: Candidate) -> Floats:
        """Derivatives of the legs along a candidate's coordinates, (m, 3, k)."""
        model = self.point.model
        none = legs_shown(model, self.runs)
        columns = []
        for coordinate in candidate.coordinates:
            ahead = candidate.with_value(coordinate, 1.0)
            behind = candidate.with_value(coordinate, -1.0)
            forth = legs_shown(_holding(model, ahead), self.runs)
            one_sided = behind.values == candidate.with_value(coordinate, 0.0).values
            back = none if one_sided else legs_shown(_holding(model, behind), self.runs)
            columns.append((forth - back) / (1.0 if one_sided else 2.0))
        return np.stack(columns, axis=-1)

    def change(self, applied: AppliedEffect) -> Floats:
        """What an effect of a given size does to the legs, (m, 3, 1)."""
        model = self.point.model
        changed = legs_shown(_holding(model, applied), self.runs) - legs_shown(model, self.runs)
        return changed[..., None]

    def each_run(self, marks: Floats) -> Floats:
        """Columns (3 m, k) given to each run anew, (3 m, k runs)."""
        run = np.repeat(self.runs.run_of_leg, 3)
        return np.concatenate(
            [marks * (run == index)[:, None] for index in range(len(self.runs.runs))], axis=-1
        )


def _holding(model: Model, applied: AppliedEffect) -> Model:
    return replace(model, robot=replace(model.robot, effects=(*model.robot.effects, applied)))


@dataclass(frozen=True)
class Sensitivities:
    """What some effects would change in some drives."""

    drives: Experiment
    legs: Mapping[str, Floats]
    """Of each effect, changes of the legs along its coordinates, (m, 3, k)."""
    white: Mapping[str, Floats]
    """The same in the innovations, (3 m, k)."""
    own: Floats
    """Columns of what may be fitted beside them, (3 m, q)."""


def sensitivities_of(
    drives: Experiment, candidates: Sequence[Candidate], numbers: Sequence[FreeParameter]
) -> Sensitivities:
    """Try effects on drives; `numbers` are those of effects that the model holds already."""
    legs = {item.name: drives.marks(item) for item in candidates}
    white = {name: drives.whitened(marks) for name, marks in legs.items()}
    return Sensitivities(drives, legs, white, drives.nuisances(numbers))


@dataclass(frozen=True)
class Trace:
    """An effect at a size: what it changes in the legs (m, 3) and in the innovations (3 m,)."""

    name: str
    legs: Floats
    white: Floats


def trace_at(look: Sensitivities, applied: AppliedEffect) -> Trace:
    """An effect at its fitted size."""
    change = look.drives.change(applied)
    return Trace(applied.name, change[..., 0], look.drives.whitened(change)[:, 0])


def trace_along(look: Sensitivities, name: str, sizes: Floats) -> Trace:
    """An effect so far along its coordinates (k,)."""
    return Trace(name, look.legs[name] @ sizes, look.white[name] @ sizes)


def best_alias(look: Sensitivities, target: Trace, rival: Candidate) -> Floats:
    """How far along its coordinates a rival looks most like the target in some drives, (k,).

    Where a calibration beside it could do the same within the noise (one circle cannot tell a base
    that depends on the turning from a base), the rival does it: else it would be imagined with next
    to nothing of itself, and no drive could tell that from the calibration.
    """
    squeezed, width = _squeezed(look, target, (rival.name, *_beside(target.name, rival)), ())
    columns, wanted = squeezed[:, :width], squeezed[:, width]
    own, whole = look.white[rival.name].shape[-1], float(np.linalg.norm(wanted))
    if whole < SILENT:
        return np.zeros(own)
    costs = np.where(np.arange(width) < own, _WILLING, _RELUCTANT) / whole
    slow = np.diag(costs * np.linalg.norm(columns, axis=0))
    found = solved(np.concatenate([columns, slow]), np.concatenate([wanted, np.zeros(width)]))
    return np.asarray(found[:own])


def separation(pairs: Sequence[tuple[Sensitivities, Trace]], rival: Candidate) -> float:
    """Rise of the cost if the rival, fitted to all these drives, must stand for the target."""
    name = pairs[0][1].name
    beside = _beside(name, rival)
    shared, anew = ((), (rival.name,)) if rival.per_run else ((rival.name,), ())
    parts = [_squeezed(look, target, (*shared, *beside), anew) for look, target in pairs]
    rows, width = np.concatenate([part for part, _ in parts]), parts[0][1]
    solution = solved(rows[:, :width], rows[:, width])
    return float(np.sum((rows[:, width] - rows[:, :width] @ solution) ** 2))


def difference(
    known: tuple[Sensitivities, Trace], ahead: tuple[Sensitivities, Trace], rival: Candidate
) -> Floats:
    """Legs (m, 3) of drives ahead: the target less what the rival, known so far, would make."""
    names = (rival.name, *_beside(known[1].name, rival))
    squeezed, width = _squeezed(known[0], known[1], names, ())
    solution = solved(squeezed[:, :width], squeezed[:, width])
    marks = np.concatenate([ahead[0].legs[name] for name in names], axis=-1)
    return np.asarray(ahead[1].legs - marks @ solution)


def _beside(target: str, rival: Candidate) -> tuple[str, ...]:
    """What may be calibrated while the rival stands for the target."""
    return tuple(name for name in CALIBRATED if name not in (target, rival.name))


def _squeezed(
    look: Sensitivities, target: Trace, shared: Sequence[str], anew: Sequence[str]
) -> tuple[Floats, int]:
    """Least squares of these drives in few rows: columns of what is shared, then the target."""
    own = np.concatenate(
        [look.own, *(look.drives.each_run(look.white[name]) for name in anew)], axis=-1
    )
    columns = [*(look.white[name] for name in shared), target.white[:, None]]
    wanted = np.concatenate(columns, axis=-1)
    free = nuisance(own).residual(wanted)
    return np.asarray(np.linalg.qr(free, mode="r")), wanted.shape[-1] - 1
