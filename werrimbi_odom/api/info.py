# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Contents of a recording, what it allows, and the next command."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from werrimbi_odom.api.info_stretches import judged_stretches
from werrimbi_odom.api.info_topics import DESCRIPTION, chosen_topics, separate_reference
from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag_joints import wheel_names
from werrimbi_odom.files.bags.bag_wheels import Wheels
from werrimbi_odom.files.bags.reference_choice import NONE
from werrimbi_odom.files.read_run import bag_at, read_run
from werrimbi_odom.files.recordings import reference_of_each
from werrimbi_odom.files.references.merged_reference import SCALE_MOST
from werrimbi_odom.files.robot_descriptions.controller_wheels import of_controller
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot, with_steps, with_wraps
from werrimbi_odom.files.robot_descriptions.wheel_joints import SIDES
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.inference.recording_info import Held, Info
from werrimbi_odom.report.info import document_of, info_json


def info(
    runs: str | Path | Sequence[str | Path],
    *,
    robot: str | Path | None = None,
    out: str | Path | None = None,
    ticks_topic: str | None = None,
    reference_topic: str | None = None,
    references: Sequence[str | Path] = (),
    force: bool = False,
) -> Result[Info]:
    """Contents of recordings, what they allow, and the next command.

    Parameters
    ----------
    runs
        Run folders or bags.
    robot
        A robot file, or the parameter file of a diff_drive_controller.
    out
        Path for a first robot file.
    ticks_topic, reference_topic
        Topics to use; default: the most suitable ones.
    references : sequence of str or Path
        Separate reference of each run: other bags, or folders with reference.csv.
    force
        Whether `out` may be overwritten.

    Raises
    ------
    InputError
        If a recording is unreadable, or a robot file cannot be written.
    """
    paths = [Path(each) for each in ([runs] if isinstance(runs, str | Path) else runs)]
    if not paths:
        raise InputError("no recordings were given")
    others = reference_of_each(paths, [Path(each) for each in references])
    file = None if robot is None else Path(robot)
    found = _look(paths, others, file, ticks_topic, reference_topic)
    if out is not None:
        found = replace(found, written=_write(found, Path(out), force))
    return Result(
        found=found, document=lambda: document_of(found), figures_of_json=lambda: info_json(found)
    )


def _look(
    paths: Sequence[Path],
    others: Sequence[Path | None],
    robot: Path | None,
    ticks_topic: str | None,
    reference_topic: str | None,
) -> Info:
    source, first = None, FirstRobot()
    if robot is not None:
        try:
            source = read_robot_file(robot)
        except InputError:
            with suppress(OSError, UnicodeDecodeError):
                if "ticks_per_revolution" in robot.read_text():
                    raise  # a robot file with a mistake, not a controller's
            first = of_controller(robot)
        if source is not None and "ticks_per_revolution" not in source.text:
            with suppress(InputError):  # a controller's file, from which a robot file is made
                source, first = None, of_controller(robot)
    held = []
    for path, other in zip(paths, others, strict=True):
        one, first = _held(path, other, source, first, ticks_topic, reference_topic)
        held.append(one)
    title = f"A first robot file, from {paths[0].name}: check base and radius with a ruler"
    sizes = source is not None or first.tells_distances
    given, parameters = (None, robot) if source is None else (robot, None)
    return Info(tuple(held), first, given, None, title, sizes, parameters)


