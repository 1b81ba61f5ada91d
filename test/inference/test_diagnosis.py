# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What the diagnosis stands on: predictions laid end to end, pushes of errors, weighed models."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.diagnosis import forward_selection
from werrimbi_odom.inference.diagnosis.effect_support import support_of
from werrimbi_odom.inference.diagnosis.evidence import summed_over_legs
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.diagnosis.step_jacobians import AMOUNTS, Amount, step_jacobians
from werrimbi_odom.inference.diagnosis.variables import variables_of
from werrimbi_odom.inference.fitting import caches, concatenated_runs
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.fitting.fit import start_point
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION, Model
from werrimbi_odom.inference.fitting.prediction import path_of, predict, predict_all, predicted_legs
from werrimbi_odom.inference.fitting.score_tests import candidates, scores
from werrimbi_odom.inference.fitting.whitened_innovations import jacobian_of
from werrimbi_odom.inference.legs.cutting import match
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot

TRUE = WhiteNoiseRobot()
ROBOT = TRUE.entered(0.05)


@pytest.fixture(scope="module")
def runs() -> list[Any]:
    random = np.random.default_rng(7)
    return [drive(TRUE, wandering(random, 60.0), random) for _ in range(3)]


@pytest.fixture(scope="module")
def laid(runs: list[Any]) -> Concatenated:
    return concatenated([match(run, ROBOT, 0.25, turn=0.4) for run in runs])


def test_runs_laid_end_to_end_are_predicted_as_one_by_one(laid: Concatenated) -> None:
    slipping = replace(
        ROBOT,
        effects=(
            find("lateral_slip").using(creep=0.01),
            find("floor_slope").using(x=0.01),
            find("left_backlash").using(travel=0.003),
        ),
    )
    model = Model(slipping, tuple({} for _ in laid.runs))
    every = predict_all(model, laid)
    for index, run in enumerate(laid.runs):
        own = slice(laid.legs[index], laid.legs[index + 1])
        alone = predict(slipping, run)
        np.testing.assert_allclose(every.relative[own], alone.relative, atol=1e-12)
        np.testing.assert_allclose(every.per_left[own], alone.per_left, rtol=1e-6, atol=1e-12)
        np.testing.assert_allclose(every.along[own], alone.along, atol=1e-12)


def slope(laid: Concatenated, ahead: Robot, behind: Robot, step: float) -> Floats:
    poses = [
        predicted_legs(Model(side, tuple({} for _ in laid.runs)), laid) for side in (ahead, behind)
    ]
    return np.asarray((poses[0] - poses[1]) / (2.0 * step))


def pushed(laid: Concatenated, amount: Amount) -> Floats:
    point = start_point(laid, ROBOT)
    left, right = step_jacobians(laid, path_of(point.model, laid), [amount], point)
    ones = np.ones((laid.run_of_step.size, 1))
    return np.asarray(
        (summed_over_legs(laid, ones, left) + summed_over_legs(laid, ones, right))[..., 0]
    )


def test_an_error_pushes_the_legs_as_the_law_that_makes_it(laid: Concatenated) -> None:
    """The evidence map's linear patterns against finite differences of laws that say the same."""

    def with_effect(name: str, **values: float) -> Robot:
        return replace(ROBOT, effects=(find(name).using(**values),))

    step = 1e-4
    crab = slope(
        laid,
        with_effect("sideways_drift", angle=step),
        with_effect("sideways_drift", angle=-step),
        step,
    )
    np.testing.assert_allclose(pushed(laid, Amount("sideways", "travel")), crab, atol=2e-5)
    left = ROBOT.left_wheel_radius_multiplier
    wheel = slope(
        laid,
        replace(ROBOT, left_wheel_radius_multiplier=left * (1.0 + step)),
        replace(ROBOT, left_wheel_radius_multiplier=left * (1.0 - step)),
        step,
    )
    np.testing.assert_allclose(pushed(laid, Amount("left", "travel")), wheel, atol=2e-5)
    both = slope(
        laid,
        with_effect("wheel_radius_scale", multiplier=1.0 + step),
        with_effect("wheel_radius_scale", multiplier=1.0 - step),
        step,
    )
    np.testing.assert_allclose(pushed(laid, Amount("along", "travel")), both, atol=2e-5)


