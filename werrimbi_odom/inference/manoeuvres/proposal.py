# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Proposal of what to drive or remount next: the simplest action that tells the rivals apart.

For rivals, the manoeuvres of the library are ranked by their expected evidence per minute
(`manoeuvre_rivals`). Observational equivalents are beyond any drive, and need a change of the mount
or a check by hand. For an error that no effect explains, the proposal is a drive that varies what
the error depends on, and keeps all else constant.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np
from scipy.special import ndtr

from werrimbi_odom.effects import find
from werrimbi_odom.inference.calibration_sizes import sizes_of
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.search import Round
from werrimbi_odom.inference.fitting.candidates import CALIBRATED, Candidate
from werrimbi_odom.inference.manoeuvres.by_hand import for_twins, twin_where
from werrimbi_odom.inference.manoeuvres.drives import MANOEUVRES, Ideal, pace_of
from werrimbi_odom.inference.manoeuvres.imagined import imagined, measured_in
from werrimbi_odom.inference.manoeuvres.rivals import (
    Experiment,
    Sensitivities,
    Trace,
    best_alias,
    difference,
    sensitivities_of,
    separation,
    trace_along,
    trace_at,
)
from werrimbi_odom.inference.manoeuvres.unknown import Manoeuvre, for_the_unknown, strongest
from werrimbi_odom.inference.rules import (
    APART_HEADING,
    APART_POSITION,
    AS_LIKELY_AS_NOT,
    ENOUGH,
    LONGEST_DRIVE,
    RIVAL,
)
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.pose import Floats

__all__ = ["Discrimination", "Manoeuvre", "discriminations", "next_manoeuvre", "strongest"]


@dataclass(frozen=True, slots=True)
class Discrimination:
    """Expected evidence of a manoeuvre of the library."""

    ideal: Ideal
    minutes: float
    """Duration in minutes."""
    rise: float
    """Expected rise of the wrong rival's cost: the first rival against each other one, the minimum
    over these pairs and over which of the two is true."""
    every: float
    """The minimum over all pairs of rivals: with it a single drive leaves only one."""
    against: str
    """The rival that is hardest to tell from the first one."""
    apart: Floats
    """Difference of the legs between the first rival and that one, (m, 3)."""

    def minutes_for(self, rise: float) -> float:
        """Duration for the required evidence, if each repetition of the manoeuvre adds `rise`."""
        return max(ENOUGH * self.minutes / rise, 1.0) if rise > 0.0 else np.inf

    def chance_in(self, minutes: float) -> float:
        """Share of cases in which driving for so long tells the first from each of the others."""
        rise = self.rise * minutes / self.minutes
        return float(ndtr((rise - RIVAL) / (2.0 * np.sqrt(rise)))) if rise > 0.0 else 0.0


def next_manoeuvre(diagnosis: Diagnosis) -> Manoeuvre | None:
    """The next thing to do; None if the diagnosis leaves nothing open that could be resolved."""
    if diagnosis.verdict == "ambiguous":
        named = [diagnosis.effect_named(name) for name in diagnosis.rivals]
        by_hand = for_twins([effect for effect in named if effect], measured_in(diagnosis.runs)[0])
        if by_hand is not None:
            return by_hand
        weighed = discriminations(diagnosis)
        return quickest(diagnosis.rivals, weighed) if weighed else None
    if diagnosis.verdict == "unknown":
        return for_the_unknown(diagnosis)
    return None


def discriminations(diagnosis: Diagnosis) -> list[Discrimination]:
    """Expected evidence of each manoeuvre of the library about the rivals, the best first."""
    this = _round_of(diagnosis)
    rivals = [_candidate(name, this, diagnosis) for name in diagnosis.rivals]
    first = _as_fitted(rivals[0], this, diagnosis)
    looked_at = _once([*rivals, *(Candidate(find(name), {}) for name in CALIBRATED)])
    point, numbers = this.before.point, this.before.numbers
    before = sensitivities_of(Experiment(diagnosis.runs, point), looked_at, numbers)
    target = trace_at(before, first)
    sizes = {item.name: best_alias(before, target, item) for item in rivals[1:]}
    pace = pace_of(diagnosis.runs, point.model.robot)
    positions = measured_in(diagnosis.runs)[0]
    found = []
    for ideal in MANOEUVRES:
        drives, minutes = imagined(ideal, diagnosis.runs, point, pace)
        ahead = sensitivities_of(drives, looked_at, numbers)
        there = trace_at(ahead, first)
        stands = {rivals[0].name: ((before, target), (ahead, there))} | {
            name: (
                (before, trace_along(before, name, size)),
                (ahead, trace_along(ahead, name, size)),
            )
            for name, size in sizes.items()
        }
        rises = {
            (one.name, other.name): min(
                _gained(*stands[one.name], other), _gained(*stands[other.name], one)
            )
            for one, other in combinations(rivals, 2)
            if twin_where(one.effect, other.effect, positions) is None
        }
        of_first = {pair[1]: rise for pair, rise in rises.items() if pair[0] == rivals[0].name}
        if not of_first:  # observationally equivalent: no drive tells
            continue
        against = min(of_first, key=lambda name: of_first[name])
        rival = next(item for item in rivals if item.name == against)
        apart = difference(*stands[rivals[0].name], rival)
        found.append(
            Discrimination(ideal, minutes, of_first[against], min(rises.values()), against, apart)
        )
    return sorted(found, key=lambda item: -item.rise / item.minutes)


