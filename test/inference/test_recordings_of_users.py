# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What ordinary recordings show, and what must not be said of them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import COMMON, of_headings, parts, run_of, runs_of
from test.model.drives import ROBOT, read
from werrimbi_odom.effects import LIBRARY, find
from werrimbi_odom.effects.user_effects import load_file
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.leg_errors import statistics
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.inference.diagnosis.evidence import Dependence
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.penalised_likelihood import RATIO
from werrimbi_odom.inference.diagnosis.step_jacobians import Amount
from werrimbi_odom.inference.diagnosis.variables import Variable, curve_knots, variables_of
from werrimbi_odom.inference.drafting.draft import draft_effect
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.set_up.search import look_for_mistakes
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.comparison.words import words_of
from werrimbi_odom.report.diagnosis.dependence import dependence_words, strength_words


def as_turning(robot: Robot, base: float) -> Robot:
    """A robot that turns as if its base were so many times as wide."""
    return replace(robot, wheel_separation_multiplier=base * robot.wheel_separation_multiplier)


@pytest.mark.parametrize("base", [1.5, 1.95])
@pytest.mark.parametrize("headings", [True, False])
def test_four_driven_wheels_are_no_mistake_of_entering(base: float, headings: bool) -> None:
    """Wheels that skid turn as on a wider base: said beside what might be entered wrongly.

    Of headings alone it is the base that leads, so that distances stay as they are.
    """
    runs = runs_of(as_turning(ROBOT, base), [1, 2])
    runs = [parts(run, "yaw") for run in runs] if headings else runs
    (finding,) = look_for_mistakes(runs, ROBOT).findings
    assert finding.effect == "track_width"
    assert finding.values["multiplier"] == pytest.approx(base, rel=0.03)
    assert "four driven wheels" in finding.words
    assert finding.twins == (("wheel_radius_scale",) if headings else ())


@pytest.mark.parametrize("base", [0.5, 4.0])
def test_no_wheels_skid_as_much(base: float) -> None:
    (finding,) = look_for_mistakes(runs_of(as_turning(ROBOT, base), [1, 2]), ROBOT).findings
    assert "four driven wheels" not in finding.words


@pytest.mark.parametrize(("ratio", "possible"), [(1.15, True), (1.4, False)])
def test_no_effect_is_believed_beside_wheels_of_two_sizes(ratio: float, possible: bool) -> None:
    """A robot that slides past its gyro was named a soft tyre, and one wheel 45 % smaller."""
    soft = replace(ROBOT, effects=(find("tyre_squash").using(coefficient=0.05),))
    truth = replace(soft, right_wheel_radius_multiplier=ratio)
    laid = concatenated(match_for_fit(runs_of(truth, [1, 2], 60), ROBOT, 1.0, None))
    this = search_round(laid, fit_calibration(laid, ROBOT), [find("tyre_squash")], ROBOT)
    assert [fit.names[-1] for fit in this.tried] == ["tyre_squash"]
    assert (RATIO in this.tried[0].at_bound) is not possible


@pytest.mark.parametrize("away", [2.0, 3.3])
def test_a_size_is_found_as_surely_as_an_effect(away: float) -> None:
    """Of few data calibration was a finding where chance shows as much once in 80 diagnoses."""
    run = run_of(ROBOT, 5, 20)
    fit = diagnose([run], ROBOT, [], holdout=[run]).final
    robot = fit.point.model.robot
    column = [number.name for number, _ in fit.design.columns].index("wheel_separation_multiplier")
    share = float(np.sqrt(fit.covariance[column, column])) * away
    off = replace(
        robot, wheel_separation_multiplier=robot.wheel_separation_multiplier * (1.0 + share)
    )
    found = diagnose([run], off, COMMON, holdout=[run])
    chances = [each.p_value for each in found.ranking if each.effect in found.found]
    assert all(each is not None and each < rules.SURE for each in chances)
    assert found.found == (() if away < 3.0 else ("track_width",))


@pytest.mark.parametrize("factor", [57.3, in_evidence(1.0 / 2.1)])
def test_a_file_whose_multiplier_mends_a_factor_is_fitted_as_any_other(factor: float) -> None:
    """`add track_width` writes a multiplier of 1/57.3 where degrees were entered.

    That was beyond the bounds of a fit: it had no derivative, and nothing missing was seen.
    """
    run = run_of(ROBOT, 5, 40)
    true = ROBOT.wheel_separation_multiplier / factor
    entered = replace(ROBOT, wheel_separation=ROBOT.wheel_separation * factor)
    off = replace(entered, wheel_separation_multiplier=1.05 * true)
    found = diagnose([run], off, COMMON, holdout=[run])
    assert found.effect == "track_width"
    assert found.robot.wheel_separation_multiplier == pytest.approx(true, rel=0.003)


