# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The loop ends: what is advised is added, at once, and then nothing more is named."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from test.hidden.sets import HiddenSet, make, runs_of
from test.inference.driven import COMMON
from test.inference.driven import runs_of as driven
from test.inference.test_late_clock import later
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.effect import Effect, Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.adding.words import words_of as words_of_added
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


class Loop:
    """A diagnosis, what it advised added at once, and the diagnosis of the new robot file."""

    def __init__(
        self, robot: Robot, train: Sequence[Run], holdout: Sequence[Run], library: Sequence[Effect]
    ) -> None:
        self.drives, self.library = (train, holdout), library
        self.first = self.diagnosed(robot)
        effects = [find(name) for name in self.first.found]
        self.added: Added = add_effects(effects, train, robot, holdout=holdout)
        self.second = self.diagnosed(self.added.robot)

    def diagnosed(self, robot: Robot) -> Diagnosis:
        train, holdout = self.drives
        return diagnose(train, robot, self.library, holdout=holdout)


def hidden(seed: int, *effects: str) -> Loop:
    folder: Path = make(HiddenSet("loop", effects, seed, "short"))
    file = read_robot_file(folder / "robot.yaml")
    train, holdout = (
        [read_run(path, file) for path in runs_of(folder, part)] for part in ("train", "holdout")
    )
    return Loop(file.robot, train, holdout, LIBRARY)


@pytest.fixture(scope="module")
def wheel_and_clock() -> Loop:
    """The right wheel is 3 % larger, and the reference 60 ms late."""
    truth = replace(PLAIN, right_wheel_radius_multiplier=1.03)
    runs = [later(run, 0.06) for run in driven(truth, (1, 2, 3), seconds=60)]
    return Loop(PLAIN, runs[:2], runs[2:], (*COMMON[:3], find("reference_delay")))


def test_a_wrong_wheel_and_a_late_clock_come_to_rest_at_the_truth(wheel_and_clock: Loop) -> None:
    added = wheel_and_clock.added
    assert added.objections == {}
    robot = added.robot
    assert robot.wheel_separation_multiplier == 1.0  # as the file has it: nothing moved it
    assert robot.left_wheel_radius_multiplier == pytest.approx(1.0, abs=5e-4)
    assert robot.right_wheel_radius_multiplier == pytest.approx(1.03, abs=5e-4)
    assert added.parameters["reference_delay.delay"].value == pytest.approx(0.06, abs=5e-4)
    assert wheel_and_clock.second.verdict == "none"
    assert wheel_and_clock.second.found == ()


def test_a_wrong_wheel_is_told_as_one_thing_with_one_command(wheel_and_clock: Loop) -> None:
    advised = AdvisedDiagnosis(wheel_and_clock.first, None, ())
    words = " ".join(as_text(words_of(advised, NextSteps())).split())
    assert "Two things are missing" in words
    assert "the size of the right wheel (" in words
    assert re.search(r"right wheel (2\.99|3\.0)\S* ± \S+ % larger \(radius 51\.", words)
    names = ",".join(wheel_and_clock.first.found)
    assert len(wheel_and_clock.first.found) == 3
    assert f"werrimbi add {names} --robot" in words
    assert words.count("werrimbi add") == 1


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("seed", "effects"),
    [
        (4711, ("left_backlash=0.0024",)),
        (8, ("castor_kick=0.02", "lateral_slip=0.015")),
    ],
)
def test_what_is_found_is_added_and_nothing_more_is_named(
    seed: int, effects: tuple[str, ...]
) -> None:
    loop = hidden(seed, *effects)
    assert set(loop.first.found) == {name.partition("=")[0] for name in effects}
    assert loop.added.objections == {}
    assert loop.second.verdict == "none"


@pytest.mark.evidence
def test_what_does_not_earn_its_place_is_refused_by_name() -> None:
    truth = replace(PLAIN, effects=(find("lateral_slip").using(creep=0.02),))
    runs = driven(truth, (1, 2, 3), seconds=60)
    effects = [find("lateral_slip"), find("left_backlash")]
    found = add_effects(effects, runs[:2], PLAIN, holdout=runs[2:])
    assert set(found.objections) == {"left_backlash"}
    assert found.without["lateral_slip"] > 1.5 * found.holdout.sides.after
    assert found.without["left_backlash"] == pytest.approx(found.holdout.sides.after, rel=0.02)
    assert found.name == "lateral_slip,left_backlash"
    lines = [
        line.split()[0]
        for line in as_text(words_of_added(found)).split("Position error")[1].split("\n")[2:6]
    ]
    assert lines == ["held-out", "without", "without", "fitted"], "whose errors they are"
    assert set(found.parameters) == {"lateral_slip.creep", "left_backlash.travel"}


def test_mistakes_of_set_up_and_effects_are_added_together() -> None:
    swapped, slip = find("wheels_swapped"), find("lateral_slip")
    truth = replace(PLAIN, effects=(swapped.using(), slip.using(creep=0.02)))
    runs = driven(truth, (1, 2, 3), seconds=60)
    found = add_effects([swapped, slip], runs[:2], PLAIN, holdout=runs[2:])
    assert found.objections == {}
    assert found.chances["wheels_swapped"] is None
    assert found.chances["lateral_slip"] == pytest.approx(0.0, abs=1e-9)
    assert [item.name for item in found.robot.effects] == ["wheels_swapped", "lateral_slip"]
    assert found.parameters["lateral_slip.creep"].value == pytest.approx(0.02, abs=2e-3)


WITHOUT_SQUASH = [effect for effect in LIBRARY if effect.name != "tyre_squash"]
"""The laws below are near its own."""


def _law(form: int) -> Effect:
    """Tyres that give way, the faster the more."""

    @wheel_effect(softness=Parameter("", 0.0, 0.05, (-1.0, 1.0), "share of the radius lost"))
    def soft_tyres(travel: Any, drive: Any, softness: float) -> Any:
        """Tyres give way.

        Formula    travel *= 1 - softness * speed^form      [m]
        Signature  distances shrink at speed
        Ruler      drive a taped line slowly and fast
        """
        return WheelTravel(
            travel.left * (1.0 - softness * abs(drive.left_speed.end) ** form),
            travel.right * (1.0 - softness * abs(drive.right_speed.end) ** form),
        )

    return soft_tyres


@pytest.mark.evidence
def test_the_rest_of_a_law_that_the_file_holds_is_no_other_effect() -> None:
    truth = replace(PLAIN, effects=(_law(2).using(softness=0.2),))
    runs = driven(truth, (1, 2, 3), seconds=60)
    line = _law(1)
    robot = add_effects([line], runs[:2], PLAIN, holdout=runs[2:]).robot
    found = diagnose(runs[:2], robot, [*COMMON, line], holdout=runs[2:])
    assert found.verdict == "none"
    assert found.misfit is not None
    assert found.misfit.effect == "soft_tyres"
    assert "the law of soft_tyres does not fit fully" in " ".join(
        as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split()
    )


@pytest.mark.evidence
def test_another_effect_beside_a_law_that_the_file_holds_is_named() -> None:
    square = _law(2)
    truth = replace(
        PLAIN, effects=(square.using(softness=0.2), find("lateral_slip").using(creep=0.02))
    )
    runs = driven(truth, (1, 2, 3, 4, 5))
    robot = replace(PLAIN, effects=(square.using(softness=0.2),))
    found = diagnose(runs[:4], robot, [*WITHOUT_SQUASH, square], holdout=runs[4:])
    assert (found.verdict, found.effect) == ("named", "lateral_slip")
