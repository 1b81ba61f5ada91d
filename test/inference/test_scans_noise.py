# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each pose by scans counts as much as its match is good for, in a hall as in a small room."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.leg_errors import errors_of, squared_deviation
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.likelihood import Innovations, innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.legs.cutting import match, with_stated_noise
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

TRUE = WhiteNoiseRobot()
NEAR, FAR = (1e-3, 1e-3), (6e-3, 4e-3)


def scanned(seed: int, stated: bool = True) -> Run:
    """A drive that begins in a small room and ends in a hall; each pose errs as it states."""
    random = np.random.default_rng(seed)
    run = drive(TRUE, wandering(random, 60.0), random, sigma_xy=0.0, sigma_yaw=0.0, every=5)
    seen = run.reference
    assert seen is not None
    hall = seen.time > np.median(seen.time)
    xy, yaw = (np.where(hall, far, near) for near, far in zip(NEAR, FAR, strict=True))
    noise = random.standard_normal((3, seen.time.size)) * (xy, xy, yaw)
    columns = {
        name: getattr(seen, name) + part
        for name, part in zip(("x", "y", "yaw"), noise, strict=True)
    }
    sigmas = {"sigma_xy": xy, "sigma_yaw": yaw} if stated else {}
    return replace(
        run, name=f"run_{seed}", reference=replace(seen, own_axes=True, **columns, **sigmas)
    )


GOOD_WHEELS = WhiteNoiseRobot(left_noise=1e-4, right_noise=1e-4)


def on_a_walking_map(seed: int) -> Run:
    """A drive of the best wheels, by scans whose map walks by a quarter of their noise a metre."""
    random = np.random.default_rng(seed)
    run = drive(GOOD_WHEELS, wandering(random, 60.0), random, sigma_xy=0.0, sigma_yaw=0.0, every=5)
    seen = run.reference
    assert seen is not None
    place, yaw = seen.x + 1j * seen.y, np.unwrap(seen.yaw)
    steps = np.diff(place)
    worth = np.abs(steps) + np.abs(np.diff(yaw)) / (0.5 * np.pi)
    walk = 0.25 * np.sqrt(worth) * random.standard_normal((3, worth.size))
    turned = np.concatenate([[0.0], np.cumsum(NEAR[1] * walk[2])])
    steps = steps * np.exp(1j * turned[:-1]) + NEAR[0] * (walk[0] + 1j * walk[1])
    place = place[0] + np.concatenate([[0.0], np.cumsum(steps)])
    white = np.array([NEAR[0], NEAR[0], NEAR[1]])[:, None] * random.standard_normal((3, yaw.size))
    poses = {"x": place.real + white[0], "y": place.imag + white[1], "yaw": yaw + turned + white[2]}
    stated = {"sigma_xy": np.full(yaw.size, NEAR[0]), "sigma_yaw": np.full(yaw.size, NEAR[1])}
    way = np.concatenate([[0.0], np.cumsum(worth)])
    walked = 0.25**2 * way[:, None] * np.square(NEAR)
    reference = replace(seen, own_axes=True, walked=walked, **poses, **stated)
    return replace(run, name=f"run_{seed}", reference=reference)


def innovations_of(
    runs: Iterable[Run], robot: Robot, **known: Floats
) -> tuple[Concatenated, Innovations]:
    """Short legs of runs with the noise that their poses state, and some that is known."""
    laid = concatenated([match(run, robot, leg=0.25) for run in runs])
    options = with_stated_noise(EvaluationOptions(reference_kind="absolute"), laid.runs)
    point = start_point(laid, robot, options)
    variances = replace(point.variances, stamp=np.array([1e-12]), **known)
    return laid, innovations(robot, laid, predict_all(point.model, laid), variances, "absolute")


def of_good_wheels(runs: Iterable[Run]) -> tuple[Concatenated, Innovations]:
    """The same of wheels that hardly err, and are known to."""
    robot = GOOD_WHEELS.entered()
    wheels = np.square([robot.left_wheel_noise])
    return innovations_of(runs, robot, left=wheels, right=wheels)


def test_the_map_that_scans_are_matched_with_walks() -> None:
    """With independent errors innovations were a tenth larger than stated, and correlated."""
    _, found = of_good_wheels(on_a_walking_map(seed) for seed in range(12))
    assert np.mean(found.whitened()[found.known.all(axis=1)] ** 2) == pytest.approx(1.0, abs=0.09)


def test_innovations_are_white_in_every_part_of_a_drive() -> None:
    """With one noise for all poses those of the small room were a fifth of what they should be."""
    laid, found = innovations_of((scanned(seed) for seed in range(4)), TRUE.entered())
    white, shares = found.whitened(), laid.shares
    assert shares is not None
    share = shares[1, :, 0, 0]
    for part in (share < 0.1, share > 0.9):
        assert part.sum() > 100
        assert np.sqrt(np.mean(white[part] ** 2)) == pytest.approx(1.0, abs=0.15)


ALONG, ACROSS = 6e-3, 1e-3


def in_a_corridor(seed: int) -> Run:
    """A drive by scans that hold it across the corridor, at 0.4 rad to the axes, six times finer.

    Position and heading err together, too: the lidar sits beside the middle of its walls.
    """
    random = np.random.default_rng(seed)
    run = drive(GOOD_WHEELS, wandering(random, 60.0), random, sigma_xy=0.0, sigma_yaw=0.0, every=5)
    seen = run.reference
    assert seen is not None
    cos, sin = np.cos(0.4), np.sin(0.4)
    into = np.array([[cos, -sin, 1e-3], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    covariance = into @ np.diag(np.square([ALONG, ACROSS, NEAR[1]])) @ into.T
    noise = np.linalg.cholesky(covariance) @ random.standard_normal((3, seen.time.size))
    many = np.ones(seen.time.size)
    reference = replace(
        seen,
        own_axes=True,
        x=seen.x + noise[0],
        y=seen.y + noise[1],
        yaw=seen.yaw + noise[2],
        sigma_xy=ALONG * many,
        sigma_yaw=NEAR[1] * many,
        covariance=many[:, None, None] * covariance,
    )
    return replace(run, name=f"run_{seed}", reference=reference)


def test_along_and_across_a_corridor_a_pose_has_its_own_noise() -> None:
    """With one noise for both, innovations across were 0.2 of what was stated."""
    laid, found = of_good_wheels(in_a_corridor(seed) for seed in range(6))
    heading = laid.start[:, 2]
    for away in (0.4, 0.4 + 0.5 * np.pi):
        ways = np.column_stack([np.cos(away - heading), np.sin(away - heading)])
        seen = np.einsum("ni,ni->n", ways, found.value[0, :, :2])
        stated = np.einsum("ni,nij,nj->n", ways, found.covariance[0, :, :2, :2], ways)
        assert np.mean(seen**2 / stated) == pytest.approx(1.0, abs=0.12)
    white = found.whitened()
    assert np.mean(white[found.known.all(axis=1)] ** 2) == pytest.approx(1.0, abs=0.08)
    model = start_point(laid, GOOD_WHEELS.entered()).model
    told = errors_of(model, laid, ALONG, NEAR[1])
    off = squared_deviation(told.error, told.covariance)
    assert np.mean(off) / 3.0 == pytest.approx(1.0, abs=0.1)


def test_where_not_all_state_it_one_noise_counts() -> None:
    robot = TRUE.entered()
    runs = [match(scanned(seed, stated=seed > 0), robot, leg=0.25) for seed in range(2)]
    assert concatenated(runs).shares is None
