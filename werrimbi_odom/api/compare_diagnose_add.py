# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The main verbs: compare, diagnose, add; defaults as on the command line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from werrimbi_odom.api.drives import Drives, Options, recordings_of, refuse_other_units
from werrimbi_odom.api.next_command import next_command
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.api.result import NewRobot, Result
from werrimbi_odom.errors import InputError, TooFewLegsError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.text_files import beside
from werrimbi_odom.progress import Show, silent
from werrimbi_odom.report.number_format import more_like_these

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from werrimbi_odom.inference.adding.added import Added
    from werrimbi_odom.inference.comparison.compare import Comparison
    from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
    from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
    from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
    from werrimbi_odom.model.effect import Effect


def compare(
    robot: RobotFile, runs: Drives, *, show: Show = silent, **options: Unpack[Options]
) -> Result[Comparison]:
    """Compare a model with measurements.

    Parameters
    ----------
    robot
        From `read_robot`.
    runs
        Drives from `read_run`, or their paths.
    show
        Callback for progress.
    **options
        How drives are evaluated: `reference_kind`, `leg`, `reference_sigma_xy`, ... (`Options`).

    Raises
    ------
    InputError
        If the drives are not usable; the message gives the reason.
    """
    given = recordings_of(robot, runs, (), **options)
    return compared(given, show)


@with_one_blas_thread
def compared(
    given: Recordings, show: Show = silent, *, over: PreparedRuns | None = None
) -> Result[Comparison]:
    """`compare` for recordings that are already read.

    `over` are the drives already cut into legs, so that before and after use the same legs.
    """
    from werrimbi_odom.inference.comparison.compare import compare as judge
    from werrimbi_odom.inference.comparison.compare import judged
    from werrimbi_odom.report.comparison.as_json import json_of
    from werrimbi_odom.report.comparison.document import document_of

    if over is None:
        refuse_other_units(given)
        found = judge(given.runs, given.robot, given.evaluation, show=show)
    else:
        found = judged(over, given.robot, show=show)
    return Result(
        found=found,
        document=lambda: document_of(
            found, next_command(["diagnose"], given), _fit_command(given, one_line=False)
        ),
        figures_of_json=lambda: json_of(found),
    )


