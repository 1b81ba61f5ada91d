# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What effects declare of their twins is what is done about them, a user's own effect too."""

from __future__ import annotations

import argparse
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.command_line import Printed
from test.inference.driven import COMMON, run_by, runs_of
from test.inference.set_up_mistakes import mounted
from test.model.drives import ROBOT
from werrimbi_odom.cli import explain
from werrimbi_odom.effects import find, load_file
from werrimbi_odom.effects.contract import check_effect
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.rivals import possible_twins
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.manoeuvres.next_manoeuvre import for_twins, next_manoeuvre
from werrimbi_odom.inference.set_up.corrected_robot import mount_of
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.report.diagnosis.document import document_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.save import save_report
from werrimbi_odom.report.terminal import as_text

OWN = '''
import math

from werrimbi_odom.model.effect import Parameter, Sketch, Twin, body_effect
from werrimbi_odom.model.motion import BodyMotion


@body_effect(
    twins=(
        Twin(
            "reference_yaw_offset",
            told_apart_by="a mast that leans carries the marker aside, and a plumb line shows it",
            do="hang a plumb line from the mast's top",
            manoeuvre="plumb_line",
            values={"angle": ("lean", -1.0)},
        ),
    ),
    sketch=Sketch("sideways", "the mast leans", "the mast leans, and the robot seems to crab"),
    lean=Parameter("rad", 0.0, 0.01, (-0.3, 0.3), "how the mast leans"),
)
def leaning_mast(motion, drive, lean):
    """The mast leans, so the robot seems to crab.

    Formula    along, sideways are turned by lean             [m]
    Signature  a sideways error in proportion to distance
    Ruler      hang a plumb line from its top
    """
    cos, sin = math.cos(lean), math.sin(lean)
    return BodyMotion(
        cos * motion.along - sin * motion.sideways,
        sin * motion.along + cos * motion.sideways,
        motion.turn,
    )
'''


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("own") / "own.py"
    path.write_text(OWN, encoding="utf-8")
    return path


def test_a_users_effect_brings_its_twin_and_its_sketch(
    own: Path, tmp_path: Path, printed: Printed
) -> None:
    (mast,) = load_file(own)
    check_effect(mast)

    parser = argparse.ArgumentParser()
    explain.add_arguments(parser)
    assert explain.run(parser.parse_args(["leaning_mast", "--effects", str(own)])) == 0
    said = printed()
    assert "reference_yaw_offset (angle = -lean): a mast that leans carries" in said
    assert "So hang a plumb line from the mast's top" in said

    truth = replace(ROBOT, effects=(find("sideways_drift").using(angle=-0.02),))
    found = diagnose(runs_of(truth, (1, 2), 60), ROBOT, [*COMMON, mast])
    assert found.verdict == "ambiguous"
    assert set(found.rivals) == {"leaning_mast", "reference_yaw_offset"}
    proposed = next_manoeuvre(found)
    assert proposed is not None
    assert (proposed.name, proposed.do) == ("plumb_line", "hang a plumb line from the mast's top")

    advised = AdvisedDiagnosis(found, proposed, ())
    assert "are one and the same, on any drive" in " ".join(
        as_text(words_of(advised, NextSteps())).split()
    )
    page = tmp_path / "page.html"
    save_report(document_of(advised), page)
    shown = page.read_text(encoding="utf-8")
    assert "the mast leans, and the robot seems to crab</text>" in shown
    assert "hang a plumb line" in shown


@pytest.mark.parametrize("lidar", [True, False])
def test_a_lidar_or_a_marker_is_askew_rather_than_the_robots_axle(lidar: bool) -> None:
    """To any reference the two are one; of motion capture the axle led by a hair."""
    truth = replace(ROBOT, effects=(find("sideways_drift").using(angle=0.1),))
    effects = [find(name) for name in ("lateral_slip", "sideways_drift", "reference_yaw_offset")]
    runs = [
        replace(run, reference=replace(run.reference, own_axes=lidar))
        for run in runs_of(truth, (1,), 60)
        if run.reference is not None
    ]
    found = diagnose(runs, ROBOT, effects)
    assert found.verdict == "ambiguous"
    assert found.rivals == ("reference_yaw_offset", "sideways_drift")


