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

from werrimbi_odom.api.result import Result
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Bag, opened_bag
from werrimbi_odom.files.bag_contents import contents_of
from werrimbi_odom.files.bag_joints import wheel_names
from werrimbi_odom.files.bag_reference import LOCALISED
from werrimbi_odom.files.bag_ticks import KINDS
from werrimbi_odom.files.bag_wheels import Wheels
from werrimbi_odom.files.compared_ways import words_about_ways
from werrimbi_odom.files.controller_wheels import of_controller
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.first_robot import FirstRobot, with_driver, with_steps, with_wraps
from werrimbi_odom.files.gyro_headings import as_of_a_gyro
from werrimbi_odom.files.measured_topic import Measured, preference
from werrimbi_odom.files.merged_reference import SCALE_MOST
from werrimbi_odom.files.mislabelled_columns import without_zeros
from werrimbi_odom.files.read_run import bag_at, read_run
from werrimbi_odom.files.recordings import reference_of_each
from werrimbi_odom.files.reference_choice import NONE
from werrimbi_odom.files.robot_file import RobotFile, read_robot_file, robot_file_of_text
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.run_checks import refuse_unjudgeable, without_held_poses
from werrimbi_odom.files.run_folder import REFERENCE
from werrimbi_odom.files.stamps import stamps_of
from werrimbi_odom.files.text_files import replacing
from werrimbi_odom.files.urdf_wheels import of_urdf
from werrimbi_odom.files.wheel_joints import (
    SIDES,
    chosen_wheels,
    joints_told_apart,
    of_another_robot,
)
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.made_from_wheels import require_independent
from werrimbi_odom.inference.legs.aligned_run import record_of, unmeasured
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.held_or_carried import with_no_driving
from werrimbi_odom.inference.legs.motion_states import driven
from werrimbi_odom.inference.recording_info import Held, Info
from werrimbi_odom.inference.set_up.corrected_robot import with_findings
from werrimbi_odom.inference.set_up.search import knows_left, mistakes_without_sizes
from werrimbi_odom.report.info import document_of, info_json

DESCRIPTION = "/robot_description"


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
    separate = None if other is None else _separate(other, source, reference_topic)
    if bag is None:
        topic = separate.name if separate is not None else None
        if source is None:
            first = replace(first, counted=True)
        file = source or robot_file_of(first)
        run = read_run(path, file, reference=other, reference_topic=topic)
        held = Held(path, None, None, separate, {}, None, "", other=other)
        return _as_read(held, run, source, first)
    held, first = _of_bag(path, bag, source, first, ticks_topic, reference_topic)
    if other is not None:
        held = replace(held, reference=separate, beside=None, other=other)
    try:
        if held.wheels is None:
            raise InputError("nothing in it tells how the wheels turned")
        own = NONE if other is None else None
        reference = reference_topic or (held.reference.name if held.reference else own)
        if source is None:
            first = _with_ticks(path, held.wheels, first)
        file, topic = source or robot_file_of(first), held.wheels.name
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
    return _judged(replace(held, run=run), source, first), first


