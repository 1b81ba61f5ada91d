# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What happens at an instant is told with its time and size, and disturbs no verdict."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, parts, run_of
from test.model.drives import ROBOT
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Reference, ReferenceKind, Run, Ticks
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.judged_legs import figures_of
from werrimbi_odom.inference.comparison.prepared_runs import for_fit, prepare
from werrimbi_odom.inference.diagnosis.diagnosis import Diagnosis, diagnose
from werrimbi_odom.inference.events.common_cause import alike
from werrimbi_odom.inference.events.events import (
    Events,
    EventSide,
    at_every_pose,
    events_among,
)
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.likelihood import innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.diagnosis.as_json import json_of
from werrimbi_odom.report.diagnosis.remarks import without_events
from werrimbi_odom.report.events import event_words, events_json, events_words
from werrimbi_odom.simulation import TrueRobot, free, out_and_back, record, write_run
from werrimbi_odom.simulation.hidden.knocks import Knock
from werrimbi_odom.simulation.robot import write_robot_file

NOISE_XY, NOISE_YAW = 1e-3, 2e-3
"""Of the simulated reference [m, rad]."""

Drives = tuple[list[Run], Robot]


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Drives:
    return _driven(tmp_path_factory.mktemp("sound"), ())


@pytest.fixture(scope="module")
def undisturbed(sound: Drives) -> Diagnosis:
    """Of these drives, in which nothing happened."""
    return _diagnosed(sound)


def _driven(folder: Path, hidden: tuple[Knock, ...]) -> Drives:
    write_robot_file(TrueRobot(), folder / "robot.yaml")
    file = read_robot_file(folder / "robot.yaml")
    runs = []
    for number in range(3):
        drive = (
            out_and_back(2.0, laps=2)
            if number == 2
            else free(40.0, seed=number, speed=0.4, yaw_rate=1.0)
        )
        made = record(TrueRobot(), drive, seed=40 + number, hidden=hidden)
        runs.append(read_run(write_run(made, folder / f"run_{number}"), file))
    return runs, file.robot


def _diagnosed(drives: Drives) -> Diagnosis:
    return diagnose(drives[0], drives[1], COMMON)


def _happened(runs: list[Run], robot: Robot) -> Events:
    """What a diagnosis tells of the first two of the drives."""
    return diagnose(runs[:2], robot, COMMON[:4]).happened


def _measured(run: Run, change: Callable[[Reference], Reference]) -> Run:
    assert run.reference is not None
    return replace(run, reference=change(run.reference))


def stepped(run: Run, at: float, sideways: float, turn: float = 0.0) -> Run:
    """As if the robot had been pushed to its left and turned at an instant."""

    def change(seen: Reference) -> Reference:
        after = seen.time >= at
        row = int(np.argmax(after))
        place, yaw = seen.x + 1j * seen.y, seen.yaw
        pivot = place[row]
        moved = pivot + np.exp(1j * turn) * (place - pivot) + sideways * 1j * np.exp(1j * yaw[row])
        place = np.where(after, moved, place)
        return replace(seen, x=place.real, y=place.imag, yaw=np.where(after, yaw + turn, yaw))

    return _measured(run, change)


def _beside_the_truth(run: Run, robot: Robot, kind: ReferenceKind = "absolute") -> Events:
    """What is told beside the robot itself, with noise near the true one."""
    options = EvaluationOptions(reference_kind=kind)
    runs = concatenated(for_fit(prepare([run], robot, options), robot))
    point = start_point(runs, robot, options)
    small = [1e-2 * point.variances.walk_xy, 1e-2 * point.variances.walk_yaw]
    point = replace(point, variances=replace(point.variances, walk_xy=small[0], walk_yaw=small[1]))
    return events_among([EventSide(runs.runs, [run.path], point, held_out=False)], kind)


@pytest.mark.evidence
@pytest.mark.parametrize("every", [1, 10])
def test_a_push_that_two_poses_see_is_one_of_their_sum(sound: Drives, every: int) -> None:
    """It was not told, or as two: a wrong pose between them says no more than two steps do."""
    runs, robot = sound
    assert runs[0].reference is not None
    rare = runs[0].reference.chosen(np.arange(runs[0].reference.time.size) % every == 0)
    row = int(np.searchsorted(rare.time, 20.0))
    x = rare.x.copy()
    x[row:] += 0.03
    x[row + 1 :] += 0.02
    pushed = replace(runs[0], reference=replace(rare, x=x))
    [event] = _beside_the_truth(pushed, robot).events
    assert event.stays
    assert np.hypot(*event.sizes[:2]) == pytest.approx(0.05, abs=4.0 * NOISE_XY)
    assert max(event.stds[:2]) < NOISE_XY


