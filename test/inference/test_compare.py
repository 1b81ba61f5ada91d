# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Comparing: figures and words that tell what is hidden in the data, and nothing that is not."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import run_by, swapped
from test.model.drives import ROBOT
from test.white_noise_robot import WhiteNoiseRobot, drive, square, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.compare import Comparison, compare, judged
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.comparison.verdict import verdict_of
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.comparison.as_json import json_of
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.terminal import as_text

TRUE = WhiteNoiseRobot(left_noise=5e-4, right_noise=5e-4)
RIGHT = Robot(
    0.35,
    0.05,
    2000.0,
    2000.0,
    TRUE.separation / 0.35,
    TRUE.left_radius / 0.05,
    TRUE.right_radius / 0.05,
    left_wheel_noise=5e-4,
    right_wheel_noise=5e-4,
)


def recorded(seed: int, *, seconds: float = 120.0, every: int = 3) -> Run:
    random = np.random.default_rng(seed)
    commands = [square(1.5, sense) for sense in (1.0, -1.0)]
    speed, rate = (np.concatenate([one, two]) for one, two in zip(*commands, strict=True))
    free = wandering(random, seconds)
    joined = np.concatenate([free[0], speed]), np.concatenate([free[1], rate])
    seen = drive(TRUE, joined, random, every=every)
    return Run(
        f"run_{seed}",
        Path(f"run_{seed}"),
        Ticks(seen.ticks.time, seen.ticks.left, seen.ticks.right),
        Reference(seen.reference.time, seen.reference.x, seen.reference.y, seen.reference.yaw),
    )


@pytest.fixture(scope="module")
def runs() -> tuple[Run, ...]:
    return tuple(recorded(seed) for seed in range(60, 64))


@pytest.fixture(scope="module")
def right(runs: tuple[Run, ...]) -> Comparison:
    """These runs by the true model."""
    return compare(runs, RIGHT)


def with_reference(run: Run, **columns: np.ndarray) -> Run:
    assert run.reference is not None
    return replace(run, reference=replace(run.reference, **columns))


def without(run: Run, *names: str) -> Run:
    assert run.reference is not None
    nothing = np.full(run.reference.time.size, np.nan)
    return with_reference(run, **dict.fromkeys(names, nothing))


def flat(comparison: Comparison) -> str:
    return " ".join(as_text(words_of(comparison)).split())


def test_a_true_model_is_called_good_and_its_covariance_honest(right: Comparison) -> None:
    assert verdict_of(right).good
    words = flat(right)
    assert words.startswith("The model explains these drives")
    assert "Next" not in words
    # 600 legs of 3 degrees of freedom: mean and coverage scatter by 0.04 and 0.01.
    figures = right.main.all.figures
    assert figures.nees == pytest.approx(1.0, abs=0.15)
    assert figures.coverage_95 == pytest.approx(0.95, abs=0.035)


def test_the_noise_of_the_reference_is_found_whatever_is_wrong_with_the_model(
    runs: tuple[Run, ...], right: Comparison
) -> None:
    wrong = replace(
        RIGHT,
        wheel_separation_multiplier=0.9,
        left_wheel_radius_multiplier=1.1,
        left_wheel_noise=5e-5,
        right_wheel_noise=5e-3,
    )
    for found in (right, compare(runs, wrong)):
        ((_, noise),) = found.prepared.noises
        assert noise.sigma_xy == pytest.approx(1e-3, rel=0.08)
        assert noise.sigma_yaw == pytest.approx(2e-3, rel=0.08)
        assert (noise.xy_told, noise.yaw_told) == ("estimated", "estimated")


def test_a_base_two_percent_too_small_goes_wrong_in_turns_and_not_on_lines(
    runs: tuple[Run, ...],
) -> None:
    small = replace(RIGHT, wheel_separation_multiplier=0.98 * RIGHT.wheel_separation_multiplier)
    words = flat(compare(runs, small))
    assert "The model goes wrong in curves and spins." in words
    assert re.search(r"Straight driving: errors of a leg [^,]*, as promised", words)
    (share,) = re.findall(r"Spins: the robot turns ([\d.]+) ± [\d.]+ % less than the model", words)
    assert float(share) == pytest.approx(2.0, abs=0.2)
    assert "says which physical effect explains it" in words


