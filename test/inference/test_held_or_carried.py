# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot that is held or carried is found, when it was, and no driving is left out."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import ROBOT_FILE
from test.evidence import in_evidence
from test.inference.driven import NOISE_XY, NOISE_YAW, of_headings, parts, run_by, run_of
from test.model.drives import ROBOT
from test.recorded_robots import ROBOTS, with_recordings
from test.white_noise_robot import WhiteNoiseRobot, drive
from werrimbi_odom.effects.lookup import find
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.references.merged_reference import merged
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import NoDriving, Reference, Run, Ticks
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.legs.agreement import Agreement
from werrimbi_odom.inference.legs.count_interpolation import counters_of
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.legs.held_or_carried import _stretches
from werrimbi_odom.inference.legs.measured_motion import judged_motion
from werrimbi_odom.inference.legs.motion_states import LOST, driven
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.legs.windows import Windows
from werrimbi_odom.inference.set_up.search import look_for_mistakes
from werrimbi_odom.report.phrases import left_out_words
from werrimbi_odom.simulation import TrueRobot, drives, hide, record, write_run

NEAR = 0.5


def moved_on(reference: Reference, first: int, pose: tuple[float, float, float]) -> np.ndarray:
    """The rest of a path from a row on, begun at another pose: x, y, yaw in columns."""
    yaw = np.unwrap(reference.yaw)
    turn = pose[2] - yaw[first]
    way = (reference.x[first:] - reference.x[first]) + 1j * (
        reference.y[first:] - reference.y[first]
    )
    place = pose[0] + 1j * pose[1] + way * np.exp(1j * turn)
    return np.stack([place.real, place.imag, yaw[first:] + turn], axis=1)


def held(run: Run, begin: float, end: float) -> tuple[Run, float, float]:
    """The run with its reference frozen while the ticks go on; from and to, while wheels turn."""
    random = np.random.default_rng(0)
    reference = run.reference
    assert reference is not None
    first, last = np.searchsorted(reference.time, [begin, end]).tolist()
    table = np.stack([reference.x, reference.y, np.unwrap(reference.yaw)], axis=1)
    pose = tuple(table[first])
    table[first:last] = pose + random.normal(
        0.0, [NOISE_XY, NOISE_XY, NOISE_YAW], (last - first, 3)
    )
    table[last:] = moved_on(reference, last, pose)
    inside = (run.ticks.time >= begin) & (run.ticks.time <= end)
    counts = np.stack([run.ticks.left, run.ticks.right])[:, inside]
    turning = np.flatnonzero(np.abs(np.diff(counts)).max(axis=0) > 1.0)
    times = run.ticks.time[inside][[turning[0], turning[-1] + 1]]
    return replace(run, reference=Reference(reference.time, *table.T)), *times.tolist()


def carried(run: Run, begin: float, lasts: float) -> Run:
    """The run with a rest in it, in which the robot is set aside."""
    random = np.random.default_rng(0)
    ticks, reference = run.ticks, run.reference
    assert reference is not None
    row, here = (int(np.searchsorted(each.time, begin)) for each in (ticks, reference))
    rest = np.arange(0.05, lasts, 0.05)

    def with_rest(counts: np.ndarray) -> np.ndarray:
        return np.concatenate([counts[:row], np.full(rest.size, counts[row]), counts[row:]])

    time = np.concatenate([ticks.time[:row], begin + rest, ticks.time[row:] + lasts])
    seen = np.arange(0.2, lasts, 0.2)
    gone = 0.5 * (1.0 - np.cos(np.pi * seen / lasts))
    pose = (reference.x[here - 1], reference.y[here - 1], np.unwrap(reference.yaw)[here - 1])
    away = np.array([0.9, -0.6, 1.4])
    table = np.concatenate(
        [
            np.stack([reference.x, reference.y, np.unwrap(reference.yaw)], axis=1)[:here],
            pose
            + gone[:, None] * away
            + random.normal(0.0, [NOISE_XY, NOISE_XY, NOISE_YAW], (seen.size, 3)),
            moved_on(reference, here, tuple(pose + away)),
        ]
    )
    stamps = np.concatenate([reference.time[:here], begin + seen, reference.time[here:] + lasts])
    return replace(
        run,
        ticks=Ticks(time, with_rest(ticks.left), with_rest(ticks.right)),
        reference=Reference(stamps, *table.T),
    )


def seen_at(run: Run, time: np.ndarray) -> np.ndarray:
    """Poses (3, n) of the reference at other times."""
    given = run.reference
    assert given is not None
    columns = (given.x, given.y, np.unwrap(given.yaw))
    return np.stack([np.interp(time, given.time, each) for each in columns])


def at_10_hz(run: Run) -> Reference:
    """A reference as often as most are."""
    assert run.reference is not None
    time = np.arange(run.reference.time[0], run.reference.time[-1], 0.1)
    return Reference(time, *seen_at(run, time))


