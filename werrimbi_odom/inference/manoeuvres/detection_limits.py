# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Detection limits: the smallest size of an effect that the drives would have shown.

The limit follows from the Fisher information in the drives, with calibration and per-run parameters
as nuisances. At this size the score test finds the effect in 95 % of cases, at the significance of
the diagnosis, corrected for all candidates. Its statistic is then non-central chi-squared.

"Nothing is missing" means as much as what would have been detected. If an effect of typical size
would have stayed hidden, the report names a manoeuvre of the library that shows it with this
reference, or says that it takes a reference that measures more.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import base_name, name_of_base
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.effect_support import able, askable
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import noncentrality
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.free_parameters import STEP, FreeParameter
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.score_tests import OF_THE_MEASUREMENT
from werrimbi_odom.inference.linear import DETERMINED, SILENT, nuisance
from werrimbi_odom.inference.manoeuvres.expected_evidence import (
    Experiment,
    Sensitivities,
    sensitivities_of,
)
from werrimbi_odom.inference.manoeuvres.ideal_drives import pace_of
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES
from werrimbi_odom.inference.manoeuvres.simulated_record import imagined
from werrimbi_odom.model.effect import Effect


@dataclass(frozen=True, slots=True)
class DetectionLimit:
    """Detection limit of an effect."""

    effect: str
    parameter: str
    """The parameter with the lowest limit relative to its typical size; no shape parameter."""
    unit: str
    null: float
    minimum_detectable: float
    """Distance from null; infinite where none that is physically possible would be seen."""
    typical: float
    """Typical distance from null on robots."""
    shown_by: str | None = None
    """A manoeuvre that shows it with this reference, if it is hidden."""
    needs_more: bool = False
    """Whether no manoeuvre shows it with this reference, but one with positions and headings
    would."""

    @property
    def hidden(self) -> bool:
        """Whether an effect of typical size would have stayed hidden."""
        return not self.minimum_detectable < rules.HIDDEN_FROM * self.typical


def detection_limits(diagnosis: Diagnosis, effects: Sequence[Effect]) -> tuple[DetectionLimit, ...]:
    """Detection limits of all effects that are not in the model, in the library's order."""
    final, tried = diagnosis.final, diagnosis.rounds[-1].number
    robot = final.point.model.robot
    held = {applied.name for applied in robot.effects}
    if name_of_base(robot) in held:
        held.add("track_width")  # its base goes by that name
    candidates = [
        _typical(effect)
        for effect in able(effects, diagnosis.runs, robot)
        if not effect.is_mistake
        and effect.name not in OF_THE_MEASUREMENT
        and effect.name not in held
        and not effect.lacks(diagnosis.runs.channels)
        and base_name(effect) is None
    ]
    asked = {each.name for each in askable(effects, diagnosis.runs, robot)}
    never = [_never(item.effect) for item in candidates if item.name not in asked]
    candidates = [item for item in candidates if item.name in asked]
    seen = _seen(Experiment(diagnosis.runs, final.point), candidates, final, tried)
    hidden = [item for item in candidates if seen[item.name].hidden]
    if not hidden:
        return (*seen.values(), *never)
    shown = _shown_by(diagnosis, hidden, better=False)
    lost = [item for item in hidden if item.name not in shown]
    better = _shown_by(diagnosis, lost, better=True) if lost else {}
    return (*(_with_remedy(item, shown, better) for item in seen.values()), *never)


def _never(effect: Effect) -> DetectionLimit:
    """Limit of an effect that is unobservable if the reference's axes differ between drives."""
    name, item = next((name, item) for name, item in effect.parameters.items() if not item.tries)
    limit = DetectionLimit(effect.name, name, item.unit, item.null, math.inf, item.scale)
    return replace(limit, needs_more=True)


def _typical(effect: Effect) -> Candidate:
    shape = {
        name: item.typical
        for name, item in effect.parameters.items()
        if item.tries and not item.per_run
    }
    return Candidate(effect, shape)


def _seen(
    drives: Experiment, candidates: Sequence[Candidate], final: Fitted, tried: int
) -> dict[str, DetectionLimit]:
    look = _looked_at(drives, candidates, final.numbers)
    return {item.name: _best(item, look, tried, final.held) for item in candidates}


