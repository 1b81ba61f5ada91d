# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Angles that may take any direction: half a turn is where they are cut, and no limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import ModelFit, fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, parameters_to_fit
from werrimbi_odom.inference.legs.cutting import match, match_for_fit
from werrimbi_odom.model.effect import AppliedEffect, Parameter
from werrimbi_odom.model.robot import Robot

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


def at_half_a_turn(run: Run, truth: AppliedEffect, begun: AppliedEffect, name: str) -> ModelFit:
    """The fit of a direction that begins on this side of half a turn, and is on the other."""
    robot = replace(ROBOT, effects=(begun,))
    runs = concatenated([match(run, robot, 0.25)])
    numbers = (*CALIBRATION, *parameters_to_fit(begun.effect, (name,)))
    fit = fit_model(runs, start_point(runs, robot), numbers)
    index = [number.name for number in fit.free].index(f"{begun.name}.{name}")
    std = float(np.sqrt(fit.covariance[index, index]))
    assert fit.robot.effects[0].values[name] == pytest.approx(truth.values[name], abs=4.0 * std)
    return fit


@pytest.mark.parametrize("begun", [3.06, -3.06])
def test_a_wheels_phase_goes_on_across_half_a_turn(begun: float) -> None:
    """Where a counter's zero lies says nothing of the wheel: 3.22 rad is -3.06 rad."""
    eccentric = find("eccentric_left_wheel")
    here, there = (eccentric.using(amplitude=1.2e-3, phase=angle) for angle in (begun, -begun))
    run = run_of(replace(ROBOT, effects=(there,)), 1)
    assert not at_half_a_turn(run, there, here, "phase").at_bound


@pytest.mark.parametrize("begun", [3.14, -3.14])
def test_a_marker_that_looks_backwards_may_be_askew_to_either_side(begun: float) -> None:
    askew = find("reference_yaw_offset")
    here, there = (askew.using(angle=angle) for angle in (begun, -begun))
    run = run_of(ROBOT, 1)
    assert run.reference is not None
    run = replace(run, reference=replace(run.reference, yaw=run.reference.yaw - begun))
    assert not at_half_a_turn(run, there, here, "angle").at_bound


def test_parts_agree_on_a_wave_as_well_wherever_the_counter_began() -> None:
    """Of a small one by chance in one case in 560, or in 3 billion: its phase counted as size."""
    eccentric = find("eccentric_left_wheel")
    truth = replace(PLAIN, effects=(eccentric.using(amplitude=3e-4, phase=0.0),))
    run = run_of(truth, 4, 60)
    chances = []
    for turned in (0, 400, 900, 1300):  # counts, of 2000 a turn
        ticks = replace(run.ticks, left=run.ticks.left + turned)
        runs = concatenated(match_for_fit([replace(run, ticks=ticks)], PLAIN, 1.0))
        (fit,) = search_round(runs, fit_calibration(runs, PLAIN), [eccentric], PLAIN).tried
        chances.append(homogeneity_of_effect(runs, fit, eccentric.name))
    assert chances == pytest.approx([chances[0]] * 4, rel=0.05)


@pytest.mark.parametrize(
    ("unit", "bounds", "is_one"),
    [
        ("rad", (-3.1415927, 3.1415927), True),
        ("rad", (0.0, 6.2832), True),
        ("rad", (-0.5, 0.5), False),
        ("rad", (0.0, 20.0), False),  # how far a wheel turns until its play is taken up
        ("m", (-3.1415927, 3.1415927), False),
    ],
)
def test_an_angle_is_a_direction_if_its_bounds_are_one(
    unit: str, bounds: tuple[float, float], is_one: bool
) -> None:
    item = Parameter(unit, null=0.0, typical=0.1, bounds=bounds, says="of something")
    assert item.is_direction == is_one
