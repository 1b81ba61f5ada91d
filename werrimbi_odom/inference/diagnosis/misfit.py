# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Model misfit: a law of about the right form leaves a remainder, which is not another effect.

An effect in the robot file (the library's, a user's, a draft) has a law of some form, and the true
law may differ slightly. The remainder then depends on the effect's own variables and acts on the
same channels. It is small against what the law explains, and a freer form of the law (a curve over
one of its variables, or a law of the acceleration a little later) removes it, or explains more than
twice of what another effect still does beside it. Some other effect may fit a part of it, but
naming that one would mislead the user. Where a law's memory is wrong (a wheel that coasts through
its play as it brakes), the remainder may show in anything that the drives have in common with it.
If it is little of what the law explains, and of the errors, it is reported, and is no missing
effect either.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.effect_support import (
    LAGGING,
    Support,
    is_even,
    support_of,
)
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.fit_statistics import wald_statistic
from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.homogeneity import lasting, pattern_of
from werrimbi_odom.inference.diagnosis.p_values import chance_of_score
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import chi2_survival
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, FreeParameter
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.score_tests import Score, residual_innovations, signatures
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.linear import nuisance, score_test
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import AppliedEffect, Effect, Parameter
from werrimbi_odom.model.motion import BodyMotion, WheelTravel
from werrimbi_odom.model.pose import Floats


@dataclass(frozen=True)
class Misfit:
    """What remains because the form of a law is slightly wrong."""

    effect: str | None
    """Effect with that law; None where no law depends on that variable: then something else
    remains."""
    cell: Dependence
    """What the errors still depend on."""
    share: float | None
    """The remainder as a share of what the law explains; without a law, of the squared errors."""
    only_in: str | None = None
    """The one drive that shows it; None where all do."""


def misfit_of_held_law(
    this: Round, best: Fitted | None, beyond: Dependence | None, runs: Concatenated
) -> Misfit | None:
    """The misfit that explains a round's finding better than a new effect; None if there is none.

    `best`: model with the effect that the round would accept. `beyond`: dependence that no effect
    explains, which would end the search.
    """
    before = this.before
    rest: Misfit | None = None
    for law, support, explained in _laws(before, runs):
        own = (cell for cell in this.dependences if _shares(support, cell))
        if beyond is not None:
            share = beyond.gain / explained
            if _shares(support, beyond) and share < rules.LITTLE_OF_A_LAW:
                return Misfit(law.name, beyond, share)
            if _is_little(beyond, explained, runs):
                rest = Misfit(None, beyond, beyond.gain / runs.data)
            continue
        if best is None:
            return None
        score = next(each for each in this.scores if each.candidate.name == best.names[-1])
        share = score.gain / explained
        cell = max(own, key=lambda cell: cell.gain - cell.degrees, default=None)
        if cell is None or share >= rules.LITTLE_OF_A_LAW:
            continue
        numbers = (*CALIBRATION, *before.numbers)
        freer = (late(law),) if support.inputs & LAGGING else ()
        by_forms, left = _gains(runs, before.point, numbers, score, cell, freer)
        both_even = support.even and _may_be_even(score.candidate, before, runs)
        most = max(score.gain, by_forms) if both_even else score.gain
        if left < (1.0 - rules.REST_EXPLAINED) * most and not _encompassed(
            chance_of_score(replace(score, gain=left), before, this.number),
            chi2_survival(by_forms + left - score.gain, cell.degrees + len(freer)),
        ):
            return Misfit(law.name, cell, share)
    return rest


def _encompassed(candidate_beside_forms: float, forms_beside_candidate: float) -> bool:
    """Whether a candidate explains all that freer forms of a law do, and surely more than they.

    Then the rest is the candidate's, not the law's (encompassing: Mizon and Richard, Econometrica
    54, 1986). Given are the chances of what each of the two explains beside the other.
    """
    return (
        candidate_beside_forms < rules.VERY_SURE and forms_beside_candidate > rules.SURE_WHEN_ASKED
    )


