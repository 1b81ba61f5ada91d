# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict: what was found, and what cannot be told apart."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import (
    name_of_base,
    sizes_of,
    std_as_effect,
)
from werrimbi_odom.inference.comparison.another_drive import (
    of_another_drive,
    turns_alike,
    unturned,
)
from werrimbi_odom.inference.comparison.judged_legs import far_above_noise
from werrimbi_odom.inference.comparison.prepared import PreparedRuns
from werrimbi_odom.inference.comparison.reference_checks import ReferenceRemark, remarks_on
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed, with_sizes
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.forward_selection import Instead, Round
from werrimbi_odom.inference.diagnosis.holdout import Begun
from werrimbi_odom.inference.diagnosis.misfit import Misfit
from werrimbi_odom.inference.diagnosis.outlying_drives import RecordedOtherwise
from werrimbi_odom.inference.diagnosis.p_values import p_value_of_size
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.ranking import Ranked, ranking_of
from werrimbi_odom.inference.diagnosis.rivals import (
    own_scale_instead,
    possible_twins,
    rivals_of,
    rivals_of_others,
    torn_by_halves,
)
from werrimbi_odom.inference.diagnosis.wandering_reference import Wander
from werrimbi_odom.inference.distributions import bonferroni
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, Model, changed
from werrimbi_odom.inference.fitting.score_tests import CALIBRATED
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.set_up.findings import IN_DEGREES
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

Verdict = Literal["none", "named", "ambiguous", "unknown"]


@dataclass(frozen=True)
class Diagnosis:
    """Result of a diagnosis."""

    verdict: Verdict
    effect: str | None
    found: tuple[str, ...]
    """All effects that were found, the most important first."""
    ranking: tuple[Ranked, ...]
    rivals: tuple[str, ...]
    """Effects that these runs cannot tell apart, including the named one."""
    torn: tuple[str, ...]
    """Those of the rivals that halves of the data prefer."""
    set_up: SetUp
    otherwise: tuple[RecordedOtherwise, ...]
    """Drives recorded with another set-up than the fitted ones; left out where others remain."""
    depends_on: tuple[Dependence, ...]
    """Dependences of the errors of the robot as given, with its set-up corrected."""
    remaining: tuple[Dependence, ...]
    """Dependences that remain with everything found in the model."""
    given: Robot
    rounds: tuple[Round, ...]
    final: Fitted
    """The fit of everything found, with all sizes free."""
    model: Model
    """The reported model: sizes that do not pay their penalty are as given, as in `add`."""
    runs: Concatenated
    train: Sides
    """Position error with the robot as given, and with everything found [m]."""
    holdout: Sides
    headings: tuple[Sides, Sides]
    """Heading errors of `train` and `holdout` [rad]: headings alone are judged by them."""
    quiet: tuple[Sides, Sides]
    """`train` and `holdout` without the legs with an abrupt event."""
    rivals_of_others: Mapping[str, tuple[str, ...]]
    """For the further effects that were found: their rivals, by name."""
    left_out: tuple[LeftOut, ...] = ()
    """Stretches of all runs that are excluded."""
    remarks: tuple[ReferenceRemark, ...] = ()
    """Suspicions about the reference of the fitted runs."""
    misfit: Misfit | None = None
    """Remainder of a law of slightly wrong form, or beside everything found."""
    wander: Wander | None = None
    """Of a reference that was taken as absolute and is not: then all this is by `local_map`."""
    happened: Events = field(default_factory=Events)
    """Abrupt errors, which no law explains."""
    rivals_of_held: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Where nothing is missing: effects that explain as much in place of one that the file holds,
    by its name."""
    outdated: tuple[str, ...] = ()
    """Where nothing is missing: effects that the file holds with values that the drives
    contradict."""
    ahead_or_behind: bool = False
    """Whether the measured point may as well lie as far on the other side of the axle."""

    @property
    def of_another_drive(self) -> bool:
        """Whether wheels and reference have at most their turns in common: there is no result."""
        nothing = ("another_drive", "no_turn", "places")
        return any(remark.what in nothing for remark in self.remarks)

    @property
    def robot(self) -> Robot:
        """The robot with everything that was found."""
        return self.model.robot

    def effect_named(self, name: str) -> Effect | None:
        """The effect of that name, a user's own included; None for a finding that is no effect."""
        if name == IN_DEGREES:
            return None
        known = [score.candidate.effect for this in self.rounds for score in this.scores]
        known += [applied.effect for applied in self.robot.effects]
        return next((effect for effect in known if effect.name == name), None) or find(name)

    def explained_by(self, name: str) -> bool:
        """Whether an effect that was tried explains all or nearly all of the evidence."""
        falls = [
            this.before.cost - fit.cost
            for this in self.rounds
            for fit in this.tried
            if fit.names[-1] == name
        ]
        most = max((cell.gain for this in self.rounds for cell in this.dependences), default=0.0)
        return max(falls, default=0.0) > rules.LAW_SHARE * most


