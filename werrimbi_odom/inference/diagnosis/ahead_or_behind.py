# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the measured point may as well lie behind the axle's midpoint as ahead of it.

On one circle, or spinning, a point x ahead and one x behind go round the same ring. If positions
alone are measured, the heading at the start takes up the difference. The standard deviation of x is
that of either side.
"""

from __future__ import annotations

from dataclasses import replace

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted, fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.fitting.start_headings import (
    starts_unmeasured,
    turned_to_the_first_legs,
)
from werrimbi_odom.model.robot import Robot

ARM = "reference_lever_arm"


def ahead_or_behind(runs: Concatenated, fit: Fitted, given: Robot) -> bool:
    """Whether a fit from the other side costs no more than a rival does."""
    model = fit.point.model
    x = _ahead(model.robot)
    if x == 0.0 or f"{ARM}.x" in fit.held or not starts_unmeasured(model):
        return False
    effects = tuple(item.learnt(x=-x) if item.name == ARM else item for item in model.robot.effects)
    there = replace(fit.point, model=Model(replace(model.robot, effects=effects), model.own))
    start, _ = turned_to_the_first_legs(runs, there)
    other = fitted(runs, start, fit.names, fit.numbers, given)
    crossed = _ahead(other.point.model.robot) * x < 0.0
    return crossed and other.total < fit.total + rules.RIVAL * fit.scatter


def _ahead(robot: Robot) -> float:
    return next((float(item.values["x"]) for item in robot.effects if item.name == ARM), 0.0)