def span(run: Run) -> tuple[float, float, set[str]]:
    """From the first to the last that is found, and what."""
    found = with_no_driving(run, ROBOT).no_driving
    assert found
    return found[0].begin, found[-1].end, {part.why for part in found}


def is_found(run: Run, why: str, begin: float, end: float, near: float = NEAR) -> None:
    """One kind of no driving is found, and when it was."""
    found = span(run)
    assert found[:2] == pytest.approx((begin, end), abs=near)
    assert found[2] == {why}


@pytest.mark.parametrize("seed", range(6))
def test_a_robot_that_is_held_is_found_within_half_a_second(seed: int) -> None:
    run, begin, end = held(run_of(ROBOT, seed), 30.0, 36.0)
    is_found(run, "held", begin, end)


@pytest.mark.parametrize("share", [0.0, 0.5])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_nobody_holds_a_robot_whose_heading_follows_its_wheels(seed: int, share: float) -> None:
    """Scans that slide along a corridor, or wheels that slip alike: the way falls short, alone."""
    run = run_of(ROBOT, seed)
    assert run.reference is not None
    time, way = run.reference.time, run.reference.x + 1j * run.reference.y
    slides = (time[1:] >= 30.0) & (time[1:] <= 36.0)
    way = way[0] + np.cumsum(np.append(0.0, np.diff(way) * np.where(slides, share, 1.0)))
    short = replace(run.reference, x=way.real, y=way.imag)
    found = with_no_driving(replace(run, reference=short), ROBOT).no_driving
    assert found == ()


@pytest.mark.parametrize("share", [0.4, 0.55])
def test_a_hand_that_lets_a_spinning_robot_turn_by_half_holds_it(share: float) -> None:
    """As that of a real TurtleBot3. How far it turns is itself in doubt: no slip does as much."""
    time = np.arange(0.0, 50.0, 0.05)
    turning = np.where(time < 14.0, 0.0, -0.4)
    speed = np.where((time >= 3.0) & (time < 13.0), 0.2, 0.0)
    free = run_by(ROBOT, speed, turning)
    slowed = np.where((time > 30.0) & (time < 34.0), share * turning, turning)
    hand = run_by(ROBOT, speed, slowed)
    begin, end, why = span(replace(free, reference=hand.reference))
    assert (begin, end) == pytest.approx((30.0, 34.0), abs=NEAR)
    assert why == {"held"}


@pytest.mark.parametrize("seed", range(3))
def test_a_hand_that_lets_go_gradually_holds_until_it_has_let_go(seed: int) -> None:
    """By scans of 3 mrad no window shows a sixth of a slow turn: a second of it shows it."""
    time = np.arange(0.0, 50.0, 0.05)
    turning = np.where(time < 14.0, 0.0, -0.21)
    speed = np.where((time >= 3.0) & (time < 13.0), 0.2, 0.0)
    free = run_by(ROBOT, speed, turning, seed)
    holds = (time > 30.0) & (time < 33.0)
    lets_go = (time >= 33.0) & (time < 34.2)
    hand = run_by(ROBOT, speed, turning * np.where(holds, 0.5, np.where(lets_go, 0.82, 1.0)), seed)
    seen = at_10_hz(hand)
    noise = 3e-3 * np.random.default_rng(seed).standard_normal(seen.time.size)
    begin, end, why = span(replace(free, reference=replace(seen, yaw=seen.yaw + noise)))
    assert begin == pytest.approx(30.0, abs=NEAR)
    assert end == pytest.approx(34.2, abs=NEAR)
    assert why == {"held"}


def test_a_robot_that_is_held_on_a_line_and_turns_when_let_go_is_found() -> None:
    """All that it turns is in windows at the end, half driven: it says nothing of the hold."""
    time = 0.05 * np.arange(1200)
    on_a_line = (time > 26.0) & (time < 36.2)
    turning = np.where(on_a_line, 0.0, 1.2 * np.sign(np.sin(0.5 * time)))
    run, begin, end = held(run_by(ROBOT, np.full(time.size, 0.4), turning), 30.0, 36.0)
    is_found(run, "held", begin, end)


@pytest.mark.parametrize("turns", [False, True])
def test_scans_beside_a_wall_do_not_say_for_certain_that_a_robot_was_held(turns: bool) -> None:
    """A Neato that followed a wall: its scans slid along it, and it was told to have been held."""
    time = 0.05 * np.arange(1200)
    on_a_line = (time > 26.0) & (time < 40.0) & (not turns)
    turning = np.where(on_a_line, 0.0, 1.2 * np.sign(np.sin(0.5 * time)))
    run, begin, end = held(run_by(ROBOT, np.full(time.size, 0.4), turning), 30.0, 36.0)
    assert run.reference is not None
    walked = np.zeros((run.reference.time.size, 2))
    run = replace(run, reference=replace(run.reference, own_axes=True, walked=walked))
    is_found(run, "held", begin, end)
    found = with_no_driving(run, ROBOT)
    words = " ".join(part.words for part in found.no_driving or ())
    assert ("or the scans slid along a bare one" in words) is not turns
    spans = driven(counters_of(found, ROBOT, None), ROBOT, found.no_driving or ()).spans
    assert ("slid" in [each.what for each in spans]) is not turns


