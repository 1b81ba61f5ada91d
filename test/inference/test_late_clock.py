# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Clocks that are seconds apart change when things were seen, and nothing else that is told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, common, run_by, run_of, runs_of
from test.inference.test_gyro_bias import BIAS, INCREMENTAL, by_gyro, short_drive
from test.model.drives import ROBOT
from test.recorded_robots import ROBOTS, with_recordings
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.adding.start_values import drives_of
from werrimbi_odom.inference.comparison.judged_legs import figures_of, statistics_of
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.effect_support import able
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.legs.matched_run import at_edges
from werrimbi_odom.inference.legs.usable_run import with_no_driving
from werrimbi_odom.inference.set_up.clock_offset_search import lag_of
from werrimbi_odom.inference.set_up.records import record_of

LATE = 1.0
LATE_ROBOT = replace(ROBOT, effects=(find("reference_delay").using(delay=LATE),))


def later(run: Run, delay: float) -> Run:
    assert run.reference is not None
    gone = tuple((begin + delay, end + delay) for begin, end in run.taken_out)
    seen = replace(run.reference, time=run.reference.time + delay)
    return replace(run, reference=seen, taken_out=gone)


def test_a_late_gyros_bias_is_told_where_the_robot_stood() -> None:
    """It still turns by its own stamps for a second after the wheels stopped."""
    run = short_drive()
    seen = with_no_driving(later(run, LATE), LATE_ROBOT).reference
    assert run.reference is not None
    assert seen is not None
    bias = (run.reference.yaw - seen.yaw)[-1] / (seen.time[-1] - seen.time[0])
    assert bias == pytest.approx(BIAS, abs=5e-4)


def test_the_robot_files_delay_moves_no_leg() -> None:
    run = short_drive()
    run = replace(run, happened=((10.0, 10.2),), taken_out=((12.0, 12.5),))
    late = replace(later(run, LATE), happened=((10.0 + LATE, 10.2 + LATE),))
    (plain,) = match_for_fit([run], ROBOT, 0.5)
    (other,) = match_for_fit([late], LATE_ROBOT, 0.5)
    assert other.delay == LATE
    np.testing.assert_array_equal(other.gap, plain.gap)
    np.testing.assert_array_equal(other.stepped, plain.stepped)
    assert plain.gap.any()
    assert plain.stepped.any()
    # A pose just where a leg is full may belong to either side of it: stamps are rounded.
    np.testing.assert_allclose(other.rows, plain.rows, atol=1)
    np.testing.assert_allclose(other.measured.time, plain.measured.time, atol=0.06)


@with_recordings
@pytest.mark.parametrize(
    ("delay", "aside"),
    [
        in_evidence(1.0, "part_2"),
        in_evidence(-0.5, "part_2"),
        in_evidence(0.5, "part_2"),
        in_evidence(2.0, "part_0"),
    ],
)
def test_a_late_gyro_is_all_that_is_wrong_with_the_sound_kobuki(delay: float, aside: str) -> None:
    """Legs and rests by the late clock were told as a backlash, and as a skew of the encoders."""
    folder = ROBOTS / "kobuki_sound"
    robot = read_robot_file(folder / "robot.yaml").robot
    runs = [later(read_run_folder(each), delay) for each in sorted(folder.glob("part_*"))]
    fitted = [run for run in runs if run.name != aside]
    kept = [run for run in runs if run.name == aside]
    found = diagnose(fitted, robot, LIBRARY, INCREMENTAL, holdout=kept)
    assert set(found.found) == {"reference_delay", "track_width"}
    values = {item.name: item.values for item in found.final.point.model.robot.effects}
    assert values["reference_delay"]["delay"] == pytest.approx(delay + 0.073, abs=0.005)


NARROW = replace(ROBOT, wheel_separation=ROBOT.wheel_separation / 1.036)


def square(seed: int) -> Run:
    """Four sides of three metres, and four turns to the right on the spot, by a gyro 60 ms late."""
    side, turn, rest = np.ones(300), np.ones(31), np.zeros(10)
    speed = np.tile(np.concatenate([0.2 * side, rest, 0.0 * turn, rest]), 4)
    rate = np.tile(np.concatenate([0.0 * side, rest, -turn, rest]), 4)
    return later(by_gyro(speed, rate, 1.0, 0.0, seed), 0.06)


@pytest.mark.evidence
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_one_square_a_late_gyro_is_named(seed: int) -> None:
    """It was *unknown*, with the acceleration.

    What explains nine tenths of few squares was taken to explain all of them.
    """
    found = diagnose([square(seed)], NARROW, COMMON, INCREMENTAL)
    assert set(found.found) == {"reference_delay", "track_width"}
    values = {item.name: item.values for item in found.final.point.model.robot.effects}
    assert values["reference_delay"]["delay"] == pytest.approx(0.06, abs=0.004)