def diagnosis_of(
    begun: Begun,
    given: Robot,
    rounds: tuple[Round, ...],
    final: Fitted,
    beyond: Dependence | None,
    remaining: tuple[Dependence, ...],
    laid: Concatenated,
    instead: tuple[Instead, ...],
) -> Diagnosis:
    """Combine all results into the diagnosis."""
    judge, set_up = begun.judge, begun.set_up
    mistakes = [finding.effect for finding in set_up.findings]
    sizes = [
        name
        for name in final.calibrated
        if _is_news(name, final, rounds[0].number) and _differs(name, final, given)
    ]
    effects = sorted([*final.names, *sizes], key=lambda name: -final.importance[name])
    names = {"track_width": name_of_base(final.point.model.robot)}
    found = tuple(dict.fromkeys([*mistakes, *(names.get(name, name) for name in effects)]))
    rivals: tuple[str, ...] = ()
    torn: tuple[str, ...] = ()
    if mistakes:
        twins = possible_twins(set_up.findings[0])
        rivals = (mistakes[0], *twins) if twins else ()
    elif found:
        rivals = rivals_of(found[0], rounds, final, instead)
        torn = torn_by_halves(found[0], rounds, final, laid)
        others = (*torn, *own_scale_instead(found[0], final, given, laid))
        rivals = tuple(dict.fromkeys((*(rivals or (found[0],)), *others))) if others else rivals
    verdict: Verdict
    as_given = Model(given, judge.nothing_of_own)
    another = all(
        of_another_drive(judge.train, model)
        for model in (_plain(final, set_up.robot), as_given)  # a fit of few poses may be far off
    )
    alike = another and turns_alike(judge.train, as_given)
    if another:
        verdict, found, rivals, torn = "unknown", (), (), ()
    elif not found:
        wrong = beyond is not None or far_above_noise(judge.train, _plain(final, set_up.robot))
        verdict = "unknown" if wrong else "none"
    elif beyond is not None and not mistakes and len(rounds) == 1:
        verdict, found, rivals, torn = "unknown", (), (), ()
    else:
        verdict = "ambiguous" if len(rivals) > 1 else "named"
    start = judge.of(as_given)
    model = _as_told(final, set_up.robot, found, laid)
    last = judge.of(model)
    mended = judge.of(Model(set_up.robot, judge.nothing_of_own)) if mistakes else start
    further = any(name not in mistakes for name in found)
    if further and not mended.to(last).fell and far_above_noise(judge.train, model):
        # It suits the fitted drives alone, and what is left there is no noise.
        found = tuple(mistakes)
        if not mistakes:
            verdict, rivals, torn = "unknown", (), ()
        model = _as_told(rounds[0].before if mistakes else final, set_up.robot, found, laid)
        last = judge.of(model)
    return Diagnosis(
        verdict,
        found[0] if found else None,
        found,
        tuple(ranking_of(found, set_up, rounds, final, judge, start, laid)),
        rivals,
        torn,
        set_up,
        begun.otherwise,
        () if another else rounds[0].dependences,
        () if another else remaining,
        given,
        rounds,
        final,
        model,
        laid,
        Sides(start.train, last.train, start.unit),
        start.to(last),
        (Sides(start.yaw[0], last.yaw[0], "rad"), Sides(start.yaw[1], last.yaw[1], "rad")),
        (
            Sides(start.quiet[0], last.quiet[0], start.unit),
            Sides(start.quiet[1], last.quiet[1], start.unit),
        ),
        rivals_of_others(found, rivals, rounds, final, given, laid),
        judge.left_out,
        (_nothing_in_common(judge.train, as_given, alike),) if another else remarks_on(judge.train),
    )


def _nothing_in_common(train: PreparedRuns, given: Model, alike: bool) -> ReferenceRemark:
    """What a reference has in common with the wheels at most: its turns, or not even these."""
    if alike:
        return ReferenceRemark("places", 0.0)
    if (turns := unturned(train, given)) is not None:
        return ReferenceRemark("no_turn", *turns)
    return ReferenceRemark("another_drive", 0.0)


def _is_news(name: str, final: Fitted, tried: int) -> bool:
    """Whether a size is a finding: significant, with a gain well above its penalty."""
    worth = final.importance[name]
    certain = bonferroni(tried, p_value_of_size(final, name)) < rules.SURE
    return certain and worth > rules.CALIBRATION_WORTH * final.penalty_of_one


def _differs(name: str, final: Fitted, given: Robot) -> bool:
    """Whether a size differs significantly from the file's.

    The set-up search may have started from sizes that differ from the file's.
    """
    robot = final.point.model.robot
    columns = final.design.names
    where = [columns.index(multiplier) for multiplier in MULTIPLIERS]
    std = std_as_effect(name, robot, final.covariance[np.ix_(where, where)])
    size = sizes_of(robot).over(sizes_of(given)).as_effects[name]
    return abs(math.log(size)) > rules.SIGNIFICANT * std


def _plain(fit: Fitted, given: Robot) -> Model:
    """A fitted model, with multipliers that it does not need as given."""
    if fit.calibrated or fit.names:
        return fit.point.model
    model = fit.point.model
    back = {name: float(getattr(given, name)) for name in MULTIPLIERS}
    return Model(changed(model.robot, back), model.own)


def _as_told(fit: Fitted, given: Robot, found: Collection[str], laid: Concatenated) -> Model:
    """A fitted model, with only the reported sizes changed."""
    if not (fit.calibrated or fit.names):
        return _plain(fit, given)
    sizes = sizes_needed(fit, given, set(found) & set(CALIBRATED))
    return with_sizes(laid, fit, given, sizes).point.model
