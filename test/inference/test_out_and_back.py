# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""k_L and k_R from drives out and back, against wheels that are simulated here, step by step."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.calibration.noise_likelihood import EndErrorDesign, Likelihood, design
from werrimbi_odom.inference.calibration.out_and_back import (
    by_moments,
    fit_noise,
    out_and_back,
    pivot_scatter,
)
from werrimbi_odom.model.motion import WheelTravel

Floats = NDArray[np.float64]

DISTANCE, TRACK = 10.0, 0.35
K_LEFT, K_RIGHT = 4.0e-4, 5.8e-4


def errors(
    rng: np.random.Generator,
    runs: int,
    *,
    k_left: float = K_LEFT,
    k_right: float = K_RIGHT,
    turn_round: bool = False,
    steps: int = 200,
    sigma_xy: float = 0.0,
    sigma_yaw: float = 0.0,
) -> Floats:
    """End errors (n, 3) of wheels with white noise along their way; no closed form in it."""
    step = DISTANCE / steps
    arc = math.pi * TRACK / 2 / steps
    out, back = [(step, step)] * steps, [(-step, -step)] * steps
    left_turn, right_turn = [(-arc, arc)] * steps, [(arc, -arc)] * steps
    path = np.array(out + left_turn + out + right_turn if turn_round else out + back)
    size = (runs, len(path))
    noise = np.sqrt(np.abs(path))
    left = path[:, 0] + k_left * noise[:, 0] * rng.standard_normal(size)
    right = path[:, 1] + k_right * noise[:, 1] * rng.standard_normal(size)
    turn = (right - left) / TRACK
    middle = np.cumsum(turn, axis=1) - turn / 2
    along = (left + right) / 2
    end = np.stack(
        [
            (along * np.cos(middle)).sum(axis=1),
            (along * np.sin(middle)).sum(axis=1),
            turn.sum(axis=1),
        ],
        axis=-1,
    )
    sigma = np.array([sigma_xy, sigma_xy, sigma_yaw])
    start_and_end = rng.standard_normal((2, runs, 3)) * sigma
    return np.asarray(end + start_and_end[1] - start_and_end[0])


def paper_design(
    sigma_xy: float = 0.0, sigma_yaw: float = 0.0, turn_round: bool = False
) -> EndErrorDesign:
    pieces = out_and_back(DISTANCE, TRACK, turn_round=turn_round)
    return design(pieces, TRACK, sigma_xy=sigma_xy, sigma_yaw=sigma_yaw)


def cramer_rao(model: EndErrorDesign, runs: int) -> Floats:
    """Least standard deviations of (k_L, k_R) that any unbiased estimate can have."""
    information = (runs - 1) * model.information(K_LEFT**2, K_RIGHT**2)
    return np.asarray(
        np.sqrt(np.diag(np.linalg.inv(information))) / (2 * np.array([K_LEFT, K_RIGHT]))
    )


def test_the_covariance_is_what_the_formulas_by_hand_say() -> None:
    """The formulas of the module's docstring, integrated by hand."""
    left, right = K_LEFT**2, K_RIGHT**2
    got = paper_design().covariance(left, right)
    total, split, d, b = left + right, right - left, DISTANCE, TRACK
    expected = [
        [total * d / 2, -split * d**2 / (2 * b), split * d / b],
        [-split * d**2 / (2 * b), total * 2 * d**3 / (3 * b**2), -total * d**2 / b**2],
        [split * d / b, -total * d**2 / b**2, total * 2 * d / b**2],
    ]
    np.testing.assert_allclose(got, expected, rtol=1e-12, atol=1e-18)


def test_turning_round_at_the_far_end_hides_the_split() -> None:
    """What the way back adds to x then has the opposite sign; in the heading there is none."""
    turned = paper_design(turn_round=True)
    split = turned.right - turned.left
    whole = turned.right + turned.left
    scale = np.sqrt(np.outer(np.diag(whole), np.diag(whole)))
    assert np.abs(split / scale).max() < 0.03
    reversed_ = paper_design()
    split = (reversed_.right - reversed_.left)[0, 2]
    whole = reversed_.right + reversed_.left
    assert split / math.sqrt(whole[0, 0] * whole[2, 2]) == pytest.approx(1.0)


@pytest.mark.parametrize("turn_round", [False, True])
def test_the_covariance_is_that_of_simulated_wheels(turn_round: bool) -> None:
    """An eighth of the noise: then second order (9 % of x when turning round) is out of sight."""
    rng, left, right = np.random.default_rng(5), K_LEFT / 8, K_RIGHT / 8
    sample = np.cov(errors(rng, 6000, k_left=left, k_right=right, turn_round=turn_round).T)
    model = paper_design(turn_round=turn_round).covariance(left**2, right**2)
    scale = np.sqrt(np.outer(np.diag(model), np.diag(model)))
    np.testing.assert_allclose(sample / scale, model / scale, atol=0.06)