def test_kicks_between_rare_headings_are_told_each_by_itself(sound: Drives) -> None:
    """Each was also a neighbour of the other, which left both unknown: none was told."""
    run = parts(sound[0][0], "yaw")
    assert run.reference is not None
    rare = run.reference.chosen(np.arange(run.reference.time.size) % 10 == 0)
    row = int(np.searchsorted(rare.time, 20.0))
    yaw = rare.yaw.copy()
    yaw[row:] += 0.03
    yaw[row + 1 :] += 0.04
    kicked = replace(run, reference=replace(rare, yaw=yaw))
    told = [event for event in _beside_the_truth(kicked, sound[1]).events if event.size > 0.02]
    assert [event.channel for event in told] == ["heading"] * 2
    for event, size, after in zip(told, (0.03, 0.04), rare.time[row : row + 2], strict=True):
        assert event.size == pytest.approx(size, abs=4.0 * np.hypot(NOISE_YAW, event.std))
        assert 0.0 < after - event.time < 0.5


def test_a_pose_on_a_map_that_was_wrong_once_did_not_stay_wrong(sound: Drives) -> None:
    """Only one of the two steps was fitted: a turn of 28° was told as one of 1° that stayed."""
    runs, robot = sound

    def glance(seen: Reference) -> Reference:
        yaw = seen.yaw.copy()
        yaw[np.searchsorted(seen.time, 20.0)] += 0.5
        return replace(seen, yaw=yaw)

    [event] = _beside_the_truth(_measured(runs[0], glance), robot, "local_map").events
    assert (event.channel, event.unit, event.stays) == ("reference", "rad", False)
    assert event.size == pytest.approx(0.5, abs=4.0 * event.std)


def test_more_pushes_at_once_than_are_looked_for_are_too_many() -> None:
    """Fifty in so long a drive were told to be too many, and seventy to be none."""
    run = run_of(ROBOT, 1, 280)

    def pushed(seen: Reference) -> Reference:
        return replace(seen, x=seen.x + 0.03 * np.floor(seen.time / 4.0))

    found = _beside_the_truth(_measured(run, pushed), ROBOT)
    assert found.many
    assert found.events == ()


def test_where_nothing_happened_nothing_is_told(undisturbed: Diagnosis) -> None:
    found = undisturbed
    assert found.happened.events == ()
    assert events_words(found.happened, found.robot.track) == []


@pytest.mark.evidence
def test_what_happened_while_the_counters_were_silent_is_nobody_s_event(sound: Drives) -> None:
    """Wheels that speed up and slow down in between are off the line that is laid across it."""
    runs, robot = sound
    silent = []
    for run in runs:
        ticks = run.ticks
        kept = np.all(
            [(ticks.time < t) | (ticks.time > t + 0.9) for t in (8.3, 19.1, 27.7)], axis=0
        )
        some = Ticks(ticks.time[kept], ticks.left[kept], ticks.right[kept])
        silent.append(replace(run, ticks=some))
    assert _happened(silent, robot).events == ()


@pytest.mark.parametrize(
    ("scans", "at", "lost"),
    [
        (True, 17.0, 18.0),
        in_evidence(True, 17.0, 40.0),
        (False, 17.0, 18.0),
        in_evidence(True, 11.0, 40.0, id="beside a part that is put aside"),
    ],
)
def test_where_scans_were_lost_a_push_may_be_theirs(
    sound: Drives, scans: bool, at: float, lost: float
) -> None:
    """Before a lidar is lost its matches slide: it was told as a slip of the robot.

    What is put aside for judging was said to be such a stretch.
    """
    runs, robot = sound
    pushed = stepped(runs[0], at, 8.0 * NOISE_XY)
    assert pushed.reference is not None
    kept = np.abs(pushed.reference.time - lost - 1.0) > 1.0
    seen = replace(pushed.reference.chosen(kept), own_axes=scans)
    cut = replace(pushed, reference=seen, taken_out=((lost, lost + 2.0),))
    [event] = _happened([cut, *runs[1:]], robot).events
    assert event.beside_lost == (scans and lost == 18.0)


def test_a_push_of_five_times_the_noise_is_told_and_left_out(
    sound: Drives, undisturbed: Diagnosis
) -> None:
    runs, robot = sound
    pushed = [stepped(runs[0], 17.0, 5.0 * NOISE_XY), *runs[1:]]
    found = _diagnosed((pushed, robot))
    [event] = found.happened.events
    assert event.run == runs[0].path
    assert event.time == pytest.approx(17.0, abs=0.2)
    assert event.channel == "sideways"
    assert event.size == pytest.approx(5.0 * NOISE_XY, abs=3.0 * event.std)
    assert event.stays
    assert found.happened.left_out
    assert found.verdict == undisturbed.verdict == "none"
    [told] = events_json(found.happened, robot.track)
    assert (told["run"], told["unit"], told["left_out"]) == (str(runs[0].path), "m", True)
    assert re.search(r"pushed [\d.]+ ± [\d.]+ mm to the left", told["words"])
    turned = replace(event, channel="heading", unit="rad", size=0.0087, std=0.001)
    assert (
        event_words(turned, robot.track, either=False)
        == "it was turned by 0.498 ± 0.057° to the left"
    )
    beside = event_words(replace(turned, beside_lost=True), robot.track, either=False)
    assert beside.startswith("the robot or the reference jumped by 0.498 ± 0.057° in heading (just")
    said = " ".join(events_words(replace(found.happened, kind="local_map"), robot.track))
    assert "the robot or the reference jumped by" in said
    assert "A localiser that corrects itself" in said
    assert "it was pushed" not in said


