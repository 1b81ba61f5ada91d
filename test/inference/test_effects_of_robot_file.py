# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A wrong value of an effect that the robot file holds is told, and the command that mends it."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from test.inference.driven import runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.effects_of_robot_file import needless_of_held, outdated
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.events.common_cause import Alike
from werrimbi_odom.inference.events.events import Events
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text

SLIP = find("lateral_slip")
SOME = [find(name) for name in ("reference_delay", "left_missed_ticks")]


def holding(creep: float, angle: float = 0.02) -> Robot:
    crabbing = find("sideways_drift").using(angle=angle)
    return replace(ROBOT, effects=(SLIP.using(creep=creep), crabbing))


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return runs_of(holding(0.04), [1, 2, 3], 60)


def diagnosed(runs: list[Run], robot: Robot) -> Diagnosis:
    return diagnose(runs[:2], robot, SOME, holdout=runs[2:])


def words(found: Diagnosis) -> str:
    return " ".join(as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split())


def test_a_wrong_value_is_told_and_mended_by_the_printed_command(runs: list[Run]) -> None:
    """The model was said to explain the drives to their noise: with that value fitted anew."""
    found = diagnosed(runs, holding(0.02))
    assert (found.verdict, found.outdated) == ("none", ("lateral_slip",))
    said = words(found)
    assert "values of effects in the robot file are off" in said
    assert "where the robot file has creep 20 ms" in said
    assert "werrimbi add lateral_slip" in said
    assert "to their noise" not in said
    assert "nothing to add" not in said
    (told,) = json_of(found, None)["outdated"]
    assert told["parameters"]["creep"]["value"] == pytest.approx(0.04, abs=3e-3)
    mended = add_effects([SLIP], runs[:2], holding(0.02), holdout=runs[2:]).robot
    assert diagnosed(runs, mended).outdated == ()


def test_a_value_that_is_known_better_now_is_not_off(runs: list[Run]) -> None:
    """Just written by `add`, and told to be off: from 1.5 mm to 1.5 mm."""
    near = holding(0.04, 0.0192)
    found = diagnosed(runs, near)
    assert outdated(found.final, near) == ("sideways_drift",), "significantly"
    assert found.holdout.after > 0.99 * found.holdout.before
    assert found.outdated == ()
    assert "nothing to add" in words(found)
    assert replace(found.holdout, before=math.nan, after=math.nan).fell_much, "no legs to tell"


def test_right_values_and_those_within_their_noise_are_left_alone(runs: list[Run]) -> None:
    for robot in (holding(0.04), holding(0.0402, 0.0201)):
        found = diagnosed(runs, robot)
        assert (found.verdict, found.outdated) == ("none", ())
        assert "to their noise" in words(found)


def test_errors_that_are_told_are_those_of_the_file(runs: list[Run]) -> None:
    """As `compare` prints for the same file and drives: not with values fitted anew."""
    found = diagnosed(runs, holding(0.0402, 0.0201))
    told = replace(found, holdout=replace(found.holdout, before=0.0123))
    assert "Its errors on the drives held out (legs of 1 m) are 12.3 mm" in " ".join(
        as_text(words_of(AdvisedDiagnosis(told, None, (), held_out=True), NextSteps())).split()
    )


def test_drives_held_out_that_err_far_more_are_to_be_fitted_too(runs: list[Run]) -> None:
    """A slippery spot that one of seven drives touched: "there is nothing to add", beside 10 mm."""
    found = diagnosed(runs, holding(0.04))
    for held_out, times, said in ((True, 3.0, True), (True, 1.5, False), (False, 3.0, False)):
        unlike = replace(found.holdout, before=times * found.train.before)
        told = AdvisedDiagnosis(replace(found, holdout=unlike), None, (), held_out=held_out)
        words_told = " ".join(as_text(words_of(told, NextSteps())).split())
        assert ("Next: fit some of the drives held out too" in words_told) is said
        assert ("nothing to add" in words_told) is not said
        assert ("so they are not noise alone" in words_told) is (times > 2.0)


def test_events_that_come_with_starts_are_no_noise(runs: list[Run]) -> None:
    """The model was said to explain the drives, and, below, to lack a law."""
    alike = Alike("start or stop", 8, 8, (math.nan, math.nan), 1e-6, of_reference=False)
    found = diagnosed(runs, holding(0.04))
    assert "noise" not in words(replace(found, happened=Events(alike=alike))).partition("Next")[0]


def test_what_stood_in_for_another_law_is_said_to_be_needless(runs: list[Run]) -> None:
    """Three effects that were never there: six rivals of each were told, and not that of none."""
    stale = find("load_transfer").using(lateral=0.03, longitudinal=0.0)
    robot = replace(holding(0.04), effects=(*holding(0.04).effects, stale))
    fit = fit_calibration(laid := concatenated(match_for_fit(runs, robot, 1.0)), robot)
    asked = ("lateral_slip", "sideways_drift", "load_transfer")
    assert needless_of_held(laid, fit, asked, robot) == ("load_transfer",)
