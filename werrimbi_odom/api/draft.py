# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drafts a new effect from the dependence of the errors, where no known effect explains them."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.api.compare_diagnose_add import as_judged
from werrimbi_odom.api.drives import Drives, Options, recordings_of
from werrimbi_odom.api.next_command import next_command
from werrimbi_odom.api.one_blas_thread import with_one_blas_thread
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.recordings import Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.text_files import beside, replacing
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose as search
from werrimbi_odom.inference.drafting.draft import Draft, as_a_floor, worth_drafting
from werrimbi_odom.inference.drafting.package import package_of
from werrimbi_odom.inference.drafting.two_variables import best_draft
from werrimbi_odom.progress import Show, silent
from werrimbi_odom.report.adding.draft import draft_document, draft_json

if TYPE_CHECKING:
    from typing_extensions import Unpack


@dataclass(frozen=True, repr=False, kw_only=True)
class Drafted(Result[Any]):
    """A draft, and its influence on the error."""

    found: Draft

    def write_package(self, folder: str | Path) -> list[Path]:
        """Write a small package that `pip install` accepts; return its files.

        Raises
        ------
        InputError
            If it cannot be written.
        """
        folder = Path(folder)
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(f"{folder} cannot be made: {error.strerror}") from error
        written = []
        for name, text in package_of(self.found).items():
            with replacing(folder / name) as file:
                file.write(text)
            written.append(folder / name)
        return written


def draft(
    robot: RobotFile,
    runs: Drives,
    *,
    holdout: Drives = (),
    force: bool = False,
    show: Show = silent,
    **options: Unpack[Options],
) -> Drafted:
    """For the verdict "unknown": draft an effect from the dependence in the drives.

    The effect depends on one variable, or on two if the second is significant on held-out drives.

    Parameters
    ----------
    force
        Draft for any verdict.

    Returns
    -------
    Drafted
        `found.source` is the text of the effect's file, `found.effect` the effect itself, for
        `add`. `write_package(folder)` writes a package.
    """
    given = recordings_of(robot, runs, holdout, **options)
    return drafted(given, "" if force else "force=True drafts", show)


@with_one_blas_thread
def drafted(given: Recordings, insist: str = "", show: Show = silent) -> Drafted:
    """`draft` for recordings that are already read.

    `insist` says how to draft for any verdict; "": already requested.
    """
    robot = given.robot
    diagnosis = search(
        given.runs,
        robot,
        given.collection.effects,
        given.evaluation,
        holdout=given.holdout,
        show=show,
    )
    given = as_judged(given, diagnosis)
    by_no_law = diagnosis.one_sided is not None or diagnosis.by_events or as_a_floor(diagnosis)
    if insist and (diagnosis.verdict != "unknown" or by_no_law):
        raise InputError(_known(diagnosis, given, insist))

    def tried_out(found: Draft) -> Added:
        return add_effects(
            (found.effect,),
            given.runs,
            diagnosis.robot,
            given.evaluation,
            given=robot,
            holdout=given.holdout,
            show=show,
        )

    found, tried = best_draft(diagnosis, tried_out, show)
    return Drafted(
        found=found,
        document=lambda: draft_document(found, tried),
        figures_of_json=lambda: draft_json(found, tried),
    )


def _known(diagnosis: Diagnosis, given: Recordings, insist: str) -> str:
    """Why nothing is drafted, and what to do instead."""
    force = f"; {insist} the strongest dependence that is left" if worth_drafting(diagnosis) else ""
    if diagnosis.verdict == "none":
        return f"the verdict is none: the model explains these drives to their noise{force}"
    if diagnosis.one_sided is not None:
        side = diagnosis.one_sided.side
        who = "both wheels err" if side == "both" else f"the {side} wheel errs"
        return (
            f"{who}, but the parts of the drives do not agree on what these errors go with{force}"
        )
    if diagnosis.by_events:
        return (
            "what is missing comes at once, with reversals or with starts and stops, and goes with "
            f"nothing that lasts{force}"
        )
    if diagnosis.verdict == "unknown":
        return (
            "what is missing goes most with the heading, in each drive by a wave of its own, as "
            "a slope or a carpet does by scans: no law of it holds in another drive. Motion "
            f"capture or a localiser's map shows it{force}"
        )
    if diagnosis.verdict == "ambiguous":
        names = ", ".join(diagnosis.rivals)
        return f"the verdict is ambiguous between effects of the library ({names}){force}"
    better = beside(given.source.path, "better")
    names = ",".join(diagnosis.found)
    add = next_command(["add", names], given, out=better, one_line=True)
    return (
        f"the verdict is named: {names}, which the library holds; add it, and draft "
        f"with the new robot file what then remains: {add}"
        f"{force}"
    )