@pytest.mark.evidence
def test_every_verb_tells_the_same_of_drives_in_which_something_happened(sound: Drives) -> None:
    """Fits leave an event out, and errors count it: who drove there by odometry was off by it."""
    runs, robot = sound
    wrong = replace(robot, wheel_separation_multiplier=1.02 * robot.wheel_separation_multiplier)
    fitted = [stepped(runs[0], 17.0, 0.01), runs[2]]
    held = [stepped(runs[1], 12.0, 0.01)]
    found = diagnose(fitted, wrong, COMMON, holdout=held)
    assert found.happened.left_out
    assert len(found.happened.events) == 2
    assert found.found == ("track_width",)
    compared = [_error(some, wrong) for some in (fitted, held)]
    assert [found.train.before, found.holdout.before] == compared
    added = add_effects([find("track_width")], fitted, wrong, holdout=held)
    assert [side.sides.before for side in (added.train, added.holdout)] == compared
    assert [event.run for event in added.happened.events] == [runs[0].path, runs[1].path]
    assert added.holdout.sides.after == pytest.approx(found.holdout.after, rel=1e-3)
    base_by_both = [each.robot.wheel_separation_multiplier for each in (added, found)]
    assert base_by_both[0] == pytest.approx(base_by_both[1], rel=2e-5)
    after = figures_of(prepare(held, wrong), found.robot).rmse_position_m
    assert found.holdout.after == pytest.approx(after, rel=1e-12)
    quiet = found.quiet[1]
    assert quiet.after < quiet.before < found.holdout.before
    assert without_events(AdvisedDiagnosis(found, None, ()))
    assert not without_events(AdvisedDiagnosis(replace(found, happened=Events()), None, ())), (
        "of no event told"
    )
    said = json_of(found, None)
    assert said["without_events"]["holdout"]["after"] == quiet.after
    base, *radii = said["calibration"].values()
    assert abs(base["value"] - robot.wheel_separation_multiplier) < 4.0 * base["std"]
    assert radii == [{"value": 1.0, "std": None}] * 2
    for side, some in (("train", fitted), ("holdout", held)):
        turned = compare(some, wrong).main.all.figures.rmse_yaw_rad
        assert said[side]["rmse_yaw_rad"]["before"] == turned > said[side]["rmse_yaw_rad"]["after"]


def _error(runs: list[Run], robot: Robot) -> float:
    return compare(runs, robot).main.all.figures.rmse_position_m


def test_a_kick_of_the_heading_is_told_by_a_gyro_alone(sound: Drives) -> None:
    runs, robot = sound
    kicked = [parts(stepped(runs[0], 22.0, 0.0, -5.0 * NOISE_YAW), "yaw")]
    kicked += [parts(run, "yaw") for run in runs[1:]]
    [event] = _happened(kicked, robot).events
    assert (event.channel, event.unit) == ("heading", "rad")
    assert event.time == pytest.approx(22.0, abs=0.2)
    assert event.size == pytest.approx(-5.0 * NOISE_YAW, abs=3.0 * event.std)


def test_a_reference_that_is_wrong_in_one_pose_jumped_and_came_back(sound: Drives) -> None:
    def wrong(seen: Reference) -> Reference:
        x = seen.x.copy()
        x[np.searchsorted(seen.time, 20.0)] += 0.05
        return replace(seen, x=x)

    runs, robot = sound
    [event] = _happened([_measured(runs[0], wrong), *runs[1:]], robot).events
    assert (event.channel, event.stays) == ("reference", False)
    assert event.time == pytest.approx(20.0, abs=0.06)
    assert event.size == pytest.approx(0.05, abs=4.0 * event.std)


@pytest.mark.evidence
def test_a_pose_with_a_wrong_heading_is_no_push_of_the_robot_that_drives_on(sound: Drives) -> None:
    """The robot does not go on along it: what it would have gone aside is no motion of its own."""
    runs, robot = sound

    def glance(seen: Reference) -> Reference:
        yaw = seen.yaw.copy()
        yaw[[250, 450, 650]] += [0.35, -0.4, 0.3]
        return replace(seen, yaw=yaw)

    found = _diagnosed(([_measured(runs[0], glance), *runs[1:]], robot))
    assert {event.channel for event in found.happened.events} == {"reference"}
    assert not any(event.stays for event in found.happened.events)
    assert found.verdict == "none"