def test_two_poses_a_drive_may_lie_just_outside_the_ticks(runs: list[Any]) -> None:
    """A robot is measured where it is put down and where it is found; it stands meanwhile."""
    run = runs[0]
    seen = run.reference
    first, last = run.ticks.time[0] - 0.2, run.ticks.time[-1] + 0.003
    ends = Reference(
        np.array([first, last]), *(part[[0, -1]] for part in (seen.x, seen.y, seen.yaw))
    )
    whole = Run("two", Path("two"), Ticks(run.ticks.time, run.ticks.left, run.ticks.right), ends)
    matched = match(whole, ROBOT, 1.0)
    assert matched.legs == 1
    counted = run.ticks.left[-1] - run.ticks.left[0]
    assert matched.left.sum() == pytest.approx(counted, abs=1e-6)
    assert np.isfinite(predict(ROBOT, matched).relative).all()


def test_every_amount_has_a_channel_of_the_contract() -> None:
    channels = {"left", "right", "along", "sideways", "heading"}
    assert {amount.channel for amount in AMOUNTS} == channels


def test_a_right_robot_needs_no_calibration_and_no_effect_scores(laid: Concatenated) -> None:
    fit = fit_calibration(laid, ROBOT)
    assert fit.calibrated == ()
    tried = candidates(LIBRARY, (), (), len(laid.runs))
    best = max(scores(laid, fit.point, CALIBRATION, tried), key=lambda score: score.excess)
    assert best.gain < best.degrees + 25.0


@pytest.mark.parametrize(
    ("wrong", "named"),
    [
        ({"wheel_separation": TRUE.separation * 0.99}, "track_width"),
        ({"wheel_radius": 0.0503}, "wheel_radius_scale"),
        (
            {
                "left_wheel_radius_multiplier": ROBOT.left_wheel_radius_multiplier * 0.998,
                "right_wheel_radius_multiplier": ROBOT.right_wheel_radius_multiplier * 1.002,
            },
            "unequal_wheel_radii",
        ),
    ],
)
def test_of_the_multipliers_those_are_kept_that_are_wrong(
    runs: list[Any], wrong: dict[str, float], named: str
) -> None:
    robot = replace(ROBOT, **wrong)  # type: ignore[arg-type]
    wronged = concatenated([match(run, robot, 0.25, turn=0.4) for run in runs])
    fit = fit_calibration(wronged, robot)
    assert named in fit.calibrated
    assert max(fit.importance, key=lambda name: fit.importance[name]) == named


def test_what_an_effect_looks_at_and_acts_on_is_found_by_trying_it(laid: Concatenated) -> None:
    steps = laid.drive(ROBOT)
    by_name = {each.name: each for each in candidates(LIBRARY, (), (), len(laid.runs))}
    castor = support_of(by_name["castor_kick"], steps)
    assert "since_reversal" in castor.inputs
    assert castor.outputs <= {"heading"}
    slip = support_of(by_name["lateral_slip"], steps)
    assert (slip.inputs, slip.outputs) == ({"speed"}, {"sideways"})
    missed = support_of(by_name["left_missed_ticks"], steps)
    assert missed.outputs <= {"left"}
    assert "left_speed" in missed.inputs


def test_what_goes_with_the_acceleration_is_a_matter_of_a_law_of_it(laid: Concatenated) -> None:
    slip = Candidate(find("coulomb_slip"), {"above": 0.5})
    own = support_of(slip, laid.drive(ROBOT)).inputs
    variables = {each.name: each for each in variables_of(laid, start_point(laid, ROBOT).model)}
    assert own & set(variables["acceleration"].looks_at)


def test_what_is_set_aside_is_not_fitted_on() -> None:
    """A quarter of every drive's reference; the counters run on through it."""
    time = np.linspace(0.0, 60.0, 601)
    ticks = Ticks(time, np.arange(601), np.arange(601))
    seen = Reference(time, time, time, time)
    runs = [Run(f"run_{number}", Path(f"run_{number}"), ticks, seen) for number in range(3)]
    fitted, kept = set_aside(runs)
    assert [run.name for run in fitted] == [run.name for run in kept] == [run.name for run in runs]
    for run, other in zip(fitted, kept, strict=True):
        assert run.reference is not None
        assert other.reference is not None
        assert not set(run.reference.time) & set(other.reference.time)
        assert other.reference.time.size == pytest.approx(150, abs=2)
        assert run.ticks.rows == other.ticks.rows == 601


