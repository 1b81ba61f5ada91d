# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A diagnosis with everything reported beside it: next manoeuvre, detection limits, changes."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.changes.between_drives import ParameterChange, changes_between
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.effect_support import support_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.manoeuvres.detection_limits import DetectionLimit, detection_limits
from werrimbi_odom.inference.manoeuvres.for_unexplained_errors import ProposedManoeuvre, strongest
from werrimbi_odom.inference.manoeuvres.next_manoeuvre import next_manoeuvre
from werrimbi_odom.progress import Show, silent

WHEELS_ANGLE = frozenset({"left_angle", "right_angle"})
"""Inputs of effects that repeat with each turn of a wheel."""


def shorter_leg(diagnosis: Diagnosis, leg: float) -> float | None:
    """Length of legs that may tell more [m]; None where the legs are not the reason.

    Drives of a metre or two make so few legs that they do not tell the noise, and without it what
    is missing cannot be told. (Positions alone need long legs for a heading.)

    Of rivals: over whole turns of a wheel a bump on its tread is a larger radius, and an axle off
    the centre is nothing: what tells them apart is seen within a turn alone. And few legs, as of
    one square, hold a start, a stop and a turn each: a late clock is like play of a wheel. `leg`:
    length of the legs of this diagnosis [m].
    """
    if diagnosis.verdict == "none":
        return None
    if not diagnosis.runs.tells_noise and not diagnosis.runs.positions_alone:
        return rules.SHORT_LEG if leg > rules.SHORT_LEG else None
    if diagnosis.verdict != "ambiguous":
        return None
    if not _repeats_each_turn(diagnosis):
        few = _legs(diagnosis, leg) < rules.LEGS_ENOUGH and leg > rules.SHORT_LEG
        return rules.SHORT_LEG if few else None
    robot = diagnosis.robot
    turns = (
        robot.left_tick * robot.left_ticks_per_revolution,
        robot.right_tick * robot.right_ticks_per_revolution,
    )
    shorter = float(f"{min(turns) / rules.LEGS_A_TURN:.2g}")
    return shorter if shorter < 0.5 * leg else None


def settles(shorter: Diagnosis, longer: Diagnosis) -> bool:
    """Whether the diagnosis with shorter legs names one of the rivals of the one with longer.

    Or, where longer legs are too few to tell the noise, whether there are more of the shorter.
    """
    if not longer.runs.tells_noise:
        return shorter.runs.data > longer.runs.data
    known = {*longer.rivals, *longer.found}
    return (
        shorter.verdict == "named"
        and shorter.effect in longer.rivals
        and known.issuperset(shorter.found)
    )


def _legs(diagnosis: Diagnosis, leg: float) -> float:
    """Length of all drives in legs of `leg` [m] or a quarter turn."""
    drives = [run.counters for run in diagnosis.runs.runs]
    return sum(float(each.way(diagnosis.robot, leg, rules.QUARTER_TURN)[-1]) for each in drives)


def _repeats_each_turn(diagnosis: Diagnosis) -> bool:
    """Whether one of the rivals is an effect of the angle of a wheel."""
    runs, model = diagnosis.runs, diagnosis.model
    drive = runs.drive(model.laid_out(runs.steps))
    return any(
        WHEELS_ANGLE & support_of(score.candidate, drive).inputs
        for score in diagnosis.rounds[0].scores
        if score.candidate.name in diagnosis.rivals
    )


@dataclass(frozen=True)
class AdvisedDiagnosis:
    """A diagnosis and everything that is reported with it."""

    diagnosis: Diagnosis
    manoeuvre: ProposedManoeuvre | None
    sights: Sequence[DetectionLimit]
    leg: float = 1.0
    """Length of the judged legs [m]."""
    held_out: bool = True
    """Whether held-out drives were given; otherwise the diagnosis held out parts itself."""
    changes: Sequence[ParameterChange] = ()
    """Changes between the fitted drives."""
    open_at: float | None = None
    """Length of legs that leave it open, where shorter ones were needed [m]."""
    too_few: bool = False
    """Whether those are too few to tell the noise; else they leave the verdict *ambiguous*."""

    @property
    def drives_differ(self) -> bool:
        """Whether changes between the drives may be all that no effect explains.

        What the mean of two robots goes with is no law of either, and no reason to drive.
        """
        return self.diagnosis.verdict == "unknown" and bool(self.changes)


def advised_diagnosis(given: Recordings, show: Show = silent) -> AdvisedDiagnosis:
    """Diagnose one robot, with the next manoeuvre, the detection limits and the changes.

    InputError when the drives do not allow it; the message says why.
    """
    diagnosis = _diagnosis(given, show)
    leg, open_at, too_few = given.how.leg, None, False
    if shorter := shorter_leg(diagnosis, leg):
        again = _diagnosis(
            with_leg(given, shorter),
            lambda share, words: show(share, f"legs of {shorter:g} m: {words}"),
        )
        if settles(again, diagnosis):
            too_few = not diagnosis.runs.tells_noise
            diagnosis, leg, open_at = again, shorter, leg
    show(0.97, "the next step")
    effects = given.collection.effects
    changes = changes_between(diagnosis, effects)
    sights = detection_limits(diagnosis, effects)
    told = AdvisedDiagnosis(
        diagnosis, None, sights, leg, bool(given.holdout), changes, open_at, too_few
    )
    return told if told.drives_differ else replace(told, manoeuvre=next_manoeuvre(diagnosis))


def with_leg(given: Recordings, leg: float) -> Recordings:
    """The same drives, to be judged with legs of this length [m]."""
    return replace(given, how=replace(given.how, leg=leg))


def _diagnosis(given: Recordings, show: Show) -> Diagnosis:
    effects = given.collection.effects
    return diagnose(
        given.runs, given.robot, effects, given.evaluation, holdout=given.holdout, show=show
    )


def significant(diagnosis: Diagnosis) -> list[Dependence]:
    """Significant cells of the evidence map, one for each channel and variable.

    Most significant first; if no effect explains the errors, first the cell that explains most.
    """
    cells = one_each(beyond_chance(diagnosis.depends_on))
    first = strongest(diagnosis) if diagnosis.verdict == "unknown" else None
    if first is None:
        return cells
    others = [cell for cell in cells if (cell.channel, cell.name) != (first.channel, first.name)]
    return [first, *others]


def beyond_chance(cells: Iterable[Dependence]) -> Iterator[Dependence]:
    """Significant cells of the evidence map."""
    return (cell for cell in cells if cell.p_value < rules.SURE)


def one_each(cells: Iterable[Dependence]) -> list[Dependence]:
    """The first cell of each channel and variable."""
    found: dict[tuple[str, str], Dependence] = {}
    for cell in cells:
        found.setdefault((cell.channel, cell.name), cell)
    return list(found.values())
