# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A size within its own uncertainty of the file is neither named nor told."""

from __future__ import annotations

import re
from dataclasses import replace
from functools import lru_cache

import numpy as np
import pytest

from test.inference.driven import COMMON
from test.inference.simulated_cases import GIVEN, Case, case
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.fits import fits_of
from werrimbi_odom.inference.adding.start_values import FitDrives
from werrimbi_odom.inference.diagnosis.calibration_selection import sizes_needed
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import best_sizes, values_of
from werrimbi_odom.inference.diagnosis.p_values import deviations_from
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.told_sizes import as_told, doubted_effects, goes_without
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.report.diagnosis.costs import sizes_found

RIGHT, ALL_OFF = 128, 68
"""Drives of a late reference: wheels and base right, but the first order keeps unequal radii; base
8 and right wheel 3 mm in a metre off, the left hardly."""


@lru_cache
def fitted(seed: int) -> tuple[Case, Concatenated, Fitted]:
    drawn = case(seed, drives=1)
    runs = concatenated(match_for_fit(drawn.runs, GIVEN, leg=1.0))
    nothing = tuple(np.zeros(run.legs, dtype=np.bool_) for run in runs.runs)
    drives = FitDrives(runs, nothing, EvaluationOptions())
    fits = fits_of([drawn.effect], drives, GIVEN, GIVEN, (), lambda share, words: None)
    return drawn, runs, fits.all


def told(seed: int, *names: str) -> Fitted:
    drawn, runs, fit = fitted(seed)
    return as_told(fit, GIVEN, [drawn.effect.name, *names], runs, ())


def sizes(fit: Fitted) -> list[float]:
    return [float(getattr(fit.point.model.robot, name)) for name in MULTIPLIERS]


def test_sizes_that_are_right_are_told_as_in_the_file() -> None:
    assert sizes_needed(fitted(RIGHT)[2], GIVEN, ()).parts == ("", "ratio")
    assert sizes(told(RIGHT)) == [1.0, 1.0, 1.0]


def test_sizes_that_are_off_are_told_and_the_one_that_is_not_is_right_as_it_is() -> None:
    drawn, _, _ = fitted(ALL_OFF)
    base, left, right = sizes(told(ALL_OFF))
    assert base == pytest.approx(drawn.truth.wheel_separation_multiplier, abs=1e-3)
    assert left == 1.0
    assert right == pytest.approx(drawn.truth.right_wheel_radius_multiplier, abs=1e-3)


def test_a_name_whose_size_is_smaller_than_twice_its_uncertainty_is_taken_back() -> None:
    """One wheel was called larger, beyond any chance, by 0.036 +- 0.042 %."""
    wider = told(RIGHT, "track_width")
    assert 0.0 < deviations_from(GIVEN, wider, "track_width") < rules.SIGNIFICANT
    assert doubted_effects(wider, GIVEN, ("reference_delay", "track_width")) == ["track_width"]
    assert goes_without(told(RIGHT), GIVEN, "track_width")
    assert doubted_effects(wider, GIVEN, ("reference_delay",)) == []


def test_a_name_whose_size_is_sure_stays() -> None:
    found = ("reference_delay", "track_width", "unequal_wheel_radii")
    assert doubted_effects(told(ALL_OFF, *found[1:]), GIVEN, found) == []


def test_a_size_that_the_drives_need_is_not_gone_without() -> None:
    """On a circle seen from beside the axle another size would do as well, but one must."""
    assert not goes_without(told(ALL_OFF), GIVEN, "track_width")
    assert not goes_without(told(ALL_OFF), GIVEN, "unequal_wheel_radii")


def test_what_is_not_determined_is_no_matter_of_size() -> None:
    wider = replace(told(RIGHT, "track_width"), held=("track_width",))
    assert doubted_effects(wider, GIVEN, ("track_width",)) == []


def test_a_ratio_is_known_where_the_size_of_both_wheels_is_not() -> None:
    """By coarse positions and fine headings it was as little known as the larger wheel alone."""
    random = np.random.default_rng(1)
    given = WhiteNoiseRobot(0.3, 0.05, 0.05, 3e-4, 3e-4)
    robot = replace(given, right_radius=0.0505)
    runs = [
        drive(robot, wandering(random, 60.0), random, sigma_xy=0.3, sigma_yaw=2e-3)
        for _ in range(3)
    ]
    found = diagnose(runs, given.entered(0.05), COMMON)
    assert found.found == ("unequal_wheel_radii",)
    wheel = best_sizes(found)["right_wheel_radius_multiplier"]
    assert wheel[1] is not None
    assert wheel[1] > 3e-3
    ratio = values_of(found, "unequal_wheel_radii")["ratio"]
    assert ratio.std < 4e-4
    assert ratio.value == pytest.approx(1.01, abs=3.0 * ratio.std)
    said = r"right over left radius 1\.0\d+ ± 0\.0\d+ % larger, both radii known .* only to 1\.\d %"
    assert re.fullmatch(said, sizes_found(found))
