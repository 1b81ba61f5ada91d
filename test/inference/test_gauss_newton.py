# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A search that spends no pass over the runs on what cannot be gained."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects.backlash import left_backlash
from werrimbi_odom.inference.fitting import gauss_newton as searched
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, parameters_to_fit
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.effect import AppliedEffect
from werrimbi_odom.model.robot import Robot


def test_a_parameter_that_its_bound_holds_costs_one_trial(monkeypatch: pytest.MonkeyPatch) -> None:
    """Play that would have to be negative: shorter steps are allowed no more of it."""
    random = np.random.default_rng(4)
    runs = [drive(WhiteNoiseRobot(), wandering(random, 60.0), random) for _ in range(2)]
    plain = Robot(0.35, 0.05, 2000.0, 2000.0)
    laid = concatenated([match(run, plain, 0.25) for run in runs])
    near = fit_model(laid, start_point(laid, plain), find_jumps=False)
    robot = replace(near.robot, effects=(AppliedEffect(left_backlash, {"travel": 0.0}),))
    point = replace(near.point, model=replace(near.point.model, robot=robot))
    trials: list[Any] = []
    tried = searched.predicted_on_path

    def counted(*given: Any) -> Any:
        trials.append(given)
        return tried(*given)

    monkeypatch.setattr(searched, "predicted_on_path", counted)
    numbers = (*CALIBRATION, *parameters_to_fit(left_backlash))
    fit = fit_model(laid, point, numbers, find_jumps=False, rounds=1)
    assert [number.name for number in fit.at_bound] == ["left_backlash.travel"]
    assert len(trials) == 1
