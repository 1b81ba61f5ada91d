# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference whose error wanders about a map: told apart from its noise, from jumps and wheels."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import of_headings
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects.lookup import all_effects, find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.references.merged_reference import merged
from werrimbi_odom.files.run import Reference, Run
from werrimbi_odom.inference.calibration.any_driving import calibrate
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.correlated_filter import (
    GaussMarkovError,
    GyroHeading,
    filtered_with_correlated_error,
)
from werrimbi_odom.inference.fitting.filtering import FilterInput, FilterResult
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.pose import Floats

TRUE = WhiteNoiseRobot(left_noise=4e-4, right_noise=5.8e-4)
WHITE = 2e-3, 3e-3
WALK = 8e-3, 4e-3
MEMORY = 12.0
WANDER = tuple(walk * math.sqrt(0.5 * MEMORY) for walk in WALK)


def localised(
    run: Run, random: np.random.Generator, jumps: int = 0, of: tuple[float, float] = WANDER
) -> Run:
    """The run as a localiser shows it: its error is drawn to nothing, and is thrown at jumps."""
    reference = run.reference
    assert reference is not None
    size = np.array([of[0], of[0], of[1]])
    kept = np.exp(-np.diff(reference.time) / MEMORY)
    error = [size * random.standard_normal(3)]
    thrown = random.choice(np.arange(30, kept.size), jumps, replace=False)
    for row, share in enumerate(kept):
        new = share * error[-1] + math.sqrt(1.0 - share**2) * size * random.standard_normal(3)
        error.append(new + (np.array([0.15, -0.15, 0.08]) if row in thrown else 0.0))
    x, y, yaw = np.array(error).T
    seen = Reference(reference.time, reference.x + x, reference.y + y, reference.yaw + yaw)
    return replace(run, reference=seen)


def session(seeds: range, jumps: int = 1, seconds: float = 100.0) -> list[Run]:
    found = []
    for seed in seeds:
        random = np.random.default_rng([seed, 4])
        run = drive(
            TRUE,
            wandering(random, seconds),
            random,
            sigma_xy=WHITE[0],
            sigma_yaw=WHITE[1],
            every=5,
        )
        found.append(localised(replace(run, name=f"run_{seed}"), random, jumps))
    return found


@pytest.fixture(scope="module")
def runs() -> list[Run]:
    return session(range(5))


def line(count: int, length: float = 0.25) -> FilterInput:
    """Straight legs whose measured ends are off by what a filter takes for small."""
    random = np.random.default_rng(7)
    relative = np.tile([length, 0.0, 0.0], (count, 1))
    root = 1e-5 * random.standard_normal((count, 3, 3))
    poses = 1e-5 * random.standard_normal((count + 1, 3))
    poses[:, 0] += length * np.arange(count + 1)
    return FilterInput(
        relative,
        (root @ root.swapaxes(-1, -2))[None],
        poses[:-1],
        poses[1:],
        np.diag([2e-10, 2e-10, 1e-10])[None, None],
        np.arange(count) == 0,
        np.zeros(count, dtype=np.bool_),
        np.full(count, np.nan),
    )


def wander_of(legs: FilterInput) -> GaussMarkovError:
    count = legs.begins.size
    kept = np.random.default_rng(8).uniform(0.7, 0.99, count)
    no_gap = np.zeros(count, dtype=np.bool_)
    return GaussMarkovError(np.array([[4e-10, 4e-10, 9e-10]]), kept[None], no_gap, no_gap, 0.0)


def whitened(found: FilterResult) -> Floats:
    root = np.linalg.inv(np.linalg.cholesky(found.covariance[0]))
    return np.asarray((root @ found.value[0][..., None])[..., 0])


def cost(found: FilterResult) -> float:
    solved = np.linalg.solve(found.covariance[0], found.value[0][..., None])[..., 0]
    return float(np.sum(found.value[0] * solved) + np.linalg.slogdet(found.covariance[0])[1].sum())


