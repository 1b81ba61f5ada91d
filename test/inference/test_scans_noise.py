# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Each pose by scans counts as much as its match is good for, and in each direction by itself."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.leg_errors import errors_of
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.likelihood import innovations
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.legs.cutting import match, with_stated_noise
from werrimbi_odom.model.pose import Floats

TRUE = WhiteNoiseRobot()
ROOM, HALL = np.array([1e-3, 1e-3, 1e-3]), np.array([6e-3, 6e-3, 4e-3])
CORRIDOR = np.array([8e-3, 1e-3, 1e-3])
"""Along it, across it, and of the heading."""
ALONG = 0.7
"""Where the corridor leads in the reference's frame [rad]."""


def scanned(seed: int, last: Floats, stated: bool = True) -> Run:
    """A drive that begins in a small room and ends elsewhere; each pose errs as it states."""
    random = np.random.default_rng(seed)
    run = drive(TRUE, wandering(random, 60.0), random, sigma_xy=0.0, sigma_yaw=0.0, every=5)
    seen = run.reference
    assert seen is not None
    there = seen.time > np.median(seen.time)
    sigmas = np.where(there[:, None], last, ROOM)
    cos, sin = np.cos(ALONG), np.sin(ALONG)
    turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    noise = (random.standard_normal(sigmas.shape) * sigmas) @ turn.T
    covariance = turn @ (sigmas[:, :, None] ** 2 * np.eye(3)) @ turn.T
    reference = replace(
        seen,
        x=seen.x + noise[:, 0],
        y=seen.y + noise[:, 1],
        yaw=seen.yaw + noise[:, 2],
        sigma_xy=sigmas[:, :2].max(axis=1),
        sigma_yaw=sigmas[:, 2],
        covariance=covariance if stated else None,
        own_axes=True,
    )
    return replace(run, name=f"run_{seed}", reference=reference)


def laid_out(last: Floats) -> tuple[Concatenated, EvaluationOptions]:
    """Eight such drives, and what is known of their noise."""
    robot = TRUE.entered()
    laid = concatenated([match(scanned(seed, last), robot, leg=0.25) for seed in range(8)])
    return laid, with_stated_noise(EvaluationOptions(reference_kind="absolute"), laid.runs)


@pytest.mark.parametrize("last", [HALL, CORRIDOR], ids=["a hall", "a corridor"])
def test_innovations_are_white_in_every_part_of_a_drive(last: Floats) -> None:
    """With one noise for all poses those of the small room were a fifth of what they should be.

    With one for both directions, so were those across the corridor.
    """
    robot = TRUE.entered()
    laid, options = laid_out(last)
    point = start_point(laid, robot, options)
    variances = replace(point.variances, stamp=np.array([1e-12]))
    found = innovations(robot, laid, predict_all(point.model, laid), variances, "absolute")
    white, shares = found.whitened(), laid.shares
    assert shares is not None
    there = shares[1, :, 0, 0] > 0.5 * shares[1, :, 0, 0].max()
    for part in (~there, there):
        assert part.sum() > 100
        assert np.sqrt(np.mean(white[part] ** 2, axis=0)) == pytest.approx(np.ones(3), abs=0.15)


def test_errors_of_legs_are_as_sure_in_each_direction_as_the_match() -> None:
    """Along and across the corridor, whichever way the robot looks: on legs of either length."""
    robot = TRUE.entered()
    laid, options = laid_out(CORRIDOR)
    assert options.sigma_xy is not None
    assert options.sigma_yaw is not None
    model = start_point(laid, robot, options).model
    legs = errors_of(model, laid, options.sigma_xy, options.sigma_yaw)
    spread, directions = np.linalg.eigh(legs.covariance[:, :2, :2])
    share = np.squeeze(directions.swapaxes(1, 2) @ legs.error[:, :2, None], -1) ** 2 / spread
    shares = laid.shares
    assert shares is not None
    there = shares[:, :, 0, 0].min(axis=0) > 0.5 * shares[1, :, 0, 0].max()
    assert there.sum() > 100
    assert share[there].mean(axis=0) == pytest.approx(np.ones(2), abs=0.3)


def test_where_not_all_state_it_one_noise_counts() -> None:
    robot = TRUE.entered()
    runs = [match(scanned(seed, HALL, stated=seed > 0), robot, leg=0.25) for seed in range(2)]
    assert concatenated(runs).shares is None