@pytest.mark.parametrize("ahead", [0.028, -0.02])
def test_a_marker_ahead_of_the_axle_goes_aside_in_curves(
    runs: tuple[Run, ...], ahead: float
) -> None:
    """Forth and back, by travel times turn, it was "nothing systematic" and a noise 110 times."""
    moved = []
    for run in runs:
        seen = run.reference
        assert seen is not None
        place = seen.x + 1j * seen.y + ahead * np.exp(1j * seen.yaw)
        moved.append(with_reference(run, x=place.real, y=place.imag))
    found = compare(moved, RIGHT)
    (part,) = [
        each
        for each in verdict_of(found).systematic
        if each.channel == "sideways" and each.kind == "arc"
    ]
    assert part.per == "sine of turn"
    assert part.value == pytest.approx(ahead, abs=max(4.0 * part.std, 0.1 * abs(ahead)))


def test_a_larger_left_wheel_veers_to_the_right(runs: tuple[Run, ...]) -> None:
    # The robot file believes the left wheel smaller than it is.
    believed = RIGHT.left_wheel_radius_multiplier / 1.01
    words = flat(compare(runs, replace(RIGHT, left_wheel_radius_multiplier=believed)))
    found = re.findall(
        r"Straight driving:.*? veers to the right by ([\d.]+) ± [\d.]+° per metre", words
    )
    # 1 % of a metre more on the left, over the base, is 0.01 / 0.353 rad.
    assert float(found[0]) == pytest.approx(np.degrees(0.01 / TRUE.separation), rel=0.1)


def test_a_wheel_noise_ten_times_too_small_makes_the_covariance_too_small(
    runs: tuple[Run, ...],
) -> None:
    sure = replace(RIGHT, left_wheel_noise=5e-5, right_wheel_noise=5e-5)
    found = compare(runs, sure)
    words = flat(found)
    assert words.startswith("Nothing systematic is seen, but the errors are larger than")
    assert "times too small over legs" in words
    low, high = (np.sqrt(bound) for bound in verdict_of(found).factor[1:])
    assert low < 10.0 < high
    assert found.main.systematic
    assert not any(part.finding for part in found.main.systematic)


def test_a_wheel_noise_that_only_the_few_longest_legs_show_is_nothing_systematic() -> None:
    """1.6 times what is stated: of three short drives 17 legs of 8 m show it, and no shorter."""
    few = tuple(recorded(seed, seconds=60.0) for seed in range(1240, 1243))
    found = compare(few, replace(RIGHT, left_wheel_noise=3.1e-4, right_wheel_noise=3.1e-4))
    verdict = verdict_of(found)
    assert (verdict.noise, verdict.judged_at) == ("too small", 8.0)
    assert verdict.factor.low < 1.6**2 < verdict.factor.high
    words = flat(found)
    assert words.startswith("Nothing systematic is seen, but the errors are larger than")
    assert "times too small over legs of 8 m" in words


@pytest.mark.parametrize("every", [15, 20])
def test_a_reference_that_scatters_for_a_while_is_no_noise_of_the_wheels(every: int) -> None:
    """Satellites float for a third of the drive: "k were 60 times", where longer legs left 18."""
    run = recorded(60, every=every)
    assert run.reference is not None
    time = run.reference.time - run.reference.time[0]
    off = np.random.default_rng(0).normal(0.0, 0.01, (2, time.size))
    off[:, (time < 20.0) | (time > 60.0)] = 0.0
    places = {"x": run.reference.x + off[0], "y": run.reference.y + off[1]}
    found = compare([with_reference(run, **places)], RIGHT)
    assert verdict_of(found).noise == "comes and goes"
    words = flat(found)
    assert "which no noise of the wheels does" in words
    assert "wheels' noise k were" not in words


def test_a_wheel_noise_ten_times_too_large_makes_it_too_large(runs: tuple[Run, ...]) -> None:
    unsure = replace(RIGHT, left_wheel_noise=5e-3, right_wheel_noise=5e-3)
    words = flat(compare(runs, unsure))
    assert words.startswith("The model is right, and better than its covariance says.")
    assert "too large" in words


