# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two poses a drive: what they cannot tell is said, before and after an effect is added."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, run_of, swapped
from test.inference.set_up_mistakes import without_yaw
from test.model.drives import ROBOT as STEERED
from test.model.drives import read
from test.white_noise_robot import WhiteNoiseRobot, drive, square, wandering
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.p_values import chance
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.set_up.search import look_for_mistakes
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.adding.as_json import json_of as json_of_added
from werrimbi_odom.report.adding.words import words_of as words_of_added
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.tables import tables_of
from werrimbi_odom.report.diagnosis.words import words_of
from werrimbi_odom.report.terminal import as_text

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
KICKING = find("castor_kick").using(angle=0.0, alternating=0.008, length=0.04)
SOME = [find(name) for name in ("castor_kick", "left_backlash", "right_backlash", "encoder_skew")]


@pytest.mark.parametrize("seed", [2, in_evidence(5)])
def test_of_few_data_the_noise_itself_is_hardly_known(seed: int) -> None:
    """Twenty numbers that scatter ten times as stated tell by how much to a fifth, and no better.

    As if it were known, an effect that is none was beyond chance in two drives of twenty-four.
    """
    random = np.random.default_rng(seed)
    robot = WhiteNoiseRobot()
    run = drive(robot, wandering(random, 16.0), random, sigma_xy=0.01, sigma_yaw=0.02, every=100)
    laid = concatenated(match_for_fit([run], robot.entered(0.05), 1.0, None))
    stated = EvaluationOptions(sigma_xy=1e-3, sigma_yaw=2e-3)
    before = fit_calibration(laid, robot.entered(0.05), stated)
    this = search_round(laid, before, LIBRARY, robot.entered(0.05))
    within = [fit for fit in this.tried if not fit.at_bound]
    assert within
    assert min(chance(fit, before, this.number) for fit in within) > rules.SURE


def by_tape(run: Run) -> Run:
    """The first pose and the last."""
    assert run.reference is not None
    ends = np.array([0, run.reference.time.size - 1])
    return replace(run, reference=replace(run.reference.chosen(ends)))


@pytest.mark.evidence
@pytest.mark.parametrize(("base", "side"), [(0.9, 1.0), (0.97, 2.0), (1.03, 2.0), (1.15, 1.0)])
def test_squares_that_close_give_the_base_that_closes_them_and_no_multiple_of_it(
    base: float, side: float
) -> None:
    """Smaller wheels end less far off: radii and base went to a third, or to four times.

    Then the radii were found to be undetermined and put back, and the base stayed there.
    """
    robot = WhiteNoiseRobot(0.3 * base, 0.05, 0.05, 5e-4, 5e-4)
    random = np.random.default_rng(1)
    senses = np.repeat([1.0, -1.0], 4)
    runs = [by_tape(drive(robot, square(side, sense), random)) for sense in senses]
    entered = replace(robot.entered(0.05), wheel_separation=0.3)
    assert not look_for_mistakes(runs, entered).findings, "wheels of 0.05 mm close a square too"
    laid = concatenated(match_for_fit(runs, entered, 1.0, None))
    found = fit_calibration(laid, entered, EvaluationOptions()).point.model.robot
    assert found.wheel_separation_multiplier == pytest.approx(base, abs=5e-3)
    assert found.left_wheel_radius_multiplier == pytest.approx(1.0, abs=1e-2)


def test_a_base_by_squares_that_close_may_be_the_wheels() -> None:
    random = np.random.default_rng(2)
    robot = WhiteNoiseRobot(0.3 * 1.03, 0.05, 0.05, 5e-4, 5e-4)
    senses = np.repeat([1.0, -1.0], 5)
    runs = [by_tape(drive(robot, square(2.0, sense), random)) for sense in senses]
    entered = replace(robot.entered(0.05), wheel_separation=0.3)
    said = diagnose(runs, entered, SOME)
    assert said.found == ("track_width",)
    words = " ".join(as_text(words_of(AdvisedDiagnosis(said, None, ()), NextSteps())).split())
    assert "wheels that are both 2.9 % smaller than entered look the same to them" in words