def test_no_leg_spans_what_is_set_aside(runs: list[Any]) -> None:
    fitted, kept = set_aside(runs)
    for side in (fitted, kept):
        for run in side:
            matched = match(run, ROBOT, 0.25, turn=0.4)
            ends = matched.measured.time
            for begin, end in run.taken_out:
                spans = (ends[:-1] < end - 1e-9) & (ends[1:] > begin + 1e-9)
                assert matched.gap[spans].all()
            assert not matched.record.left_out
            usual = np.diff(ends)[~matched.gap].max()
            assert usual < 4.0


def test_few_poses_put_whole_drives_aside() -> None:
    time = np.linspace(0.0, 60.0, 601)
    ticks = Ticks(time, np.arange(601), np.arange(601))
    seen = Reference(*(np.array([0.0, 60.0]) for _ in range(4)))
    runs = [Run(f"run_{number}", Path(f"run_{number}"), ticks, seen) for number in range(3)]
    fitted, kept = set_aside(runs)
    assert len(fitted) + len(kept) == len(runs)
    assert not {run.name for run in fitted} & {run.name for run in kept}
    (first,), (last,) = set_aside(runs[:1])
    assert first.ticks.time[-1] < last.ticks.time[0]


@pytest.mark.parametrize("order", [(0, 1), (1, 0)])
@pytest.mark.parametrize(
    ("poses", "to_fit"),
    [((2, 60), 60), ((2, 600), 452), ((40, 600), 490)],  # a quarter of the 600, or the two poses
)
def test_what_is_set_aside_does_not_hang_on_the_order_of_the_drives(
    poses: tuple[int, int], to_fit: int, order: tuple[int, int]
) -> None:
    """A drive seen at its ends alone was all that was left to fit, where it came first."""
    runs = []
    for count in (poses[index] for index in order):
        time = np.linspace(0.0, 60.0, count)
        ticks = Ticks(np.linspace(0.0, 60.0, 601), np.arange(601), np.arange(601))
        runs.append(Run(f"{count}", Path(f"{count}"), ticks, Reference(time, time, time, time)))
    fitted, kept = set_aside(runs)
    assert kept
    assert sum(run.reference.time.size for run in fitted if run.reference) == to_fit


def test_derivatives_worked_out_side_by_side_are_the_same_to_the_last_bit(
    laid: Concatenated, monkeypatch: pytest.MonkeyPatch
) -> None:
    point, asked = start_point(laid, ROBOT), candidates(LIBRARY, (), (), len(laid.runs))
    found = []
    for worth in (range(10**6), range(0)):
        monkeypatch.setattr(caches, "WORTH_THREADS", worth)
        runs = concatenated(laid.runs)
        found.append((jacobian_of(runs, point.model, CALIBRATION), scores(runs, point, (), asked)))
    (one, gains), (other, its) = found
    assert np.array_equal(one, other)
    assert [score.gain for score in gains] == [score.gain for score in its]
    assert len(gains) > 20


def test_fits_side_by_side_are_the_same_to_the_last_bit(
    laid: Concatenated, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(forward_selection, "worth_fitting", lambda ordered, floor: ordered[:3])
    monkeypatch.setattr(forward_selection, "may_pay", lambda score, before, data: True)
    found = []
    for worth in (range(10**6), range(0)):
        monkeypatch.setattr(caches, "WORTH_THREADS", worth)
        monkeypatch.setattr(concatenated_runs, "WORTH_COPIES", worth)
        runs = concatenated(laid.runs)
        found.append(search_round(runs, fit_calibration(runs, ROBOT), LIBRARY, ROBOT))
        given = runs.side_by_side([lambda own: own] * 2)
        assert len({id(each) for each in (*given, runs)}) == (3 if worth else 1)
    one, other = found
    assert [fit.total for fit in one.tried] == [fit.total for fit in other.tried]
    assert len(one.tried) > 1
    assert [cell.gain for cell in one.dependences] == [cell.gain for cell in other.dependences]
