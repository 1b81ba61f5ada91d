# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Expected evidence of a drive between rivals, before it is driven (experiment design).

Effect A, at its fitted size, changes the innovations of the drive. The part of it that rival B
cannot follow, with everything else refitted, tells them apart: it is the expected rise of B's cost
over A's. The recorded drives count as well, as they determine the size of B. All is to first order,
without any fit.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import FreeParameter, Model
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.prediction import predict_all, predicted_legs
from werrimbi_odom.inference.fitting.whitened_innovations import Point, stacked, unexpected
from werrimbi_odom.inference.linear import SILENT, nuisance, solved
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.pose import Floats

_RELUCTANT, _WILLING = 1.0, 0.1
"""Ridge penalty for calibrations, and for the rival itself, to produce all of the target's change
[standard deviations]. It is below the information of drives that tell the two apart. The rival's
keeps two equivalent coordinates from growing against each other."""


@dataclass(frozen=True)
class Experiment:
    """Some drives, the model to begin from, and the Jacobians of all that may be fitted."""

    runs: Concatenated
    point: Point

    def whitened(self, changes: Floats) -> Floats:
        """Changes of the legs (m, 3, p) as changes of the whitened innovations, (3 m, p)."""
        prediction = predict_all(self.point.model, self.runs)
        found = unexpected(self.runs, self.point, prediction)
        marks = found.marks(changes)[..., : changes.shape[-1]]
        return np.asarray(marks.reshape(-1, changes.shape[-1]))

    def nuisances(self, numbers: Sequence[FreeParameter]) -> Floats:
        """Columns of per-run and other parameters; (3 m, q)."""
        every = [*numbers, *self.point.model.nuisance_parameters]
        return stacked(self.runs, self.point, every).flat()[1]

    def marks(self, candidate: Candidate) -> Floats:
        """Derivatives of the legs along a candidate's coordinates, (m, 3, k)."""
        model = self.point.model
        none = predicted_legs(model, self.runs)
        columns = []
        for coordinate in candidate.coordinates:
            ahead = candidate.with_value(coordinate, 1.0)
            behind = candidate.with_value(coordinate, -1.0)
            forth = predicted_legs(_holding(model, ahead), self.runs)
            one_sided = behind.values == candidate.with_value(coordinate, 0.0).values
            back = none if one_sided else predicted_legs(_holding(model, behind), self.runs)
            columns.append((forth - back) / (1.0 if one_sided else 2.0))
        return np.stack(columns, axis=-1)

    def change(self, applied: AppliedEffect) -> Floats:
        """Change of the legs by an effect of a given size, (m, 3, 1)."""
        model = self.point.model
        changed = predicted_legs(_holding(model, applied), self.runs) - predicted_legs(
            model, self.runs
        )
        return changed[..., None]

    def each_run(self, marks: Floats) -> Floats:
        """Expand columns (3 m, k) to one copy per run, (3 m, k runs)."""
        run = np.repeat(self.runs.run_of_leg, 3)
        return np.concatenate(
            [marks * (run == index)[:, None] for index in range(len(self.runs.runs))], axis=-1
        )


def _holding(model: Model, applied: AppliedEffect) -> Model:
    return replace(model, robot=replace(model.robot, effects=(*model.robot.effects, applied)))


@dataclass(frozen=True)
class Sensitivities:
    """Jacobians of some effects in some drives."""

    drives: Experiment
    legs: Mapping[str, Floats]
    """For each effect, changes of the legs along its coordinates, (m, 3, k)."""
    white: Mapping[str, Floats]
    """The same for the whitened innovations, (3 m, k)."""
    own: Floats
    """Columns of the nuisance parameters, (3 m, q)."""


def sensitivities_of(
    drives: Experiment, candidates: Sequence[Candidate], numbers: Sequence[FreeParameter]
) -> Sensitivities:
    """Compute the Jacobians; `numbers` are parameters of effects that the model already has."""
    legs = {item.name: drives.marks(item) for item in candidates}
    white = {name: drives.whitened(marks) for name, marks in legs.items()}
    return Sensitivities(drives, legs, white, drives.nuisances(numbers))


@dataclass(frozen=True)
class Trace:
    """Change of legs (m, 3) and innovations (3 m,) by an effect of a given size."""

    name: str
    legs: Floats
    white: Floats


def trace_at(look: Sensitivities, applied: AppliedEffect) -> Trace:
    """Trace of an effect at its fitted size."""
    change = look.drives.change(applied)
    return Trace(applied.name, change[..., 0], look.drives.whitened(change)[:, 0])


def trace_along(look: Sensitivities, name: str, sizes: Floats) -> Trace:
    """Trace of an effect at a distance along its coordinates (k,)."""
    return Trace(name, look.legs[name] @ sizes, look.white[name] @ sizes)


def best_alias(look: Sensitivities, target: Trace, rival: Candidate) -> Floats:
    """Size of a rival that looks most like the target in some drives, (k,).

    Where a calibration could do the same within the noise (on one circle, a base that depends on
    the turn rate equals a base), the change is attributed to the rival. Otherwise the rival would
    be assumed at almost zero size, and no drive could tell that from the calibration.
    """
    return _aliased(look, target, rival)[: look.white[rival.name].shape[-1]]


def _aliased(look: Sensitivities, target: Trace, rival: Candidate) -> Floats:
    """Sizes of the rival and of the calibrations beside it, as fitted to the target, (k,)."""
    squeezed, width = _squeezed(look, target, (rival.name, *_beside(target.name, rival)), ())
    columns, wanted = squeezed[:, :width], squeezed[:, width]
    own, whole = look.white[rival.name].shape[-1], float(np.linalg.norm(wanted))
    if whole < SILENT:
        return np.zeros(width)
    costs = np.where(np.arange(width) < own, _WILLING, _RELUCTANT) / whole
    slow = np.diag(costs * np.linalg.norm(columns, axis=0))
    return solved(np.concatenate([columns, slow]), np.concatenate([wanted, np.zeros(width)]))


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
    """Legs (m, 3) of new drives: the target less the rival as fitted to the known drives."""
    names = (rival.name, *_beside(known[1].name, rival))
    marks = np.concatenate([ahead[0].legs[name] for name in names], axis=-1)
    return np.asarray(ahead[1].legs - marks @ _aliased(*known, rival))


def _beside(target: str, rival: Candidate) -> tuple[str, ...]:
    """Calibration effects that are fitted while the rival stands for the target."""
    return tuple(name for name in CALIBRATED if name not in (target, rival.name))


def _squeezed(
    look: Sensitivities, target: Trace, shared: Sequence[str], anew: Sequence[str]
) -> tuple[Floats, int]:
    """Least squares of these drives, reduced by QR: shared parameters, then the target."""
    own = np.concatenate(
        [look.own, *(look.drives.each_run(look.white[name]) for name in anew)], axis=-1
    )
    columns = [*(look.white[name] for name in shared), target.white[:, None]]
    wanted = np.concatenate(columns, axis=-1)
    free = nuisance(own).residual(wanted)
    return np.asarray(np.linalg.qr(free, mode="r")), wanted.shape[-1] - 1