def misfit_of_found(
    fit: Fitted, certain: Sequence[Dependence], runs: Concatenated
) -> Misfit | None:
    """The lasting dependence, if any, that remains beside everything found.

    `certain`: significant cells of the final model's map.
    """
    worth = sorted(certain, key=lambda cell: cell.degrees * fit.penalty_of_one - cell.gain)
    numbers = (*CALIBRATION, *fit.numbers)
    for cell, p_value, only_in in lasting(runs, fit.point, numbers, worth[: rules.LEFT_ASKED]):
        dear = cell.gain <= cell.degrees * fit.penalty_of_one  # does not pay its penalty as a law
        if only_in or (p_value < rules.SURE and not dear):
            laws = list(_laws(fit, runs))
            for law, support, explained in laws:
                if _shares(support, cell):
                    return Misfit(law.name, cell, cell.gain / explained, only_in)
            little = any(_is_little(cell, explained, runs) for _, _, explained in laws)
            return Misfit(None, cell, cell.gain / runs.data if little else None, only_in)
    return None


def _is_little(cell: Dependence, explained: float, runs: Concatenated) -> bool:
    """Whether a dependence is little of the errors, and of what a law explains."""
    return cell.gain < min(rules.LITTLE_OF_ERRORS * runs.data, rules.LITTLE_OF_A_LAW * explained)


def _laws(fit: Fitted, runs: Concatenated) -> Iterator[tuple[AppliedEffect, Support, float]]:
    """Laws of a model, each with its support and the rise of the cost without it."""
    robot = fit.point.model.robot
    drive = runs.drive(fit.point.model.laid_out(runs.steps))
    for applied in robot.effects:
        if applied.effect.is_mistake or applied.name in CALIBRATED or not applied.ready:
            continue
        parameters = applied.effect.parameters
        shape = {name: applied.values[name] for name, item in parameters.items() if item.tries}
        support = support_of(Candidate(applied.effect, shape), drive)
        support = support._replace(even=is_even(applied, drive))
        explained = wald_statistic(applied.name, fit.design, fit.by_noise, fit.point)
        if support.outputs and explained > 0.0:
            yield applied, support, explained


def _shares(support: Support, cell: Dependence) -> bool:
    """Whether a dependence is on an input of the law and in one of its output channels.

    A law that treats left and right alike leaves no error of one side that goes with what has no
    side: how a robot turns as it speeds up is no form of a slip of both tyres.
    """
    one_sided = cell.variable.even and not cell.amount.even
    known = support.inputs & set(cell.variable.looks_at)
    return cell.channel in support.outputs and bool(known) and not (support.even and one_sided)


def _may_be_even(candidate: Candidate, before: Fitted, runs: Concatenated) -> bool:
    """Whether a candidate treats left and right alike, as what the reference does to them may."""
    if candidate.effect.stage == "reference":
        return True
    drive = runs.drive(before.point.model.laid_out(runs.steps))
    return is_even(candidate.effect.using(**candidate.coordinates[0]), drive)


def _gains(
    runs: Concatenated,
    point: Point,
    numbers: Sequence[FreeParameter],
    score: Score,
    cell: Dependence,
    freer: Sequence[Effect],
) -> tuple[float, float]:
    """Score gains of the cell's pattern with freer forms, and of a candidate beside them."""
    prediction = predict_all(point.model, runs)
    turned, rest = residual_innovations(runs, point, numbers, prediction)
    tried = [score.candidate, *(Candidate(effect, {}) for effect in freer)]
    asked, *forms = signatures(runs, point, numbers, tried)[1]
    pattern = turned.residual(pattern_of(runs, point, cell))
    own = nuisance(np.hstack([pattern, *(form.free for form in forms)]))
    without = own.residual(rest)
    found = score_test(asked.flat, own.residual(asked.free), without)
    return float(rest @ rest - without @ without), 0.0 if found is None else found.gain


def late(law: AppliedEffect) -> Effect:
    """What a law says a message too early or too late, as an effect whose size is the share of one.

    A law of the acceleration knows it as the difference between the mean speeds of two messages:
    half a message late, and evened out over both. And a castor of other lengths than the law's
    swings earlier or later.
    """

    def apply(
        moved: WheelTravel[Floats] | BodyMotion[Floats], drive: Drive[Floats], messages: float
    ) -> WheelTravel[Floats] | BodyMotion[Floats]:
        changed = law.effect.apply(moved, drive, **law.values)
        said = (np.asarray(after - before) for after, before in zip(changed, moved, strict=True))
        later = (messages * np.diff(part, prepend=part[:1]) for part in said)
        return type(moved)(*(part - change for part, change in zip(moved, later, strict=True)))

    messages = Parameter("messages", 0.0, 1.0, (-10.0, 10.0), "how much later")
    return replace(law.effect, parameters={"messages": messages}, apply=apply, quadrature=None)