@pytest.mark.evidence
def test_a_late_clock_that_drifts_is_one_effect() -> None:
    """The mean delay was told as a mistake, and the drift beside it: both were added."""
    starts, rates = (0.55, 0.6, 0.7), (1e-3, -5e-4, 2e-3)
    runs = []
    for seed, (start, rate) in enumerate(zip(starts, rates, strict=True)):
        run = run_of(ROBOT, seed, 60)
        assert run.reference is not None
        time = start + (1.0 + rate) * run.reference.time
        runs.append(replace(run, reference=replace(run.reference, time=time)))
    effects = common("reference_clock_drift")
    found = diagnose(runs, ROBOT, effects, EvaluationOptions(leg=0.5))
    assert found.found == ("reference_clock_drift",)
    assert not found.set_up.findings
    (drift,) = found.final.point.model.robot.effects
    assert drift.name == "reference_clock_drift"
    for key, truth in (("delay", starts), ("rate", rates)):
        values = [own[f"reference_clock_drift.{key}"] for own in found.final.point.model.own]
        assert values == pytest.approx(truth, abs={"delay": 0.01, "rate": 3e-4}[key])
    mended = replace(ROBOT, effects=(find("reference_clock_drift").using(),))
    assert diagnose(runs, mended, effects, EvaluationOptions(leg=0.5)).verdict == "none"


@pytest.mark.evidence
def test_a_drifting_clock_takes_the_place_of_a_late_one_behind_another_effect() -> None:
    """First the kick, then the delay, then the drift in its place: two effects of three rounds."""
    truth = replace(ROBOT, effects=(find("castor_kick").using(angle=0.05, length=0.05),))
    few = [find(name) for name in ("castor_kick", "reference_delay", "reference_clock_drift")]
    runs = []
    for run in runs_of(truth, (1, 2), 45):
        assert run.reference is not None
        seconds = run.reference.time - run.reference.time[0]
        clock = run.reference.time + 0.05 + 1e-4 * seconds
        runs.append(replace(run, reference=replace(run.reference, time=clock)))
    found = diagnose(runs, ROBOT, few)
    assert found.final.names == ("castor_kick", "reference_clock_drift")
    assert set(found.found) == set(found.final.names)
    assert found.verdict == "named"
    chances = {each.effect: each.p_value for each in found.ranking}
    assert all(chances[name] < 1e-3 for name in found.final.names)


def test_no_clock_drifts_that_the_recorders_shows_to_keep_its_rate() -> None:
    runs = [run_of(ROBOT, seed, 30) for seed in (1, 2)]
    shown = [
        replace(run, reference=replace(run.reference, one_rate=True))
        for run in runs
        if run.reference is not None
    ]
    asked = [
        {each.name for each in able(LIBRARY, concatenated(match_for_fit(of, ROBOT, 0.5)), ROBOT)}
        for of in (runs, [shown[0], runs[1]], shown)
    ]
    assert asked[0] == asked[1]
    assert asked[0] - asked[2] == {"reference_clock_drift"}


def kept(runs: list[Run]) -> list[Run]:
    return list(set_aside(runs)[0])


def wavy(seed: int) -> Run:
    """Forty curves of one and a half seconds each, some sharper than others."""
    rates = np.random.default_rng(seed).normal(0.0, 0.6, 40).repeat(30)
    return by_gyro(np.full(rates.size, 0.3), rates, 1.0, 0.0, seed)


@pytest.mark.parametrize("delay", [LATE, -2.0])
def test_where_nothing_is_measured_no_motion_is_compared(delay: float) -> None:
    """Headings drawn straight across what was put aside were a third of what no lag explains.

    So a lag of 0.6 s was told that was not there, and what agrees was left out as carried.
    """
    (run,) = kept([later(wavy(1), delay)])
    assert run.taken_out
    lag, gain = _lag_in(run)
    assert lag == pytest.approx(delay, abs=0.02)
    assert gain > 30.0
    silent = replace(run, taken_out=())
    assert _lag_in(silent) == pytest.approx((lag, gain))


@pytest.mark.parametrize("seed", [5, *(in_evidence(n) for n in (15, 39))])
def test_rare_positions_show_no_lag_that_is_not_there(seed: int) -> None:
    """A line from pose to pose was compared with wheels that turn in between.

    Of 99 sound drives with 17 to 60 poses, two were told with a clock half a second off.
    """
    true = WhiteNoiseRobot(0.35, 0.05, 0.05, 5e-4, 5e-4)
    random = np.random.default_rng(seed)
    run = drive(true, wandering(random, 50.0), random, sigma_xy=0.05, every=125)
    run.reference.yaw[:] = np.nan
    for delay in (0.0, 1.5):
        record = record_of(later(run, delay), true.entered(0.05), None)
        assert record is not None
        assert lag_of([record])[0] == pytest.approx(delay, abs=0.25)