def test_the_papers_experiment() -> None:
    """60 runs of 10 m: both k within three of their standard deviations, which are Cramér-Rao's."""
    fit = fit_noise(errors(np.random.default_rng(1), 60), paper_design())
    bound = cramer_rao(paper_design(), 60)
    assert fit.split_known
    for got, true, least in zip((fit.left, fit.right), (K_LEFT, K_RIGHT), bound, strict=True):
        assert abs(got.value - true) < 3 * got.std
        assert got.std == pytest.approx(least, rel=0.3)
        assert got.low < got.value < got.high
    assert fit.misfit_p > 0.01
    assert fit.mean_p > 0.01


def test_the_estimate_is_the_summit_of_the_likelihood() -> None:
    sample = errors(np.random.default_rng(2), 40)
    fit = fit_noise(sample, paper_design())
    likelihood = Likelihood(paper_design(), np.cov(sample.T), 39)
    best = likelihood.cost(fit.left.value**2, fit.right.value**2)
    for left, right in [(0.98, 1.0), (1.02, 1.0), (1.0, 0.98), (1.0, 1.02)]:
        assert likelihood.cost((left * fit.left.value) ** 2, (right * fit.right.value) ** 2) > best


def test_the_stated_std_is_the_curvature_of_the_likelihood() -> None:
    """Fisher's information by formula against finite differences where data equal the model."""
    model = paper_design(1e-3, 2e-3)
    at = np.array([K_LEFT**2, K_RIGHT**2])
    likelihood = Likelihood(model, model.covariance(*at), 59)
    step = 1e-3 * at

    def cost(i: int, j: int) -> float:
        return likelihood.cost(at[0] + i * step[0], at[1] + j * step[1])

    here = cost(0, 0)
    measured = np.array(
        [
            [
                (cost(1, 0) - 2 * here + cost(-1, 0)) / step[0] ** 2,
                (cost(1, 1) - cost(1, -1) - cost(-1, 1) + cost(-1, -1)) / (4 * step[0] * step[1]),
            ],
            [0.0, (cost(0, 1) - 2 * here + cost(0, -1)) / step[1] ** 2],
        ]
    )
    measured[1, 0] = measured[0, 1]
    np.testing.assert_allclose(measured, 59 * model.information(*at), rtol=1e-4)


def test_the_references_noise_is_taken_off() -> None:
    """Two poses are measured in each run, so it counts twice; left out, k comes out too large."""
    rng = np.random.default_rng(3)
    sample = errors(rng, 400, sigma_xy=1e-3, sigma_yaw=2e-3)
    fit = fit_noise(sample, paper_design(1e-3, 2e-3))
    assert abs(fit.left.value - K_LEFT) < 3 * fit.left.std
    assert abs(fit.right.value - K_RIGHT) < 3 * fit.right.std
    assert fit.misfit_p > 0.01
    careless = fit_noise(sample, paper_design())
    assert careless.misfit_p < 1e-3


def test_what_is_systematic_is_estimated_and_kept_apart() -> None:
    sample = errors(np.random.default_rng(4), 60)
    shifted = sample + np.array([0.003, 0.1, -0.01])
    fit, again = fit_noise(sample, paper_design()), fit_noise(shifted, paper_design())
    assert again.left.value == pytest.approx(fit.left.value, rel=1e-6)
    np.testing.assert_allclose(again.mean - fit.mean, [0.003, 0.1, -0.01], atol=1e-12)
    assert again.mean_p < 1e-6 < fit.mean_p


@pytest.mark.parametrize(
    "model",
    [paper_design(5e-3, 5e-3), paper_design(20e-3, 5e-3), paper_design(1e-3, 2e-3, True)],
    ids=["5 mm", "20 mm", "turned round"],
)
def test_what_cannot_be_told_apart_is_not(model: EndErrorDesign) -> None:
    """The sum alone is known: one k for both wheels, and an interval that holds either share."""
    runs = 10
    rng = np.random.default_rng(6)
    true = model.covariance(K_LEFT**2, K_RIGHT**2)
    sample = rng.multivariate_normal(np.zeros(3), true, runs)
    fit = fit_noise(sample, model)
    assert not fit.split_known
    assert fit.left == fit.right
    assert fit.left.low <= K_LEFT <= fit.left.high
    assert fit.right.low <= K_RIGHT <= fit.right.high
    assert fit.difference_std > 0.5 * fit.left.value
    assert fit.correlation < -0.5


