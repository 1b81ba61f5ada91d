# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A manoeuvre of the library as a given robot and reference would record it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.free_parameters import NUISANCES
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.inference.manoeuvres.expected_evidence import Experiment
from werrimbi_odom.inference.manoeuvres.ideal_drives import DrivingLimits, ideal_run, rates_of
from werrimbi_odom.inference.manoeuvres.library import Ideal


def measured_in(runs: Concatenated) -> tuple[bool, bool]:
    """Whether the reference measures positions, and headings."""
    return (
        any(bool(run.measured.has_position.any()) for run in runs.runs),
        any(bool(run.measured.has_yaw.any()) for run in runs.runs),
    )


def imagined(
    ideal: Ideal, runs: Concatenated, point: Point, pace: DrivingLimits, *, better: bool = False
) -> tuple[Experiment, float]:
    """Predict the record of a manoeuvre, and its duration in minutes.

    `ideal`: the manoeuvre. `runs`, `point`: recorded drives, and the model and noise fitted to
    them. `pace`: speeds of the robot. `better`: with a reference that measures positions and
    headings as well as motion capture does.
    """
    robot = point.model.robot
    ticks, poses = rates_of(runs)
    ranges = {
        name: (
            min(float(np.nanmin(run.counters.channels[name])) for run in runs.runs),
            max(float(np.nanmax(run.counters.channels[name])) for run in runs.runs),
        )
        for name in runs.channels
    }
    measures = measured_in(runs)
    variances, options = point.variances, point.options
    if better:
        poses = rules.MOTION_CAPTURE_INTERVAL
        measures = True, True
        variances = replace(
            variances,
            xy=np.array([rules.MOTION_CAPTURE_XY**2]),
            yaw=np.array([rules.MOTION_CAPTURE_YAW**2]),
        )
        options = replace(options, reference_kind="absolute")
    run = ideal_run(
        ideal, robot, pace, ticks=ticks, poses=poses, measures=measures, channels=ranges
    )
    leg = pace.size / rules.PARTS_OF_A_LEG
    laid = concatenated([match(run, robot, leg, None, rules.QUARTER_TURN / rules.PARTS_OF_A_LEG)])
    start = start_point(laid, robot, options)
    first = point.model.own[0]
    own = {name: value for name, value in first.items() if name not in NUISANCES}
    model = replace(start.model, own=({**own, **start.model.own[0]},))
    minutes = float(run.ticks.time[-1]) / 60.0
    return Experiment(laid, replace(start, model=model, variances=variances)), minutes