@pytest.mark.evidence
@pytest.mark.parametrize(
    ("entered", "told"),
    [
        ({"wheel_radius": 0.1}, ("wheel_radius_scale",)),
        ({"wheel_separation": 0.15}, ("track_width",)),
        ({}, ()),
    ],
)
def test_how_far_drives_ended_from_their_start_tells_sizes_far_off_and_no_wiring(
    entered: dict[str, float], told: tuple[str, ...]
) -> None:
    """Exchanged wheels end as far away: so six wirings fit alike, and no size was told either."""
    robot, random = WhiteNoiseRobot(0.3, 0.05, 0.05, 5e-4, 5e-4), np.random.default_rng(3)
    runs = [by_tape(drive(robot, wandering(random, 20.0), random)) for _ in range(12)]
    blind = [without_yaw(run) for run in runs]
    file = replace(Robot(0.3, 0.05, 2000.0, 2000.0), **entered)  # type: ignore[arg-type]
    found = look_for_mistakes(blind, file).findings
    assert tuple(each.effect for each in found) == told
    crossed = [swapped(run) for run in blind]
    assert tuple(each.effect for each in look_for_mistakes(crossed, file).findings) == told


@pytest.mark.evidence
def test_one_drive_that_ended_anywhere_makes_no_wiring_likelier() -> None:
    """Its tyres slipped: of seven drives by tape it alone spoke for exchanged wheels."""
    robot, random = WhiteNoiseRobot(0.35, 0.05, 0.05, 5e-4, 5e-4), np.random.default_rng(204)
    runs = [
        by_tape(drive(robot, square(1.0, sense), random)) for sense in (1.0, -1.0, 1.0, -1.0, 1.0)
    ]
    sound, slipped = (by_tape(drive(robot, wandering(random, 40.0), random)) for _ in range(2))
    seen = slipped.reference
    assert seen is not None
    x, y, yaw = (np.array([0.0, random.uniform(-far, far)]) for far in (4.0, 4.0, 3.0))
    slipped = replace(slipped, reference=replace(seen, x=x, y=y, yaw=yaw))
    assert not look_for_mistakes([*runs, sound, slipped], robot.entered(0.05)).findings


def test_the_last_pose_may_come_after_the_last_count() -> None:
    """Of coarse counters; it ended in an IndexError."""
    random = np.random.default_rng(5)
    robot = WhiteNoiseRobot(ticks_per_revolution=60.0)
    run = by_tape(drive(robot, wandering(random, 20.0), random))
    seen = run.reference
    assert seen is not None
    late = replace(run, reference=replace(seen, time=seen.time + np.array([0.0, 0.1])))
    laid = concatenated(match_for_fit([late], robot.entered(0.05), 1.0, None))
    assert np.isfinite(laid.drive(robot.entered(0.05)).speed.end).all()


def to_and_fro(seed: int) -> Run:
    """Along a line, forwards and backwards, one to six times; a pose before and one after."""
    random, rate = np.random.default_rng(seed), 20
    speed = np.concatenate([np.full(4 * rate, 0.3 * (-1.0) ** leg) for leg in range(2 + seed % 6)])
    speed = np.convolve(speed, np.ones(8) / 8.0, "same")
    truth = replace(PLAIN, effects=(KICKING,))
    ticks = read(PLAIN, float(rate), speed, np.zeros(speed.size))
    path = trajectory(truth, *ticks)
    ends = [0, path.x.size - 1]
    noise = random.normal(0.0, 1.0, (3, 2)) * [[1e-3], [1e-3], [2e-3]]
    seen = Reference(
        path.time[ends], path.x[ends] + noise[0], path.y[ends] + noise[1], path.yaw[ends] + noise[2]
    )
    record = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float), {})
    return Run(f"line_{seed}", Path(f"line_{seed}"), record, seen)


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return [to_and_fro(seed) for seed in range(9)]


def diagnosed(runs: list[Run], robot: Robot) -> Diagnosis:
    return diagnose(runs[:7], robot, SOME, holdout=runs[7:])


@pytest.fixture(scope="module")
def first(runs: list[Run]) -> Diagnosis:
    return diagnosed(runs, PLAIN)


@pytest.fixture(scope="module")
def kick(runs: list[Run]) -> Added:
    return add_effects([find("castor_kick")], runs[:7], PLAIN, holdout=runs[7:])


def test_of_four_drives_by_tape_nothing_is_beyond_chance(runs: list[Run]) -> None:
    """Three legs were fitted: a wave over a wheel's angle was "beyond any chance"."""
    random = np.random.default_rng(4)
    taped = []
    for run in runs[:4]:
        seen = run.reference
        assert seen is not None
        x, y, yaw = (part + random.normal(0.0, 0.05, 2) for part in (seen.x, seen.y, seen.yaw))
        taped.append(replace(run, reference=replace(seen, x=x, y=y, yaw=yaw)))
    with pytest.raises(InputError, match="have 3 legs to fit, and 6 are the least"):
        diagnose(taped, PLAIN, LIBRARY)