@pytest.mark.parametrize("seed", range(3))
def test_a_localiser_that_jumps_just_before_does_not_make_it_longer(seed: int) -> None:
    run, begin, end = held(run_of(ROBOT, seed), 30.0, 36.0)
    seen = at_10_hz(run)
    jump = np.where(seen.time > begin - 0.5, 0.4, 0.0)
    jumped = replace(run, reference=replace(seen, x=seen.x + jump, y=seen.y - jump))
    assert span(jumped)[:2] == pytest.approx((begin, end), abs=NEAR)


@pytest.mark.parametrize("seed", [2, 5, 9, 12])
def test_a_localiser_that_wanders_does_not_make_it_longer(seed: int) -> None:
    """By 8 mm and 4 mrad in half a second; in one of these the robot stands where it is let go."""
    run, begin, end = held(run_of(ROBOT, seed), 30.0, 36.0)
    given = at_10_hz(run)
    wander, random = np.zeros(3), np.random.default_rng([seed, 5])
    seen = []
    for pose in np.stack([given.x, given.y, given.yaw], axis=1):
        wander = 0.993 * wander + [3.5e-3, 3.5e-3, 1.8e-3] * random.standard_normal(3)
        seen.append(pose + wander)
    found = span(replace(run, reference=Reference(given.time, *np.array(seen).T)))
    assert found[:2] == pytest.approx((begin, end), abs=NEAR)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("which", ["poses", "yaw"])
def test_a_robot_that_is_carried_is_found_within_half_a_second(seed: int, which: str) -> None:
    is_found(parts(carried(run_of(ROBOT, seed), 30.0, 3.0), which), "carried", 30.0, 33.0)


@pytest.mark.parametrize("late", [0.0, 0.1])
def test_a_reference_that_is_late_at_starts_and_stops_hides_no_hand(late: float) -> None:
    """A drive of short lines says nothing of turns: of places alone it must be learnt how late."""
    time = np.arange(0.0, 60.0, 0.05)
    speed = np.where((time > 30.0) & (time < 36.0), 0.0, 0.35 * (1.0 - np.cos(2.0 * np.pi * time)))
    way = np.cumsum(0.05 * speed)
    counts = way / ROBOT.left_tick
    away = 0.4 * 0.5 * (1.0 - np.cos(np.pi * np.clip((time - 30.5) / 5.0, 0.0, 1.0)))
    noise = np.random.default_rng(0).normal(0.0, [[NOISE_XY], [NOISE_XY], [NOISE_YAW]], (3, 1200))
    seen = Reference(time + late, way + noise[0], away + noise[1], 2.0 * away + noise[2])
    begin, end, why = span(Run("lines", Path("lines"), Ticks(time, counts, counts), seen))
    assert why == {"carried"}
    assert begin == pytest.approx(30.5, abs=NEAR)
    assert end == pytest.approx(35.5 + late, abs=NEAR)


@pytest.mark.parametrize("seed", range(6))
def test_nothing_of_a_carry_is_left_in_the_next_leg(seed: int) -> None:
    """Who sets a robot down does it gently; it stands, and what nobody drove is nobody's leg."""
    run = carried(run_of(ROBOT, seed), 30.0, 5.0)
    assert run.reference is not None
    begin, end, _ = span(run)
    left = [
        0.5 * (1.0 - np.cos(np.pi * np.clip((at - 30.0) / 5.0, 0.0, 1.0))) for at in (begin, end)
    ]
    assert left[0] < 2e-3
    assert 1.0 - left[1] < 2e-3, "of 1.1 m: two millimetres"


def test_an_end_error_is_not_that_of_a_hand(tmp_path: Path) -> None:
    run = carried(run_of(ROBOT, 1), 30.0, 5.0)
    found = compare([run, run_of(ROBOT, 2)], ROBOT).runs
    assert np.isnan([found[0].end_error_m, found[0].end_error_rad, found[0].rmse_path_m]).all()
    assert np.isfinite([found[1].end_error_m, found[1].end_error_rad]).all()
    ticks, seen = run.ticks, run.reference
    assert seen is not None
    poses = np.stack([seen.time, seen.x, seen.y, seen.yaw], axis=1)
    wo.write_run(tmp_path / "run", ticks.time, ticks.left, ticks.right, poses)
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    told = wo.odom(wo.read_robot(tmp_path / "robot.yaml"), tmp_path / "run").to_dict()["notes"]
    assert any("the robot moved and its wheels did not" in note for note in told)


