# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A law that fits but not fully is said to be that: its rest is not another effect.

An effect that the robot file holds (the library's, a user's, a draft) has a law of some form, and
nature's may be a bit another one. What that leaves goes with the effect's own variables and acts
where the effect acts, it is little beside what the law explains, and a freer form of the law (a
curve over one of its variables) takes it away. Some other effect may fit a part of it; to name that
would send the user after a thing that is not there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.homogeneity import lasting, pattern_of
from werrimbi_odom.inference.diagnosis.search import Round
from werrimbi_odom.inference.diagnosis.selection import Fitted, rise_without
from werrimbi_odom.inference.diagnosis.support import Support, support_of
from werrimbi_odom.inference.fitting.candidates import (
    CALIBRATED,
    Candidate,
    Score,
    signatures,
    unexplained,
)
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.design import Point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, FreeParameter
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.linear import nuisance, score_test
from werrimbi_odom.inference.rules import LEFT_ASKED, LITTLE_OF_A_LAW, REST_EXPLAINED, SURE
from werrimbi_odom.model.effect import AppliedEffect


@dataclass(frozen=True)
class Misfit:
    """What a law leaves, because its form is not quite nature's."""

    effect: str | None
    """Whose law; None where no law looks at that variable: then something else is left."""
    cell: Dependence
    """What the errors still go with."""
    share: float | None
    """Of what the law explains."""
    only_in: str | None = None
    """The one drive that shows it; None where all do."""


def misfit_of_held_law(
    this: Round, best: Fitted | None, beyond: Dependence | None, runs: Concatenated
) -> Misfit | None:
    """The misfit that a round found in the place of an effect; None where it found one.

    Parameters
    ----------
    best
        The effect that the round would take.
    beyond
        The dependence that no effect explains, which would end the search.
    """
    before = this.before
    for law, support, explained in _laws(before, runs):
        own = (cell for cell in this.dependences if _shares(support, cell))
        if beyond is not None:
            share = beyond.gain / explained
            if _shares(support, beyond) and share < LITTLE_OF_A_LAW:
                return Misfit(law.name, beyond, share)
            continue
        if best is None:
            return None
        score = next(each for each in this.scores if each.candidate.name == best.names[-1])
        share = score.gain / explained
        cell = max(own, key=lambda cell: cell.gain - cell.degrees, default=None)
        if cell is None or share >= LITTLE_OF_A_LAW:
            continue
        numbers = (*CALIBRATION, *before.numbers)
        left = _gain_beside(runs, before.point, numbers, score, cell)
        if left < (1.0 - REST_EXPLAINED) * score.gain:
            return Misfit(law.name, cell, share)
    return None


def misfit_of_found(
    fit: Fitted, certain: Sequence[Dependence], runs: Concatenated
) -> Misfit | None:
    """What is left beside everything found, if anything lasts: what explains most for its numbers.

    Parameters
    ----------
    certain
        Cells of the final model's map that chance does not show.
    """
    worth = sorted(certain, key=lambda cell: cell.degrees * fit.price_of_one - cell.gain)
    numbers = (*CALIBRATION, *fit.numbers)
    for cell, p_value, only_in in lasting(runs, fit.point, numbers, worth[:LEFT_ASKED]):
        dear = cell.gain <= cell.degrees * fit.price_of_one  # as a law of the robot
        if only_in or (p_value < SURE and not dear):
            for law, support, explained in _laws(fit, runs):
                if _shares(support, cell):
                    return Misfit(law.name, cell, cell.gain / explained, only_in)
            return Misfit(None, cell, None, only_in)
    return None


def _laws(fit: Fitted, runs: Concatenated) -> Iterator[tuple[AppliedEffect, Support, float]]:
    """Laws of a model with their reach, and by how much each lowers the cost."""
    robot = fit.point.model.robot
    drive = runs.drive(fit.point.model.laid_out(runs.steps))
    for applied in robot.effects:
        if applied.effect.is_mistake or applied.name in CALIBRATED or not applied.ready:
            continue
        parameters = applied.effect.parameters
        shape = {name: applied.values[name] for name, item in parameters.items() if item.tries}
        support = support_of(Candidate(applied.effect, shape), drive)
        explained = rise_without(applied.name, fit.design, fit.by_noise, fit.point)
        if support.outputs and explained > 0.0:
            yield applied, support, explained


def _shares(support: Support, cell: Dependence) -> bool:
    """Whether a dependence is in a variable that a law looks at, where it acts."""
    return cell.channel in support.outputs and bool(support.inputs & set(cell.variable.looks_at))


def _gain_beside(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    score: Score,
    cell: Dependence,
) -> float:
    """What a candidate would still explain if the model could turn a cell's pattern as well."""
    prediction = predict_all(point.model, runs)
    turned, rest = unexplained(runs, point, numbers, prediction)
    pattern = pattern_of(runs, point, cell)
    freer = nuisance(turned.residual(pattern))
    signature = next(signatures(runs, point, numbers, [score.candidate])[1])
    free, left = freer.residual(signature.free), freer.residual(rest)
    found = score_test(signature.flat, free, left)
    return 0.0 if found is None else found.gain