@pytest.mark.evidence
def test_the_rival_that_headings_alone_leave_is_told_with_the_inverse() -> None:
    """Of headings alone the radii are the base's rival: "multiplier 1 ± 6e-12" was printed."""
    runs = [
        parts(run, "yaw")
        for run in runs_of(
            replace(as_turning(ROBOT, 1.95), right_wheel_radius_multiplier=1.01), [1, 2]
        )
    ]
    found = diagnose(runs, ROBOT, COMMON, holdout=runs)
    assert found.rivals == ("track_width", "wheel_radius_scale")
    base = values_of(found, "track_width")["multiplier"]
    radii = values_of(found, "wheel_radius_scale")["multiplier"]
    assert base.value == pytest.approx(1.95, rel=0.03)
    assert radii.value == pytest.approx(1.0 / base.value)
    assert radii.std / radii.value == pytest.approx(base.std / base.value)


def test_a_drift_of_a_gyro_is_not_learnt_from_one_leg() -> None:
    """It took the leg's whole error: "falls from 0.00° to 0.00°"."""
    run = parts(run_of(as_turning(ROBOT, 1.3), 4, 30), "yaw")
    assert run.reference is not None
    rows = np.flatnonzero(run.reference.time < run.reference.time[0] + 2.5)
    short = replace(run, reference=run.reference.chosen(rows))
    for some, fewest in ((short, 1), (run, rules.DRIFT_LEGS)):
        legs = compare([some], ROBOT, EvaluationOptions(leg=0.5)).legs
        assert legs.run.size >= fewest
        assert (legs.run.size < rules.DRIFT_LEGS) == (some is short)
        assert statistics(legs.errors).rmse_yaw_rad > 0.05


def test_nothing_goes_with_an_acceleration_that_no_wheel_can_make() -> None:
    """Stamps that wander make it, and errors went with -43 m/s^2.

    Of counters that are read now and then, so that nobody can say when.
    """
    run, random = run_of(ROBOT, 4, 30), np.random.default_rng(4)
    kept = np.flatnonzero(random.random(run.ticks.time.size) < 0.7)
    stamps = np.sort(run.ticks.time[kept] + random.uniform(0.0, 0.09, kept.size))
    late = Ticks(stamps, run.ticks.left[kept], run.ticks.right[kept])
    for ticks, told in ((run.ticks, True), (late, False)):
        laid = concatenated(match_for_fit([replace(run, ticks=ticks)], ROBOT, 1.0))
        names = {item.name for item in variables_of(laid, Model(ROBOT, ({},)))}
        assert ("acceleration" in names) == told
        assert "speed" in names


def test_sizes_that_are_told_are_those_that_occurred() -> None:
    """An error per metre where the robot stands is none: it was told as where it is highest."""
    random = np.random.default_rng(5)
    speed = np.concatenate([np.zeros(480), random.uniform(0.2, 1.0, 2000)])
    variable = Variable("speed", "m/s", speed, speed)
    knots = curve_knots(speed)
    cell = Dependence(
        Amount("along", "travel"),
        variable,
        "curve",
        np.where(knots < 0.1, 0.4, 0.02 * knots),
        gain=100.0,
        degrees=6,
        p_value=1e-9,
        shares=(speed, speed),
    )
    assert strength_words(cell) == "±0.75 %"
    assert "lowest at 0.2" in dependence_words(cell)
    assert "highest at 0.99 m/s" in dependence_words(cell)
    assert strength_words(replace(cell, shares=None)) == "±20 %"
    slow = 0.01 + 0.0004 * random.random(2000)  # it was "highest at 0.01" too
    crawling = replace(
        cell,
        variable=Variable("speed", "m/s", slow, slow),
        coefficients=0.02 * np.arange(curve_knots(slow).size),
        shares=(slow, slow),
    )
    assert "lowest at 0.01 and highest at 0.0104 m/s" in dependence_words(crawling)