def _with_gyro(path: Path, held: Held, file: RobotFile) -> Run | None:
    """The run with a localiser's positions and a gyro's headings; None if that is not to be had.

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
        file, topic = source or robot_file_of(first), held.wheels.name
        read_run(path, file, ticks_topic=topic, reference_topic="none")
    except InputError:
        ours = (held.joints.left, held.joints.right)
        named = None if source is None else tuple(wheel_names(source, side) for side in SIDES)
        return "names" if all(ours) and named not in (None, ours) else "wheels"
    return ""


def _of_bag(
    path: Path,
    bag: Path,
    source: RobotFile | None,
    first: FirstRobot,
    ticks_topic: str | None,
    reference_topic: str | None,
) -> tuple[Held, FirstRobot]:
    """Contents of a bag, and what it says about the robot."""
    with opened_bag(bag) as opened:
        base = "" if source is None else str(source.values["base_frame_id"])
        contents = contents_of(opened, base, wished=[reference_topic or ""])
        wheels, joints = chosen_wheels(opened, contents, ticks_topic, source)
        if source is None and not first.has_sizes:
            first = of_urdf(_description(opened, wheels), tuple(joints.turned or ()))
        if source is None and wheels:
            first = with_driver(replace(first, counted=wheels.gives == "counts"), wheels.kind)
            if first.counted and not wheels.places:
                named = (name for name, kind in KINDS.items() if kind == wheels.kind)
                first = replace(first, input_type=next(named, ""))
        if source is None and joints.turned:
            known = (first.left, first.right)
            joints = joints_told_apart(tuple(joints.turned), joints.turned, known)
            told = dict(first.told or {})
            if (joints.left, joints.right) != known and "joints" in told:
                told["joints"] = "the bag's joints, by their names"
            first = replace(first, left=joints.left, right=joints.right, told=told)
        others = of_another_robot(contents, wheels) if reference_topic is None else set()
        if wheels is not None:  # odometry that is asked for as the wheels measures nothing more
            others = {*others, wheels.name}
        ours = [each for each in contents.references if each.name not in others]
        reference = _best(ours, reference_topic)
        beside = None if reference_topic else _gyro(ours, reference)
        listed = [wheels, *contents.references]
        topics = {name for each in listed if each for name in _topics(each)}
        stamps = stamps_of(opened, sorted(topics))
    held = Held(path, contents, wheels, reference, stamps, None, "", joints, beside=beside)
    return held, first


def _description(bag: Bag, wheels: Wheels | None) -> str:
    """The URDF of the namespace of the wheels, or else the first one; "" without one."""
    spaces = [
        each.name.removesuffix(DESCRIPTION)
        for each in bag.topics
        if each.name.endswith(DESCRIPTION)
    ]
    ours = "" if wheels is None else wheels.name
    spaces.sort(key=lambda space: (not ours.startswith(f"{space}/"), -len(space)))
    named = [f"{space}{DESCRIPTION}" for space in spaces]
    found = bag.firsts(named[:1])
    return next((getattr(each, "data", "") for each in found.values()), "")


def _separate(other: Path, source: RobotFile | None, wish: str | None) -> Measured | None:
    """The reference in a recording of its own; None for a folder with reference.csv."""
    bag = bag_at(other, REFERENCE)
    if bag is None:
        return None
    base = "" if source is None else str(source.values["base_frame_id"])
    with opened_bag(bag) as opened:
        return _best(contents_of(opened, base, wished=[wish or ""]).references, wish)


def _topics(each: Wheels | Measured) -> list[str]:
    return [name.partition(":")[0] for name in each.name.split(",")]


def _best(references: Sequence[Measured], wish: str | None) -> Measured | None:
    """The requested reference, or the independent one that measures most."""
    if wish is not None:
        return next((each for each in references if each.name == wish), None)
    usable = [each for each in references if each.independent and each.messages >= rules.FEW_POSES]
    usable = usable or [each for each in references if each.independent]
    return min(usable, key=preference, default=None)


def _gyro(references: Sequence[Measured], reference: Measured | None) -> Measured | None:
    """A gyro that may give the headings beside the poses of a localiser."""
    if reference is None or reference.measures != "poses":
        return None
    if reference.chain is None and reference.kind != LOCALISED:  # motion capture, scans
        return None
    return _best([each for each in references if each.measures == "yaw"], None)


def _with_ticks(path: Path, wheels: Wheels, first: FirstRobot) -> FirstRobot:
    """Counts per turn from the steps of the joint angles, if visible."""
    if first.ticks is not None or wheels.gives != "positions" or not first.left:
        return first
    turn = 2.0 * math.pi
    run = read_run(
        path,
        robot_file_of(replace(first, ticks=turn)),
        ticks_topic=wheels.name,
        reference_topic="none",
    )
    if run.wheels_from != "positions":  # they stay at zero beside speeds
        return first
    angles = (run.ticks.left, run.ticks.right)
    return with_steps(first, [np.asarray(each, dtype=np.float64) for each in angles])


def robot_file_of(first: FirstRobot) -> RobotFile:
    """A robot file from the known values, with placeholders for unknown sizes."""
    return robot_file_of_text(first.text("what is known"), Path("robot.yaml"))


def _judged(held: Held, source: RobotFile | None, first: FirstRobot) -> Held:
    """When the robot stood, drove, was held and carried, and what will be excluded."""
    assert held.run is not None
    (recorded,) = as_of_a_gyro([without_zeros(held.run)])
    robot_file = source or robot_file_of(first)
    robot, limits = robot_file.robot, robot_file.limits
    try:
        if recorded.reference is not None:
            refuse_unjudgeable(recorded, robot)
            if source is not None or first.tells_distances:
                if words := words_about_ways(recorded, robot):
                    return replace(held, problem=f"{recorded.path}: {words}")
                require_independent(recorded, robot, limits)
            if recorded.reference.kind != "incremental":  # as where drives are judged
                recorded = without_held_poses(recorded, robot)
        run = with_no_driving(recorded, robot, limits)
        counters = counters_of(run, robot, limits)
        how = EvaluationOptions(limits=limits)
        mistakes = mistakes_without_sizes(run, robot, how)
        without_names = held.wheels is not None and held.wheels.of_array
        confirmed = without_names and not mistakes and knows_left(run, robot, how)
        wired, _ = with_findings(robot, mistakes, None)
        found = driven(counters, wired, run.no_driving or ())
        record = record_of(run, robot, limits) if run.reference is not None else None
    except InputError as error:
        return replace(held, problem=str(error))
    seen = None
    if record is not None:
        seen = driven(counters, wired, run.no_driving or (), unmeasured(record))
    scans = bias = 0.0
    if recorded.reference is not None and run.reference is not None:
        given, used = recorded.reference, run.reference
        scans = float(np.std(used.time - given.time))
        last = int(np.flatnonzero(used.has_yaw)[-1]) if used.has_yaw.any() else 0
        if last:
            bias = float(given.yaw[last] - used.yaw[last]) / float(np.ptp(used.time[: last + 1]))
    return replace(
        held,
        run=run,
        mistakes=mistakes,
        confirmed=confirmed,
        driven=found,
        seen=seen,
        left_out=() if record is None else record.left_out,
        restamped=counters.restamped,
        scans_restamped=scans,
        gyro_bias=bias,
    )


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