def test_exchanged_wheels_are_no_matter_of_calibration(runs: tuple[Run, ...]) -> None:
    found = compare([swapped(run) for run in runs], RIGHT)
    assert verdict_of(found).gross
    words = flat(found)
    assert words.startswith("The model is grossly wrong")
    assert "turns the other way" in words


@pytest.mark.parametrize(
    ("unmeasured", "freedom"), [(("yaw",), 2), (("x", "y"), 1)], ids=["position", "heading"]
)
def test_references_of_positions_or_headings_alone_are_judged_honestly(
    runs: tuple[Run, ...], unmeasured: tuple[str, ...], freedom: int
) -> None:
    found = compare([without(run, *unmeasured) for run in runs], RIGHT)
    figures = found.main.all.figures
    assert set(found.legs.errors.freedom.tolist()) == {freedom}
    assert figures.nees == pytest.approx(1.0, abs=0.2)
    assert figures.coverage_95 == pytest.approx(0.95, abs=0.04)
    assert np.isnan(figures.rmse_position_m) == (freedom == 1)
    assert np.isnan(figures.rmse_yaw_rad) == (freedom == 2)
    assert np.isnan(found.runs[0].end_error_m) == (freedom == 1)
    assert "goes wrong" not in flat(found)


def test_a_gyro_that_shows_too_little_is_told_beside_a_base(runs: tuple[Run, ...]) -> None:
    said = find("track_width").indistinguishable_from
    (twin,) = (each for each in said if each.name == "reference_scale")
    small = replace(RIGHT, wheel_separation_multiplier=0.98 * RIGHT.wheel_separation_multiplier)
    by_gyro = flat(compare([without(run, "x", "y") for run in runs], small))
    assert "% less than the model says" in by_gyro
    assert twin.told_apart_by in by_gyro
    assert twin.do in by_gyro
    assert twin.told_apart_by not in flat(compare(runs, small)), "positions tell them apart"
    half = replace(RIGHT, wheel_separation_multiplier=0.6 * RIGHT.wheel_separation_multiplier)
    no_gyro = flat(compare([without(run, "x", "y") for run in runs], half))
    assert twin.do not in no_gyro, "no gyro is so far off"


@pytest.mark.evidence
def test_a_bad_spin_shows_in_positions_alone_and_does_not_spoil_what_follows(
    runs: tuple[Run, ...],
) -> None:
    blind = [without(run, "yaw") for run in runs]
    small = replace(RIGHT, wheel_separation_multiplier=0.9 * RIGHT.wheel_separation_multiplier)
    figures = compare(blind, small).main.all
    assert figures.figures.nees > 3.0
    # A heading that is never corrected would be off by radians at the end of each drive.
    assert figures.figures.median_position_m < 0.1


def test_runs_whose_references_differ_are_judged_together(runs: tuple[Run, ...]) -> None:
    mixed = compare([runs[0], without(runs[1], "yaw"), without(runs[2], "x", "y")], RIGHT)
    assert mixed.prepared.measures == ("pose", "position", "heading")
    assert (np.diff(mixed.legs.run) >= 0).all()
    assert sum(item.legs.figures.count for item in mixed.runs) == mixed.main.all.figures.count
    alone = compare([runs[0]], RIGHT)
    ours = mixed.legs.errors.error[mixed.legs.run == 0]
    np.testing.assert_allclose(ours, alone.legs.errors.error, atol=1e-12)


def test_two_poses_a_drive_are_one_leg_each(runs: tuple[Run, ...]) -> None:
    ends = []
    for run in runs:
        assert run.reference is not None
        two = {name: getattr(run.reference, name)[[0, -1]] for name in ("time", "x", "y", "yaw")}
        ends.append(with_reference(run, **two))
    found = compare(ends, RIGHT)
    assert found.main.all.figures.count == len(runs)
    assert flat(found).startswith("Too little to judge: 4 legs")
    np.testing.assert_allclose(
        [item.end_error_m for item in found.runs], found.legs.errors.distance, atol=1e-9
    )


