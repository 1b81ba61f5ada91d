# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Calibration by maximum likelihood: right, sure of itself just as much as it should be."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference.comparison.leg_errors import (
    LegErrors,
    LegStatistics,
    errors_of,
    joined,
    statistics,
)
from werrimbi_odom.inference.diagnosis.evidence import dependences
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import ModelFit, fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, Model, parameters_to_fit
from werrimbi_odom.inference.fitting.noise import NOISES, noise_estimates
from werrimbi_odom.inference.fitting.whitened_innovations import Costs
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel
from werrimbi_odom.model.robot import Robot

NOMINAL = Robot(0.35, 0.05, 2000.0, 2000.0)
TRUE = WhiteNoiseRobot()
TRUTH = {
    "wheel_separation_multiplier": TRUE.separation / 0.35,
    "left_wheel_radius_multiplier": TRUE.left_radius / 0.05,
    "right_wheel_radius_multiplier": TRUE.right_radius / 0.05,
    "left_wheel_noise": TRUE.left_noise,
    "right_wheel_noise": TRUE.right_noise,
    "reference_sigma_xy": 1e-3,
    "reference_sigma_yaw": 2e-3,
}


def runs_of(seed: int, *, count: int = 4, seconds: float = 60.0) -> list[Any]:
    random = np.random.default_rng(seed)
    return [drive(TRUE, wandering(random, seconds), random) for _ in range(count)]


def fitted(runs: list[Any]) -> tuple[ModelFit, dict[str, Any]]:
    matched = concatenated([match(run, NOMINAL, 0.25) for run in runs])
    fit = fit_model(matched, start_point(matched, NOMINAL))
    costs = Costs(matched, fit.point)
    return fit, noise_estimates(costs, fit.point.variances, (False, False))


def deviations(seed: int) -> dict[str, float]:
    """(estimate - truth) / stated standard deviation of everything that is fitted."""
    fit, noises = fitted(runs_of(seed))
    spread = np.sqrt(np.diag(fit.covariance))
    result = {
        number.name: (fit.point.model.value(number) - TRUTH[number.name]) / spread[index]
        for index, number in enumerate(fit.free)
    }
    for name in NOISES:
        result[name] = (noises[name].value - TRUTH[name]) / noises[name].std
    return result


def test_the_truth_lies_within_four_of_the_stated_standard_deviations() -> None:
    found = deviations(seed=11)
    assert set(found) == set(TRUTH)
    assert max(abs(value) for value in found.values()) < 4.0


@pytest.mark.evidence
def test_the_stated_95_percent_intervals_hold_the_truth_in_90_to_99_percent_of_50() -> None:
    found = [deviations(seed) for seed in range(50)]
    for name in TRUTH:
        inside = np.mean([abs(values[name]) < 1.96 for values in found])
        print(f"{name:32s} inside the 95 % interval: {inside:.0%}")
    everything = np.mean([abs(value) < 1.96 for values in found for value in values.values()])
    assert 0.90 <= everything <= 0.99
    for name in TRUTH:
        assert np.mean([abs(values[name]) < 1.96 for values in found]) >= 0.86


def test_a_base_that_was_never_turned_on_is_left_alone() -> None:
    random = np.random.default_rng(5)
    speed = 0.4 * np.ones(1500)
    straight = [drive(TRUE, (speed, 0.0 * speed), random) for _ in range(3)]
    nominal = replace(NOMINAL, wheel_separation_multiplier=1.02)
    matched = concatenated([match(run, nominal, 0.5) for run in straight])
    # The wheels themselves differ, so the robot does turn a little: what is told apart is bounded.
    fit = fit_model(matched, start_point(matched, nominal))
    assert [number.name for number in fit.not_identifiable] == ["wheel_separation_multiplier"]
    assert fit.robot.wheel_separation_multiplier == 1.02


def test_a_noise_of_which_the_data_say_nothing_is_not_determined() -> None:
    """By ten squares, each measured at begin and end, a tape erred by 0.14 um, exactly.

    There the noises of wheels and headings are so much larger that the likelihood is level.
    """
    matched = concatenated([match(run, NOMINAL, 8.0) for run in runs_of(seed=5)])
    point = fit_model(matched, start_point(matched, NOMINAL)).point
    variances = replace(point.variances, xy=np.array([1e-14]))
    found = noise_estimates(Costs(matched, point), variances, (False, False))["reference_sigma_xy"]
    assert not found.determined
    assert 2.0 * found.std > 1e-3, "no less than it was"


