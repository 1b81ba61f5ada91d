# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Exact moments: right where first order is not, equal to it where errors are small."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from werrimbi_odom.model.covariance import (
    PathNoise,
    PoseCovariance,
    carried,
    noise_of_wheel_variances,
    piece_covariance,
    plus,
)
from werrimbi_odom.model.exact_moments import PathMoments, chained, from_covariance, piece_moments
from werrimbi_odom.model.motion import BodyMotion, displacement

Pieces = list[tuple[BodyMotion[float], PathNoise[float]]]

BENT_PATH: Pieces = [
    (BodyMotion(2.0, 0.3, -1.0), PathNoise(0.02, 0.3, -0.02)),
    (BodyMotion(0.0, 0.0, 2.0), PathNoise(0.01, 0.2, 0.01)),
    (BodyMotion(3.0, 0.0, 0.0), PathNoise(0.02, 0.3, 0.03)),
]
ONE_ARC: Pieces = [(BodyMotion(5.0, 0.0, 1.5), PathNoise(0.02, 0.81, 0.05))]


def exact(pieces: Pieces, start: PathMoments | None = None) -> PathMoments:
    path, yaw = start or PathMoments(), 0.0
    for motion, noise in pieces:
        path = chained(path, piece_moments(motion, noise), yaw)
        yaw += motion.turn
    return path


def about_mean(moments: PathMoments) -> np.ndarray:
    """Covariance proper: about the mean of the true pose, not about the nominal one."""
    shift = np.array([moments.error.real, moments.error.imag, 0.0])
    return moments.about_pose().matrix() - np.outer(shift, shift)