def test_two_poses_a_drive_and_radii_five_percent_off_are_no_mistake_of_the_set_up() -> None:
    """The leg is the drive, of 2.5 m: it errs by more than a tenth of the metre asked for."""
    random = np.random.default_rng(4)
    ahead = np.linspace(0.0, 2.5, 200)
    counts = np.round(ahead / RIGHT.left_tick)
    ends = np.array([0.0, 2.5])
    drives = [
        Run(f"{index}", Path(f"{index}"), Ticks(ahead, counts, counts), reference)
        for index in range(12)
        for reference in [Reference(ends, ends + random.normal(0.0, 0.001, 2), 0 * ends, 0 * ends)]
    ]
    found = compare(drives, replace(RIGHT, wheel_radius=0.95 * RIGHT.wheel_radius))
    assert found.main.all.figures.median_position_m > 0.1
    assert not verdict_of(found).gross
    assert verdict_of(compare(drives, replace(RIGHT, wheel_radius=0.8 * RIGHT.wheel_radius))).gross


def test_one_pose_a_second_is_enough(runs: tuple[Run, ...]) -> None:
    slow = []
    for run in runs:
        assert run.reference is not None
        rows = slice(None, None, 17)
        fewer = {name: getattr(run.reference, name)[rows] for name in ("time", "x", "y", "yaw")}
        slow.append(with_reference(run, **fewer))
    found = compare(slow, RIGHT)
    assert 0.6 < found.main.all.figures.nees < 1.3
    assert "goes wrong" not in flat(found)


def shifted(run: Run, at: float, by: float, last: int | None = None) -> Run:
    assert run.reference is not None
    first = int(at * run.reference.time.size)
    rows = slice(first, None if last is None else first + last)
    x = run.reference.x.copy()
    x[rows] += by
    return with_reference(run, x=x)


def test_a_tracker_that_jumps_spoils_the_leg_on_which_it_does_and_no_other(
    runs: tuple[Run, ...], right: Comparison
) -> None:
    found = compare([shifted(runs[0], 0.4, 0.3), *runs[1:]], RIGHT)
    assert right.main.all.outliers == 0
    assert found.main.all.outliers == 1
    assert found.legs.run[found.legs.outlier].tolist() == [0]
    assert found.main.all.rmse_all_position_m > 2.0 * found.main.all.figures.rmse_position_m
    assert found.main.all.figures.rmse_position_m == pytest.approx(
        right.main.all.figures.rmse_position_m, rel=0.02
    )
    assert "On 1 of" in flat(found)
    assert verdict_of(found).good
    ((moment,),) = [json_of(found)["outliers"]]
    assert runs[0].reference is not None
    jumped = runs[0].reference.time[int(0.4 * runs[0].reference.time.size)]
    assert moment["t_start_s"] <= jumped <= moment["t_end_s"]


@pytest.mark.evidence
def test_a_wrong_model_is_no_jump_of_the_reference(runs: tuple[Run, ...]) -> None:
    for robot in (
        replace(RIGHT, wheel_separation_multiplier=2.0),
        replace(RIGHT, wheel_radius=0.1),
        replace(RIGHT, wheel_radius=0.0125),
    ):
        assert compare(runs, robot).main.all.outliers == 0


def test_a_marker_beside_the_axle_does_not_jump_while_it_is_not_seen() -> None:
    """On the spot the wheels go nowhere, and a marker 6 cm ahead of them 2 cm in half a second."""
    one, spin = np.ones(100), np.ones(200)
    speed = np.tile(np.concatenate([0.3 * one, 0.0 * spin]), 20)
    rate = np.concatenate([[*(0.0 * one), *(sense * 0.7 * spin)] for sense in [1.0, -1.0] * 10])
    made = drive(TRUE, (speed, rate), np.random.default_rng(1), every=1, sigma_xy=3e-4)
    seen = made.reference
    since = np.mod(seen.time, 6.0)
    unseen = (since > 3.7) & (since < 4.2) & (np.mod(seen.time, 24.0) < 6.0)
    rows = ~unseen
    x, y = seen.x + 0.06 * np.cos(seen.yaw), seen.y + 0.06 * np.sin(seen.yaw)
    reference = Reference(seen.time[rows], x[rows], y[rows], seen.yaw[rows])
    ticks = Ticks(made.ticks.time, made.ticks.left, made.ticks.right)
    found = compare([Run("spins", Path("spins"), ticks, reference)], RIGHT)
    assert [part for part in found.left_out if part.why == "reference"] == []