def joint_cost(legs: FilterInput, wander: GaussMarkovError) -> float:
    """The same from the covariance of all poses together, with no filter."""
    count = legs.begins.size
    step = np.eye(3)
    step[1, 2] = legs.relative[0, 0]
    noise, reading = legs.noise[0], legs.reading[0, 0]
    own = np.diag(wander.variance[0])
    # Errors of the path since the first pose, of the wandering, of the readings: all linear.
    size = 3 * (count + 1)
    path, walk = np.zeros((size, size)), np.zeros((size, size))
    for j in range(count + 1):
        for k in range(j, count + 1):
            share = float(np.prod(wander.kept[0, j:k]))
            part = np.zeros((3, 3))
            for i in range(j):  # noise of leg i ends at pose i + 1
                early, late = (np.linalg.matrix_power(step, at - i - 1) for at in (j, k))
                part += early @ noise[i] @ late.T
            rows, columns = slice(3 * j, 3 * j + 3), slice(3 * k, 3 * k + 3)
            path[rows, columns], path[columns, rows] = part, part.T
            walk[rows, columns] = walk[columns, rows] = share * own
    covariance = path + walk + np.kron(np.eye(count + 1), reading)
    carried = np.concatenate([np.linalg.matrix_power(step, at) for at in range(1, count + 1)])
    less = np.concatenate([-carried, np.eye(3 * count)], axis=1)
    ideal = np.outer(np.arange(count + 1), legs.relative[0]).ravel()
    poses = np.concatenate([legs.start[:1], legs.finish]).ravel() - ideal
    left = less @ poses
    covariance = less @ covariance @ less.T
    return float(left @ np.linalg.solve(covariance, left) + np.linalg.slogdet(covariance)[1])


def test_the_filter_is_the_likelihood_of_all_poses_together() -> None:
    legs = line(25)
    wander = wander_of(legs)
    assert cost(filtered_with_correlated_error(legs, wander)) == pytest.approx(
        joint_cost(legs, wander), rel=1e-6
    )


@pytest.mark.parametrize("laid", [False, True], ids=["localiser", "gyro laid upon it"])
def test_innovations_change_as_their_derivatives_say(laid: bool) -> None:
    legs = line(12)
    wander = wander_of(legs)
    if laid:
        turn, duration = np.linspace(-0.3, 0.3, 12), np.full(12, 0.8)
        wander = wander._replace(laid=GyroHeading(turn, duration, np.array([1e-7])))
    random = np.random.default_rng(9)
    direction = random.standard_normal((12, 3, 1))

    def value(size: float) -> Floats:
        moved = legs._replace(relative=legs.relative + size * direction[..., 0])
        return filtered_with_correlated_error(moved, wander).value[0]

    told = filtered_with_correlated_error(legs, wander).ways.innovations(direction)[..., 0]
    np.testing.assert_allclose((value(1e-6) - value(-1e-6)) / 2e-6, told, atol=2e-4)


def test_a_laid_heading_may_be_off_by_an_angle_a_drift_and_a_scale() -> None:
    """All three together are no surprise after a while; of a localiser they go on being one."""
    legs, turn = line(40), np.full(40, 0.2)
    legs = legs._replace(relative=legs.relative + turn[:, None] * [0.0, 0.0, 1.0])
    true = np.concatenate([[0.0], np.cumsum(turn)])
    step = 0.25 * np.exp(1j * true[:-1])
    place = np.concatenate([[0j], np.cumsum(step)])
    yaw = 1.01 * true + 0.02 + 5e-4 * np.arange(41)
    poses = np.stack([place.real, place.imag, yaw], axis=1)
    legs = legs._replace(start=poses[:-1], finish=poses[1:])
    wander = wander_of(legs)
    told = GyroHeading(turn, np.full(40, 1.0), np.array([1e-12]))
    late = [
        np.abs(whitened(filtered_with_correlated_error(legs, each))[-10:]).max()
        for each in (wander._replace(laid=told), wander)
    ]
    assert late[0] < 1.0
    assert late[1] > 10.0


