# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robots that skid as they turn, from the engine: four tyres in balance, no formula of the law."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from test.inference.driven import COMMON, parts, run_by, run_of
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter, weakest
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.told_sizes import sizes_among
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text
from werrimbi_odom.simulation import TrueRobot, free, record
from werrimbi_odom.simulation.hidden.skid import LENGTH, SkidSteer

HIDDEN = SkidSteer(1.7, 0.6, 0.45)
ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
FOUR_WHEELS = replace(ROBOT, wheels_a_side=2)
X, Y = 0.1 * LENGTH, 0.05 * 0.35 * 0.7


@cache
def drive(number: int, *, headings_alone: bool = False) -> Run:
    true = TrueRobot(left_wheel_noise=4e-4, right_wheel_noise=5.8e-4)
    found = record(true, free(25.0, seed=number, yaw_rate=1.0), seed=number, hidden=[HIDDEN])
    place = (found.reference_x_m, found.reference_y_m)
    if headings_alone:
        place = (0.0 * place[0] + float("nan"), 0.0 * place[1] + float("nan"))
    return Run(
        f"drive_{number}",
        Path(f"drive_{number}"),
        Ticks(found.t_s, found.left_ticks.astype(float), found.right_ticks.astype(float)),
        Reference(found.reference_t_s, *place, found.reference_yaw_rad),
    )


@cache
def diagnosed(robot: Robot, *, headings_alone: bool = False) -> Diagnosis:
    runs = [drive(number, headings_alone=headings_alone) for number in (1, 2, 3)]
    return diagnose(runs[:2], robot, (*COMMON, find("skid_steer")), holdout=runs[2:])


def said(diagnosis: Diagnosis) -> str:
    return " ".join(as_text(words_of(AdvisedDiagnosis(diagnosis, None, ()), NextSteps())).split())


def test_it_is_named_with_its_numbers_and_no_mistake_is_told() -> None:
    found = diagnosed(FOUR_WHEELS)
    assert (found.verdict, found.effect, found.found) == ("named", "skid_steer", ("skid_steer",))
    values = json_of(found, None)["found"][0]["parameters"]
    for name, true in (("multiplier", 1.7), ("x", X), ("y", Y)):
        assert abs(values[name]["value"] - true) < 4.0 * values[name]["std"]
    assert values["multiplier"]["std"] < 2e-3
    assert json_of(found, None)["set_up"] == []
    words = said(found)
    assert "set up wrongly" not in words
    assert "half the base" not in words
    assert "nothing is entered wrongly" in words


@pytest.mark.evidence
def test_a_gyro_tells_its_multiplier_and_nothing_of_its_point() -> None:
    found = diagnosed(FOUR_WHEELS, headings_alone=True)
    assert (found.verdict, found.found) == ("named", ("skid_steer",))
    values = json_of(found, None)["found"][0]["parameters"]
    assert abs(values["multiplier"]["value"] - 1.7) < 4.0 * values["multiplier"]["std"]
    # Whatever is found beside it: with the base held at what the set-up search found there is no ±.
    assert sizes_among(("reference_delay", "skid_steer"), found.final) == {"track_width"}
    assert "x is not determined by these drives" in said(found)
    assert "y is not determined by these drives" in said(found)


@pytest.mark.evidence
def test_by_another_name_a_base_is_no_surer() -> None:
    """A gyro's scale does what a base does, and on one circle the radii do."""
    truth = replace(ROBOT, wheel_separation_multiplier=1.04)
    skid = find("skid_steer").using(multiplier=1.5)
    held = replace(ROBOT, effects=(skid,), wheel_separation_multiplier=1.0 / 1.5)
    turned = [parts(run_of(truth, seed, 40), "yaw") for seed in (1, 2)]
    circle = [run_by(truth, np.full(600, 0.3), np.full(600, 0.6), seed) for seed in (1, 2)]
    for runs, robot, rivals in (
        (turned, ROBOT, {"track_width", "reference_scale"}),
        (turned, held, {"skid_steer", "reference_scale"}),
        (circle, held, {"skid_steer", "unequal_wheel_radii", "wheel_radius_scale"}),
    ):
        found = diagnose(runs, robot, COMMON[:3])
        assert found.verdict == "ambiguous"
        assert set(found.rivals) == rivals


def test_two_wheels_keep_the_base_and_hear_of_skidding() -> None:
    found = diagnosed(ROBOT)
    assert found.effect == "track_width"
    assert "skid_steer" not in found.found
    assert "left_wheel_names" in said(found)


def test_four_driven_wheels_have_no_castor() -> None:
    of_two, of_four = (
        {each.effect for each in diagnosed(robot).ranking} for robot in (ROBOT, FOUR_WHEELS)
    )
    assert "castor_kick" in of_two
    assert "castor_kick" not in of_four


@pytest.mark.evidence
def test_whoever_asks_for_it_gets_it_and_no_other_number_moves() -> None:
    runs = [drive(number) for number in (1, 2, 3)]
    added = add_effects([find("skid_steer")], runs[:2], ROBOT, holdout=runs[2:])
    assert not added.objections
    (applied,) = added.robot.effects
    assert applied.values == pytest.approx({"multiplier": 1.7, "x": X, "y": Y}, abs=2e-3)
    assert added.robot.wheel_separation_multiplier == 1.0


@pytest.mark.evidence
def test_a_file_that_holds_it_is_fitted_again_by_its_own_name() -> None:
    near = find("skid_steer").using(multiplier=1.6)
    runs = [drive(number) for number in (1, 2, 3)]
    added = add_effects(
        [find("skid_steer")], runs[:2], replace(FOUR_WHEELS, effects=(near,)), holdout=runs[2:]
    )
    assert added.robot.effects[0].values["multiplier"] == pytest.approx(1.7, abs=2e-3)
    assert added.robot.wheel_separation_multiplier == 1.0


def test_the_base_is_never_taken_out_of_it() -> None:
    """It is in every fit, so taking it out changes nothing: such a search never ended."""
    skid = find("skid_steer")

    def least(**values: float) -> str | None:
        items = skid.parameters
        found = {
            name: FittedParameter(items[name], value, 1e-3, "fitted")
            for name, value in values.items()
        }
        return weakest(skid, found, 2.5)

    assert least(multiplier=1.0, x=-0.1, y=-0.03) is None
    assert least(multiplier=1.0, x=-0.1, y=-0.001) == "y"
    assert least(multiplier=1.7, x=0.001) == "x"
    assert least(x=0.001) is None