@pytest.mark.parametrize(("after", "leap"), [(0.01, 1.7e9), in_evidence(20.0, 3600.0)])
def test_a_clock_that_leaps_forwards_hides_no_lag(after: float, leap: float) -> None:
    """The first message may come before a computer knows the time: 54 years pass until the next.

    They were all looked through in steps of a tenth of a second, which no memory holds; and an hour
    at rest made every turn of the minutes around it an outlier.
    """
    run = later(run_of(ROBOT, 1, 60), 2.0)
    seen, ticks = run.reference, run.ticks
    assert seen is not None
    times = (np.where(each.time > after, each.time + leap, each.time) for each in (ticks, seen))
    ticks, seen = (replace(each, time=t) for each, t in zip((ticks, seen), times, strict=True))
    lag, gain = _lag_in(replace(run, ticks=ticks, reference=seen))
    assert lag == pytest.approx(2.0, abs=0.02)
    assert gain > 30.0


@pytest.mark.parametrize("noise", [0.0, 5e-3])
def test_a_long_rest_hides_no_lag(noise: float) -> None:
    """Where it stood for 25 minutes after one of driving, every turn was taken for an outlier."""
    run, random = run_of(ROBOT, 1, 60), np.random.default_rng(0)
    ticks, seen = run.ticks, run.reference
    assert seen is not None
    rest = 0.2 * np.arange(1.0, 7500.0)
    x, y, yaw = (
        np.append(each, each[-1] + random.normal(0.0, noise, rest.size))
        for each in (seen.x, seen.y, seen.yaw)
    )
    seen = replace(seen, time=np.append(seen.time, seen.time[-1] + rest), x=x, y=y, yaw=yaw)
    left, right = (
        np.append(side, np.full(rest.size, side[-1])) for side in (ticks.left, ticks.right)
    )
    ticks = replace(
        ticks, time=np.append(ticks.time, ticks.time[-1] + rest), left=left, right=right
    )
    lag, gain = _lag_in(later(replace(run, ticks=ticks, reference=seen), 2.0))
    assert lag == pytest.approx(2.0, abs=0.02)
    assert gain > 30.0


def _lag_in(run: Run) -> tuple[float, float]:
    record = record_of(run, ROBOT, None)
    assert record is not None
    return lag_of([record])


@pytest.mark.parametrize("delay", [LATE, in_evidence(-LATE)])
def test_a_jump_is_left_out_of_a_fit_by_another_clock(delay: float) -> None:
    """The delay as fitted is another than that by which drives were cut.

    `add` ended in an IndexError, or left out a leg of a second later.
    """
    run = run_by(ROBOT, np.full(400, 0.3), np.full(400, 0.2))
    assert run.reference is not None
    jump = 10.0
    x = run.reference.x + 0.3 * (run.reference.time >= jump)
    run = replace(run, reference=replace(run.reference, x=x))
    apart = replace(ROBOT, effects=(find("reference_delay").using(delay=delay),))
    options = EvaluationOptions(leg=0.5, reference_kind="local_map")
    for first, then in ((ROBOT, apart), (apart, ROBOT)):
        drives = drives_of(prepare([run], first, options), then, options)
        (legs,), (skipped,) = drives.laid.runs, drives.skipped
        stamps = legs.measured.time + legs.delay
        with_jump = (stamps[:-1] < jump - 0.01) & (stamps[1:] > jump - 0.01)
        np.testing.assert_array_equal(skipped & ~at_edges([legs])[0], with_jump)


def test_add_and_compare_judge_a_late_clocks_drives_alike() -> None:
    """By the delay that is written, not by the rough one of the set-up search."""
    robot, random = WhiteNoiseRobot(left_noise=4e-4, right_noise=5e-4), np.random.default_rng(5)
    runs = [
        replace(later(drive(robot, wandering(random, 30.0), random), 0.413), name=f"drive {number}")
        for number in range(3)
    ]
    known = EvaluationOptions(sigma_xy=1e-3, sigma_yaw=2e-3)  # else each estimates it by its robot
    late = [find("reference_delay")]
    added = add_effects(late, runs[:2], robot.entered(), known, holdout=runs[2:])
    here = statistics_of(added.holdout.after)
    there = figures_of(prepare(runs[2:], added.robot, known), added.robot)
    assert here.count == there.count
    assert here.rmse_position_m == pytest.approx(there.rmse_position_m, rel=1e-5)
    assert here.nees == pytest.approx(there.nees, rel=1e-3)