def test_what_a_quarter_of_the_intervals_do_is_no_jump() -> None:
    """A scan matcher that sees no turn in most intervals, and in others one that was not driven."""
    random = np.random.default_rng(3)
    steps = 300
    time = np.arange(steps + 1.0)
    ahead = 0.15 * time
    counts = np.round(
        ahead / (2.0 * math.pi * RIGHT.wheel_radius) * RIGHT.left_ticks_per_revolution
    )
    turned = np.where(random.random(steps) < 0.25, random.normal(0.0, 0.005, steps), 0.0)
    yaw = np.concatenate([[0.0], np.cumsum(turned)])
    x, y = (
        np.concatenate([[0.0], np.cumsum(0.15 * along(yaw[:-1]) + random.normal(0, 0.01, steps))])
        for along in (np.cos, np.sin)
    )
    run = Run("straight", Path("straight"), Ticks(time, counts, counts), Reference(time, x, y, yaw))
    found = compare([run], RIGHT, EvaluationOptions(reference_kind="incremental"))
    assert found.main.all.outliers == 0


def test_noise_of_a_camera_that_is_alike_at_all_lengths_is_not_put_down_to_the_wheels() -> None:
    """Tags that are measured worse from afar: legs of 0.25 m err as those of 4 m."""
    runs = []
    for seed in (0, 1):
        random = np.random.default_rng(seed)
        run = drive(TRUE, wandering(random, 90.0), random, every=5, sigma_xy=0.0, sigma_yaw=0.0)
        assert run.reference is not None
        afar = (run.reference.x % 3.0) / 3.0
        errors = (0.005 + 0.03 * afar) * random.normal(size=(3, afar.size))
        told = {
            name: getattr(run.reference, name) + error
            for name, error in zip(("x", "y", "yaw"), errors, strict=True)
        }
        seen = with_reference(run, **told)
        assert seen.reference is not None
        runs.append(
            replace(seen, path=Path(f"{seed}"), reference=seen.reference.chosen(afar < 0.8))
        )
    found = compare(runs, RIGHT)
    assert verdict_of(found).noise == "comes and goes"
    words = as_text(words_of(found))
    assert "wheels' noise k" not in words
    assert "the reference's own noise" in " ".join(words.split())
    quiet = replace(RIGHT, left_wheel_noise=2.5e-5, right_wheel_noise=2.5e-5)
    assert verdict_of(compare([recorded(7)], quiet)).noise == "too small", "a noise of wheels is"


def test_a_heading_in_whole_degrees_does_not_jump_from_one_to_the_next() -> None:
    """In a wide curve steps are rare, and far from what most intervals err by.

    One that jumps by many of its steps still does.
    """
    random = np.random.default_rng(4)
    curve = np.full(1500, 0.3), np.full(1500, 0.02)
    run = drive(TRUE, curve, random, every=3, sigma_yaw=2e-4)
    assert run.reference is not None
    whole = np.radians(np.rint(np.degrees(run.reference.yaw)))
    by_degrees = with_reference(run, yaw=whole)
    (group,) = prepare([by_degrees], RIGHT).groups
    assert not group.jumps[0].any()
    assert compare([by_degrees], RIGHT).main.all.outliers == 0
    late = run.reference.time > np.quantile(run.reference.time, 0.6)
    lost = with_reference(run, yaw=whole + np.radians(10.0) * late)
    (group,) = prepare([lost], RIGHT).groups
    assert np.flatnonzero(group.jumps[0].any(axis=1)).tolist() == [np.flatnonzero(late)[0] - 1]


def test_fixes_at_fifty_hertz_that_scatter_by_a_third_of_their_spacing_are_no_jumps() -> None:
    """An RTK receiver: quiet while the robot stands, shaken while it drives at 1.2 m/s."""
    random = np.random.default_rng(8)
    time = np.arange(0.0, 160.0, 0.02)
    drives = (time % 20.0) > 8.0
    ahead = 1.2 * 0.02 * np.cumsum(drives)
    counts = np.round(
        ahead / (2.0 * math.pi * RIGHT.wheel_radius) * RIGHT.left_ticks_per_revolution
    )
    sigma = np.where(drives, 0.005, 0.001)
    shaken = random.standard_t(4, (3, time.size)) * sigma
    reference = Reference(time, ahead + shaken[0], shaken[1], shaken[2])
    run = Run("rtk", Path("rtk"), Ticks(time, counts, counts), reference)
    clean = compare([run], RIGHT)
    assert clean.main.all.outliers <= 0.02 * clean.legs.run.size
    lost = compare([shifted(run, 0.6, 0.3)], RIGHT)
    assert 1 <= lost.main.all.outliers <= clean.main.all.outliers + 1
    spiked = compare([shifted(run, 0.6, 0.3, last=2)], RIGHT)
    assert spiked.main.all.outliers <= clean.main.all.outliers + 1