@pytest.mark.parametrize("rounds", [1, 2])
def test_the_noise_of_a_fit_is_that_of_its_model_however_far_it_came(rounds: int) -> None:
    """What the model that it began with left was noise of the wheels, ten times theirs."""
    wrong = replace(NOMINAL, wheel_separation_multiplier=1.2)
    matched = concatenated([match(run, wrong, 0.25) for run in runs_of(seed=11)])
    fit = fit_model(matched, start_point(matched, wrong), find_jumps=False, rounds=rounds)
    noises = [
        float(np.sqrt(part[0])) for part in (fit.point.variances.left, fit.point.variances.right)
    ]
    assert noises == pytest.approx([TRUE.left_noise, TRUE.right_noise], rel=0.4)


@wheel_effect(grip=Parameter("", 0.0, 0.2, (-5.0, 5.0), "what holds; a wheel slips with the rest"))
def slip_beyond_grip(travel: Any, drive: Any, grip: float) -> Any:
    """A wheel slips until it is held.

    Formula    travel *= 1 - (0.3 - grip) where that is above 0
    Signature  distances shrink
    Ruler      drive a taped line
    """
    lost = max(0.3 - grip, 0.0)
    return WheelTravel(travel.left * (1.0 - lost), travel.right * (1.0 - lost))


@pytest.mark.parametrize("rounds", [1, 3])
def test_what_has_no_effect_where_a_fit_ends_is_no_number(rounds: int) -> None:
    """Wheels larger than the file says: no slip at all is best, and more grip moves nothing."""
    robot = replace(
        NOMINAL,
        left_wheel_radius_multiplier=0.9,
        right_wheel_radius_multiplier=0.9,
        effects=(slip_beyond_grip.using(grip=0.1),),
    )
    matched = concatenated([match(run, robot, 0.25) for run in runs_of(seed=11)])
    numbers = parameters_to_fit(slip_beyond_grip)
    fit = fit_model(matched, start_point(matched, robot), numbers, find_jumps=False, rounds=rounds)
    assert fit.free == ()
    assert fit.robot.effects == robot.effects


def test_jumps_of_the_tracker_are_found_and_left_out() -> None:
    clean = runs_of(3, count=2)
    spoilt = runs_of(3, count=2)
    for run in spoilt:
        run.reference.x[400:] += 0.25  # the tracker re-initialised
        run.reference.y[700] -= 0.4  # a single false pose
    honest, _ = fitted(clean)
    robust, _ = fitted(spoilt)
    assert sum(int(legs.sum()) for legs in robust.point.excluded) >= 2
    for index, number in enumerate(robust.free):
        spread = np.sqrt(robust.covariance[index, index])
        shift = robust.point.model.value(number) - honest.point.model.value(number)
        assert abs(shift) < spread


def test_positions_alone_calibrate_too() -> None:
    runs = runs_of(8)
    for run in runs:
        run.reference.yaw[:] = np.nan
    matched = concatenated([match(run, NOMINAL, 0.25) for run in runs])
    fit = fit_model(matched, start_point(matched, NOMINAL))
    spread = np.sqrt(np.diag(fit.covariance))
    assert len(fit.free) == 3
    for index, number in enumerate(fit.free):
        assert abs(fit.point.model.value(number) - TRUTH[number.name]) < 4.0 * spread[index]


def headings_alone(runs: list[Any]) -> list[Any]:
    for run in runs:
        run.reference.x[:] = run.reference.y[:] = np.nan
    return runs


@pytest.mark.parametrize("kind", ["absolute", "incremental"])
def test_headings_alone_hold_two_numbers(kind: ReferenceKind) -> None:
    """The right and the left radius over the base; both radii keep their mean as given."""
    given = replace(NOMINAL, left_wheel_radius_multiplier=1.02, right_wheel_radius_multiplier=1.03)
    matched = concatenated([match(run, given, 0.25) for run in headings_alone(runs_of(8))])
    fit = fit_model(matched, start_point(matched, given, EvaluationOptions(reference_kind=kind)))
    assert (fit.numbers, fit.held) == (2, ("wheel_radius_scale",))
    base, left, right = (getattr(fit.robot, name) for name in list(TRUTH)[:3])
    assert left * right == pytest.approx(1.02 * 1.03, rel=1e-6)
    # Of the three values only two move independently.
    assert np.linalg.matrix_rank(fit.covariance, tol=1e-12) == 2
    for side, value in (("left", left), ("right", right)):
        index = [number.name for number in fit.free].index(f"{side}_wheel_radius_multiplier")
        row = np.zeros(3)
        row[index], row[0] = 1.0 / value, -1.0 / base
        std = float(np.sqrt(row @ fit.covariance @ row))
        true = TRUTH[f"{side}_wheel_radius_multiplier"] / TRUTH["wheel_separation_multiplier"]
        assert abs(np.log(value / base) - np.log(true)) < 4.0 * std
        assert std < 2e-3


