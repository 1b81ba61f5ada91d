# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What to drive next, or to remount: the simplest thing that tells apart what these drives cannot.

For rivals the manoeuvres of the library are weighed by what they would show in a minute
(`expected_evidence`). For twins no drive can tell, and the mount or a hand has to, as the effects
declare. For an error that no effect explains, a drive that varies what the error depends on, and
holds the rest (`for_unexplained_errors`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np
from scipy.special import ndtr

from werrimbi_odom.effects import find
from werrimbi_odom.effects.effect_docstring import page_of
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import sizes_of
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.rivals import round_of
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.manoeuvres.expected_evidence import (
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
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import (
    ProposedManoeuvre,
    for_the_unknown,
)
from werrimbi_odom.inference.manoeuvres.ideal_drives import pace_of
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES, Ideal
from werrimbi_odom.inference.manoeuvres.simulated_record import imagined, measured_in
from werrimbi_odom.model.effect import AppliedEffect, Effect, Twin, twin_of
from werrimbi_odom.model.pose import Floats


def twin_where(one: Effect, other: Effect, positions: bool) -> Twin | None:
    """The declared equivalence of two effects, if it holds for this kind of reference."""
    twin = twin_of(one, other)
    return None if twin is None or (twin.of_headings and positions) else twin


def for_twins(rivals: Sequence[Effect], positions: bool) -> ProposedManoeuvre | None:
    """What to do at the robot; None if drives may tell some rivals apart, or nothing is declared.

    Set-up mistakes are equivalent in larger sets than pairs: two of them may equal a third. A check
    by hand tells them all apart.
    """
    pairs = [twin_where(*pair, positions) for pair in combinations(rivals, 2)]
    twins = [twin for twin in pairs if twin is not None]
    mistakes = [effect for effect in rivals if effect.is_mistake]
    said = next((twin for twin in twins if twin.do), None)
    if said is not None and (len(twins) == len(pairs) or mistakes):
        return ProposedManoeuvre(said.manoeuvre, said.told_apart_by, said.do, said.minutes)
    if not mistakes:
        return None
    checks = dict.fromkeys(" ".join(page_of(each).sections["Ruler"].split()) for each in mistakes)
    return ProposedManoeuvre(
        "push_by_hand",
        "no drive can tell them apart, because the robot file alone says which end is ahead; a "
        "hand can",
        "; ".join(checks),
        0.0,
    )


Pair = tuple[str, str]


@dataclass(frozen=True, slots=True)
class Discrimination:
    """Expected evidence of a manoeuvre of the library."""

    ideal: Ideal
    minutes: float
    """Duration in minutes."""
    rises: Mapping[Pair, float]
    """Expected rise of the wrong rival's cost, for each pair that a drive can tell apart: the
    minimum over which of the two is true."""
    apart: Callable[[Pair], Floats]
    """Difference of the legs between two rivals, (m, 3)."""

    def minutes_for(self, pairs: Sequence[Pair]) -> float:
        """Duration that tells all of them, if each repetition adds as much evidence."""
        rise = self.rises[self.hardest(pairs)]
        return max(rules.ENOUGH * self.minutes / rise, 1.0) if rise > 0.0 else np.inf

    def hardest(self, pairs: Sequence[Pair]) -> Pair:
        """The pair with the least evidence."""
        return min(pairs, key=lambda pair: self.rises[pair])

    def chance_in(self, minutes: float, pairs: Sequence[Pair]) -> float:
        """Share of cases in which driving for so long tells the hardest of them."""
        rise = self.rises[self.hardest(pairs)] * minutes / self.minutes
        return float(ndtr((rise - rules.RIVAL) / (2.0 * np.sqrt(rise)))) if rise > 0.0 else 0.0

    def told_apart(self) -> list[Pair]:
        """The pairs that it tells in the longest drive."""
        return [pair for pair in self.rises if self.minutes_for([pair]) <= rules.LONGEST_DRIVE]


def next_manoeuvre(diagnosis: Diagnosis) -> ProposedManoeuvre | None:
    """The next thing to do; None if the diagnosis leaves nothing open that could be resolved."""
    if diagnosis.verdict == "ambiguous":
        named = [diagnosis.effect_named(name) for name in diagnosis.rivals]
        by_hand = for_twins([effect for effect in named if effect], measured_in(diagnosis.runs)[0])
        if by_hand is not None:
            return by_hand
        weighed = discriminations(diagnosis)
        return quickest(diagnosis.rivals, weighed) if weighed[0].rises else None
    if diagnosis.verdict == "unknown" and diagnosis.one_sided is None:
        return for_the_unknown(diagnosis)
    return None


def discriminations(diagnosis: Diagnosis) -> list[Discrimination]:
    """Expected evidence of each manoeuvre of the library about the rivals, the simplest first."""
    this = round_of(diagnosis.rivals[0], diagnosis.rounds, diagnosis.final) or diagnosis.rounds[0]
    rivals = [_candidate(name, this, diagnosis) for name in diagnosis.rivals]
    first = _as_fitted(rivals[0], this, diagnosis)
    looked_at = _once([*rivals, *(Candidate(find(name), {}) for name in CALIBRATED)])
    point, numbers = this.before.point, this.before.numbers
    before = sensitivities_of(Experiment(diagnosis.runs, point), looked_at, numbers)
    target = trace_at(before, first)
    sizes = {item.name: best_alias(before, target, item) for item in rivals[1:]}
    pace = pace_of(diagnosis.runs, point.model.robot)
    positions = measured_in(diagnosis.runs)[0]
    by_name = {item.name: item for item in rivals}
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
        found.append(Discrimination(ideal, minutes, rises, partial(_apart, stands, by_name)))
    return found


Stands = Mapping[str, tuple[tuple[Sensitivities, Trace], tuple[Sensitivities, Trace]]]
"""What each rival does to the drives so far, and to one ahead."""


def _apart(stands: Stands, rivals: Mapping[str, Candidate], pair: Pair) -> Floats:
    known, ahead = stands[pair[0]]
    return difference(known, ahead, rivals[pair[1]])


def _gained(
    known: tuple[Sensitivities, Trace], ahead: tuple[Sensitivities, Trace], rival: Candidate
) -> float:
    """What new drives add to the cost of a rival that stands for the target."""
    return separation([known, ahead], rival) - separation([known], rival)


def quickest(rivals: Sequence[str], weighed: Sequence[Discrimination]) -> ProposedManoeuvre | None:
    """The quickest manoeuvre that leaves one rival; else that tells the first from all others.

    If none does within the longest drive: the one that tells the most pairs, those with the first
    rival before the rest, so that the next proposal has fewer left. If none tells any pair: the
    longest drive, if it tells the first from all others at least as often as not.
    """
    pairs = list(weighed[0].rises)
    of_first = [pair for pair in pairs if rivals[0] in pair]
    for goal in filter(None, (pairs, of_first)):
        best = min(weighed, key=lambda item: item.minutes_for(goal))
        if best.minutes_for(goal) <= rules.LONGEST_DRIVE:
            return _proposed(best, goal, rivals[0])
    best = max(weighed, key=lambda item: _tells(item, rivals[0]))
    if best.told_apart():
        return _proposed(best, best.told_apart(), rivals[0])
    best = min(weighed, key=lambda item: item.minutes_for(of_first or pairs))
    if best.chance_in(rules.LONGEST_DRIVE, of_first or pairs) < rules.AS_LIKELY_AS_NOT:
        return None
    return _proposed(best, of_first or pairs, rivals[0])


def _tells(item: Discrimination, first: str) -> tuple[int, int, float]:
    """How many pairs, those of the first rival before all; of equals the quickest."""
    apart = item.told_apart()
    return (
        sum(first in pair for pair in apart),
        len(apart),
        -item.minutes_for(apart) if apart else 0.0,
    )


def _proposed(best: Discrimination, pairs: Sequence[Pair], first: str) -> ProposedManoeuvre:
    one, other = best.hardest([pair for pair in pairs if first in pair] or pairs)
    why = (
        f"{one} and {other} look alike on these drives, but {best.ideal.where} "
        f"they differ by {_size(best.apart((one, other)))}"
    )
    minutes = min(best.minutes_for(pairs), rules.LONGEST_DRIVE)
    chance = best.chance_in(minutes, pairs)
    do = f"drive {best.ideal.words}"
    return ProposedManoeuvre(best.ideal.name, why, do, float(np.ceil(minutes)), chance)


def _size(apart: Floats) -> str:
    """The larger differences, in position and heading."""
    position = float(np.quantile(np.hypot(apart[:, 0], apart[:, 1]), 0.9))
    heading = float(np.degrees(np.quantile(np.abs(apart[:, 2]), 0.9)))
    parts = []
    if position > rules.APART_POSITION:
        millimetres = float(f"{1e3 * position:.2g}")
        parts.append(f"{millimetres:g} mm" if position < 0.1 else f"{position:.2g} m")
    if heading > rules.APART_HEADING:
        parts.append(f"{float(f'{heading:.2g}'):g}°")
    told = " and ".join(parts)
    if len(apart) == 1:  # measured at its start and its end alone
        return f"{told or 'little'} at the end"
    return f"{told or 'little, again and again'} on a short leg"


def _candidate(name: str, this: Round, diagnosis: Diagnosis) -> Candidate:
    """A rival at the shape that suits these drives best."""
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
    """The first rival at its fitted size; what each run has anew as in the first of them."""
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