def test_after_a_jump_the_pose_is_where_the_wheels_brought_it() -> None:
    """And the jump is the reference's: what follows it is expected, half a metre off."""
    legs = line(20)
    jump = np.array([0.3, -0.4, 0.0])
    start, finish, skip = legs.start.copy(), legs.finish.copy(), legs.skip.copy()
    start[11:] += jump
    finish[10:] += jump
    skip[10] = True
    no_gap = np.zeros(20, np.bool_)
    kept = GaussMarkovError(
        np.full((1, 3), 1e-4), np.full((1, 20), 1.0 - 1e-9), no_gap, no_gap, 0.0
    )
    found = filtered_with_correlated_error(
        legs._replace(start=start, finish=finish, skip=skip), kept
    )
    assert np.all(found.value[0, 10] == 0.0)
    assert np.abs(found.value[0]).max() < 2e-4
    blind = filtered_with_correlated_error(legs._replace(start=start, finish=finish), kept)
    assert np.abs(blind.value[0, 10]).max() > 0.3


def test_noise_walk_and_memory_are_told_apart(runs: list[Run]) -> None:
    robot = TRUE.entered()
    found = calibrate(
        match_for_fit(runs, robot, 1.0), robot, EvaluationOptions(reference_kind="local_map")
    )
    noises = found.noises
    assert noises["reference_walk_xy"].value == pytest.approx(WALK[0], rel=0.15)
    assert noises["reference_walk_yaw"].value == pytest.approx(WALK[1], rel=0.2)
    assert noises["reference_sigma_xy"].value == pytest.approx(WHITE[0], rel=0.25)
    assert noises["reference_sigma_yaw"].value == pytest.approx(WHITE[1], rel=0.2)
    back = noises["reference_reversion"]
    assert abs(back.value - 1.0 / MEMORY) < 3.0 * back.std
    for name, multiplier in found.multipliers.items():
        assert multiplier.std is not None
        off = multiplier.value - getattr(robot, name)
        assert abs(off) < 3.0 * multiplier.std, "what is calibrated is so within its error bar"
        assert multiplier.std < 4e-3


def test_a_part_put_aside_for_judging_does_not_lose_the_robot() -> None:
    """The reference went on all the while, so its memory is told as by whole drives."""
    robot = TRUE.entered()
    kept, _ = set_aside(session(range(3), jumps=0))
    options = EvaluationOptions(reference_kind="local_map")
    back = calibrate(match_for_fit(kept, robot, 1.0), robot, options).noises["reference_reversion"]
    assert abs(back.value - 1.0 / MEMORY) < 2.0 * back.std


def test_a_jump_in_a_part_put_aside_is_told_by_the_legs_after_it() -> None:
    robot, options = TRUE.entered(), EvaluationOptions(reference_kind="local_map")
    kept, _ = set_aside(session(range(3), jumps=0))
    *_, (_, end) = kept[1].taken_out
    seen = kept[1].reference
    assert seen is not None
    thrown = 0.2 * np.exp(-(seen.time - end) / MEMORY) * (seen.time >= end)
    jumped = replace(kept[1], reference=replace(seen, x=seen.x + thrown, y=seen.y - thrown))

    def found(runs: list[Run]) -> list[int]:
        laid = concatenated(match_for_fit(runs, robot, 1.0))
        excluded = fit_model(laid, start_point(laid, robot, options)).point.excluded
        return [int(np.count_nonzero(each)) for each in excluded]

    assert found([*kept]) == [0, 0, 0]
    assert found([kept[0], jumped, kept[2]]) == [0, 1, 0]


def test_legs_are_as_wrong_as_promised_at_every_length(runs: list[Run]) -> None:
    """By poses that each err by themselves the covariance is far off at one length or another."""
    found = compare(runs, TRUE.entered(), EvaluationOptions(reference_kind="local_map"))
    nees = [each.all.figures.nees for each in found.lengths if each.all.figures.count >= 30]
    assert len(nees) >= 4
    assert 0.75 < min(nees) <= max(nees) < 1.3
    plain = compare(runs, TRUE.entered())
    wrong = [each.all.figures.nees for each in plain.lengths if each.all.figures.count >= 30]
    assert max(max(wrong), 1.0 / min(wrong)) > 2.0