@pytest.mark.evidence
def test_a_length_that_they_do_not_hold_is_no_number(first: Diagnosis, kick: Added) -> None:
    """It was printed and written as 0.15 m ± 1e+06 m."""
    found = replace(first, found=("castor_kick",), rivals=())
    assert "castor_kick.length not determined" in " ".join(as_text(tables_of(found)).split())
    parameters = json_of(found, None)["found"][0]["parameters"]
    assert parameters["length"]["value"] is parameters["length"]["std"] is None
    assert kick.parameters["length"].value is None
    assert kick.robot.effects[0].values["length"] == find("castor_kick").nulls["length"]
    assert "length = not determined by these drives, left at 40 mm" in as_text(words_of_added(kick))
    figures = json_of_added(kick)["parameters"]["length"]
    assert figures["value"] is figures["std"] is None


@pytest.mark.evidence
def test_rivals_are_not_forgotten_when_one_of_them_is_added(
    runs: list[Run], first: Diagnosis
) -> None:
    assert first.verdict == "ambiguous"
    added = add_effects([find(first.rivals[0])], runs[:7], PLAIN, holdout=runs[7:])
    later = diagnosed(runs, added.robot)
    assert later.verdict == "none"
    others = later.rivals_of_held[first.rivals[0]]
    assert set(first.rivals[1:]) <= set(others)
    words = " ".join(as_text(words_of(AdvisedDiagnosis(later, None, ()), NextSteps())).split())
    held = f"that it is {first.rivals[0]}, which the robot file holds, these drives do not show"
    assert held in words
    assert all(name in words for name in others)
    assert json_of(later, None)["rivals_of_held"] == {first.rivals[0]: list(others)}


@pytest.mark.evidence
def test_what_is_found_beside_another_thing_has_its_rivals_too(
    runs: list[Run], first: Diagnosis
) -> None:
    """By a gyro whose scale was the first finding, counters read late were certain for play."""
    small = replace(PLAIN, left_wheel_radius_multiplier=0.9, right_wheel_radius_multiplier=0.9)
    found = diagnosed(runs, small)
    assert found.found[0] == "wheel_radius_scale"
    (beside,) = set(found.found) & set(first.rivals)
    # In the first diagnosis the kick's length ends at its bound.
    assert {*first.rivals, "castor_kick"} == {beside, *found.rivals_of_others[beside]}
    said = json_of(found, None)
    assert said["rivals_of_others"] == {beside: list(found.rivals_of_others[beside])}
    words = " ".join(as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())).split())
    assert "These drives cannot tell it from" in words


def test_drives_that_tell_have_no_rivals_to_recall() -> None:
    robot = replace(PLAIN, effects=(KICKING,))
    runs = [run_of(robot, seed, 40) for seed in range(4)]
    found = diagnose(runs[:3], robot, SOME, holdout=runs[3:])
    assert found.verdict == "none"
    assert found.rivals_of_held == {}


@pytest.mark.parametrize(
    ("seed", "effects"),
    [(2, COMMON), *(in_evidence(n, LIBRARY) for n in (1, 2))],
)
def test_whatever_a_reference_says_no_number_is_beyond_sense(
    seed: int, effects: Sequence[Effect]
) -> None:
    """Poses by chance: what is printed of them stays within what the parameters allow."""
    random = np.random.default_rng(seed)
    runs = []
    for number in range(9):
        run = by_tape(run_of(PLAIN, 10 * seed + number, 20))
        assert run.reference is not None
        x, y = random.uniform(-2.0, 2.0, (2, 2))
        seen = replace(run.reference, x=x, y=y, yaw=random.uniform(-3.0, 3.0, 2))
        runs.append(replace(run, reference=seen))
    found = diagnose(runs[:8], PLAIN, effects, holdout=runs[8:])
    said = as_text(words_of(AdvisedDiagnosis(found, None, ()), NextSteps())) + as_text(
        tables_of(found)
    )
    assert "nan" not in said.lower()
    assert not re.search(r"± \d(\.\d+)?e\+", said)
    for item in json_of(found, None)["found"]:
        for parameter, value in item["parameters"].items():
            low, high = find(item["effect"]).parameters[parameter].bounds
            assert value["std"] is None or not value["std"] > high - low


def test_of_a_drive_seen_only_at_its_end_the_last_poses_are_put_aside() -> None:
    """A lidar that found its walls after three quarters of the way: nothing was left to fit."""
    run = run_of(STEERED, 1, 100)
    assert run.reference is not None
    seen = run.reference.chosen(run.reference.time > 85.0)
    parts = set_aside([replace(run, reference=seen)])
    poses = [each.reference.time.size for part in parts for each in part if each.reference]
    assert min(poses) > 0.2 * sum(poses)
    assert sum(poses) == seen.time.size < rules.SET_ASIDE_ROWS
