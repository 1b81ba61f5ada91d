# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""An error of the place per radian is told by what it comes to where the robot turned."""

from __future__ import annotations

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_by, run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.diagnosis.evidence import Dependence, dependences
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.quarter_turns import Turning
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.report.diagnosis.dependence import strength_words


def cell_of(runs: list[Run], channel: str, variable: str) -> Dependence:
    """Of an error per radian."""
    laid = concatenated(match_for_fit(runs, ROBOT, 1.0))
    cells = dependences(laid, fit_calibration(laid, ROBOT).point, CALIBRATION)
    asked = channel, "turn", variable
    return next(c for c in cells if (c.channel, c.amount.per, c.variable.name) == asked)


def millimetres(said: str) -> list[float]:
    return [float(each) for each in re.findall(r"([\d.]+) mm", said)]


def test_a_point_beside_the_axle_is_told_by_what_a_quarter_turn_moves_it() -> None:
    """50 mm ahead: it goes sideways by as much for each radian."""
    runs = []
    for run in (run_of(ROBOT, seed) for seed in (1, 2)):
        seen = run.reference
        x, y = seen.x + 0.05 * np.cos(seen.yaw), seen.y + 0.05 * np.sin(seen.yaw)
        runs.append(replace(run, reference=replace(seen, x=x, y=y)))
    said = strength_words(cell_of(runs, "sideways", "constant"))
    assert said.endswith("over a quarter turn of these drives")
    assert millimetres(said) == [pytest.approx(50.0 * 0.5 * math.pi, rel=0.1)]


def test_of_one_that_goes_with_the_speed_it_is_how_turns_differ() -> None:
    """Rounds at 0.2 and 0.5 m/s, by a robot that creeps aside by 0.1 s times both its rates."""
    slip = AppliedEffect(find("lateral_slip"), {"creep": 0.1})
    speed = np.repeat([0.0, 0.2, 0.5, 0.2, 0.5, 0.0], [20, 300, 300, 300, 300, 20])
    rate = np.where(speed > 0.0, 2.0 * math.pi / 15.0, 0.0)
    run = run_by(replace(ROBOT, effects=(slip,)), speed, rate)
    said = strength_words(cell_of([run], "sideways", "speed"))
    assert said.startswith("±")
    assert millimetres(said)[0] == pytest.approx(100.0 * 0.15 * 0.5 * math.pi, rel=0.15)


def test_where_a_robot_only_wobbles_an_error_per_radian_comes_to_little() -> None:
    """889 mm each radian, where nothing turns by one to one side."""
    wobble = 2e-3 * (-1.0) ** np.arange(1000)
    turn = np.concatenate([wobble, np.full(100, 0.01 * math.pi)])
    turning = Turning(turn, np.zeros(1100, dtype=np.intp), ((0, 1100),))
    assert turning.quarters() == ((0, 1050), (1050, 1100))
    moved = turning.moved(np.where(np.arange(1100) < 1000, 0.889, 0.01))
    assert moved == pytest.approx([0.005 * math.pi, 0.005 * math.pi], abs=2e-3)


def test_no_quarter_turn_spans_a_gap() -> None:
    turn = np.full(100, 0.011 * math.pi)
    turning = Turning(turn, np.zeros(100, dtype=np.intp), ((0, 40), (50, 97)))
    assert turning.quarters() == ((50, 96),)
    assert replace(turning, stretches=((0, 40),)).quarters() == ((0, 40),), "all there is"


def test_an_error_of_the_whole_robot_as_it_turns_goes_with_nothing_of_one_wheel() -> None:
    """It went with "the speed of the wheel", of which the left one's alone was looked at."""
    laid = concatenated(match_for_fit([run_of(ROBOT, 1, 30)], ROBOT, 1.0))
    cells = dependences(laid, fit_calibration(laid, ROBOT).point, CALIBRATION)
    of_one = {(c.channel, c.amount.per) for c in cells if c.variable.name == "wheel_speed"}
    assert of_one == {
        ("left", "travel"),
        ("right", "travel"),
        ("along", "travel"),
        ("along", "path"),
    }
    of_turns = {(c.channel, c.amount.per) for c in cells if c.variable.name == "speed"}
    assert {("along", "turn"), ("sideways", "turn")} <= of_turns