def test_an_incremental_reference_calibrates_too() -> None:
    """A scan matcher's pose drifts, but its steps are good."""
    random = np.random.default_rng(21)
    runs = runs_of(21)
    for run in runs:
        reference = run.reference
        drift = np.cumsum(1e-3 * random.standard_normal((2, reference.time.size)), axis=1)
        reference.x[:] += drift[0]
        reference.y[:] += drift[1]
    matched = concatenated([match(run, NOMINAL, 0.25) for run in runs])
    incremental = EvaluationOptions(reference_kind="incremental")
    fit = fit_model(matched, start_point(matched, NOMINAL, incremental))
    for index, number in enumerate(fit.free):
        spread = np.sqrt(fit.covariance[index, index])
        assert abs(fit.point.model.value(number) - TRUTH[number.name]) < 4.0 * spread


def test_under_a_true_model_nothing_depends_on_anything() -> None:
    matched = concatenated([match(run, NOMINAL, 0.25) for run in runs_of(2)])
    fit = fit_model(matched, start_point(matched, NOMINAL))
    assert dependences(matched, fit.point, CALIBRATION)[0].p_value > 0.01


def test_a_missing_effect_shows_as_a_dependence() -> None:
    """The reference measures a point 3 cm to the left of the axle's middle: turns displace it."""
    runs = runs_of(2)
    for run in runs:
        run.reference.x[:] -= 0.03 * np.sin(run.reference.yaw)
        run.reference.y[:] += 0.03 * np.cos(run.reference.yaw)
    matched = concatenated([match(run, NOMINAL, 0.25) for run in runs])
    fit = fit_model(matched, start_point(matched, NOMINAL))
    strongest = dependences(matched, fit.point, CALIBRATION)[0]
    assert strongest.p_value < 1e-12
    assert (strongest.channel, strongest.name) == ("along", "turn")


KNOWN = replace(
    NOMINAL,
    wheel_separation_multiplier=TRUTH["wheel_separation_multiplier"],
    left_wheel_radius_multiplier=TRUTH["left_wheel_radius_multiplier"],
    right_wheel_radius_multiplier=TRUTH["right_wheel_radius_multiplier"],
    left_wheel_noise=TRUE.left_noise,
    right_wheel_noise=TRUE.right_noise,
)


def legs_of(seed: int, count: int, leg: float = 1.0) -> LegErrors:
    runs = concatenated([match(run, NOMINAL, leg) for run in runs_of(seed, count=count)])
    return errors_of(Model(KNOWN, ({},) * count), runs, 1e-3, 2e-3)


def constant(legs: LegErrors) -> LegErrors:
    """The same legs with the constant pose covariance of diff_drive_controller's example file."""
    example = np.diag([0.001, 0.001, 0.01])
    return replace(legs, covariance=np.broadcast_to(example, legs.covariance.shape))


def report(name: str, legs: LegErrors) -> tuple[LegStatistics, LegStatistics]:
    ours, theirs = statistics(legs), statistics(constant(legs))
    print(
        f"{name:8s} {ours.count:6d} legs  NEES {ours.nees:6.3f} coverage {ours.coverage_95:6.1%}"
        f"   constant covariance: NEES {theirs.nees:7.4f} coverage {theirs.coverage_95:6.1%}"
    )
    return ours, theirs


@pytest.mark.evidence
def test_the_covariance_is_honest_by_motion_type() -> None:
    legs = joined([legs_of(seed, count=20) for seed in range(900, 980)])
    for kind in ("line", "arc", "spin"):
        ours, theirs = report(kind, legs.chosen(legs.kind == kind))
        assert ours.nees == pytest.approx(1.0, abs=0.05)
        assert 0.94 <= ours.coverage_95 <= 0.96
        assert abs(theirs.nees - 1.0) > 0.2


@pytest.mark.evidence
def test_the_covariance_is_honest_for_short_and_long_legs() -> None:
    for length in (0.25, 1.0, 4.0, 12.0):
        ours, _ = report(
            f"{length:g} m", legs_of(77, count=400 if length > 2.0 else 100, leg=length)
        )
        assert ours.nees == pytest.approx(1.0, abs=0.08)