def test_pivots_would_tell() -> None:
    """About the standing left wheel the right one turns the robot by itself."""
    model = design([WheelTravel(0.0, 2 * math.pi * 10.0 * TRACK)], TRACK)
    assert model.left[2, 2] == 0.0
    scatter = math.sqrt(model.covariance(K_LEFT**2, K_RIGHT**2)[2, 2])
    assert pivot_scatter(K_RIGHT, TRACK, 10.0) == pytest.approx(scatter, rel=1e-12)


def test_ellipses_matched_as_in_the_paper_come_near() -> None:
    model = paper_design()
    fit = fit_noise(errors(np.random.default_rng(7), 60), model)
    assert fit.by_moments[0] == pytest.approx(K_LEFT, rel=0.4)
    assert fit.by_moments[1] == pytest.approx(K_RIGHT, rel=0.4)
    exact = model.covariance(K_LEFT**2, K_RIGHT**2)
    assert by_moments(exact, model) == pytest.approx((K_LEFT, K_RIGHT), rel=1e-9)


def test_refused() -> None:
    sample = errors(np.random.default_rng(8), 60)
    with pytest.raises(InputError, match="too few runs: 4 given"):
        fit_noise(sample[:4], paper_design())
    with pytest.raises(InputError, match="scatter no more than the reference"):
        fit_noise(sample, paper_design(0.5, 0.5))
    with pytest.raises(InputError, match="same error"):
        fit_noise(np.zeros((6, 3)), paper_design())
    with pytest.raises(InputError, match="the headings look like degrees"):
        fit_noise(sample * [1.0, 1.0, math.degrees(1.0)], paper_design())
    with pytest.raises(InputError, match=r"no rolling wheels err by more than 0\.01"):
        fit_noise(100.0 * sample, paper_design())
    with pytest.raises(InputError, match=r"same error in yaw: measure it"):
        fit_noise(sample * [1.0, 1.0, 0.0], paper_design())
    with pytest.raises(InputError, match=r"same error in x and yaw"):
        fit_noise(sample * [0.0, 1.0, 0.0] + 0.1, paper_design())
    with pytest.raises(InputError, match="follows from the other two"):
        fit_noise(
            np.stack([sample[:, 0], 2.0 * sample[:, 0], sample[:, 2]], axis=-1), paper_design()
        )


def test_noise_that_no_wheel_has_is_refused_where_the_wheels_cannot_be_told_apart() -> None:
    """Either wheel may then have none of it, but not both."""
    sample = errors(np.random.default_rng(8), 20, turn_round=True)
    model = paper_design(turn_round=True)
    assert not fit_noise(sample, model).split_known
    with pytest.raises(InputError, match=r"no rolling wheels err by more than 0\.01"):
        fit_noise(100.0 * sample, model)


def test_one_wheel_with_a_noise_that_no_wheel_has_is_refused_too() -> None:
    sample = errors(np.random.default_rng(8), 30, k_right=0.03)
    with pytest.raises(InputError, match=r"no rolling wheels err by more than 0\.01"):
        fit_noise(sample, paper_design())


def test_the_reference_s_noise_alone_leaves_nothing_for_the_wheels() -> None:
    """Half of such tables scatter a little more by chance: k of 4e-6 was written for them."""
    rng, sizes = np.random.default_rng(3), np.array([1e-3, 1e-3, 2e-3]) * math.sqrt(2.0)
    refused = 0
    for _ in range(20):
        try:
            fit_noise(rng.standard_normal((30, 3)) * sizes, paper_design(1e-3, 2e-3))
        except InputError as error:
            refused += "scatter no more than the reference" in str(error)
    assert refused >= 18


@pytest.mark.parametrize("share", [1e-2, 1e-3, 1e-5])
def test_headings_that_hardly_scatter_are_no_noise_of_wheels(share: float) -> None:
    """Taken from the odometry, not measured: the search of an interval ended there."""
    sample = errors(np.random.default_rng(8), 20) * [1.0, 1.0, share]
    fit = fit_noise(sample, paper_design())
    assert fit.misfit_p < 1e-6
    assert 0.0 < fit.left.low < fit.left.value < fit.left.high < 0.1


def test_runs_that_would_fit_in_degrees_by_the_reference_alone_are_told_as_they_are() -> None:
    """The trial in degrees said that they scatter no more than the reference."""
    sample = np.random.default_rng(0).normal(0.0, 1.0, (20, 3)) * [0.05, 0.05, 0.2]
    assert fit_noise(sample, paper_design(0.036, 0.01)).misfit_p < 1e-5


def test_where_the_sum_alone_is_known_the_difference_is_not_at_all() -> None:
    half = 0.5 * (paper_design().left + paper_design().right)
    alike = EndErrorDesign(half, half, np.zeros((3, 3)))
    fit = fit_noise(errors(np.random.default_rng(8), 20), alike)
    assert fit.difference_std == math.inf
    assert fit.correlation == -1.0
