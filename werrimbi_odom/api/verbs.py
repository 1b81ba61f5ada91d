# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The verbs of the loop: compare, diagnose, add, draft; the same defaults as the command line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from werrimbi_odom.api.drives import Drives, Options, recordings_of
from werrimbi_odom.api.result import NewRobot, Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.asked import Recordings
from werrimbi_odom.files.robot_file import RobotFile

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from werrimbi_odom.inference.adding.added import Added
    from werrimbi_odom.inference.adding.drafting import Draft
    from werrimbi_odom.inference.comparison.compare import Comparison
    from werrimbi_odom.model.effect import Effect
    from werrimbi_odom.report.diagnosis.told import Told

Show = Callable[[float, str], None]
"""Told the share done, and what is being done."""


def silent(share: float, words: str) -> None:
    """Show nothing."""


def compare(
    robot: RobotFile,
    runs: Drives,
    *,
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[Comparison]:
    """Model against measurement: where it fails.

    Parameters
    ----------
    robot
        From `read_robot`.
    runs
        Drives from `read_run`, or their paths.
    show
        Told the share done, and what is being done.
    **options
        How drives are judged: `reference_kind`, `leg`, `reference_sigma_xy`, ... (`Options`).

    Raises
    ------
    InputError
        When the drives cannot be used; the message says why.
    """
    given = recordings_of(robot, runs, (), **options)
    return compared(given, show)


def compared(given: Recordings, show: Show = silent) -> Result[Comparison]:
    """`compare` for what was read already."""
    from werrimbi_odom.inference.comparison.compare import compare as judge
    from werrimbi_odom.report.comparison.as_json import json_of
    from werrimbi_odom.report.comparison.page import compare_page
    from werrimbi_odom.report.comparison.tables import tables_of
    from werrimbi_odom.report.comparison.words import words_of

    found = judge(given.runs, given.source.robot, **given.judging, show=show)
    step = "`diagnose`"
    return Result(
        found=found,
        words=lambda: f"{words_of(found, next_step=step)}\n\n{tables_of(found)}",
        figures_of_json=lambda: json_of(found),
        page=lambda: compare_page(found, next_step=step, made={}),
    )


def diagnose(
    robot: RobotFile,
    runs: Drives,
    *,
    holdout: Drives = (),
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[Told]:
    """Which physical effect is missing; see `compare` for what it has in common.

    Parameters
    ----------
    holdout
        Drives that report alone. None given: parts of every drive are put aside for it.
    """
    given = recordings_of(robot, runs, holdout, **options)
    return diagnosed(given, show)


def diagnosed(given: Recordings, show: Show = silent) -> Result[Told]:
    """`diagnose` for what was read already."""
    from werrimbi_odom.report.diagnosis.as_json import json_of
    from werrimbi_odom.report.diagnosis.page import diagnosis_page
    from werrimbi_odom.report.diagnosis.tables import tables_of
    from werrimbi_odom.report.diagnosis.told import told_of
    from werrimbi_odom.report.diagnosis.words import NextSteps, words_of

    told = told_of(given, show)
    return Result(
        found=told,
        words=lambda: f"{words_of(told, NextSteps())}\n\n{tables_of(told.diagnosis, told.sights)}",
        figures_of_json=lambda: json_of(told.diagnosis, told.manoeuvre, told.sights),
        page=lambda: diagnosis_page(told, NextSteps(), {}),
    )


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
    """Add physical effects to the model, fitted together with all calibration, and judge them.

    Parameters
    ----------
    effect
        One or several: names ("castor_kick", or "castor_kick,track_width"), or effects themselves.
    force
        Take even an effect that does not earn its place.

    Returns
    -------
    Result
        `write_robot(path)` writes the new robot file.

    Raises
    ------
    InputError
        When the drives cannot be used, or an effect does not earn its place.
    """
    given = recordings_of(robot, runs, holdout, **options)
    result = added(given, _effects(effect, given), show)
    if result.found.objection is not None and not force:
        raise InputError(f"{result.found.objection} (force=True takes it all the same)")
    return result


def _effects(wanted: str | Effect | Sequence[str | Effect], given: Recordings) -> list[Effect]:
    if isinstance(wanted, str):
        return [given.collection.find(name.strip()) for name in wanted.split(",")]
    several = wanted if isinstance(wanted, Sequence) else [wanted]
    return [given.collection.find(each) if isinstance(each, str) else each for each in several]


def added(given: Recordings, effects: Sequence[Effect], show: Show = silent) -> Result[Added]:
    """`add` for what was read already, whatever speaks against it."""
    from werrimbi_odom.inference.adding.adding import add_effects
    from werrimbi_odom.report.adding.page import adding_page
    from werrimbi_odom.report.adding.words import json_of, words_of

    found = add_effects(
        effects,
        given.runs,
        given.source.robot,
        holdout=given.holdout,
        **given.judging,
        show=show,
    )
    return Result(
        found=found,
        words=lambda: words_of(found),
        figures_of_json=lambda: json_of(found),
        page=lambda: adding_page(found, {}),
        new_robot=NewRobot(given.source, found.changes, found.robot.effects),
    )


def draft(
    robot: RobotFile,
    runs: Drives,
    *,
    holdout: Drives = (),
    force: bool = False,
    show: Show = silent,
    **options: Unpack[Options],
) -> Result[Draft]:
    """Where the verdict is unknown: an effect whose law is the dependence that the drives show.

    Parameters
    ----------
    force
        Draft whatever the verdict is.

    Returns
    -------
    Result
        `found.source` is the effect's file, `found.effect` the effect, to be read, and given to
        `add`.
    """
    given = recordings_of(robot, runs, holdout, **options)
    return drafted(given, force=force, show=show)


def drafted(given: Recordings, *, force: bool = False, show: Show = silent) -> Result[Draft]:
    """`draft` for what was read already."""
    from werrimbi_odom.inference.adding.adding import add_effects
    from werrimbi_odom.inference.adding.drafting import draft_effect
    from werrimbi_odom.inference.diagnosis.diagnosis import diagnose as search
    from werrimbi_odom.report.adding.draft_words import draft_json, draft_words
    from werrimbi_odom.report.adding.page import adding_page

    robot = given.source.robot
    diagnosis = search(
        given.runs,
        robot,
        given.collection.effects,
        holdout=given.holdout,
        show=show,
        **given.judging,
    )
    if diagnosis.verdict != "unknown" and not force:
        raise InputError(
            f"the verdict is {diagnosis.verdict}: only what is unknown is drafted (force=True "
            "drafts the strongest dependence all the same)"
        )
    found = draft_effect(diagnosis, show)
    tried = add_effects(
        (found.effect,),
        given.runs,
        diagnosis.robot,
        given=robot,
        holdout=given.holdout,
        show=show,
        **given.judging,
    )
    return Result(
        found=found,
        words=lambda: draft_words(found, tried),
        figures_of_json=lambda: draft_json(found, tried, ()),
        page=lambda: adding_page(tried, {}),
    )