def test_what_creeps_in_over_seconds_is_no_event(sound: Drives) -> None:
    """An error as large as that push, which takes four seconds to come."""

    def creeping(seen: Reference) -> Reference:
        return replace(seen, x=seen.x + 5.0 * NOISE_XY * np.clip((seen.time - 15.0) / 4.0, 0, 1))

    runs, robot = sound
    assert _happened([_measured(runs[0], creeping), *runs[1:]], robot).events == ()


@pytest.mark.evidence
def test_events_of_the_engine_are_found_and_no_verdict_is_made_of_them(tmp_path: Path) -> None:
    runs, robot = _driven(tmp_path, (Knock("wheel_slip", 0.015, every=12.0),))
    found = _diagnosed((runs, robot))
    made = record(
        TrueRobot(), free(40.0, seed=0, speed=0.4, yaw_rate=1.0), seed=40,
        hidden=[Knock("wheel_slip", 0.015, every=12.0)],
    )  # fmt: skip
    told = [event for event in found.happened.events if event.run == runs[0].path]
    assert len(told) == len(made.happened) > 1
    for event, truth in zip(told, made.happened, strict=True):
        assert event.time == pytest.approx(truth.t_s, abs=0.2)
        assert event.sizes[2] == pytest.approx(truth.turn_rad, abs=4.0 * event.stds[2])
    assert found.verdict == "none"
    said = " ".join(events_words(found.happened, robot.track))
    assert re.search(r"wheel slipped by [\d.]+ ± [\d.]+ mm", said)


def test_the_filter_backwards_is_the_adjoint_of_the_filter_forwards(
    undisturbed: Diagnosis,
) -> None:
    """A step's score is the product of what it shows with the innovations, leg by leg."""
    found = undisturbed
    runs = at_every_pose(found.runs.runs)
    point = found.final.point
    told = innovations(
        point.model.robot, runs, predict_all(point.model, runs), point.variances, "absolute"
    )
    white = told.whitened()
    shocks = told.shocks(white)
    for leg in (3, runs.count // 2, runs.count - 2):
        change = np.zeros((runs.count, 3, 3))
        change[leg] = np.eye(3)
        shown: Floats = told.shown(change)
        np.testing.assert_allclose(
            shocks.score[leg], np.einsum("mij,mi->j", shown, white), rtol=1e-6, atol=1e-6
        )
        np.testing.assert_allclose(
            shocks.known[leg], np.einsum("mij,mik->jk", shown, shown), rtol=1e-6, atol=1e-4
        )


def test_what_comes_at_one_place_is_no_accident(undisturbed: Diagnosis) -> None:
    found = undisturbed
    runs = at_every_pose(found.runs.runs)
    sides = [(runs, predict_all(found.final.point.model, runs))]
    x = runs.finish[:, 0]
    chance = np.random.default_rng(1)
    anywhere = chance.choice(runs.count, 8, replace=False)
    at_a_line = np.flatnonzero(np.abs(x - np.median(x)) < 0.03)
    robots_own = [np.zeros(8, dtype=np.bool_)]
    assert alike([anywhere], sides, robots_own) is None
    common = alike([chance.choice(at_a_line, 8, replace=False)], sides, robots_own)
    assert common is not None
    assert (common.what, common.count, common.of_reference) == ("x", 8, False)


@pytest.mark.evidence
def test_where_a_reference_goes_wrong_is_no_floor(sound: Drives) -> None:
    """A marker that is hidden at one place, time and again: nothing of the robot goes with it."""

    def hidden(seen: Reference) -> Reference:
        x, poses = seen.x.copy(), seen.x.size
        first = int(np.argmax(seen.x))
        near = np.hypot(seen.x - seen.x[first], seen.y - seen.y[first]) < 0.2
        rows = np.flatnonzero(near)
        for row in rows[np.diff(rows, prepend=-poses) > 0][::10]:
            x[row] += 0.05
        return replace(seen, x=x)

    runs, robot = sound
    found = _happened([_measured(runs[0], hidden), *runs[1:]], robot)
    assert found.alike is not None
    assert found.alike.of_reference
    assert found.left_out
    said = " ".join(events_words(found, robot.track))
    assert "there the reference goes wrong" in said
    assert "floor" not in said
    assert "They are left out of the fits" in said
    # Of a place that the held-out drives know the user is told, and the fits are not.
    held_out = replace(found, alike=None, in_all=replace(found.alike, of_reference=False))
    said = " ".join(events_words(held_out, robot.track))
    assert "look at the floor there" in said
    assert held_out.left_out
