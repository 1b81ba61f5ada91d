# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot file with what a run alone can tell: phases of its own, learnt from its reference."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Run
from werrimbi_odom.model.effect import AppliedEffect, view_of
from werrimbi_odom.model.phases import KNOWN_WELL_ENOUGH, Phase, learnable, phases_of_run


def with_learnt_phases(run: Run, robot_file: RobotFile) -> tuple[RobotFile, tuple[str, ...]]:
    """The robot file with the run's own phases, as far as its reference tells them; and remarks.

    Effects of which something stays unknown are left out of what is reckoned; the remarks say so.
    """
    learnt: dict[str, Phase] = {}
    if learnable(robot_file.robot) and run.reference is not None:
        view = view_of(robot_file.robot.effects)
        reference = run.reference
        found = phases_of_run(
            robot_file.robot,
            run.ticks.time,
            run.ticks.left,
            run.ticks.right,
            reference.time - view.delay - view.heading_delay,
            -reference.yaw if view.mirrored else reference.yaw,
            limits=robot_file.limits,
            channels=run.ticks.channels,
        )
        learnt = {phase.effect: phase for phase in found}
    effects = tuple(_completed(item, learnt.get(item.name)) for item in robot_file.effects)
    remarks = tuple(
        _told(item, learnt.get(item.name)) for item in robot_file.effects if item.unknown
    )
    return replace(robot_file, effects=effects), remarks


def _completed(applied: AppliedEffect, phase: Phase | None) -> AppliedEffect:
    if phase is None or phase.std > KNOWN_WELL_ENOUGH:
        return applied
    return applied.learnt(**{phase.parameter: phase.value})


def _told(applied: AppliedEffect, phase: Phase | None) -> str:
    if phase is not None and phase.std <= KNOWN_WELL_ENOUGH:
        return (
            f"{phase.effect}: {phase.parameter} {phase.value:.3f} ± {phase.std:.3f} rad, learnt "
            "from the reference of this run"
        )
    what = " and ".join(applied.unknown)
    if phase is None or not np.isfinite(phase.std):
        why = "and there is nothing in this run to learn it from"
    else:
        why = f"and the reference of this run tells it only to {phase.std:.2f} rad"
    return f"{applied.name} is left out: its {what} is another in each run, {why}"