def _gained(
    known: tuple[Sensitivities, Trace], ahead: tuple[Sensitivities, Trace], rival: Candidate
) -> float:
    """Rise of a rival's cost by new drives, if the target is true."""
    return separation([known, ahead], rival) - separation([known], rival)


def quickest(rivals: Sequence[str], weighed: Sequence[Discrimination]) -> Manoeuvre | None:
    """The quickest manoeuvre that leaves one rival; else that tells the first from all others.

    If none is sure to within the longest drive, that long a drive, if it tells at least as often as
    not.
    """
    best = min(weighed, key=lambda item: item.minutes_for(item.every))
    minutes = best.minutes_for(best.every)
    if minutes > LONGEST_DRIVE:
        best = weighed[0]
        minutes = min(best.minutes_for(best.rise), LONGEST_DRIVE)
    chance = best.chance_in(minutes)
    if chance < AS_LIKELY_AS_NOT:
        return None
    why = (
        f"{rivals[0]} and {best.against} look alike on these drives, but {best.ideal.where} "
        f"they differ by {_size(best.apart)}"
    )
    do = f"drive {best.ideal.words}"
    return Manoeuvre(best.ideal.name, why, do, float(np.ceil(minutes)), chance)


def _size(apart: Floats) -> str:
    """The larger differences, in position and heading."""
    position = float(np.quantile(np.hypot(apart[:, 0], apart[:, 1]), 0.9))
    heading = float(np.degrees(np.quantile(np.abs(apart[:, 2]), 0.9)))
    parts = []
    if position > APART_POSITION:
        millimetres = float(f"{1e3 * position:.2g}")
        parts.append(f"{millimetres:g} mm" if position < 0.1 else f"{position:.2g} m")
    if heading > APART_HEADING:
        parts.append(f"{heading:.2g}°")
    return (" and ".join(parts) or "little, again and again") + " on a short leg"


def _round_of(diagnosis: Diagnosis) -> Round:
    """The round in which the rivals were compared."""
    first = diagnosis.rivals[0]
    for this in diagnosis.rounds:
        if any(fit.names[-1] == first for fit in this.tried):
            return this
    return diagnosis.rounds[0]


def _candidate(name: str, this: Round, diagnosis: Diagnosis) -> Candidate:
    """A rival with the best shape for these drives."""
    for score in (*this.scores, *(one for other in diagnosis.rounds for one in other.scores)):
        if score.candidate.name == name:
            return _with_fitted_shape(score.candidate, this)
    return Candidate(find(name), {})


def _with_fitted_shape(candidate: Candidate, this: Round) -> Candidate:
    fit = next((fit for fit in this.tried if fit.names[-1] == candidate.name), None)
    if fit is None or not candidate.shape:
        return candidate
    held = next(item for item in fit.point.model.robot.effects if item.name == candidate.name)
    return replace(candidate, shape={name: held.values[name] for name in candidate.shape})


def _as_fitted(candidate: Candidate, this: Round, diagnosis: Diagnosis) -> AppliedEffect:
    """The first rival at its fitted size, with the per-run parameters of the first run."""
    for fit in this.tried:
        if fit.names[-1] == candidate.name:
            return next(
                item for item in fit.point.model.of_run(0).effects if item.name == candidate.name
            )
    sizes = sizes_of(diagnosis.robot).over(sizes_of(diagnosis.given)).as_effects
    return candidate.effect.using(
        **{next(iter(candidate.effect.parameters)): sizes[candidate.name]}
    )


def _once(candidates: Sequence[Candidate]) -> list[Candidate]:
    return list({item.name: item for item in reversed(candidates)}.values())