@pytest.mark.parametrize("unit", [0.5, 1.0, 2.0])
def test_a_heading_in_whole_degrees_holds_no_robot_that_turns_slowly(unit: float) -> None:
    """Each of its steps is more than twice what the wheels did meanwhile."""
    speed, turning = np.full(1200, 0.3), np.zeros(1200)
    speed[400:], turning[400:800], turning[800:] = 0.0, 0.15, -0.2
    machine, random = WhiteNoiseRobot(), np.random.default_rng(0)
    run = drive(machine, (speed, turning), random, every=1, sigma_yaw=1e-3)
    seen = run.reference
    assert seen is not None
    rounded = np.radians(unit * np.round(np.degrees(seen.yaw) / unit))
    run = replace(run, reference=replace(seen, yaw=rounded))
    assert with_no_driving(run, machine.entered()).no_driving == ()


def test_a_gyro_that_turns_too_fast_for_it_does_not_say_that_the_robot_stood() -> None:
    """It shows up to 0.6 rad/s: "the robot did not" was said of spins that it saw by 0.6."""
    random = np.random.default_rng(2)
    parts_of = [
        (0.4 * random.uniform(0.5, 1.0), 0.0) if number % 2 else (0.0, random.choice([-0.4, 0.4]))
        for number in range(24)
    ]
    parts_of[9], parts_of[18] = (0.0, 1.0), (0.0, -1.0)
    speed, turning = (np.repeat(each, 70) for each in zip(*parts_of, strict=True))
    run = run_by(ROBOT, speed, turning)
    assert run.reference is not None
    time, yaw = run.reference.time, np.unwrap(run.reference.yaw)
    rate = np.clip(np.diff(yaw) / np.diff(time), -0.6, 0.6)
    seen = np.concatenate([[0.0], np.cumsum(rate * np.diff(time))])
    found = with_no_driving(replace(run, reference=of_headings(time, seen)), ROBOT).no_driving
    assert found
    for part in found:
        assert part.why == "held"
        assert "faster than the reference can follow" in part.words


def test_angles_that_tremble_in_their_last_digits_are_no_driving() -> None:
    """As of a simulator: a minute of waiting in which no angle is twice the same."""
    time = np.arange(0.0, 60.0, 0.05)
    way = np.cumsum(0.05 * 0.3 * ((time > 10.0) & (time < 18.0)))
    way += 1e-7 * np.random.default_rng(0).standard_normal(time.size)
    ticks = Ticks(time, way / ROBOT.left_tick, way / ROBOT.right_tick)
    run = Run("waits", Path("waits"), ticks, None)
    found = driven(counters_of(run, ROBOT, None), ROBOT, ())
    assert [each.what for each in found.spans] == ["stood", "drove", "stood"]
    assert found.reversals == 0
    assert found.turned < 1e-3
    other = replace(ROBOT, effects=(find("right_wheel_reversed").using(),))
    assert driven(counters_of(run, other, None), other, ()).turned > 1.0, "as the file says"


def test_a_robot_that_only_trembles_stood_all_the_time() -> None:
    """A simulator's: it "drove for 4.7 s" and went 0.0 m."""
    time = np.arange(0.0, 5.0, 0.05)
    tremble = np.random.default_rng(3).normal(0.0, 1e-4 / ROBOT.left_tick, (2, time.size))
    run = Run("drive", Path("drive"), Ticks(time, *tremble))
    (only,) = driven(counters_of(run, ROBOT, None), ROBOT, ()).spans
    assert only.what == "stood"


def test_what_follows_a_carry_is_not_said_to_be_carried() -> None:
    """Of positions alone: half of a car's drive, whose heading was not known after a silence."""
    run = run_of(ROBOT, 1)
    parts = (NoDriving(10.0, 12.0, "carried", "carried"), NoDriving(12.0, 30.0, "carried", LOST))
    spans = driven(counters_of(run, ROBOT, None), ROBOT, parts).spans
    lasted = {each.what: each.end - each.begin for each in spans if each.what[0] in "cl"}
    assert lasted == pytest.approx({"carried": 2.0, "lost": 18.0}, abs=0.2)


def test_headings_alone_show_it_while_the_wheels_turn_the_robot() -> None:
    found = 0
    for seed in range(6):
        run, *_ = held(run_of(ROBOT, seed), 30.0, 36.0)
        stretches = with_no_driving(parts(run, "yaw"), ROBOT).no_driving
        assert stretches is not None
        assert all(29.5 < part.begin < part.end < 36.5 for part in stretches)
        found += bool(stretches)
    assert found >= 4  # of six: in the others it drives straight on


