# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verdict: what was found, what cannot be told apart, what each effect is worth."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from werrimbi_odom.effects import find
from werrimbi_odom.inference.calibration_sizes import name_of_base, sizes_of, std_as_effect
from werrimbi_odom.inference.chances import chi2_above, in_any_of
from werrimbi_odom.inference.comparison.another_drive import of_another_drive
from werrimbi_odom.inference.comparison.judged_legs import far_above_noise
from werrimbi_odom.inference.comparison.reference_checks import ReferenceRemark, remarks_on
from werrimbi_odom.inference.diagnosis.chance import chance, chance_by_parts, chance_of_size
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.held_law import Misfit
from werrimbi_odom.inference.diagnosis.holdout import Begun, Errors, Judge
from werrimbi_odom.inference.diagnosis.outlying_drives import RecordedOtherwise
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.rivals import (
    own_scale_instead,
    possible_twins,
    rivals_of,
    rivals_of_others,
    torn_by_halves,
)
from werrimbi_odom.inference.diagnosis.search import Instead, Round
from werrimbi_odom.inference.diagnosis.selection import Fitted
from werrimbi_odom.inference.diagnosis.sizes import sizes_needed, with_sizes
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.candidates import CALIBRATED
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, Model, changed
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.rules import CALIBRATION_WORTH, LAW_SHARE, SIGNIFICANT, SURE
from werrimbi_odom.inference.set_up.findings import IN_DEGREES
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

Verdict = Literal["none", "named", "ambiguous", "unknown"]


@dataclass(frozen=True, slots=True)
class Ranked:
    """An effect and what it is worth."""

    effect: str
    p_value: float | None
    """Of as much by chance, corrected for the number of effects tried; None where nothing was
    tested: a set-up mistake is found by a search of all set-ups, and has no distribution."""
    train: Sides | None
    """Position error before and after adding it [m]; None where it was not worth a fit."""
    holdout: Sides | None


@dataclass(frozen=True)
class Diagnosis:
    """What is missing, and what is known of it."""

    verdict: Verdict
    effect: str | None
    found: tuple[str, ...]
    """All effects that were found, one after the other; the most important first."""
    ranking: tuple[Ranked, ...]
    rivals: tuple[str, ...]
    """Effects that these runs cannot tell apart; the named one is among them."""
    torn: tuple[str, ...]
    """Those of the rivals that are so because halves of the data disagree."""
    set_up: SetUp
    otherwise: tuple[RecordedOtherwise, ...]
    """Drives that were recorded otherwise than the fitted ones; left out where others remain."""
    depends_on: tuple[Dependence, ...]
    """What the errors of the robot as given (its set-up put right) depend on."""
    remaining: tuple[Dependence, ...]
    """What they depend on once all that was found is put in."""
    given: Robot
    rounds: tuple[Round, ...]
    final: Fitted
    """The fit of everything found, with all sizes free."""
    model: Model
    """What is told: sizes that are not worth their price as they were given, as `add` has them."""
    runs: Concatenated
    train: Sides
    """Position error with the robot as given, and with everything found [m]."""
    holdout: Sides
    medians: Sides
    """Median position error on the held-out runs, outliers and all [m]."""
    headings: tuple[Sides, Sides]
    """Heading errors of `train` and `holdout` [rad]: those of headings alone are judged by them."""
    quiet: tuple[Sides, Sides]
    """`train` and `holdout` without the legs in which something happened at once."""
    rivals_of_others: Mapping[str, tuple[str, ...]]
    """Of the further effects that were found those that the runs cannot tell from another one."""
    left_out: tuple[LeftOut, ...] = ()
    """Stretches of all runs that none of it is about."""
    remarks: tuple[ReferenceRemark, ...] = ()
    """What is suspect about the reference of the fitted runs."""
    misfit: Misfit | None = None
    """What is left because a law's form is not quite nature's, or beside everything found."""
    happened: Events = field(default_factory=Events)
    """What no law explains, for it happened at an instant."""
    rivals_of_held: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Where nothing is missing: effects that would do as well in the place of one that the file
    holds, by its name."""

    @property
    def of_another_drive(self) -> bool:
        """Whether wheels and reference have nothing in common, so that nothing is told."""
        return any(remark.what == "another_drive" for remark in self.remarks)

    @property
    def robot(self) -> Robot:
        """With everything that was found put in."""
        return self.model.robot

    def effect_named(self, name: str) -> Effect | None:
        """The effect of a name, a user's own among them; None for a finding that is no effect."""
        if name == IN_DEGREES:
            return None
        known = [score.candidate.effect for this in self.rounds for score in this.scores]
        known += [applied.effect for applied in self.robot.effects]
        return next((effect for effect in known if effect.name == name), None) or find(name)

    def explained_by(self, name: str) -> bool:
        """Whether an effect that was tried explains what the errors go with, or nearly so."""
        falls = [
            this.before.cost - fit.cost
            for this in self.rounds
            for fit in this.tried
            if fit.names[-1] == name
        ]
        most = max((cell.gain for this in self.rounds for cell in this.dependences), default=0.0)
        return max(falls, default=0.0) > LAW_SHARE * most