@pytest.mark.evidence
def test_a_localiser_shows_a_wrong_base(runs: list[Run]) -> None:
    robot = replace(TRUE.entered(), wheel_separation_multiplier=1.0 / 1.03)
    others = [find(name) for name in ("castor_kick", "floor_slope", "lateral_slip")]
    found = diagnose(runs[:3], robot, others, EvaluationOptions(reference_kind="local_map"))
    assert (found.verdict, found.effect) == ("named", "track_width")


def with_gyro(seeds: range, robot: WhiteNoiseRobot, scale: float) -> list[Run]:
    """A localiser's places, and headings of a gyro of another scale that were laid upon its own."""
    found = []
    for seed in seeds:
        random = np.random.default_rng([seed, 6])
        way = wandering(random, 100.0)
        run = drive(robot, way, random, sigma_xy=WHITE[0], sigma_yaw=5e-4, every=5)
        true = run.reference
        assert true is not None
        shown = scale * np.unwrap(true.yaw) + 2e-3 * true.time
        seen = localised(replace(run, name=f"run_{seed}"), random, jumps=1)
        assert seen.reference is not None
        shown[0] = np.nan  # the localiser is heard first
        both, _ = merged("", seen.reference, of_headings(true.time, shown))
        found.append(replace(seen, reference=both))
    return found


@pytest.mark.evidence
@pytest.mark.parametrize("wide", [1.0, 1.03])
def test_a_gyros_scale_is_no_wide_base_and_hides_none(wide: float) -> None:
    """One drive tells neither the angle by which it is laid nor its scale to a percent."""
    robot = replace(TRUE.entered(), wheel_separation_multiplier=1.0 / wide)
    *drives, held = with_gyro(range(7), TRUE, 1.004)
    names = ("track_width", "castor_kick", "longitudinal_slip", "eccentric_left_wheel")
    options = EvaluationOptions(reference_kind="local_map")
    found = diagnose(drives, robot, [find(name) for name in names], options, holdout=[held])
    # Each drive's first heading is fitted, and what is measured after it is not forgotten.
    assert found.train.before == compare(drives, robot, options).main.all.figures.rmse_position_m
    assert found.effect == (None if wide == 1.0 else "track_width")
    assert found.verdict == ("none" if wide == 1.0 else "named")


@pytest.mark.evidence
@pytest.mark.parametrize("seed", range(4))
def test_a_localiser_shows_nothing_where_nothing_is(seed: int) -> None:
    runs = session(range(10 * seed, 10 * seed + 4), jumps=2)
    found = diagnose(
        runs, TRUE.entered(), all_effects().effects, EvaluationOptions(reference_kind="local_map")
    )
    assert found.verdict == "none"


def test_a_wrong_base_shows_in_turns_and_not_in_the_lines_after_them(runs: list[Run]) -> None:
    """The reference's heading would be doubted for it, and every line after a turn go sideways."""
    robot = TRUE.entered()
    wrong = replace(robot, wheel_separation_multiplier=1.0 / 1.1)
    right, off = (
        compare(runs[:2], one, EvaluationOptions(reference_kind="local_map"))
        .main.by_motion["line"]
        .figures
        for one in (robot, wrong)
    )
    assert off.rmse_position_m < 1.4 * right.rmse_position_m


def test_few_poses_have_the_noise_that_is_usual() -> None:
    [run] = session(range(1), jumps=0)
    assert run.reference is not None
    rows = np.zeros(run.reference.time.size, dtype=np.bool_)
    rows[[0, -1]] = True
    short = replace(run, reference=run.reference.chosen(rows))
    [(_, noise)] = compare(
        [short], TRUE.entered(), EvaluationOptions(reference_kind="local_map")
    ).prepared.noises
    assert (noise.xy_told, noise.yaw_told) == ("assumed", "assumed")
    assert 0.0 < noise.sigma_xy < noise.wander[0] < 0.1
