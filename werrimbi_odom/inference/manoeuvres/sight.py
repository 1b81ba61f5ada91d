# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What these drives could have shown: from which size on an effect would have been seen.

"Nothing is missing" is worth as much as what would have been seen. Where an effect of the size that
robots show would have stayed hidden, the drive of the library that shows it with this reference is
named, or it is said that no drive does and a reference that measures more is needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.selection import Fitted
from werrimbi_odom.inference.fitting.candidates import CALIBRATED, Candidate
from werrimbi_odom.inference.fitting.knobs import STEP
from werrimbi_odom.inference.linear import DETERMINED, SILENT, nuisance
from werrimbi_odom.inference.manoeuvres.drives import MANOEUVRES, pace_of
from werrimbi_odom.inference.manoeuvres.imagined import imagined
from werrimbi_odom.inference.manoeuvres.rivals import Drives, Look, look_at
from werrimbi_odom.model.effect import Effect

SIGMAS = 5.0
"""Standard deviations that an effect must be away from null to be believed, all tried counted."""

HIDDEN = 3.0
"""An effect that would be seen only from so many times its typical size on counts as hidden."""


@dataclass(frozen=True, slots=True)
class Sight:
    """From which size on an effect would have been seen."""

    effect: str
    parameter: str
    """The one that shows best, beside its shape."""
    unit: str
    null: float
    seen_from: float
    """Distance from null; infinite where it leaves no trace at all."""
    typical: float
    """Distance from null that robots show."""
    shown_by: str | None = None
    """A manoeuvre that shows it with this reference; where it is hidden."""
    needs_more: bool = False
    """No drive shows it with this reference, but with one of positions and headings it shows."""

    @property
    def hidden(self) -> bool:
        """Whether an effect of usual size would have stayed hidden."""
        return not self.seen_from < HIDDEN * self.typical


def sight_of(diagnosis: Diagnosis, effects: Sequence[Effect]) -> tuple[Sight, ...]:
    """For all effects that are not in the model, in the library's order."""
    final = diagnosis.final
    held = {applied.name for applied in final.point.model.robot.effects}
    measured = set.intersection(*(set(run.counters.channels) for run in diagnosis.runs.runs))
    candidates = [
        _typical(effect)
        for effect in effects
        if not effect.is_mistake and effect.name not in held and set(effect.channels) <= measured
    ]
    seen = _seen(Drives(diagnosis.runs, final.point, diagnosis.kind), candidates, final)
    hidden = [item for item in candidates if seen[item.name].hidden]
    if not hidden:
        return tuple(seen.values())
    shown = _shown_by(diagnosis, hidden, better=False)
    lost = [item for item in hidden if item.name not in shown]
    better = _shown_by(diagnosis, lost, better=True) if lost else {}
    return tuple(_with_remedy(item, shown, better) for item in seen.values())


def _typical(effect: Effect) -> Candidate:
    shape = {name: item.typical for name, item in effect.parameters.items() if item.tries}
    return Candidate(effect, shape)


def _seen(drives: Drives, candidates: Sequence[Candidate], final: Fitted) -> dict[str, Sight]:
    look = look_at(drives, candidates, final.knobs)
    return {item.name: _sight(item, look, final.held) for item in candidates}


def _sight(candidate: Candidate, look: Look, held: Sequence[str]) -> Sight:
    """The parameter of an effect that shows best, beside what calibration may explain."""
    effect = candidate.effect
    beside = [name for name in CALIBRATED if name in look.white and name != candidate.name]
    if candidate.name in CALIBRATED:
        # What the runs do not determine is held, so that it hides nothing (`Fitted.held`).
        beside = [name for name in beside if name not in held]
    others = [look.white[name] for name in beside]
    frame = nuisance(np.concatenate([look.own, *others], axis=-1))
    marks = look.white[candidate.name]
    if candidate.per_run:
        marks = look.drives.each_run(marks)
    free = frame.residual(marks)
    width = look.white[candidate.name].shape[-1]
    heard = np.sum(free**2, axis=0).reshape(-1, width).sum(axis=0)
    before = np.sum(marks**2, axis=0).reshape(-1, width).sum(axis=0)
    heard = np.where(heard > DETERMINED**2 * np.maximum(before, SILENT), heard, 0.0)
    if effect.quadrature is not None:
        names = [effect.quadrature[0]]
        heard = np.array([heard.min()])
    else:
        names = [name for name, item in effect.parameters.items() if not item.tries]
    best: Sight | None = None
    for name, power in zip(names, heard.tolist(), strict=True):
        item = effect.parameters[name]
        size = SIGMAS * STEP * item.scale / power**0.5 if power > 0.0 else np.inf
        sight = Sight(effect.name, name, item.unit, item.null, size, item.scale)
        if best is None or sight.seen_from / sight.typical < best.seen_from / best.typical:
            best = sight
    assert best is not None
    return best


def _shown_by(diagnosis: Diagnosis, hidden: Sequence[Candidate], *, better: bool) -> dict[str, str]:
    """For each effect the first manoeuvre that shows it at its typical size within some minutes."""
    final = diagnosis.final
    pace = pace_of(diagnosis.runs, final.point.model.robot)
    wanted, found = list(hidden), {}
    for ideal in MANOEUVRES:
        drives, _ = imagined(
            ideal, diagnosis.runs, final.point, diagnosis.kind, pace, better=better
        )
        beside = [item for item in _calibrated(diagnosis) if item.name not in _names(wanted)]
        look = look_at(drives, [*wanted, *beside], final.knobs)
        for item in list(wanted):
            if not _sight(item, look, final.held).hidden:
                found[item.name] = ideal.name
                wanted.remove(item)
        if not wanted:
            break
    return found


def _names(candidates: Sequence[Candidate]) -> set[str]:
    return {item.name for item in candidates}


def _calibrated(diagnosis: Diagnosis) -> list[Candidate]:
    from werrimbi_odom.effects import find

    return [Candidate(find(name), {}) for name in CALIBRATED]


def _with_remedy(sight: Sight, shown: dict[str, str], better: dict[str, str]) -> Sight:
    if not sight.hidden:
        return sight
    return Sight(
        sight.effect,
        sight.parameter,
        sight.unit,
        sight.null,
        sight.seen_from,
        sight.typical,
        shown.get(sight.effect),
        sight.effect not in shown and sight.effect in better,
    )