SQUASH = '''
from werrimbi_odom.effects.shapes import mean_square, steady
from werrimbi_odom.model.drive import Drive
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import Number, WheelTravel


@wheel_effect(growth=Parameter("s^2/m^2", null=0, typical=-0.05, bounds=(-1, 1), says="share"))
def squash(
    travel: WheelTravel[Number], drive: Drive[Number], growth: float
) -> WheelTravel[Number]:
    """Both radii shrink with the square of the wheel's speed.

    Formula    left and right *= 1 + growth * speed^2
    Signature  as a scale, with the speed
    Ruler      a taped line, slowly and fast
    """
    left = growth * mean_square(steady(abs(drive.left_speed.end)))
    right = growth * mean_square(steady(abs(drive.right_speed.end)))
    return WheelTravel(travel.left * (1 + left), travel.right * (1 + right))
'''


@pytest.mark.evidence
def test_a_radius_that_falls_with_speed_is_drafted_backwards_too(tmp_path: Path) -> None:
    """Forms were told apart before they were fitted: "path (travel without sign)" was written."""
    (tmp_path / "squash.py").write_text(SQUASH)
    (squash,) = load_file(tmp_path / "squash.py")
    truth = replace(ROBOT, effects=(squash.using(growth=-0.08),))
    runs = runs_of(truth, [1, 2, 3, 4], 60)
    library = [effect for effect in LIBRARY if effect.name != "tyre_squash"]
    found = draft_effect(diagnose(runs, ROBOT, library, holdout=[run_of(truth, 5, 60)]))
    claim = found.claim
    assert (claim.variable, found.form, claim.amount.per) == ("wheel_speed", "square", "travel")
    applied = found.fit.point.model.robot.effects[-1]
    assert applied.values["growth"] == pytest.approx(-0.08, rel=0.03)


def test_a_gyro_without_noise_does_not_jump_where_a_model_errs() -> None:
    """A simulator's: the robot stands for most of it, and trembles by little as it drives."""
    rate, seconds = 50.0, 120.0
    time = np.arange(0.0, seconds, 1.0 / rate)
    speed = np.where((time > 50.0) & (time < 70.0), 0.15, 0.0)
    yaw_rate = sum(
        np.where((time > begin) & (time < begin + 0.4), 0.3, 0.0) for begin in (52.0, 57.0, 64.0)
    )
    ticks = read(as_turning(ROBOT, 1.1), rate, speed, yaw_rate)
    trembles = np.random.default_rng(1).normal(0.0, 2e-6, time.size) * (speed > 0.0)
    heading = np.cumsum(np.append(0.0, yaw_rate / rate + trembles))
    reference = of_headings(ticks.time, heading, "incremental")
    run = Run("run", Path("run"), Ticks(ticks.time, ticks.left, ticks.right, {}), reference)
    options = EvaluationOptions(reference_kind="incremental", leg=0.25)
    compared = compare((run,), ROBOT, options)
    found = compared.main.all
    assert (found.outliers, found.figures.count) == (0, 12)
    said = [part.text for part in words_of(compared)]
    assert any("noise (headings alone) is too small to tell" in text for text in said)


def by_gps(noise: float) -> Run:
    """Six minutes of a sound robot, seen by satellites twice a second."""
    run = run_of(ROBOT, 5, 360)
    reference = run.reference
    assert reference is not None
    random = np.random.default_rng(5)
    size = reference.time.size
    x, y = (part + random.normal(0.0, noise, size) for part in (reference.x, reference.y))
    seen = replace(reference, x=x, y=y, yaw=np.full(size, np.nan), sigma_xy=np.full(size, noise))
    return replace(run, reference=seen.chosen(np.arange(size) % 2 == 0))


def test_legs_that_are_shorter_than_gps_errs_say_nothing_of_the_robot() -> None:
    """It was grossly wrong, and went backward where the model says forward."""
    compared = compare((by_gps(0.9),), ROBOT, EvaluationOptions(leg=1.0))
    said = [part.text for part in words_of(compared)]
    assert said[0].startswith("Legs of 1 m are too short for this reference")
    assert said[0].endswith("Try --leg 9.")
    assert not any("grossly" in text or "backward" in text for text in said)


@pytest.mark.parametrize("leg", [9.0, 20.0])
def test_a_sound_robot_before_gps_is_not_grossly_wrong(leg: float) -> None:
    compared = compare((by_gps(0.9),), ROBOT, EvaluationOptions(leg=leg))
    assert "grossly" not in words_of(compared)[0].text


@pytest.mark.evidence
@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_a_robot_of_half_or_twice_the_radius_is_grossly_wrong_before_gps_too(factor: float) -> None:
    wrong = replace(ROBOT, wheel_radius=factor * ROBOT.wheel_radius)
    compared = compare((by_gps(0.1),), wrong, EvaluationOptions(leg=1.0))
    assert "grossly" in words_of(compared)[0].text