def _held(
    path: Path,
    other: Path | None,
    source: RobotFile | None,
    first: FirstRobot,
    ticks_topic: str | None,
    reference_topic: str | None,
) -> tuple[Held, FirstRobot]:
    bag = bag_at(path)
    separate = None if other is None else separate_reference(other, source, reference_topic)
    if bag is None:
        topic = separate.name if separate is not None else None
        if source is None:
            first = replace(first, counted=True)
        file = source or first.file
        run = read_run(path, file, reference=other, reference_topic=topic)
        held = Held(path, None, None, separate, {}, None, "", other=other)
        return _as_read(held, run, source, first)
    held, first = chosen_topics(path, bag, source, first, ticks_topic, reference_topic)
    if other is not None:
        held = replace(held, reference=separate, beside=None, other=other)
    try:
        if held.wheels is None:
            raise InputError("nothing in it tells how the wheels turned")
        own = NONE if other is None else None
        reference = reference_topic or (held.reference.name if held.reference else own)
        if source is None:
            first = _with_ticks(path, held.wheels, first)
        file, topic = source or first.file, held.wheels.name
        merged = _with_gyro(path, held, file)
        if merged is not None:
            judged, first = _as_read(held, merged, source, first)
            if not judged.problem:
                return judged, first
        held = replace(held, beside=None)
        run = read_run(path, file, ticks_topic=topic, reference_topic=reference, reference=other)
    except InputError as error:
        at_fault = _at_fault(path, held, source, first)
        return replace(held, problem=str(error), at_fault=at_fault), first
    return _as_read(held, run, source, first)


def _as_read(
    held: Held, run: Run, source: RobotFile | None, first: FirstRobot
) -> tuple[Held, FirstRobot]:
    """What the run that was read tells, by a robot file with the width at which counters wrap."""
    first = first if source else with_wraps(first, run.ticks)
    return judged_stretches(replace(held, run=run), source, first), first


def _with_gyro(path: Path, held: Held, file: RobotFile) -> Run | None:
    """The run with others' positions and a gyro's headings; None if that is not to be had.

    A localiser's headings wander by more than most effects turn a robot in a metre. A gyro's do
    not, and the localiser frees them of their drift. It also tells a gyro that is dead, turned over
    or in other units: then the localiser is taken alone.
    """
    if held.beside is None or held.wheels is None:
        return None
    try:
        run = read_run(path, file, ticks_topic=held.wheels.name, reference_topic=tuple(held.topics))
    except InputError:
        return None
    seen = run.reference
    if seen is None or seen.gyro is None or seen.kind != "local_map":
        return None
    return None if max(abs(seen.gyro.scale - 1.0), seen.gyro.std) > SCALE_MOST else run


def _at_fault(
    path: Path, held: Held, source: RobotFile | None, first: FirstRobot
) -> Literal["", "wheels", "names"]:
    """Whether the wheels, or their joints' names in the robot file, are why a bag is unreadable."""
    if held.wheels is None:
        return ""
    try:
        file, topic = source or first.file, held.wheels.name
        read_run(path, file, ticks_topic=topic, reference_topic="none")
    except InputError:
        ours = (held.joints.left, held.joints.right)
        named = None if source is None else tuple(wheel_names(source, side) for side in SIDES)
        return "names" if all(ours) and named not in (None, ours) else "wheels"
    return ""


def _with_ticks(path: Path, wheels: Wheels, first: FirstRobot) -> FirstRobot:
    """Counts per turn from the steps of the joint angles, if visible."""
    if first.ticks is not None or wheels.gives != "positions" or not first.left:
        return first
    turn = 2.0 * math.pi
    run = read_run(
        path,
        replace(first, ticks=turn).file,
        ticks_topic=wheels.name,
        reference_topic="none",
    )
    if run.wheels_from != "positions":  # they stay at zero beside speeds
        return first
    angles = (run.ticks.left, run.ticks.right)
    return with_steps(first, [np.asarray(each, dtype=np.float64) for each in angles])


def _write(found: Info, out: Path, force: bool) -> Path:
    if found.given is not None:
        raise InputError(f"{found.given} is a robot file already; --out is for a first one")
    if not found.first.has_sizes:
        raise InputError(
            f"no robot file can be written: neither {DESCRIPTION} nor a parameter file says the "
            "wheels' radius and separation; measure both, or give the diff_drive_controller's "
            "parameters with --robot"
        )
    if out.exists() and not force:
        raise InputError(f"--out {out} exists; --force overwrites it, another --out keeps it")
    with replacing(out) as file:
        file.write(found.robot_text)
    return out
