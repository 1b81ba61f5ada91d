# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Result of a diagnosis: its verdict, what was found, and all that it rests on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.reference_remark import ReferenceRemark
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.forward_selection import Round
from werrimbi_odom.inference.diagnosis.misfit import Misfit
from werrimbi_odom.inference.diagnosis.one_sided_noise import OneSidedNoise
from werrimbi_odom.inference.diagnosis.outlying_drives import RecordedOtherwise
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.ranking import Ranked
from werrimbi_odom.inference.diagnosis.wandering_reference import Wander
from werrimbi_odom.inference.diagnosis.what_is_left import WhatIsLeft
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.gaps import LeftOut
from werrimbi_odom.inference.set_up.findings import IN_DEGREES
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot

Verdict = Literal["none", "named", "ambiguous", "unknown"]


@dataclass(frozen=True, kw_only=True)
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
    told: Fitted
    """The reported fit, as in `add`: sizes that do not pay their penalty are as given, and standard
    deviations allow for what was chosen (`uncertainty.with_spread`)."""
    runs: Concatenated
    train: Sides
    """Position error with the robot as given, and with everything found [m]; of headings alone
    theirs [rad]."""
    holdout: Sides
    headings: tuple[Sides, Sides]
    """Heading errors of `train` and `holdout` [rad]: headings alone are judged by them."""
    quiet: tuple[Sides, Sides]
    """`train` and `holdout` without the legs with an abrupt event."""
    left: WhatIsLeft | None
    """What is left with everything found, beside the reference's own noise; None where that is not
    known, or legs are few."""
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
    one_sided: OneSidedNoise | None = None
    """Where errors go with something, and the parts of the drives agree on nothing: that one wheel
    errs far more than the other, or that errors last along the path alone. No reference errs so,
    and the verdict is *unknown*."""
    happened: Events = field(default_factory=Events)
    """Abrupt errors, which no law explains."""
    by_events: bool = False
    """Whether nothing but these says that something is missing: they come with reversals, or with
    starts and stops. The verdict is *unknown*."""
    rivals_of_held: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Where nothing is missing: effects that explain as much in place of one that the file holds,
    by its name."""
    needless_of_held: tuple[str, ...] = ()
    """Those of `rivals_of_held` without which the drives are explained as well, with nothing in
    their place."""
    outdated: tuple[str, ...] = ()
    """Where nothing is missing: effects that the file holds with values that the drives
    contradict."""
    ahead_or_behind: bool = False
    """Whether the measured point may as well lie as far on the other side of the axle."""

    @property
    def left_by(self) -> str | None:
        """The law of the robot file, if any, whose form or size is not quite right."""
        if self.outdated:
            return self.outdated[0]
        misfit = self.misfit
        return misfit.effect if misfit is not None and misfit.only_in is None else None

    @property
    def of_another_drive(self) -> bool:
        """Whether wheels and reference have at most their turns in common: there is no result."""
        nothing = ("another_drive", "no_turn", "places", "scale")
        return any(remark.what in nothing for remark in self.remarks)

    @property
    def model(self) -> Model:
        """The reported model."""
        return self.told.point.model

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
