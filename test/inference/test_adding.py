# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Adding: a missing effect is found with its size, a useless one is refused, sizes are sizes."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import of_headings, run_by, runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.inference.adding.added import Added
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.adding.fitted_parameters import FittedParameter
from werrimbi_odom.inference.adding.objection import Worth, objection
from werrimbi_odom.inference.adding.start_values import drives_of
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.diagnosis import penalised_likelihood
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.paired_comparison import Sides
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.splitting import set_aside
from werrimbi_odom.inference.manoeuvres.advice import AdvisedDiagnosis
from werrimbi_odom.inference.set_up.search import SetUp
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.adding.as_json import json_of
from werrimbi_odom.report.adding.words import words_of
from werrimbi_odom.report.diagnosis.next_steps import NextSteps
from werrimbi_odom.report.diagnosis.words import words_of as diagnosis_words
from werrimbi_odom.report.terminal import as_text

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


def added(name: str, truth: Robot, given: Robot = PLAIN) -> Added:
    runs = runs_of(truth, (1, 2, 3, 4), 60)
    return add_effects([find(name)], runs[:3], given, holdout=runs[3:])


@pytest.fixture(scope="module")
def creep() -> Added:
    return added("lateral_slip", replace(PLAIN, effects=(find("lateral_slip").using(creep=0.02),)))


def test_the_size_is_found_within_its_error(creep: Added) -> None:
    found = creep.parameters["creep"]
    assert found.value is not None
    assert found.std is not None
    assert abs(found.value - 0.02) < 4.0 * found.std < 0.004


@pytest.mark.evidence
def test_a_size_is_stated_no_finer_than_its_law() -> None:
    """Of ten starts by an engine, three had a slip within twice the ± of 1 % that was stated."""
    true = {"coefficient": 0.1, "above": 0.4}
    found = added("coulomb_slip", replace(PLAIN, effects=(find("coulomb_slip").using(**true),)))
    for name, value in true.items():
        each = found.parameters[name]
        assert each.value == pytest.approx(value, rel=0.1)
        assert each.std is not None
        assert 0.028 * value < each.std < 0.06 * value


def test_what_moved_beside_an_added_effect_is_told() -> None:
    """A delay that stood in for backlash went from 60.8 to 60.0 ms, and nothing was said of it."""
    true = replace(PLAIN, effects=(find("track_width").using(multiplier=1.01),))
    given = replace(PLAIN, effects=(find("reference_delay").using(delay=0.006),))
    found = add_effects([find("track_width")], runs_of(true, (1, 2), 30), given)
    ((name, before, now),) = found.moved
    assert (name, before) == ("reference_delay.delay", 0.006)
    assert now.value == pytest.approx(0.0, abs=0.001)
    said = " ".join(as_text(words_of(found)).split())
    assert "of what the file held: reference_delay.delay from 6.0" in said
    assert json_of(found)["moved"]["reference_delay.delay"]["before"] == 0.006
    still = replace(found, moved=())
    assert "of what the file held" not in as_text(words_of(still))


@pytest.mark.evidence
@pytest.mark.parametrize("turning", [0.4, in_evidence(1.0)])
def test_a_slip_has_the_moment_of_inertia_beside_it_where_the_drives_tell_it(
    turning: float,
) -> None:
    """What a robot with its mass in the middle slips had two more names, by wheels' accelerations.

    No number that is not needed is stated or written.
    """
    slip = find("longitudinal_slip").using(coefficient=0.04, turning=turning)
    truth = replace(PLAIN, effects=(slip,))
    runs = runs_of(truth, (1, 2, 3, 4), 30)
    others = ("coulomb_slip", "lateral_slip", "reference_delay", "reference_heading_delay")
    library = tuple(find(each) for each in ("longitudinal_slip", *others))
    named = diagnose(runs[:3], PLAIN, library, holdout=runs[3:])
    assert (named.verdict, named.found) == ("named", ("longitudinal_slip",))
    told = values_of(named, "longitudinal_slip")
    found = add_effects([find("longitudinal_slip")], runs[:3], PLAIN, holdout=runs[3:])
    written = found.robot.effects[0].values["turning"]
    if turning == 1.0:
        assert list(told) == list(found.parameters) == ["coefficient"]
        assert written == 1.0
        return
    added = found.parameters["turning"]
    assert added.value is not None
    assert added.std is not None
    assert abs(added.value - turning) < 4.0 * added.std < 0.4
    assert abs(told["turning"].value - turning) < 4.0 * told["turning"].std
    assert written == pytest.approx(added.value)
    older = replace(PLAIN, effects=(find("longitudinal_slip").using(coefficient=0.04),))
    for robot, outdated in ((found.robot, ()), (older, ("longitudinal_slip",))):
        once_more = diagnose(runs[:3], robot, library, holdout=runs[3:])
        assert (once_more.verdict, once_more.outdated) == ("none", outdated)


