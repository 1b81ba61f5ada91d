# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""When the robot of a recording stood, drove, was held and carried, for `info`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.references.gyro_headings import as_of_a_gyro
from werrimbi_odom.files.references.held_poses import without_held_poses
from werrimbi_odom.files.robot_descriptions.first_robot import FirstRobot
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run_checks import refuse_unjudgeable
from werrimbi_odom.files.tables.compared_ways import words_about_ways
from werrimbi_odom.files.tables.mislabelled_columns import without_zeros
from werrimbi_odom.inference.comparison.made_from_wheels import require_independent
from werrimbi_odom.inference.comparison.speeds_at_rest import speeds_at_rest
from werrimbi_odom.inference.legs.aligned_run import record_of, unmeasured
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.motion_states import driven
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.recording_info import Held
from werrimbi_odom.inference.set_up.corrected_robot import with_findings
from werrimbi_odom.inference.set_up.search import knows_left, mistakes_without_sizes


def judged_stretches(held: Held, source: RobotFile | None, first: FirstRobot) -> Held:
    """When the robot stood, drove, was held and carried, and what will be excluded."""
    assert held.run is not None
    (recorded,) = as_of_a_gyro([without_zeros(held.run)])
    robot_file, sizes = source or first.file, source is not None or first.tells_distances
    robot, limits = robot_file.robot, robot_file.limits
    try:
        if recorded.reference is not None:
            refuse_unjudgeable(recorded, robot)
            if sizes:
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
        measured = run.reference is not None
        record = record_of(run, robot, limits, sizes=sizes) if measured else None
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
        rare=counters.interval if counters.are_rare else 0.0,
        scans_restamped=scans,
        gyro_bias=bias,
        at_rest=speeds_at_rest([run], [counters], wired) if sizes else None,
    )
