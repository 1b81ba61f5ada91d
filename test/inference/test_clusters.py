# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A standard deviation is as wide as parts of the drives scatter, where noise alone is less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from test.inference.test_homogeneity import ROBOT, driven, late, nothing
from werrimbi_odom.effects import LIBRARY
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect
from werrimbi_odom.inference.diagnosis.p_values import p_value_by_parts, p_value_of_size
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.distributions import chi2_survival, fisher_survival
from werrimbi_odom.inference.fitting.clusters import (
    effective_freedom,
    parts_of,
    parts_of_innovations,
    widening,
)
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, value_of
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.legs.cutting import match_for_fit

Spoil = Callable[[np.ndarray, np.random.Generator], np.ndarray]


def calibrated(seed: int, spoil: Spoil, hotter: float = 0.0) -> Fitted:
    runs = [driven(10 * seed + each, spoil, f"drive_{each}", hotter) for each in range(4)]
    return fit_calibration(concatenated(match_for_fit(runs, ROBOT, 1.0, None)), ROBOT)


def deviations(fit: Fitted) -> tuple[np.ndarray, np.ndarray]:
    """Of base and radii from the truth: in standard deviations, and in those of the noise alone."""
    names = [number.name for number, _ in fit.design.columns]
    where = [names.index(name) for name in MULTIPLIERS]
    robot = fit.point.model.robot
    error = np.array([value_of(robot, name) - value_of(ROBOT, name) for name in MULTIPLIERS])
    std = np.sqrt(np.diag(fit.covariance))[where]
    return error / std, error / (std / fit.widening[where])


def rms(values: list[np.ndarray]) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.evidence
def test_where_the_model_holds_nothing_is_widened() -> None:
    fits = [calibrated(seed, nothing) for seed in range(100, 116)]
    assert all((fit.widening == 1.0).all() for fit in fits)
    assert rms([deviations(fit)[0] for fit in fits]) < 1.4


@pytest.mark.evidence
def test_sizes_are_known_as_well_as_the_parts_agree_on_them() -> None:
    """Of wheels that shrink by 5 % with something that nobody put in, to and fro in a minute."""
    fits = [calibrated(seed, nothing, hotter=0.05) for seed in range(200, 216)]
    by_parts, by_noise = zip(*map(deviations, fits), strict=True)
    assert rms(list(by_noise)) > 1.5
    assert rms(list(by_parts)) < 1.2


def test_where_parts_disagree_a_size_is_as_sure_as_they_are() -> None:
    importance = 30.0
    sound, shrinking = calibrated(100, nothing), calibrated(200, nothing, 0.05)
    assert set(sound.doubts.values()) == {1.0}
    assert shrinking.doubts["wheel_radius_scale"] > 4.0
    for fit in (sound, shrinking):
        weighed = replace(fit, importance=dict.fromkeys(CALIBRATED, importance))
        for name in CALIBRATED:
            assert 10.0 < fit.freedom[name] <= 27.0, "of 28 parts, each driven otherwise"
            by_noise = chi2_survival(importance, 1)
            by_parts = fisher_survival(importance, 1, fit.freedom[name])
            apart = fit.doubts[name] > 1.0
            assert p_value_of_size(weighed, name, ROBOT, ROBOT) == (by_parts if apart else by_noise)


def test_a_number_that_few_parts_show_is_known_by_few() -> None:
    runs = [driven(each, nothing, f"drive_{each}") for each in range(4)]
    laid = concatenated(match_for_fit(runs, ROBOT, 0.25, None))
    white = np.random.default_rng(0).normal(size=3 * laid.count)
    parts = parts_of_innovations(laid, white)
    assert parts is not None
    alike = 1.0 / np.sqrt(np.bincount(parts)[parts])
    assert effective_freedom(laid, white, alike) == pytest.approx(27.0)
    assert effective_freedom(laid, white, np.where(parts % 7 == 0, alike, 0.0)) == pytest.approx(3)


def test_an_effect_that_parts_disagree_on_counts_all_that_was_tried() -> None:
    laid = concatenated(match_for_fit([late(0, 0.1)], ROBOT, 0.25, None))
    delay = [effect for effect in LIBRARY if effect.name == "reference_delay"]
    (fit,) = search_round(laid, fit_calibration(laid, ROBOT), delay, ROBOT).tried
    mine = np.array([number.name == "reference_delay.delay" for number, _ in fit.design.columns])
    alone = homogeneity_of_effect(laid, fit, "reference_delay")
    for apart in (False, True):
        told = replace(fit, widening=np.where(mine & apart, 1.5, 1.0))
        chance = p_value_by_parts(laid, told, "reference_delay", 60)
        assert chance == (60.0 if apart else 1.0) * alone > 0.0


def test_legs_without_data_are_no_part() -> None:
    runs = [driven(each, nothing, f"drive_{each}") for each in range(2)]
    laid = concatenated(match_for_fit(runs, ROBOT, 0.25, None))
    white = np.random.default_rng(0).normal(size=(laid.count, 3))
    half = laid.run_of_leg * 0 + (np.arange(laid.count) % 100 < 50)
    parts = parts_of_innovations(laid, (white * half[:, None]).ravel())
    assert parts is not None
    assert ((parts >= 0) == np.repeat(half > 0, 3)).all()
    sizes = np.bincount(parts[parts >= 0])
    assert sizes.size == parts_of(laid.run_of_leg).max() + 1
    for of_one in (sizes[:12], sizes[12:]):
        assert of_one.max() - of_one.min() <= 3
    few = np.zeros(3 * laid.count)
    few[:60] = 1.0
    assert parts_of_innovations(laid, few) is None
    assert (widening(few, np.ones((few.size, 1)), np.eye(1), laid) == 1.0).all()