def _looked_at(
    drives: Experiment, candidates: Sequence[Candidate], numbers: Sequence[FreeParameter]
) -> Sensitivities:
    """Jacobians; of an effect at one place of a wheel at four angles, which average to its mean."""
    look = sensitivities_of(drives, candidates, numbers)
    white = dict(look.white)
    for item in candidates:
        if item.place is not None:
            angles = item.effect.parameters[item.place].tries
            there = [
                drives.marks(replace(item, shape={**item.shape, item.place: angle}))
                for angle in angles[:: max(len(angles) // 4, 1)]
            ]
            white[item.name] = drives.whitened(np.concatenate(there, axis=-1))
    return replace(look, white=white)


def _best(
    candidate: Candidate, look: Sensitivities, tried: int, held: Sequence[str]
) -> DetectionLimit:
    """The limit of an effect's most sensitive parameter."""
    limits = _limits(candidate, look, tried, rules.POWER, held)
    return min(limits, key=lambda limit: limit.minimum_detectable / limit.typical)


def _limits(
    candidate: Candidate, look: Sensitivities, tried: int, power: float, held: Sequence[str] = ()
) -> Iterator[DetectionLimit]:
    """Limit of each parameter except shapes, with the calibration as nuisance.

    What an effect shows by the parameters of one that it extends is that other one's: a clock that
    is late by another delay in each drive need not run at another rate.
    """
    effect = candidate.effect
    names = [name for name, item in effect.parameters.items() if not (item.tries or item.as_base)]
    extended = find(effect.extends).parameters if effect.extends else {}
    beside = [name for name in CALIBRATED if name in look.white and name != candidate.name]
    if candidate.name in CALIBRATED:
        # Directions that the runs do not determine are held, so they hide nothing (`Fitted.held`).
        beside = [name for name in beside if name not in held]
    others = [look.white[name] for name in beside]
    marks = look.white[candidate.name]
    if extended:
        beyond = [name not in extended for name in names]
        below = marks[:, np.logical_not(beyond)]
        others.append(look.drives.each_run(below) if candidate.per_run else below)
        marks, names = marks[:, beyond], [name for name in names if name not in extended]
    frame = nuisance(np.concatenate([look.own, *others], axis=-1))
    width = marks.shape[-1]
    if candidate.per_run:
        marks = look.drives.each_run(marks)
    free = frame.residual(marks)
    heard, before = (np.sum(columns**2, axis=0) for columns in (free, marks))
    heard = np.where(heard > DETERMINED**2 * np.maximum(before, SILENT), heard, 0.0)
    degrees = int(np.sum(heard > 0.0))
    information = heard.reshape(-1, width).sum(axis=0)
    if candidate.place is not None:
        # One size, and an angle of its own in each run. What is the same at all angles adds up over
        # the runs, and the calibration takes it: a bump is a larger radius, too.
        around = np.where(heard > 0.0, free, 0.0).reshape(len(free), -1, width)
        common = around.mean(axis=-1)
        degrees = 1 + around.shape[1]
        of_place = np.sum((around - common[..., None]) ** 2) / width
        information = np.array([np.sum(common.sum(axis=-1) ** 2) + of_place])
    wanted = noncentrality(max(degrees, 1), rules.SURE / max(tried, 1), power)
    if effect.quadrature is not None:  # the least observable phase
        names, information = [effect.quadrature[0]], information.min(keepdims=True)
    for name, of_step in zip(names, information.tolist(), strict=True):
        item = effect.parameters[name]
        size = STEP * item.scale * math.sqrt(wanted / of_step) if of_step > 0.0 else math.inf
        seen = size if size <= item.reach else math.inf
        yield DetectionLimit(effect.name, name, item.unit, item.null, seen, item.scale)


def _shown_by(diagnosis: Diagnosis, hidden: Sequence[Candidate], *, better: bool) -> dict[str, str]:
    """For each effect the first manoeuvre that shows it at its typical size within some minutes."""
    final = diagnosis.final
    pace = pace_of(diagnosis.runs, final.point.model.robot)
    wanted, found = list(hidden), {}
    for ideal in MANOEUVRES:
        drives, _ = imagined(ideal, diagnosis.runs, final.point, pace, better=better)
        beside = [item for item in _calibrated() if item.name not in _names(wanted)]
        look = _looked_at(drives, [*wanted, *beside], final.numbers)
        for item in list(wanted):
            if not _best(item, look, diagnosis.rounds[-1].number, final.held).hidden:
                found[item.name] = ideal.name
                wanted.remove(item)
        if not wanted:
            break
    return found


def _names(candidates: Sequence[Candidate]) -> set[str]:
    return {item.name for item in candidates}


def _calibrated() -> list[Candidate]:
    return [Candidate(find(name), {}) for name in CALIBRATED]


def _with_remedy(
    limit: DetectionLimit, shown: dict[str, str], better: dict[str, str]
) -> DetectionLimit:
    if not limit.hidden:
        return limit
    shown_by = shown.get(limit.effect)
    return replace(limit, shown_by=shown_by, needs_more=shown_by is None and limit.effect in better)