@pytest.mark.parametrize(("wider", "kept"), [(1.0, True), (1e6, False)])
def test_what_refines_a_law_pays_by_its_own_deviation_too(
    wider: float, kept: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By a gyro a turning of 2.6 ± 1.5 was cheaper, for the fit had ended in another minimum."""
    slip = find("longitudinal_slip")
    held = replace(PLAIN, effects=(slip.using(coefficient=0.04),))
    truth = replace(PLAIN, effects=(slip.using(coefficient=0.04, turning=0.4),))
    drives = drives_of(prepare(runs_of(truth, (1, 2), 30), PLAIN), PLAIN, EvaluationOptions())
    point, numbers = drives.begin(held)
    fit = drives.fit(point, (), numbers, held)
    fits = penalised_likelihood.fitted

    def poorly_told(*asked: Any) -> Fitted:
        found = fits(*asked)
        return replace(found, covariance=wider * found.covariance)

    monkeypatch.setattr(penalised_likelihood, "fitted", poorly_told)
    found = penalised_likelihood.refined(drives.laid, fit, held)
    assert found.total < fit.total or not kept
    assert (found is not fit) is kept


@pytest.mark.evidence
def test_a_radius_in_degrees_is_found_as_well_as_one_that_is_right() -> None:
    """Legs of 57 m, of the file's metre, would be a handful of a drive of 40 m."""
    runs = runs_of(PLAIN, (1, 2))
    close, far = (
        add_effects([find("wheel_radius_scale")], runs, replace(PLAIN, wheel_radius=radius))
        for radius in (0.05, 0.05 * np.pi / 180.0)
    )
    name = "left_wheel_radius_multiplier"
    right = close.robot.left_wheel_radius_multiplier * 180.0 / np.pi
    assert far.robot.left_wheel_radius_multiplier == pytest.approx(right, rel=3e-4)
    assert far.multiplier_stds[name] < 2.0 * close.multiplier_stds[name] * 180.0 / np.pi


def test_the_held_out_error_falls_to_the_noise(creep: Added) -> None:
    assert creep.objection is None
    assert creep.holdout.sides.after < 0.8 * creep.holdout.sides.before
    assert creep.holdout.sides.after < 1.25 * creep.noise_alone(creep.holdout)


def test_noise_alone_is_not_more_than_the_error_without_a_reason(creep: Added) -> None:
    quiet = creep.holdout.after
    loud = replace(quiet, errors=replace(quiet.errors, covariance=4.0 * quiet.errors.covariance))
    some = quiet.errors.covariance.copy()
    some[:3] *= 20.0
    odd = replace(quiet, errors=replace(quiet.errors, covariance=some))
    reason = "Noise alone is what the covariance promises, and the held-out"
    for after in (loud, odd):
        found = replace(creep, holdout=replace(creep.holdout, after=after, promising=after))
        assert found.noise_alone(found.holdout) > found.holdout.error("after")
        assert reason in " ".join(as_text(words_of(found)).split())
    few, legs = replace(creep.holdout, after=odd, promising=odd).of_few_legs
    assert few < 0.3 * legs < creep.holdout.of_few_legs[0]
    for share in (0.5, 0.8):
        covariance = share * quiet.errors.covariance
        after = replace(quiet, errors=replace(quiet.errors, covariance=covariance))
        found = replace(creep, holdout=replace(creep.holdout, after=after, promising=after))
        told = reason in " ".join(as_text(words_of(found)).split())
        assert told == (found.noise_alone(found.holdout) > found.holdout.error("after"))


def test_noise_is_what_remains_only_where_compare_says_so_too(creep: Added) -> None:
    """As where all legs together are as promised, and the spins among them are not."""
    assert creep.verdict.good
    assert "What remains is noise" in as_text(words_of(creep))
    main = creep.compared.main
    few = replace(main.by_motion["arc"].figures, count=3, nees=30.0)
    spins = {**main.by_motion, "spin": replace(main.by_motion["spin"], figures=few)}
    lengths = tuple(
        replace(item, by_motion=spins) if item is main else item for item in creep.compared.lengths
    )
    found = replace(creep, compared=replace(creep.compared, lengths=lengths))
    assert found.covariance == creep.covariance == "honest"
    words = " ".join(as_text(words_of(found)).split())
    assert "What remains is noise" not in words
    assert "The model's errors are larger than it promises in spins." in words


def test_words_and_json_tell_the_same(creep: Added) -> None:
    words, figures = as_text(words_of(creep)), json_of(creep)
    assert max(map(len, words.splitlines())) <= 80
    assert f"{1e3 * figures['holdout']['after']:.2f} mm" in words
    assert figures["parameters"]["creep"]["unit"] == "s"


def test_of_a_single_drive_too_all_is_fitted_that_is_written() -> None:
    """What was put aside judges as if it were another drive, and is then fitted with the rest."""
    truth = replace(PLAIN, effects=(find("lateral_slip").using(creep=0.02),))
    runs = runs_of(truth, (1,), 30)
    whole = add_effects([find("lateral_slip")], runs, PLAIN)
    fitted, kept = set_aside(runs)
    parts = add_effects([find("lateral_slip")], fitted, PLAIN, holdout=kept)
    assert whole.holdout.sides.after == pytest.approx(parts.holdout.sides.after, rel=1e-9)
    one, other = (each.parameters["creep"] for each in (whole, parts))
    assert one.std is not None
    assert other.std is not None
    assert one.value != pytest.approx(other.value, rel=1e-4)
    assert one.std < other.std
    assert "were then fitted on all of it" in " ".join(as_text(words_of(whole)).split())


def test_legs_on_which_the_reference_jumped_are_fitted_as_in_a_diagnosis() -> None:
    """One question has one answer: `add` left out spins of a TurtleBot3, and `diagnose` did not."""
    (run,) = runs_of(PLAIN, (3,), 30)
    assert run.reference is not None
    time, x = run.reference.time, run.reference.x
    jumped = replace(run, reference=replace(run.reference, x=x + 0.1 * (time > 0.4 * time[-1])))
    prepared = prepare([jumped], PLAIN)
    assert prepared.groups[0].jumps[0].any()
    drives = drives_of(prepared, PLAIN, prepared.options)
    fit = drives.fit(drives.begin(PLAIN)[0], (), (), PLAIN)
    other = fit_calibration(drives.laid, PLAIN, drives.options)
    assert fit.cost == pytest.approx(other.cost, abs=1e-3)


def test_what_is_not_there_is_objected_to() -> None:
    found = added("lateral_slip", replace(PLAIN, wheel_separation_multiplier=1.02))
    assert found.objection is not None
    assert re.search("does not lower|do not show", found.objection)


def test_a_held_out_error_that_rises_by_chance_refuses_no_effect_that_the_others_show() -> None:
    """Twenty seconds, in which a creep of eighteen deviations costs less than the noise."""
    truth = replace(PLAIN, effects=(find("lateral_slip").using(creep=0.003),))
    fitted, held = runs_of(truth, (1, 2, 3), 60), runs_of(truth, (8,), 20)
    found = add_effects([find("lateral_slip")], fitted, PLAIN, holdout=held)
    sides = found.holdout.sides
    assert sides.after > sides.before
    assert found.objection is None
    assert "higher, not told from chance" in " ".join(as_text(words_of(found)).split())


@pytest.mark.evidence
def test_a_held_out_error_that_rises_beyond_chance_refuses_what_the_others_show() -> None:
    """A carpet whose pile leans the other way, and half a minute on it is enough."""
    one, other = (
        replace(PLAIN, effects=(find("lateral_slip").using(creep=creep),)) for creep in (0.02, 0.0)
    )
    fitted, held = runs_of(one, (1, 2, 3), 30), runs_of(other, (8,), 40)
    found = add_effects([find("lateral_slip")], fitted, PLAIN, holdout=held)
    assert found.objection is not None
    assert "chance does not raise it so" in found.objection
    assert found.chances["lateral_slip"] == pytest.approx(0.0, abs=1e-9)
    named = diagnose(fitted, PLAIN, [find("lateral_slip")], holdout=held)
    assert named.holdout.rose
    assert "chance does not raise it so" in " ".join(
        as_text(diagnosis_words(AdvisedDiagnosis(named, None, ()), NextSteps())).split()
    )


def test_a_base_is_written_as_the_files_multiplier() -> None:
    found = added("track_width", replace(PLAIN, wheel_separation_multiplier=1.02))
    assert found.objection is None
    assert found.robot.effects == ()
    assert found.robot.wheel_separation_multiplier == pytest.approx(1.02, abs=1e-3)
    assert found.parameters["multiplier"].value == pytest.approx(1.02, abs=1e-3)


@pytest.mark.evidence
def test_a_ratio_is_known_by_headings_however_coarse_the_positions_are() -> None:
    """Positions of 10 cm leave both radii open by as much, together: their ratio is not."""
    truth = replace(PLAIN, left_wheel_radius_multiplier=0.995, right_wheel_radius_multiplier=1.005)
    random = np.random.default_rng(1)
    stated = []
    for noise in (1e-3, 0.1):
        runs = []
        for run in runs_of(truth, (1, 2, 3, 4), 60):
            assert run.reference is not None
            seen = run.reference
            off = random.normal(0.0, noise, (2, seen.time.size))
            runs.append(replace(run, reference=replace(seen, x=seen.x + off[0], y=seen.y + off[1])))
        found = add_effects([find("unequal_wheel_radii")], runs[:3], PLAIN, holdout=runs[3:])
        ratio = found.parameters["ratio"]
        assert ratio.value is not None
        assert ratio.std is not None
        assert abs(ratio.value - 1.005 / 0.995) < 4.0 * ratio.std
        stated.append(ratio.std)
    fine, coarse = stated
    assert coarse < 2.0 * fine


@pytest.mark.evidence
@pytest.mark.parametrize(("name", "factor"), [("track_width", 0.5), ("wheel_radius_scale", 4.0)])
def test_factors_far_from_one_are_reached(name: str, factor: float) -> None:
    key = {"track_width": "wheel_separation", "wheel_radius_scale": "wheel_radius"}[name]
    given = replace(PLAIN, **{key: getattr(PLAIN, key) / factor})  # type: ignore[arg-type]
    found = added(name, PLAIN, given)
    assert found.objection is None
    assert found.parameters["multiplier"].value == pytest.approx(factor, rel=2e-3)


def test_exchanged_wheels_are_put_right() -> None:
    found = added("wheels_swapped", replace(PLAIN, effects=(find("wheels_swapped").using(),)))
    assert found.objection is None
    assert [item.name for item in found.robot.effects] == ["wheels_swapped"]
    assert found.holdout.sides.after < 0.1 * found.holdout.sides.before


def test_a_phase_of_each_drive_is_not_written() -> None:
    truth = [
        replace(PLAIN, effects=(find("eccentric_left_wheel").using(amplitude=2e-3, phase=phase),))
        for phase in (0.3, 1.9, -2.0, 3.0)
    ]
    runs = [runs_of(robot, (seed,), 60)[0] for seed, robot in enumerate(truth)]
    found = add_effects([find("eccentric_left_wheel")], runs[:3], PLAIN, holdout=runs[3:])
    assert found.robot.effects[0].unknown == ("phase",)
    assert found.parameters["amplitude"].value == pytest.approx(2e-3, abs=2e-4)
    gone = np.angle(np.exp(1j * (np.array(found.parameters["phase"].of_runs) - [0.3, 1.9, -2.0])))
    assert np.max(np.abs(gone)) < 0.2


def test_sizes_that_nothing_moves_stay_as_the_file_has_them(creep: Added) -> None:
    for name in (
        "wheel_separation_multiplier",
        "left_wheel_radius_multiplier",
        "right_wheel_radius_multiplier",
    ):
        assert getattr(creep.robot, name) == getattr(PLAIN, name)
        assert json_of(creep)["calibration"][name]["std"] is None


def test_a_size_that_is_off_is_moved_alone_and_told_as_one_measures_it() -> None:
    slip = find("lateral_slip").using(creep=0.02)
    found = added(
        "lateral_slip", replace(PLAIN, right_wheel_radius_multiplier=1.03, effects=(slip,))
    )
    assert found.robot.wheel_separation_multiplier == 1.0
    assert found.robot.left_wheel_radius_multiplier == 1.0
    assert found.robot.right_wheel_radius_multiplier == pytest.approx(1.03, abs=1e-3)
    words = " ".join(as_text(words_of(found)).split())
    assert re.search(
        r"left wheel right as it is, right wheel (2\.99|3\.0)\S* ± \S+ % larger", words
    )


def test_noise_alone_is_not_known_while_something_is_missing(creep: Added) -> None:
    assert creep.explained
    assert json_of(creep)["holdout"]["noise_alone"] == pytest.approx(
        creep.holdout.promised, abs=1e-12
    )
    late = find("right_missed_ticks").using(fraction=0.05, above=0.3)
    slip = find("lateral_slip").using(creep=0.02)
    found = added("lateral_slip", replace(PLAIN, effects=(slip, late)))
    assert not found.explained
    assert np.isnan(json_of(found)["holdout"]["noise_alone"])
    assert not json_of(found)["noise"]["written"]
    assert "noise alone" not in as_text(words_of(found)).split("Position error")[1].split("\n\n")[0]
    assert found.robot.left_wheel_noise == PLAIN.left_wheel_noise


def test_a_chance_that_nobody_worked_out_is_none() -> None:
    found = added("track_width", replace(PLAIN, wheel_separation_multiplier=1.02))
    assert found.chances == {"track_width": None}
    assert json_of(found)["p_value"] is None


def test_a_reference_in_millimetres_is_to_be_converted_and_nothing_else() -> None:
    runs = []
    for run in runs_of(PLAIN, (1, 2, 3, 4), 60):
        assert run.reference is not None
        seen = replace(run.reference, x=1e3 * run.reference.x, y=1e3 * run.reference.y)
        runs.append(replace(run, reference=seen))
    for asked in (
        lambda: diagnose(runs[:3], PLAIN, LIBRARY, holdout=runs[3:]),
        lambda: add_effects([find("wheel_radius_scale")], runs[:3], PLAIN, holdout=runs[3:]),
    ):
        with pytest.raises(InputError) as refused:
            asked()
        words = str(refused.value)
        assert words.count("millimetres") == 1
        assert "divide by 1000" in words


def test_headings_alone_are_judged_by_headings_beside_the_gyros_drift() -> None:
    """A gyro that drifts by a third of a degree a second, and a base 2 % wider than entered."""
    truth = replace(PLAIN, wheel_separation_multiplier=1.02)
    runs = []
    for number, run in enumerate(runs_of(truth, (1, 2, 3, 4), 60)):
        assert run.reference is not None
        time = run.reference.time
        yaw = run.reference.yaw + (0.006 - 0.003 * number) * (time - time[0])
        runs.append(replace(run, reference=of_headings(time, yaw)))
    found = add_effects([find("track_width")], runs[:3], PLAIN, holdout=runs[3:])
    assert found.objection is None
    assert found.parameters["multiplier"].value == pytest.approx(1.02, abs=1e-3)
    assert found.holdout.unit == "rad"
    assert found.holdout.sides.after < 0.7 * found.holdout.sides.before
    words, figures = as_text(words_of(found)), json_of(found)
    assert "nan" not in words
    assert "°" in words.splitlines()[0]
    assert figures["holdout"]["rmse_yaw_rad"]["after"] == found.holdout.sides.after


SPIN = np.full(800, 0.002), np.full(800, -0.39)
"""On the spot, as nearly as robots do: speed [m/s] and yaw rate [rad/s], 20 of each a second."""


def test_sizes_do_not_stand_in_for_a_point_beside_the_axle() -> None:
    """A spin does not part them; what was asked for is fitted, and the file's sizes stay."""
    spin, noise = run_by(PLAIN, *SPIN, seed=1), np.random.default_rng(1)
    seen = spin.reference
    assert seen is not None
    point = (0.356 + 0.05j) * np.exp(1j * seen.yaw)
    east, north = (part + noise.normal(0.0, 6e-3, part.size) for part in (point.real, point.imag))
    ahead = replace(spin, reference=replace(seen, x=seen.x + east, y=seen.y + north))
    found = add_effects([find("reference_lever_arm")], [ahead], PLAIN)
    assert found.objection is None
    x, y = (found.parameters[name] for name in "xy")
    assert x.value == pytest.approx(0.356, abs=4e-3)
    assert y.value == pytest.approx(0.05, abs=5e-3)
    assert found.robot.left_wheel_radius_multiplier == 1.0
    assert found.robot.right_wheel_radius_multiplier == 1.0


@pytest.mark.parametrize("asked_for", [True, False])
def test_where_nothing_held_out_was_measured_the_fitted_drives_decide(asked_for: bool) -> None:
    """As in the diagnosis that printed the command."""
    nothing = Sides(math.nan, math.nan)
    worth = Worth(nothing, nothing, asked_for, 1e-9, held=False, others=())
    effect = find("reference_lever_arm")
    x = FittedParameter(effect.parameters["x"], 0.3, 0.01, None)
    said = objection(effect, {"x": x}, worth, SetUp((), PLAIN))
    assert (said is None) == asked_for
    assert asked_for or "no leg that was measured" in str(said)