def told(
    begun: Begun,
    given: Robot,
    rounds: tuple[Round, ...],
    final: Fitted,
    beyond: Dependence | None,
    remaining: tuple[Dependence, ...],
    laid: Concatenated,
    instead: tuple[Instead, ...],
) -> Diagnosis:
    """Everything put together."""
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
        for model in (_plain(final, set_up.robot), as_given)  # a fit of few poses may lead astray
    )
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
    if found and not mistakes and not start.to(last).fell and far_above_noise(judge.train, model):
        # It suits the fitted drives alone, and what is left there is no noise.
        verdict, found, rivals, torn = "unknown", (), (), ()
        model = _as_told(final, set_up.robot, found, laid)
        last = judge.of(model)
    return Diagnosis(
        verdict,
        found[0] if found else None,
        found,
        tuple(_ranking(found, set_up, rounds, final, judge, start, laid)),
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
        Sides(start.holdout_median, last.holdout_median, start.unit),
        (Sides(start.yaw[0], last.yaw[0], "rad"), Sides(start.yaw[1], last.yaw[1], "rad")),
        (
            Sides(start.quiet[0], last.quiet[0], start.unit),
            Sides(start.quiet[1], last.quiet[1], start.unit),
        ),
        rivals_of_others(found, rivals, rounds, final),
        judge.left_out,
        (ReferenceRemark("another_drive", 0.0),) if another else remarks_on(judge.train),
    )


def _is_news(name: str, final: Fitted, tried: int) -> bool:
    """Whether a size is a finding: worth its price twice, and as sure as any effect must be."""
    worth = final.importance[name]
    certain = in_any_of(tried, chance_of_size(final, name)) < SURE
    return certain and worth > CALIBRATION_WORTH * final.price_of_one


def _differs(name: str, final: Fitted, given: Robot) -> bool:
    """Whether a size surely differs from the file's; what set-ups began with may be off it too."""
    robot = final.point.model.robot
    columns = [number.name for number, _ in final.design.columns]
    where = [columns.index(multiplier) for multiplier in MULTIPLIERS]
    std = std_as_effect(name, robot, final.covariance[np.ix_(where, where)])
    size = sizes_of(robot).over(sizes_of(given)).as_effects[name]
    return abs(math.log(size)) > SIGNIFICANT * std


def _plain(fit: Fitted, given: Robot) -> Model:
    """A fitted model; multipliers that it does not need stay as they were given."""
    if fit.calibrated or fit.names:
        return fit.point.model
    model = fit.point.model
    back = {name: float(getattr(given, name)) for name in MULTIPLIERS}
    return Model(changed(model.robot, back), model.own)


def _as_told(fit: Fitted, given: Robot, found: Collection[str], laid: Concatenated) -> Model:
    """A fitted model with those sizes alone that are told."""
    if not (fit.calibrated or fit.names):
        return _plain(fit, given)
    sizes = sizes_needed(fit, given, set(found) & set(CALIBRATED))
    return with_sizes(laid, fit, given, sizes).point.model


def _ranking(
    found: tuple[str, ...],
    set_up: SetUp,
    rounds: tuple[Round, ...],
    final: Fitted,
    judge: Judge,
    start: Errors,
    laid: Concatenated,
) -> list[Ranked]:
    """All effects, what was found first, with the figures of the round that took it.

    Those of the others are of their first trial.
    """
    ranked: dict[str, Ranked] = {}
    mended = judge.of(Model(set_up.robot, judge.nothing_of_own)) if set_up.findings else start
    for finding in set_up.findings:
        ranked[finding.effect] = _worth(finding.effect, None, start, mended)
    before = mended
    for number, this in enumerate(rounds):
        if number > 0:
            before = judge.of(this.before.point.model)
        for fit in this.tried:
            name = fit.names[-1]
            # What was taken is told as it stood when it was taken, not at an earlier trial.
            taken = final.names[number : number + 1] == (name,)
            if name not in ranked or taken:
                p_value = chance(fit, this.before, this.number)
                if taken:
                    p_value = max(p_value, chance_by_parts(laid, final, name, this.number))
                ranked[name] = _worth(name, p_value, before, judge.of(fit.point.model))
    calibrated = judge.of(rounds[0].before.point.model)
    for name in CALIBRATED:
        importance = final.importance.get(name, 0.0)
        p_value = in_any_of(rounds[0].number, chance_of_size(final, name))
        untried = Ranked(name, p_value, None, None)
        worth = _worth(name, p_value, mended, calibrated) if importance else untried
        base = name_of_base(final.point.model.robot)
        ranked.setdefault(base if name == "track_width" else name, worth)
    for score in rounds[0].scores:
        p_value = in_any_of(rounds[0].number, chi2_above(score.gain, score.degrees))
        ranked.setdefault(score.candidate.name, Ranked(score.candidate.name, p_value, None, None))
    first = [ranked.pop(name) for name in found if name in ranked]
    return [*first, *sorted(ranked.values(), key=_certainty)]


def _certainty(item: Ranked) -> float:
    return 0.0 if item.p_value is None else item.p_value


def _worth(effect: str, p_value: float | None, before: Errors, after: Errors) -> Ranked:
    return Ranked(
        effect,
        p_value,
        Sides(before.train, after.train, after.unit),
        before.to(after),
    )