def test_noise_that_keeps_to_an_axis_of_the_room_is_no_jump_where_the_robot_turns() -> None:
    """Scans between two walls that are far apart: sideways noise of a robot that has turned."""
    random = np.random.default_rng(2)
    time = np.arange(0.0, 44.0, 0.1)
    speed, turning = np.where(time < 40.0, 0.2, 0.0), np.where(time < 40.0, 0.0, 0.4)
    run = run_by(ROBOT, np.repeat(speed, 2), np.repeat(turning, 2))
    assert run.reference is not None
    seen = run.reference.time
    along, across, askew = random.normal(size=(3, seen.size)) * [[3e-3], [1e-4], [2e-3]]
    x = np.minimum(0.2 * seen, run.reference.x[-1]) + along
    yaw = 0.4 * np.maximum(seen - 40.0, 0.0) + askew
    (group,) = prepare([with_reference(run, x=x, y=across, yaw=yaw)], ROBOT).groups
    assert not group.jumps[0].any()


def test_before_and_after_are_over_the_same_legs(runs: tuple[Run, ...]) -> None:
    wrong = replace(RIGHT, wheel_radius=0.06)
    prepared = prepare([shifted(runs[0], 0.4, 0.3), *runs[1:]], wrong)
    before, after = judged(prepared, wrong), judged(prepared, RIGHT)
    np.testing.assert_array_equal(before.legs.start_time, after.legs.start_time)
    np.testing.assert_array_equal(before.legs.outlier, after.legs.outlier)
    assert after.main.all.figures.rmse_position_m < 0.1 * before.main.all.figures.rmse_position_m


def test_a_model_with_values_of_the_runs_own_is_taken_as_well(
    runs: tuple[Run, ...], right: Comparison
) -> None:
    found = compare(runs, Model(RIGHT, tuple({} for _ in runs)))
    np.testing.assert_array_equal(found.legs.errors.error, right.legs.errors.error)


def test_a_floor_that_pulls_one_way_goes_with_the_heading(runs: tuple[Run, ...]) -> None:
    drifting = []
    for run in runs:
        assert run.reference is not None
        path = np.concatenate(
            [[0.0], np.cumsum(np.hypot(*np.diff([run.reference.x, run.reference.y])))]
        )
        drifting.append(with_reference(run, x=run.reference.x + 0.01 * path))
    found = compare(drifting, RIGHT)
    assert not verdict_of(found).mean_is_right
    words = flat(found)
    assert re.search(r"(along the way|sideways error).* go(es)? with the heading", words)


@pytest.mark.parametrize("headings", [in_evidence(0), 1])
def test_positions_alone_have_no_increments(runs: tuple[Run, ...], headings: int) -> None:
    """Fits had no data, and diagnose said that nothing is missing where the base was 8 % off."""
    seen = runs[0].reference
    assert seen is not None
    yaw = np.where(np.arange(seen.yaw.size) < headings, seen.yaw, np.nan)
    increments = EvaluationOptions(reference_kind="incremental")
    refused = r"run_60: .* positions alone.*give --reference-kind absolute, or local_map"
    positions = [with_reference(runs[0], yaw=yaw)]
    with pytest.raises(InputError, match=refused):
        compare(positions, RIGHT, increments)
    with pytest.raises(InputError, match=refused):
        diagnose(positions, RIGHT, (), increments)


def test_a_run_without_a_reference_is_refused_by_name(runs: tuple[Run, ...]) -> None:
    with pytest.raises(InputError, match=r"run_60: there is no reference to compare with"):
        compare([replace(runs[0], reference=None)], RIGHT)
