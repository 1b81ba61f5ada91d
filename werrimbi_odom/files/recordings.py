# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The requested files of one robot, and their content."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from numbers import Real
from pathlib import Path
from typing import get_args

from werrimbi_odom.effects.lookup import Collection
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import LEAST, MOST, EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.gyro_headings import as_of_a_gyro
from werrimbi_odom.files.references.held_poses import without_held_poses
from werrimbi_odom.files.references.merged_reference import as_mounted, with_one_scale
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.files.run_bag import Topics
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.run_folder import TICKS
from werrimbi_odom.files.tables.mislabelled_columns import without_zeros
from werrimbi_odom.files.text_files import place_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.progress import Show, silent

BAG = "metadata.yaml"
_NAMED = 8  # runs of a folder named before "..."


@dataclass(frozen=True, kw_only=True)
class DriveOptions:
    """How drives are read and evaluated: from Python, on the command line, and in a worker."""

    reference_kind: ReferenceKind | None = None
    """Noise of the reference; None: as known to the reader of the drives, incremental for headings
    alone, otherwise absolute."""
    leg: float = 1.0
    """Length of a leg [m]."""
    reference_sigma_xy: float | None = None
    """Noise of the reference's position, if known [m]."""
    reference_sigma_yaw: float | None = None
    """Noise of its heading, if known [rad]."""
    ticks_topic: str | None = None
    reference_topic: Topics = None
    effects: tuple[Path, ...] = ()
    """Files with the user's own effects."""
    references: tuple[Path, ...] = ()
    """References of the runs, then of the held-out ones, in order; empty: contained in the runs."""
    force_reference: bool = False
    """Accept a reference that is computed from the wheels."""

    def __post_init__(self) -> None:
        """Refuse what the command line refuses; it says so itself, with the option's name there."""
        kinds = get_args(ReferenceKind)
        if self.reference_kind is not None and self.reference_kind not in kinds:
            raise InputError(
                f"reference_kind must be one of {', '.join(kinds)}, and is {self.reference_kind!r}"
            )
        for name in ("leg", "reference_sigma_xy", "reference_sigma_yaw"):
            value = getattr(self, name)
            known = value is not None or name == "leg"
            if known and not (isinstance(value, Real) and LEAST <= float(value) <= MOST):
                raise InputError(
                    f"{name} must be a number greater than zero (from {LEAST:g} to {MOST:g}), and "
                    f"is {value!r}"
                )


@dataclass(frozen=True)
class Asked:
    """The files of one robot."""

    robot: Path
    runs: tuple[Path, ...]
    holdout: tuple[Path, ...] = ()
    how: DriveOptions = DriveOptions()


@dataclass(frozen=True)
class Recordings:
    """Content of all requested files."""

    source: RobotFile
    collection: Collection
    """Effects that a robot file may name, including those of --effects."""
    runs: tuple[Run, ...]
    holdout: tuple[Run, ...]
    """Held-out runs, for evaluation only; may be empty."""
    how: DriveOptions
    fitted: Robot | None = None
    """Robot to evaluate, if it differs from the file's because more was fitted."""

    @property
    def robot(self) -> Robot:
        """Robot to evaluate."""
        return self.fitted or self.source.robot

    def chosen(self, names: Sequence[str]) -> Recordings:
        """With the fitted runs of these names alone."""
        keep = [run.name in names for run in self.runs]
        others = self.how.references
        kept = (*(each for each, kept in zip(others, keep, strict=False) if kept),)
        return replace(
            self,
            runs=tuple(run for run, kept in zip(self.runs, keep, strict=True) if kept),
            how=replace(self.how, references=(*kept, *others[len(keep) :])),
        )

    @property
    def evaluation(self) -> EvaluationOptions:
        """Options for evaluating a robot on these runs."""
        how = self.how
        return EvaluationOptions(
            reference_kind=how.reference_kind or "absolute",
            leg=how.leg,
            limits=self.source.limits,
            sigma_xy=how.reference_sigma_xy,
            sigma_yaw=how.reference_sigma_yaw,
        )