def diagnose(
    robot: RobotFile,
    runs: Drives,
    *,
    holdout: Drives = (),
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[AdvisedDiagnosis]:
    """Find the missing physical effect; for common parameters see `compare`.

    Parameters
    ----------
    holdout
        Drives for evaluation only. If none are given, parts of every drive are held out.
    """
    given = recordings_of(robot, runs, holdout, **options)
    return diagnosed(given, show)


@with_one_blas_thread
def diagnosed(given: Recordings, show: Show = silent) -> Result[AdvisedDiagnosis]:
    """`diagnose` for recordings that are already read."""
    from werrimbi_odom.inference.manoeuvres.advice import advised_diagnosis, with_leg
    from werrimbi_odom.report.diagnosis.as_json import json_of
    from werrimbi_odom.report.diagnosis.document import document_of
    from werrimbi_odom.report.diagnosis.next_steps import NextSteps

    try:
        advised = advised_diagnosis(given, show)
    except TooFewLegsError as few:
        raise InputError(f"{few}{_instead(given)}") from None
    given = as_judged(with_leg(given, advised.leg), advised.diagnosis)

    def steps() -> NextSteps:
        better = beside(given.source.path, "better")
        return NextSteps(
            add=lambda names: next_command(["add", ",".join(names)], given, out=better).strip(),
            again=lambda names: next_command(["diagnose"], given.chosen(names)).strip(),
            on_map=_fit_command(on_map(given), one_line=False).strip(),
            draft=next_command(["draft"], given, out="my_effect").strip(),
        )

    return Result(
        found=advised,
        document=lambda: document_of(advised, steps()),
        figures_of_json=lambda: {
            **json_of(advised.diagnosis, advised.manoeuvre, advised.sights, advised.changes),
            "drives_differ": advised.drives_differ,
            "leg_m": advised.leg,
        },
    )


def _instead(given: Recordings) -> str:
    """Words for drives that are too few to diagnose: how many more are needed, and what they tell.

    The end of a sentence.
    """
    from werrimbi_odom.inference.seldom_measured import more_to_diagnose, tell_sizes

    more = more_to_diagnose(given.runs, all_fitted=bool(given.holdout))
    apart = "" if given.holdout else ", a quarter of all being put aside for judging"
    words = more_like_these(more, apart)
    if not tell_sizes(given.runs):
        return f"{words}; `werrimbi compare` shows the errors of these"
    return f"{words}; base and radii alone are told by: {_fit_command(given, one_line=True)}"


def _fit_command(given: Recordings, *, one_line: bool) -> str:
    out = beside(given.source.path, "fitted")
    return next_command(["calibrate", "fit"], given, out=out, one_line=one_line)


def as_judged(given: Recordings, diagnosis: Diagnosis) -> Recordings:
    """Recordings with the kind of reference that a diagnosis found, for what follows it."""
    return given if diagnosis.wander is None else on_map(given)


def on_map(given: Recordings) -> Recordings:
    """Recordings with a reference that wanders."""
    return replace(given, how=replace(given.how, reference_kind="local_map"))


def add(
    effect: str | Effect | Sequence[str | Effect],
    robot: RobotFile,
    runs: Drives,
    *,
    holdout: Drives = (),
    force: bool = False,
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[Added]:
    """Add physical effects to the model, fitted with all calibration parameters; evaluate them.

    Parameters
    ----------
    effect
        One or several: names ("castor_kick", or "castor_kick,track_width"), or effects themselves.
    force
        Accept an effect despite objections.

    Returns
    -------
    Result
        `write_robot(path)` writes the new robot file.

    Raises
    ------
    InputError
        If the drives are not usable, or there is an objection to an effect.
    """
    given = recordings_of(robot, runs, holdout, **options)
    result = added(given, effects_of(effect, given), show)
    if not force:
        refuse_unearned(result.found, "force=True takes")
    return result


def effects_of(wanted: str | Effect | Sequence[str | Effect], given: Recordings) -> list[Effect]:
    """Find effects by name: "A,B" or several; effects are passed through.

    InputError if there is none, or a name is unknown or given twice.
    """
    several: Sequence[str | Effect]
    if isinstance(wanted, str):
        several = [name.strip() for name in wanted.split(",")]
    else:
        several = wanted if isinstance(wanted, Sequence) else [wanted]
    found = [given.collection.find(each) if isinstance(each, str) else each for each in several]
    if not found:
        raise InputError("no effect was given")
    names = [effect.name for effect in found]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice:
        raise InputError(f"{','.join(names)} names {twice} twice")
    return found


@with_one_blas_thread
def added(given: Recordings, effects: Sequence[Effect], show: Show = silent) -> Result[Added]:
    """`add` for recordings that are already read, without raising on objections."""
    from werrimbi_odom.inference.adding.adding import add_effects
    from werrimbi_odom.report.adding.as_json import json_of
    from werrimbi_odom.report.adding.document import document_of

    found = add_effects(
        effects, given.runs, given.robot, given.evaluation, holdout=given.holdout, show=show
    )
    return Result(
        found=found,
        document=lambda: document_of(found),
        figures_of_json=lambda: json_of(found),
        new_robot=NewRobot(given.source, found.changes, found.robot.effects),
    )


def refuse_unearned(added: Added, insist: str) -> None:
    """Raise InputError if there is an objection to any of the effects; it names those without one.

    `insist` says how to add them regardless.
    """
    if added.objection is None:
        return
    it = "it" if len(added.effects) == 1 else "them"
    text = f"{added.objection}; nothing is written ({insist} {it} all the same"
    good = [effect.name for effect in added.effects if effect.name not in added.objections]
    if good:
        rest = ",".join(good)
        text += f"; without {' and '.join(added.objections)}: werrimbi add {rest} ..."
    raise InputError(f"{text})")
