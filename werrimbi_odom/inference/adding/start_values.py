# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Start values for the fit of one more effect: near the answer, however far that is from null.

Set-up mistakes and factors start at the result of the set-up search. All other effects start at the
values that their score suggests, once for each of the best trial shapes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns, for_fit
from werrimbi_odom.inference.comparison.reference_jumps import jumped_legs
from werrimbi_odom.inference.diagnosis.forward_selection import as_given
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted
from werrimbi_odom.inference.fitting.candidate import names_with
from werrimbi_odom.inference.fitting.candidate_starts import looked_for_delay, started_with
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.free_parameters import (
    CALIBRATION,
    FreeParameter,
    parameters_to_fit,
)
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.run_phases import with_own_values
from werrimbi_odom.inference.fitting.score_tests import (
    Score,
    candidates,
    parameters_with,
    scores,
)
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.legs.cutting import with_stated_noise
from werrimbi_odom.inference.legs.matched_run import at_edges
from werrimbi_odom.inference.set_up.findings import IN_DEGREES
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot


@dataclass(frozen=True, slots=True)
class FitDrives:
    """The drives of a fit, in short legs."""

    laid: Concatenated
    skipped: tuple[NDArray[np.bool_], ...]
    """Legs on which the reference jumped, and legs at the ends of the records."""
    options: EvaluationOptions
    """With the stated noise of the reference."""

    def begin(self, robot: Robot) -> tuple[Point, tuple[FreeParameter, ...]]:
        """The robot with per-run parameters estimated, and its free parameters."""
        point = replace(start_point(self.laid, robot, self.options), excluded=self.skipped)
        return with_own_values(self.laid, point)

    def fit(
        self,
        point: Point,
        names: Sequence[str],
        numbers: Sequence[FreeParameter],
        given: Robot,
        rounds: int = 3,
    ) -> Fitted:
        """Fit calibration, noise and `numbers`."""
        point = replace(point, options=self.options)
        return fitted(self.laid, point, names, numbers, given, rounds=rounds)


@dataclass(frozen=True, slots=True)
class Start:
    """Start of a fit: a model and its free parameters."""

    point: Point
    names: tuple[str, ...]
    """Effects beyond the given robot's."""
    numbers: tuple[FreeParameter, ...]
    """Free parameters of all effects."""
    gain: float = 0.0
    """Gain by the score test, for an effect that starts at its suggested values."""


def drives_of(prepared: PreparedRuns, robot: Robot, options: EvaluationOptions) -> FitDrives:
    """Cut the drives of a fit by the travel of `robot`.

    Legs on which the reference jumped are left out where `diagnose` does so: a pose whose error is
    its own costs two legs and no more (`refit_to_rest`), and a place that is lost is an event. The
    clock of `robot` may be another than that of `prepared` (the delay as fitted, of drives that
    were cut by the set-up's), so the reference's poses are found by its own stamps.
    """
    runs = for_fit(prepared, robot)
    skipped = list(at_edges(runs))
    for group in prepared.groups if options.reference_kind != "absolute" else ():
        for index, every, jumps in zip(group.index, group.every.runs, group.jumps, strict=True):
            stamps = every.measured.time + every.record.delay
            wanted = runs[index].measured.time + runs[index].record.delay
            nodes = np.searchsorted(0.5 * (stamps[1:] + stamps[:-1]), wanted)
            skipped[index] |= jumped_legs(jumps, nodes, options.reference_kind)
    return FitDrives(concatenated(runs), tuple(skipped), with_stated_noise(options, runs))


def is_of_set_up(effect: Effect, set_up: SetUp) -> bool:
    """Whether the set-up search found the effect, or an observational equivalent."""
    return any(effect.name in (item.effect, *item.twins) for item in set_up.findings)


def with_set_up(
    effects: Sequence[Effect], robot: Robot, set_up: SetUp
) -> tuple[Robot, tuple[str, ...]]:
    """The robot with the findings of the set-up search, if some of `effects` are among them.

    Result: if one of the effects is a finding, all findings are put in, because one
    mistake corrected alone may leave the robot worse than before (both counters reversed).
    Otherwise only factors of the sizes, which belong to the calibration.
    """
    found = {item.effect for item in set_up.findings} - {IN_DEGREES}
    mended = set_up.robot
    asked = [effect for effect in effects if is_of_set_up(effect, set_up)]
    for effect in asked:
        if effect.name not in found:
            twin = next(item.effect for item in set_up.findings if effect.name in item.twins)
            held = tuple(item for item in mended.effects if item.name != twin)
            mended = replace(mended, effects=(effect.using(), *held))
    if asked:
        held_before = {item.name for item in robot.effects}
        names = [item.name for item in mended.effects if item.name not in held_before]
        return mended, tuple(name for name in names if name not in CALIBRATED)
    if found and found <= set(CALIBRATED):
        return mended, ()
    return robot, ()


def starts(
    drives: FitDrives,
    before: Fitted,
    effect: Effect,
    numbers: Sequence[FreeParameter],
    given: Robot,
) -> tuple[Start, ...]:
    """Starts for fits of an effect: at the values of its score, for the best of its shapes.

    Where not all of the calibration is determined, it may stand in for the effect, and a fit that
    starts with it stays with it. Then there is also a start at the given robot's sizes, and where
    a score is no guide to a delay one with the best of some, as in a diagnosis.
    """
    begun = [(before, (*CALIBRATION, *numbers))]
    if before.sizes_held:
        point = as_given(before.point, given)
        nuisances = point.model.nuisance_parameters
        begun.append((replace(before, point=point), (*numbers, *nuisances)))
    found = []
    for at, beside in begun:
        for score in _best_shapes(scored(drives, at, [effect], beside)):
            start = start_at(drives.laid, at, score, numbers)
            found.append(start)
            if (instead := looked_for_delay(drives.laid, at.point, score)) is not None:
                found.append(replace(start, point=instead))
    return tuple(found)


def scored(
    drives: FitDrives, before: Fitted, effects: Sequence[Effect], beside: Sequence[FreeParameter]
) -> tuple[Score, ...]:
    """Score tests of effects in a model, beside nuisances: each shape of each effect."""
    runs = drives.laid
    tried = candidates(effects, (), runs.channels, len(runs.runs), asked=True)
    return scores(runs, before.point, beside, tried)


def start_at(
    runs: Concatenated, before: Fitted, score: Score, numbers: Sequence[FreeParameter]
) -> Start:
    """A start at the values that a score suggests."""
    point = started_with(runs, before.point, score)
    names = names_with(before.names, score.candidate)
    return Start(point, names, parameters_with(numbers, score.candidate), score.gain)


def _best_shapes(found: Sequence[Score]) -> list[Score]:
    """The best shapes, both with a phase for each run and with one for all."""
    ordered = sorted(found, key=lambda score: -score.gain)
    chosen: list[Score] = []
    for per_run in (True, False):
        chosen += [score for score in ordered if score.candidate.per_run == per_run][
            : rules.SHAPES_FITTED
        ]
    return chosen


def start_of_held(drives: FitDrives, robot: Robot, names: tuple[str, ...]) -> Start:
    """A start at the values of the robot."""
    point, numbers = drives.begin(robot)
    return Start(point, names, numbers)


def parameters_held(
    robot: Robot, numbers: Sequence[FreeParameter], effect: Effect
) -> tuple[FreeParameter, ...]:
    """Add the free parameters of `effect`, if the robot has it."""
    names = {number.name for number in numbers}
    more = (
        parameters_to_fit(effect) if any(item.name == effect.name for item in robot.effects) else ()
    )
    return (*numbers, *(number for number in more if number.name not in names))