def read(asked: Asked, collection: Collection, show: Show = silent) -> Recordings:
    """Read robot file and runs.

    `collection`: effects that the robot file may name. InputError if an input is not usable.
    """
    source = read_robot_file(asked.robot, effects=collection)
    return gathered(source, collection, asked.runs, asked.holdout, asked.how, show)


def gathered(
    source: RobotFile,
    collection: Collection,
    runs: Sequence[Run | Path],
    holdout: Sequence[Run | Path],
    how: DriveOptions,
    show: Show = silent,
) -> Recordings:
    """Collect the drives of a robot; paths are read.

    InputError if an input is not usable, or a drive is given twice.
    """
    drives = [*runs, *holdout]
    references = reference_of_each(drives, how.references)
    refuse_twice(drives)
    found: list[Run] = []
    for number, drive in enumerate(drives):
        if isinstance(drive, Run):
            run = drive
        else:
            show(number / len(drives), f"reading {drive.name}")
            run = _read(drive, source, how, references[number])
        if run.reference is not None:
            run = replace(run, reference=as_mounted(run.reference, source.robot))
        run = without_zeros(run)
        refuse_unjudgeable(run, source.robot)
        found.append(run)
    found = _with_one_scale(found, len(runs))
    found = as_of_a_gyro(found, noise_known=how.reference_sigma_yaw is not None)
    if how.reference_kind is None:
        how = replace(how, reference_kind=_kind_of(found))
    if how.reference_kind != "incremental":
        found = [without_held_poses(run, source.robot) for run in found]
    count = len(runs)
    return Recordings(source, collection, tuple(found[:count]), tuple(found[count:]), how)


def reference_of_each(
    drives: Sequence[Run | Path], references: Sequence[Path]
) -> Sequence[Path | None]:
    """The separate reference of each drive; None where they contain theirs.

    InputError if there are not as many as drives.
    """
    if references and len(references) != len(drives):
        raise InputError(
            f"{len(references)} times --reference for {len(drives)} runs: give it once for each "
            "RUN, then for each of --holdout, in their order"
        )
    return references or [None] * len(drives)


def _with_one_scale(runs: Sequence[Run], fitted: int) -> list[Run]:
    """Apply the common gyro scale, estimated from the fitted drives, to merged headings."""
    references = [run.reference for run in runs if run.reference is not None]  # of all
    scaled = with_one_scale(references, references[:fitted])
    return [replace(run, reference=each) for run, each in zip(runs, scaled, strict=True)]


def _kind_of(runs: Sequence[Run]) -> ReferenceKind:
    """Kind of the reference if known for any drive, otherwise absolute."""
    kinds = {run.reference.kind for run in runs if run.reference is not None}
    known: tuple[ReferenceKind, ...] = ("local_map", "incremental")
    return next((kind for kind in known if kind in kinds), "absolute")


def _read(path: Path, source: RobotFile, how: DriveOptions, reference: Path | None) -> Run:
    if path.is_dir() and not any((path / name).exists() for name in (TICKS, BAG)):
        within = sorted(
            {found.parent.name for name in (TICKS, BAG) for found in path.glob(f"*/{name}")}
        )
        if within:
            more = " ..." if len(within) > _NAMED else ""
            raise InputError(
                f"{path} is no run but a folder of {len(within)} "
                f"({', '.join(within[:_NAMED])}{more}); give each of them: {path}/*"
            )
    return read_run(
        path,
        source,
        ticks_topic=how.ticks_topic,
        reference_topic=how.reference_topic,
        reference=reference,
        force=how.force_reference,
    )


def refuse_twice(drives: Iterable[Run | Path]) -> None:
    """Raise on a repeated drive, which would make every result too precise.

    InputError if two paths lead to the same drive, or one that was read is given again.
    """
    seen: set[str | int] = set()
    for drive in drives:
        place = id(drive) if isinstance(drive, Run) else place_of(drive)
        if place in seen:
            path = drive.path if isinstance(drive, Run) else drive
            raise InputError(f"{path} is given twice; a drive counts once, in RUN or in --holdout")
        seen.add(place)