def first_order(pieces: Pieces) -> PoseCovariance[float]:
    covariance, yaw = PoseCovariance(0.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0
    for motion, noise in pieces:
        dx, dy = displacement(motion, yaw)
        covariance = plus(carried(covariance, dx, dy), piece_covariance(motion, noise, yaw))
        yaw += motion.turn
    return covariance


def sampled(pieces: Pieces, count: int, start: np.ndarray | None = None) -> np.ndarray:
    """Errors (x, y, yaw) of `count` robots whose motion is noisy at every small step."""
    random, steps = np.random.default_rng(20260101), 200
    error = (
        np.zeros((3, count))
        if start is None
        else random.multivariate_normal(np.zeros(3), start, count).T
    )
    position, heading = error[0] + 1j * error[1], error[2].copy()
    nominal, yaw = 0j, 0.0
    for motion, noise in pieces:
        root = np.linalg.cholesky(np.array([[noise.a, noise.c], [noise.c, noise.b]]) / steps)
        for _ in range(steps):
            along, turn = root @ random.standard_normal((2, count))
            turn += motion.turn / steps
            chord = along + (motion.along + 1j * motion.sideways) / steps
            position += np.exp(1j * (heading + 0.5 * turn)) * np.sinc(0.5 * turn / np.pi) * chord
            heading += turn
        dx, dy = displacement(motion, yaw)
        nominal, yaw = nominal + complex(dx, dy), yaw + motion.turn
    away = position - nominal
    return np.stack([away.real, away.imag, heading - yaw])


@pytest.mark.parametrize("pieces", [ONE_ARC, BENT_PATH], ids=["one arc", "three pieces"])
def test_moments_agree_with_noisy_robots_where_first_order_is_off_by_more_than_30_percent(
    pieces: Pieces,
) -> None:
    count = 40_000
    errors = sampled(pieces, count)
    moments = exact(pieces)
    mean = np.array([moments.error.real, moments.error.imag])
    uncertainty = errors[:2].std(axis=1) / np.sqrt(count)
    assert np.all(np.abs(errors[:2].mean(axis=1) - mean) < 4.0 * uncertainty)
    products = errors[:, None, :] * errors[None, :, :]
    uncertainty = products.std(axis=2) / np.sqrt(count)
    deviation = np.abs(products.mean(axis=2) - moments.about_pose().matrix())
    assert np.all(deviation < 4.0 * uncertainty)
    largest_exact = np.linalg.eigvalsh(about_mean(moments))[-1]
    largest_first = np.linalg.eigvalsh(first_order(pieces).matrix())[-1]
    assert largest_first / largest_exact - 1.0 > 0.3


def test_an_uncertain_start_pose_is_carried_exactly() -> None:
    start = np.array([[0.1, 0.02, 0.05], [0.02, 0.2, -0.03], [0.05, -0.03, 0.4]])
    given_start = PoseCovariance(0.1, 0.02, 0.05, 0.2, -0.03, 0.4)
    count = 40_000
    pieces = BENT_PATH[::2]
    errors = sampled(pieces, count, start)
    moments = exact(pieces, from_covariance(given_start))
    products = errors[:, None, :] * errors[None, :, :]
    uncertainty = products.std(axis=2) / np.sqrt(count)
    deviation = np.abs(products.mean(axis=2) - moments.about_pose().matrix())
    assert np.all(deviation < 4.0 * uncertainty)


travel = st.floats(-5.0, 5.0)
turn = st.floats(-7.0, 7.0)
wheel_variance = st.floats(1e-10, 1.0)


@given(travel, st.floats(-1.0, 1.0), turn, wheel_variance, wheel_variance, st.integers(2, 9))
def test_splitting_a_piece_anywhere_changes_no_moment(
    along: float, sideways: float, turning: float, left: float, right: float, parts: int
) -> None:
    noise = noise_of_wheel_variances(left, right, 0.5)
    motion = BodyMotion(along, sideways, turning)
    whole = exact([(motion, noise)])
    part = (
        BodyMotion(along / parts, sideways / parts, turning / parts),
        PathNoise(noise.a / parts, noise.b / parts, noise.c / parts),
    )
    split = exact([part] * parts)
    size = abs(along) + abs(sideways) + np.sqrt(noise.a)
    scales = (size, size**2, size**2, size, size, size, 1.0)
    for value, other, scale in zip(whole, split, scales, strict=True):
        assert abs(value - other) <= 1e-12 * max(scale, abs(value))


@given(travel, turn)
def test_small_errors_give_the_first_order_covariance(along: float, turning: float) -> None:
    noise = noise_of_wheel_variances(1e-7 * abs(along) + 1e-9, 2e-7 * abs(along) + 1e-9, 0.35)
    pieces = [(BodyMotion(along, 0.0, turning), noise), (BodyMotion(0.5, 0.0, 0.3), noise)]
    from_moments = about_mean(exact(pieces))
    plain = first_order(pieces).matrix()
    assert np.abs(from_moments - plain).max() <= 1e-4 * np.abs(plain).max()


def test_the_mean_falls_short_of_the_nominal_position() -> None:
    """Heading noise makes paths curl, so the mean position lags behind: e^(-b/2) for a spin."""
    spin_then_line: Pieces = [
        (BodyMotion(0.0, 0.0, 1.0), PathNoise(0.0, 0.5, 0.0)),
        (BodyMotion(2.0, 0.0, 0.0), PathNoise(0.0, 0.0, 0.0)),
    ]
    shift = exact(spin_then_line).error
    assert shift == pytest.approx(2.0 * np.exp(1j) * np.expm1(-0.25), rel=1e-12)


def test_arrays_and_scalars_agree() -> None:
    motions = BodyMotion(*np.array([[1.0, 0.0, -2.0], [0.0, 0.1, 0.0], [0.3, -4.0, 0.0]]))
    noises = PathNoise(*np.array([[0.1, 0.2, 0.3], [0.5, 0.01, 1e-9], [0.02, -0.01, 0.0]]))
    together = piece_moments(motions, noises)
    for index in range(3):
        alone = piece_moments(
            BodyMotion(*(float(part[index]) for part in motions)),
            PathNoise(*(float(part[index]) for part in noises)),
        )
        for array, scalar in zip(together, alone, strict=True):
            assert array[index] == pytest.approx(scalar, rel=1e-12, abs=1e-15)
