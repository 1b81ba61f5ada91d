# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files and recorded drives, from disk or already read."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import UnionType
from typing import TYPE_CHECKING, Any, TypedDict

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run as read_one
from werrimbi_odom.files.recordings import DriveOptions, Recordings, gathered
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import ReferenceKind, Run

if TYPE_CHECKING:
    from typing_extensions import Unpack

    from werrimbi_odom.effects.lookup import Collection

Drives = Run | str | Path | Sequence[Run | str | Path]
"""One drive or several, as paths or already read."""


class Options(TypedDict, total=False):
    """Options for evaluating drives; defaults as on the command line."""

    reference_kind: ReferenceKind | None
    """"absolute": independent noise per pose of the reference; "incremental": it accumulates;
    "local_map": it also drifts slowly. Default: incremental for a gyro and for headings alone,
    local_map for a localiser (map -> odom -> base_link, AMCL) in a bag, else absolute."""
    leg: float
    """Length of a leg [m]; default 1."""
    reference_sigma_xy: float | None
    """Noise of the reference in x and in y, if known [m]."""
    reference_sigma_yaw: float | None
    """Noise of the reference in heading, if known [rad]."""
    ticks_topic: str | None
    """Topic of the ticks, in bags."""
    reference_topic: str | Sequence[str] | None
    """Topic of the reference, in bags."""
    references: Sequence[str | Path]
    """Separate references of each drive, then of each held-out one: other bags, or folders with
    reference.csv."""
    effects: Sequence[str | Path]
    """Files with your own effects, for use in the robot file."""
    force_reference: bool
    """Accept a reference that is computed from the wheels."""


def read_robot(path: str | Path, effects: Sequence[str | Path] = ()) -> RobotFile:
    """Read a robot file.

    Parameters
    ----------
    effects
        Files with your own effects, for use in the robot file.

    Raises
    ------
    InputError
        If it is not usable; the message gives file, line and remedy.
    """
    return read_robot_file(path, collection_of(effects) if effects else None)


def read_run(
    path: str | Path,
    robot: RobotFile,
    *,
    ticks_topic: str | None = None,
    reference_topic: str | Sequence[str] | None = None,
    reference: str | Path | None = None,
    force: bool = False,
    progress: Callable[[float], None] | None = None,
) -> Run:
    """Read a recorded drive: a run folder, a rosbag2, an .mcap or a ROS 1 .bag.

    Parameters
    ----------
    ticks_topic, reference_topic
        Topics of wheels and reference, in a bag with several; two references are merged.
    reference
        Separate recording of the reference of this drive.
    force
        Accept a localiser's correction as poses of the robot.
    progress
        Callback for the share read.

    Raises
    ------
    InputError
        If it is not usable; the message gives place and remedy.
    """
    return read_one(
        Path(path),
        robot,
        ticks_topic=ticks_topic,
        reference_topic=reference_topic,
        reference=reference,
        force=force,
        progress=progress,
    )


def collection_of(effects: Sequence[str | Path] = ()) -> Collection:
    """All effects: the library's, those of installed packages, and those of files."""
    from werrimbi_odom.effects.lookup import all_effects

    return all_effects(tuple(Path(file) for file in effects))


def recordings_of(
    robot: RobotFile, runs: Drives, holdout: Drives = (), **options: Unpack[Options]
) -> Recordings:
    """Read and check all inputs of a verb, as the command line does."""
    require_robot(robot, RobotFile)
    how = how_of(**options)
    fitted, held = _several(runs), _several(holdout)
    if not fitted:
        raise InputError("no drives were given")
    found = told_apart(gathered(robot, collection_of(how.effects), fitted, held, how))
    for words in refuse_circles(found):
        warnings.warn(words, stacklevel=3)
    return found


def require_robot(robot: object, kind: type | UnionType) -> None:
    """Check that what should be a robot is one; TypeError if it is not."""
    if not isinstance(robot, kind):
        raise TypeError(f"the robot comes first, from read_robot, and not {type(robot).__name__}")


def how_of(**options: Unpack[Options]) -> DriveOptions:
    """Options for reading and evaluating drives, as on the command line."""
    unknown = sorted(set(options) - set(Options.__annotations__))
    if unknown:
        raise TypeError(
            f"unknown option {unknown[0]}; there are {', '.join(Options.__annotations__)}"
        )
    given: dict[str, Any] = dict(options)
    for name in ("effects", "references"):
        given[name] = tuple(Path(each) for each in given.get(name, ()))
    return DriveOptions(**given)


def told_apart(given: Recordings) -> Recordings:
    """With their folders in the names of drives, fitted or held out, of which two are called alike.

    A drive is told, and chosen, by its name.
    """
    from werrimbi_odom.report.phrases import drive_names

    def named(runs: tuple[Run, ...]) -> tuple[Run, ...]:
        if len({run.name for run in runs}) == len(runs):
            return runs
        names = drive_names(run.path for run in runs)
        return tuple(replace(run, name=names[run.path]) for run in runs)

    return replace(given, runs=named(given.runs), holdout=named(given.holdout))


def refuse_circles(given: Recordings) -> list[str]:
    """Check that the references are independent of the wheels; return remarks on them.

    InputError if one is computed from the wheels, and this is not accepted by option.
    """
    from werrimbi_odom.inference.comparison.made_from_wheels import require_independent

    told = []
    for run in (*given.runs, *given.holdout):
        try:
            words = require_independent(run, given.source.robot, given.source.limits)
        except InputError as error:
            if not given.how.force_reference:
                raise
            words = (
                f"{str(error).replace(' (--force takes it all the same)', '')}: taken all the same"
            )
        told += [words] if words else []
    return told


def refuse_other_units(given: Recordings) -> None:
    """Check that no reference is in another unit, as `diagnose` does; InputError if one is.

    The set-up is searched where ways by wheels and reference are as far apart as units are.
    """
    from werrimbi_odom.files.tables.compared_ways import words_about_ways
    from werrimbi_odom.inference.set_up.search import look_for_mistakes

    if not any(words_about_ways(run, given.robot) for run in given.runs):
        return
    words = None
    with suppress(InputError):  # nothing in common: what is judged tells it
        words = look_for_mistakes(given.runs, given.robot, given.evaluation).to_convert
    if words is not None:
        raise InputError(f"{given.runs[0].path}: {words}")


def _several(runs: Drives) -> list[Run | Path]:
    given = [runs] if isinstance(runs, Run | str | Path) else list(runs)
    for each in given:
        if not isinstance(each, Run | str | Path):
            raise TypeError(
                f"drives are runs from read_run, or paths, and not {type(each).__name__}; "
                "write_run makes a folder of arrays"
            )
    return [each if isinstance(each, Run) else Path(each) for each in given]
