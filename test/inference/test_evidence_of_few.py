# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Of few legs the scatter is hardly known: what errors go with is as uncertain as what they do."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np

from test.inference.driven import of_headings, run_by
from test.model.drives import ROBOT
from werrimbi_odom.effects import LIBRARY
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.evidence import dependences
from werrimbi_odom.inference.diagnosis.p_values import p_value_of_size
from werrimbi_odom.inference.distributions import fisher_survival
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.legs.cutting import match_for_fit

GYRO = EvaluationOptions(reference_kind="incremental")


def likeliest_by_chance(seed: int) -> float:
    """Smallest p-value of what the errors of a spin go with, by a gyro noisier than is assumed."""
    random = np.random.default_rng(seed)
    spin = run_by(ROBOT, np.zeros(200), np.full(200, 0.5), seed=seed)
    seen = spin.reference
    assert seen is not None
    wandering = 0.02 * np.cumsum(random.normal(size=seen.time.size))
    turned = of_headings(seen.time, seen.yaw + wandering)
    runs = concatenated(match_for_fit([replace(spin, reference=turned)], ROBOT, 1.0))
    assert 8 <= runs.data < rules.NOISE_NUMBERS
    point = fit_model(runs, start_point(runs, ROBOT, GYRO), CALIBRATION).point
    return dependences(runs, point, CALIBRATION)[0].p_value


def test_noise_larger_than_assumed_is_no_dependence() -> None:
    found = [likeliest_by_chance(seed) for seed in range(6)]
    assert min(found) > rules.VERY_SURE, found


def test_a_size_is_as_sure_as_few_data_know_their_noise() -> None:
    """By 18 headings of a gyro a wheel of 1 % was said to be chance once in 10^11."""
    name, fit = "unequal_wheel_radii", SimpleNamespace(spare=14.0, importance={}, freedom={})
    fit.importance[name], fit.freedom[name], fit.doubts = 47.0, 5.0, {name: 1.0}
    of_few: Any = fit
    assert p_value_of_size(of_few, name, ROBOT, ROBOT) == fisher_survival(47.0, 1, 14.0) > 1e-6
    fit.doubts[name] = 1.5
    assert p_value_of_size(of_few, name, ROBOT, ROBOT) == fisher_survival(47.0, 1, 5.0)


def test_what_was_not_fitted_is_no_surer_than_what_was() -> None:
    """By nine headings the table said "< 1e-12" of effects that the verdict did not find."""
    spin = run_by(ROBOT, np.full(160, 0.1), np.full(160, 0.3), seed=2)
    seen = spin.reference
    assert seen is not None
    wandering = 0.02 * np.cumsum(np.random.default_rng(2).normal(size=seen.time.size))
    turned = of_headings(seen.time, seen.yaw + wandering)
    options = replace(GYRO, leg=0.25)
    found = diagnose([replace(spin, reference=turned)], ROBOT, LIBRARY, options)
    assert found.runs.data < rules.NOISE_NUMBERS
    assert found.verdict in ("none", "unknown")
    assert min(item.p_value for item in found.ranking if item.p_value is not None) > rules.VERY_SURE