def test_a_robot_that_is_turned_while_it_stands_is_found_in_a_straight_drive_of_a_gyro() -> None:
    """Nothing else in it says how the gyro goes with the wheels."""
    time = np.arange(0.0, 40.0, 0.05)
    drives = (time < 15.0) | (time > 20.0)
    counts = np.cumsum(40.0 * drives)
    yaw = np.clip(time - 16.0, 0.0, 2.0) + np.random.default_rng(0).normal(0.0, 1e-3, time.size)
    ticks, seen = Ticks(time, counts, counts), of_headings(time, yaw)
    run = with_no_driving(Run("straight", Path("straight"), ticks, seen), ROBOT)
    is_found(run, "carried", 16.0, 18.0)


@pytest.mark.parametrize("seed", range(3))
def test_a_gyro_shows_a_carry_beside_a_localiser_that_seldom_speaks(seed: int) -> None:
    """It speaks after each 0.15 m of the wheels' way: at rest never, and the gyro was not asked."""
    run = carried(run_of(ROBOT, seed), 30.0, 6.0)
    time = np.arange(run.ticks.time[0], run.ticks.time[-1], 0.01)
    random = np.random.default_rng(seed)
    turned = seen_at(run, time)[2] + 0.01 * time + random.normal(0.0, 1e-4, time.size)
    way = np.abs(np.diff(run.ticks.left + run.ticks.right, prepend=0.0)).cumsum()
    way *= 0.5 * ROBOT.left_tick
    spoken = run.ticks.time[np.flatnonzero(np.diff(way // 0.15)) + 1]
    wander = random.normal(0.0, [[0.02], [0.02], [0.01]], (3, spoken.size))
    poses = Reference(spoken, *(seen_at(run, spoken) + wander))
    both, _ = merged("drive", poses, of_headings(time, turned))
    is_found(replace(run, reference=both), "carried", 30.0, 36.0, near=1.0)
    late, _ = merged("drive", poses.earlier(-0.4), of_headings(time + 0.4, turned))
    is_found(replace(run, reference=late.earlier(0.4)), "carried", 30.0, 36.0, near=1.0)


def test_a_robot_that_is_carried_slowly_between_straight_lines_is_found_by_its_turning() -> None:
    """How it drives says nothing of turns; and a tenth of a metre a second is no way to tell."""
    time = np.arange(0.0, 40.0, 0.05)
    speed = 60.0 * np.sign(np.sin(0.4 * np.pi * time)) * ((time < 20.0) | (time > 25.0))
    counts = np.cumsum(50.0 * speed * 0.05)
    hand = np.clip(time - 20.0, 0.0, 5.0)
    way = np.cumsum(np.append(0.0, np.diff(counts))) * ROBOT.left_tick
    yaw = 0.4 * hand
    step = np.append(0.0, np.diff(way)) * np.exp(1j * yaw) + 0.12j * np.append(0.0, np.diff(hand))
    noise = np.random.default_rng(0).normal(0.0, [[5e-3], [5e-3], [2e-3]], (3, time.size))
    path = np.cumsum(step)
    seen = Reference(time, path.real + noise[0], path.imag + noise[1], yaw + noise[2])
    run = Run("to_and_fro", Path("to_and_fro"), Ticks(time, counts, counts), seen)
    is_found(run, "carried", 20.0, 25.0)


def test_no_leg_comes_near_the_ends_of_what_was_no_driving() -> None:
    """They are known to less than a window; what is left of a hand there is a leg's whole error."""
    run, *_ = held(run_of(ROBOT, 1), 30.0, 36.0)
    begin, end, _ = span(run)
    (matched,) = match_for_fit([run], ROBOT, 1.0)
    first, last = (
        matched.measured.time[ends][~matched.gap] for ends in (slice(-1), slice(1, None))
    )
    assert first.size > 100
    assert not ((first < end + 0.4) & (last > begin - 0.4)).any()


def test_a_robot_that_a_hand_turns_faster_than_its_wheels_could_is_found_by_a_gyro() -> None:
    """It drove straight on until then, and spun slowly: how it turns, nothing else says."""
    time = np.arange(0.0, 40.0, 0.05)
    spins = 4.0 * (time > 20.0)
    forth = 40.0 * (time < 15.0)
    by_hand = np.where((time > 30.0) & (time < 36.0), 1.5 * np.sin(time - 30.0), 0.0)
    yaw = np.cumsum(0.05 * by_hand) + np.random.default_rng(0).normal(0.0, 1e-3, time.size)
    ticks = Ticks(time, np.cumsum(forth - spins), np.cumsum(forth + spins))
    lifted = Run("lifted", Path("lifted"), ticks, of_headings(time, yaw))
    found = span(with_no_driving(lifted, ROBOT))
    assert found[0] == pytest.approx(30.0, abs=NEAR)
    assert found[1] > 35.5
    assert found[2] == {"carried"}


def test_a_robot_that_runs_against_something_soon_after_its_first_turn_is_found() -> None:
    """As a TurtleBot3 did: 7 s ahead, 2.6 s turning, and 9 s by two fifths of what wheels turn."""
    time = np.arange(0.0, 22.0, 0.05)
    forth = 0.19 * ((time > 2.0) & (time < 9.0))
    turning = -0.216 * ((time > 9.0) & (time < 20.6))
    slows = np.where(time > 11.6, 0.4, 1.0)
    noise = np.random.default_rng(0).normal(0.0, [[1e-3], [1e-3], [2e-3]], (3, time.size))
    yaw = np.cumsum(0.05 * slows * turning)
    path = np.cumsum(0.05 * forth * np.exp(1j * yaw))
    left, right = (
        np.cumsum(0.05 * (forth + side * 0.5 * ROBOT.track * turning)) / ROBOT.left_tick
        for side in (-1.0, 1.0)
    )
    seen = Reference(time, path.real + noise[0], path.imag + noise[1], yaw + noise[2])
    is_found(Run("stuck", Path("stuck"), Ticks(time, left, right), seen), "held", 11.6, time[-1])


def test_a_robot_that_is_lifted_ever_faster_until_it_is_lost() -> None:
    time = np.arange(0.0, 33.0, 0.1)
    spins, forth = 2.0 * (time > 20.0), 40.0 * (time < 15.0)
    left, right = (np.cumsum(forth + side * spins) for side in (-1.0, 1.0))
    gone = 0.5 * (left + right) * ROBOT.left_tick + np.clip(time - 30.0, 0.0, 2.4) ** 3 / 12.0
    noise = np.random.default_rng(0).normal(0.0, 1e-3, (2, time.size))
    seen = time < 32.4
    yaw = (right - left) * ROBOT.left_tick / ROBOT.track
    reference = Reference(time[seen], (gone + noise[0])[seen], noise[1][seen], yaw[seen])
    run = Run("lost", Path("lost"), Ticks(time, left, right), reference)
    begin, end, why = span(with_no_driving(run, ROBOT))
    assert begin == pytest.approx(30.0, abs=NEAR)
    assert end > 32.0
    assert why == {"carried"}


def test_who_sets_a_robot_elsewhere_takes_half_a_second() -> None:
    """Its wheels go on meanwhile; a localiser that jumps does so from one pose to the next."""
    run = run_of(ROBOT, 2)
    reference = at_10_hz(run)
    gone = np.clip((reference.time - 40.0) / 0.5, 0.0, 1.0)
    away = replace(
        reference, x=reference.x + 0.5 * gone, y=reference.y - 0.3 * gone, yaw=reference.yaw + gone
    )
    is_found(replace(run, reference=away), "carried", 40.0, 40.5)


def test_a_robot_that_is_stopped_for_a_moment_is_found_by_a_gyro_though_its_wheels_are_slow() -> (
    None
):
    """Five readings of the wheels a second: six windows of them are a second and a half."""
    time = np.arange(0.0, 60.0, 0.2)
    spins = np.where(time % 8.0 < 6.0, 40.0, -40.0)
    turn = np.cumsum(2.0 * spins) * ROBOT.left_tick / ROBOT.track
    held_back = (time > 33.0) & (time < 33.9)
    rate = np.where(held_back, 0.0, np.gradient(turn, time))
    stamps = np.arange(0.0, 59.7, 0.02)
    yaw = np.cumsum(0.02 * np.interp(stamps, time, rate))
    ticks = Ticks(time, np.cumsum(-spins), np.cumsum(spins))
    run = Run("stopped", Path("stopped"), ticks, of_headings(stamps, yaw))
    is_found(run, "held", 33.0, 33.9)


def test_nothing_is_expected_of_a_robot_whose_wheels_stand() -> None:
    """A law learnt from straight driving says anything of turns, and drivers' speeds creep."""
    stands = np.arange(200) < 60
    wheels = np.where(stands, 0.00026, 0.018)
    shown = np.where(stands, 0.0042, 0.018)  # by an arm of 0.7 m, which no turn has shown wrong
    seen = np.where(stands, 0.0, shown) + np.random.default_rng(0).normal(0.0, 1e-4, 200)
    time = 0.1 * np.arange(200.0)
    windows = Windows(0.1, 5, time, wheels, wheels, wheels, seen, np.ones(200))
    agreement = Agreement(windows, shown, shown, 0.0, np.array([1.0, 0.0, 0.5]))
    assert _stretches(judged_motion(agreement, 0.0018, 0.03, turns=False)) == []


def test_a_slow_carry_is_found_however_roughly_wheels_follow_their_law() -> None:
    """In starts and stops seen from beside the axle it goes 8 % less far than its wheels."""
    time = 0.1 * np.arange(200.0)
    stands = (time >= 10.0) & (time < 15.0)
    wheels = np.where(stands, 0.0, 0.2 * (1.0 - np.cos(2.0 * time)))
    seen = np.where(stands, 0.055, 0.92 * wheels)
    seen = seen + np.random.default_rng(0).normal(0.0, 2e-3, 200)
    windows = Windows(0.1, 5, time, wheels, wheels, wheels, seen, np.ones(200))
    agreement = Agreement(windows, wheels, wheels, 0.0, np.array([1.0, 0.0, 0.0]))
    slowest = 0.1 * float(np.median(wheels[wheels > windows.still]))
    (found,) = _stretches(judged_motion(agreement, slowest, 0.03, turns=False))
    assert found == pytest.approx((10.0, 15.0), abs=0.3)


@pytest.mark.parametrize("lines", [2.0, 10.0])
@pytest.mark.parametrize("radius", [0.7, 1.0, 1.4])
def test_nobody_holds_a_robot_on_the_lines_before_and_after_an_arc(
    radius: float, lines: float
) -> None:
    """In one arc a turn for any way of both wheels fits as well, and more goes into it."""
    time = np.arange(0.0, 30.0, 0.05)
    straight = (time < lines) | (time > 29.0 - lines / 3.0)
    run = run_by(ROBOT, np.full(time.size, 0.25), np.where(straight, 0.0, 0.25 / radius))
    assert with_no_driving(run, ROBOT).no_driving == ()


def stop_and_go(noise: float) -> Run:
    """Moves of a second with rests of three, below a camera that sees tags at 8 Hz."""
    time = np.arange(0.0, 120.0, 0.05)
    going = np.where(time % 4.0 < 1.0, np.sin(np.pi * (time % 4.0)), 0.0)
    turning = np.where(time // 4.0 % 3.0 == 1.0, 0.8, 0.0) * going
    run = run_by(ROBOT, 0.3 * going, turning)
    stamps = np.arange(0.1, 119.0, 0.125)
    seen = seen_at(run, stamps)
    seen += noise * np.random.default_rng(1).standard_t(4, seen.shape)
    return replace(run, reference=Reference(stamps, *seen))


@pytest.mark.parametrize("noise", [0.01, 0.02])
def test_nobody_carries_a_robot_that_stands_below_a_poor_camera(noise: float) -> None:
    """Of slow windows only those with little noise keep to the law, and they told the noise."""
    assert with_no_driving(stop_and_go(noise), ROBOT).no_driving == ()


def test_a_carry_below_a_poor_camera_is_found() -> None:
    run = carried(stop_and_go(0.01), 62.0, 4.0)
    is_found(run, "carried", 62.0, 66.0, near=1.0)


@pytest.mark.parametrize("seed", range(6))
def test_nobody_lifts_a_robot_whose_tag_is_seen_elsewhere_now_and_then(seed: int) -> None:
    """Radio ranging: single positions off by half a metre, several in some seconds."""
    run = parts(run_of(ROBOT, seed), "positions")
    reference, random = at_10_hz(run), np.random.default_rng(seed)
    size = (2, reference.x.size)
    off = 0.02 * random.standard_normal(size)
    off += 0.5 * random.standard_normal(size) * (random.random(reference.x.size) < 0.04)
    seen = replace(reference, x=reference.x + off[0], y=reference.y + off[1])
    seen = replace(seen, yaw=np.full_like(seen.yaw, np.nan))
    assert with_no_driving(replace(run, reference=seen), ROBOT).no_driving == ()


def test_who_spins_as_slowly_as_wheels_creep_drives() -> None:
    """A tenth of a radian a second, beside brisk turns: wheels that hardly roll are believed."""
    time = np.arange(0.0, 60.0, 0.02)
    rate = np.where(time < 40.0, 1.2 * np.sign(np.sin(0.3 * time)), 0.12)
    speed = np.where(time < 40.0, 0.8, 0.0)
    way, turn = np.cumsum(0.02 * speed), np.cumsum(0.02 * rate)
    half = 0.5 * ROBOT.track * turn
    counts = (np.floor((way + side * half) / ROBOT.left_tick) for side in (-1.0, 1.0))
    place = np.cumsum(0.02 * speed * np.exp(1j * turn))
    noise = np.random.default_rng(0).normal(0.0, [[1e-3], [1e-3], [2e-3]], (3, time.size))
    seen = Reference(time, place.real + noise[0], place.imag + noise[1], turn + noise[2])
    run = Run("slow", Path("slow"), Ticks(time, *counts), seen)
    assert with_no_driving(run, ROBOT).no_driving == ()


@pytest.mark.evidence
def test_arcs_seen_from_beside_the_axle_are_driving(tmp_path: Path) -> None:
    """Outwards it goes farther than its wheels, inwards less far: no one scale is both."""
    mount = hide("reference_lever_arm", seed=3).peculiarity  # 61 mm ahead, 132 mm to the right
    drive = record(TrueRobot(), drives(7)["train/eights_and_spins"], seed=42, hidden=[mount])
    run = read_run_folder(write_run(drive, tmp_path / "eights"))
    assert with_no_driving(run, ROBOT).no_driving == ()


def test_of_positions_alone_the_longest_drive_is_kept() -> None:
    """How a robot stands after it was carried, positions do not say."""
    run = with_no_driving(parts(carried(run_of(ROBOT, 1), 60.0, 3.0), "positions"), ROBOT)
    assert run.no_driving is not None
    assert [part.why for part in run.no_driving] == ["carried", "carried"]
    assert run.no_driving[0].begin == pytest.approx(60.0, abs=NEAR)
    assert run.no_driving[-1].end == pytest.approx(float(run.ticks.time[-1]))
    assert "heading is not known" in run.no_driving[-1].words


TRUTHS = {
    "nothing": ROBOT,
    "base": replace(ROBOT, wheel_separation_multiplier=2.0),
    "skid": replace(ROBOT, wheel_separation_multiplier=1.9),
    "radii": replace(ROBOT, left_wheel_radius_multiplier=0.5, right_wheel_radius_multiplier=0.5),
    "swapped": replace(ROBOT, effects=(find("wheels_swapped").using(),)),
    "reversed": replace(ROBOT, effects=(find("left_wheel_reversed").using(),)),
    "late": replace(ROBOT, effects=(find("reference_delay").using(delay=0.25),)),
    "castor": replace(ROBOT, effects=(find("castor_kick").using(angle=0.05),)),
    "slip": replace(ROBOT, effects=(find("longitudinal_slip").using(coefficient=0.05),)),
    "arm": replace(ROBOT, effects=(find("reference_lever_arm").using(x=0.3, y=-0.2),)),
}


@pytest.mark.parametrize("seed", [1, in_evidence(2)])
@pytest.mark.parametrize("truth", TRUTHS)
@pytest.mark.parametrize("which", ["poses", "positions", "yaw"])
def test_what_is_driving_is_left_in(truth: str, which: str, seed: int) -> None:
    run = with_no_driving(parts(run_of(TRUTHS[truth], seed), which), ROBOT)
    assert run.no_driving == ()


@pytest.mark.parametrize("truth", ["base", "swapped", "reversed", "arm"])
def test_a_wrong_robot_file_hides_nothing(truth: str) -> None:
    run, begin, end = held(run_of(TRUTHS[truth], 3), 30.0, 36.0)
    assert span(run)[:2] == pytest.approx((begin, end), abs=NEAR)


def test_a_jump_of_the_reference_is_no_hand() -> None:
    run = run_of(ROBOT, 2)
    reference = run.reference
    assert reference is not None
    late = reference.time > 40.0
    leapt = replace(reference, x=reference.x + 0.4 * late, yaw=reference.yaw + 0.5 * late)
    assert with_no_driving(replace(run, reference=leapt), ROBOT).no_driving == ()


def test_all_verbs_leave_it_out_and_find_what_they_find_without_it() -> None:
    wide = replace(ROBOT, wheel_separation_multiplier=1.03)
    runs = [held(run_of(wide, 1), 30.0, 36.0)[0], carried(run_of(wide, 4), 45.0, 3.0)]
    assert look_for_mistakes(runs, ROBOT).findings == ()
    judged = compare(runs, ROBOT).prepared
    cut = [part for run in match_for_fit(runs, ROBOT, 1.0) for part in run.record.left_out]
    assert [part for part in judged.left_out if part.why != "reference"] == cut
    assert {part.why for part in cut} == {"held", "carried"}
    diagnosis = diagnose(runs, ROBOT, [find("track_width"), find("lateral_slip")])
    assert diagnosis.effect == "track_width"
    fitted = diagnosis.robot.wheel_separation_multiplier
    assert fitted == pytest.approx(1.03, abs=0.003)
    told = [part for part in diagnosis.left_out if part.why != "reference"]
    assert told == cut
    assert "the wheels turned and the robot did not: held" in left_out_words(cut)[0]


def test_a_clock_of_the_day_is_told_from_the_start_of_the_drive() -> None:
    run, begin, _ = held(run_of(ROBOT, 1), 30.0, 36.0)
    reference = run.reference
    assert reference is not None
    day = 1.7e9
    run = replace(
        run,
        ticks=replace(run.ticks, time=run.ticks.time + day),
        reference=replace(reference, time=reference.time + day),
    )
    (stretch, *_) = compare([run], ROBOT).left_out
    assert stretch.begin == pytest.approx(begin + day, abs=NEAR)
    told = float(left_out_words([stretch])[0].split()[1])
    assert told == pytest.approx(begin - float(run.ticks.time[0]) + day, abs=NEAR)


@with_recordings
def test_nobody_held_the_recorded_robots() -> None:
    count = 0
    for file in sorted(ROBOTS.glob("*/robot.yaml")):
        source = read_robot_file(file)
        for folder in sorted(each for each in file.parent.iterdir() if each.is_dir()):
            run = with_no_driving(read_run(folder, source), source.robot, source.limits)
            assert run.no_driving == (), folder
            count += 1
    assert count