@pytest.mark.evidence
def test_a_marker_ahead_is_no_axle_askew_beside_a_larger_wheel() -> None:
    """Lines alone, bent by one wheel: the marker goes askew of where it looks, and so may the axle.

    The axle led by 1e-4 of a squared deviation. What is found beside the first is put into the
    model, and there an axle bends the path that is published.
    """
    truth = replace(ROBOT, left_wheel_radius_multiplier=1.01)
    speed = 0.4 * np.clip(4.0 * np.sin(2.0 * np.pi * np.arange(1800) / 240.0), -1.0, 1.0)
    runs = []
    for seed in (1, 2):
        run = run_by(truth, speed, np.zeros(speed.size), seed)
        assert run.reference is not None
        runs.append(replace(run, reference=mounted(0.0, 0.08)(run.reference)))
    names = ("sideways_drift", "reference_yaw_offset", "reference_lever_arm")
    found = diagnose(runs, ROBOT, named(*names))
    assert found.verdict == "named"
    assert {*found.found} == {"wheel_radius_scale", "unequal_wheel_radii", "reference_yaw_offset"}
    assert "sideways_drift" in found.rivals_of_others["reference_yaw_offset"]


@pytest.mark.evidence
@pytest.mark.parametrize("ahead", [0.1, 0.3])
def test_twins_are_rivals_beside_what_is_missing_too(ahead: float) -> None:
    """A lidar where its transform says and askew, its place taken off in axes askew with it.

    Before the lever arm that this makes was fitted, an axle that is askew explained more by 13, and
    was named.
    """
    names = ("lateral_slip", "sideways_drift", "reference_yaw_offset", "reference_lever_arm")
    runs = []
    for run in runs_of(ROBOT, (1, 2), 60):
        seen = run.reference
        assert seen is not None
        place = seen.x + 1j * seen.y + (ahead + 0.02j) * np.exp(1j * seen.yaw)
        base = place - (ahead + 0.02j) * np.exp(1j * (seen.yaw + 0.05))
        askew = replace(seen, x=base.real, y=base.imag, yaw=seen.yaw + 0.05, own_axes=True)
        runs.append(replace(run, reference=askew))
    found = diagnose(runs, ROBOT, named(*names))
    assert found.verdict == "ambiguous"
    assert found.rivals == ("reference_yaw_offset", "sideways_drift")
    assert found.found == ("reference_yaw_offset", "reference_lever_arm")


def named(*names: str) -> list[Effect]:
    return [find(name) for name in names]


@pytest.mark.parametrize(
    ("rivals", "positions", "manoeuvre"),
    [
        (("sideways_drift", "reference_yaw_offset"), True, "remount_reference"),
        (("wheels_swapped", "reference_mirrored"), True, "turn_by_hand"),
        (("reference_mirrored", "wheels_swapped"), False, "turn_by_hand"),
        (("left_wheel_reversed", "right_wheel_reversed"), True, "push_by_hand"),
        (("reference_yaw_offset", "wheels_swapped", "left_wheel_reversed"), True, "push_by_hand"),
        (("track_width", "wheel_radius_scale"), False, "out_and_back"),
        (("track_width", "wheel_radius_scale"), True, None),
        (("sideways_drift", "reference_yaw_offset", "lateral_slip"), True, None),
        (("lateral_slip", "reference_lever_arm"), True, None),
    ],
)
def test_what_to_do_by_hand(
    rivals: tuple[str, ...], positions: bool, manoeuvre: str | None
) -> None:
    proposed = for_twins(named(*rivals), positions)
    assert (proposed.name if proposed else None) == manoeuvre


def test_pushing_says_what_to_look_at_for_each_counter() -> None:
    proposed = for_twins(named("left_wheel_reversed", "wheels_swapped"), True)
    assert proposed is not None
    assert "both counters must grow" in proposed.do
    assert "the left counter must run" in proposed.do


def test_no_axle_is_askew_by_a_quarter_turn() -> None:
    twins = ("sideways_drift", "wheels_swapped")
    for angle, possible in ((-0.2, twins), (0.5 * math.pi, ("wheels_swapped",))):
        finding = SetUpFinding("reference_yaw_offset", {"angle": angle}, None, "", twins)
        assert possible_twins(finding) == possible


def test_to_the_reference_a_crab_is_a_mount_askew() -> None:
    crab = find("sideways_drift").using(angle=0.1)
    mount = find("reference_yaw_offset").using(angle=0.3)
    assert mount_of(replace(ROBOT, effects=(crab, mount))).yaw == pytest.approx(0.2)
    assert mount_of(ROBOT).yaw == 0.0
