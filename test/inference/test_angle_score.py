# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A bump on a tread is found with its place and its sign; a gyro's drift, in each drive anew."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from test.evidence import in_evidence
from test.inference.driven import common, runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.homogeneity import homogeneity_of_effect
from werrimbi_odom.inference.fitting.angle_score import best_angles
from werrimbi_odom.inference.fitting.candidate import Candidate
from werrimbi_odom.inference.fitting.candidate_starts import with_candidate
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.prediction import predict_all
from werrimbi_odom.inference.fitting.run_phases import fitted_per_run
from werrimbi_odom.inference.fitting.score_tests import scores
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.manoeuvres.detection_limits import detection_limits
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.report.adding.words import words_of
from werrimbi_odom.report.terminal import as_text

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
PLACES = (0.3, 1.9, -2.0, 3.0)
RATES = (6e-5, -4e-5, 3e-5, -7e-5)
SETTLES = 20.0
"""Time constant of a chip's warmth [s]."""
TRIES = np.array(find("left_tread_bump").parameters["place"].tries)


def apart(one: float, other: float) -> float:
    """Of two places on the wheel [rad]."""
    return abs(math.remainder(one - other, 2.0 * math.pi))


def bumpy(height: float) -> list[Run]:
    """Four drives, each with its bump at another angle of the counter."""
    law = find("left_tread_bump")
    truth = [replace(PLAIN, effects=(law.using(height=height, place=at),)) for at in PLACES]
    return [runs_of(robot, (seed,), 60)[0] for seed, robot in enumerate(truth)]


def drifting() -> list[Run]:
    """Four drives whose reference's bias grows, to either side."""
    found = []
    for run, rate in zip(runs_of(PLAIN, (1, 2, 3, 4), 60), RATES, strict=True):
        assert run.reference is not None
        since = run.reference.time - run.ticks.time[0]
        yaw = run.reference.yaw + 0.5 * rate * since**2
        found.append(replace(run, reference=replace(run.reference, yaw=yaw)))
    return found


# -- the score --------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [0.7, -0.7])
@pytest.mark.parametrize("blocks", [1, 3])
def test_size_sign_and_places_of_what_is_local(size: float, blocks: int) -> None:
    """Between the places that are tried, where two harmonics make the columns."""
    turned = np.linspace(0.0, 60.0, 900)

    def column(place: float) -> np.ndarray:
        return np.sin(turned + place) + 0.4 * np.sin(2.0 * (turned + place))

    places = [0.37, -2.9, 1.5][:blocks]
    free = np.kron(np.eye(blocks), np.stack([column(at) for at in TRIES], axis=-1))
    rest = -size * np.concatenate([column(at) for at in places])
    best = max(best_angles(TRIES, free, rest, blocks), key=lambda found: found.gain)
    assert best.size == pytest.approx(size, rel=0.01)
    assert best.gain == pytest.approx(rest @ rest, rel=0.01)
    assert all(apart(a, b) < 0.04 for a, b in zip(best.places, places, strict=True))


def test_of_the_other_sign_there_is_a_poorer_one_half_a_turn_away() -> None:
    turned = np.linspace(0.0, 60.0, 900)
    table = np.stack([np.sin(turned + p) + 0.4 * np.sin(2.0 * (turned + p)) for p in TRIES], -1)
    rest = -np.sin(turned + 0.3) - 0.4 * np.sin(2.0 * (turned + 0.3))
    bump, flat = best_angles(TRIES, table, rest, 1)
    assert bump.size > 0.0 > flat.size
    assert flat.gain < 0.9 * bump.gain
    assert apart(float(flat.places[0]), 0.3 + math.pi) < 0.8


def test_what_changes_nothing_has_no_score() -> None:
    assert best_angles(TRIES, np.zeros((40, 8)), np.ones(40), 1) == []


# -- bumps ------------------------------------------------------------------------------------


HEIGHTS = pytest.mark.parametrize("height", [in_evidence(1.5e-3), -1.5e-3])


@HEIGHTS
def test_a_bump_and_a_flat_are_found_where_they_are(height: float) -> None:
    runs = bumpy(height)
    found = add_effects([find("left_tread_bump")], runs[:3], PLAIN, holdout=runs[3:])
    assert found.objection is None
    assert found.parameters["height"].value == pytest.approx(height, rel=0.1)
    places = found.parameters["place"].of_runs
    assert places is not None
    assert all(apart(a, b) < 0.15 for a, b in zip(places, PLACES, strict=False))
    assert found.robot.effects[0].unknown == ("place",)
    assert "the node does not, and leaves the effect out" in as_text(words_of(found))


@HEIGHTS
def test_the_place_is_learnt_where_the_height_is_known(height: float) -> None:
    """A robot file that holds a flat is not judged with a bump half a turn away."""
    robot = replace(PLAIN, effects=(find("left_tread_bump").using(height=height),))
    laid = concatenated(match_for_fit(bumpy(height), PLAIN, 1.0, None))
    point = fitted_per_run(fit_calibration(laid, robot).point.model, laid, "absolute")
    places = [own["left_tread_bump.place"] for own in point.model.own]
    assert all(apart(a, b) < 0.2 for a, b in zip(places, PLACES, strict=True))


@pytest.mark.evidence
def test_a_bump_is_named_and_an_axle_off_its_centre_is_none() -> None:
    waves = [f"{kind}_{side}_wheel" for kind in ("eccentric", "oval") for side in ("left", "right")]
    effects = common("left_tread_bump", "right_tread_bump", *waves)
    told = diagnose(bumpy(2e-3)[:3], PLAIN, effects)
    assert (told.verdict, told.found) == ("named", ("left_tread_bump",))
    law = find("left_tread_bump")
    off = find("eccentric_left_wheel")
    truth = [replace(PLAIN, effects=(off.using(amplitude=1e-3, phase=at),)) for at in PLACES[:3]]
    runs = [runs_of(robot, (seed,), 60)[0] for seed, robot in enumerate(truth)]
    told = diagnose(runs, PLAIN, effects)
    assert (told.verdict, told.found) == ("named", ("eccentric_left_wheel",))
    assert law.name in {score.candidate.name for score in told.rounds[0].scores}  # it was asked


# -- a gyro's drift ---------------------------------------------------------------------------


def test_each_drive_has_its_own_rate_from_its_score() -> None:
    laid = concatenated(match_for_fit(drifting(), PLAIN, 1.0, None))
    fit = fit_calibration(laid, PLAIN)
    candidate = Candidate(find("reference_gyro_drift"), {})
    (score,) = scores(laid, fit.point, CALIBRATION, [candidate])
    assert score.degrees == 4
    model = with_candidate(fit.point.model, score)
    rates = [own["reference_gyro_drift.rate"] for own in model.own]
    np.testing.assert_allclose(rates, RATES, atol=1e-5)


@pytest.mark.evidence
def test_it_is_named_and_lasts() -> None:
    runs = drifting()
    told = diagnose(runs, PLAIN, common("reference_gyro_drift"))
    assert (told.verdict, told.found) == ("named", ("reference_gyro_drift",))
    laid = concatenated(match_for_fit(runs, PLAIN, 1.0, None))
    best = search_round(laid, fit_calibration(laid, PLAIN), [find("reference_gyro_drift")], PLAIN)
    assert homogeneity_of_effect(laid, best.tried[0], "reference_gyro_drift") < rules.SURE


@pytest.mark.evidence
def test_what_a_bias_that_settles_leaves_is_the_law_s_and_no_other_effect() -> None:
    """It was *unknown*, or a reference askew: the rates, each drive's own, counted as none."""
    runs = []
    for run, rate in zip(runs_of(PLAIN, (1, 2, 3), 60), (8e-5, 12e-5, 10e-5), strict=True):
        assert run.reference is not None
        since = run.reference.time - run.ticks.time[0]
        bias = rate * SETTLES * (since - SETTLES * (1.0 - np.exp(-since / SETTLES)))
        runs.append(replace(run, reference=replace(run.reference, yaw=run.reference.yaw + bias)))
    drift = replace(find("reference_gyro_drift").using(), unknown=("rate",))
    holds = replace(PLAIN, effects=(drift,))
    told = diagnose(runs[:2], holds, common("reference_gyro_drift"), holdout=runs[2:])
    assert told.verdict == "none"
    assert told.misfit is not None
    assert told.misfit.effect == "reference_gyro_drift"
    assert told.misfit.share is not None
    assert told.misfit.share < rules.LITTLE_OF_A_LAW


def test_matched_scans_have_neither_a_gyro_nor_headings_that_come_later() -> None:
    """What they do wrong goes by no such name, and what they cannot have is not told as unseen."""
    gyros = {"reference_gyro_drift", "reference_heading_delay"}
    runs = [replace(run, reference=replace(run.reference, own_axes=True)) for run in drifting()[:2]]
    effects = common(*gyros)
    told = diagnose(runs, PLAIN, effects)
    assert gyros.isdisjoint(score.candidate.name for this in told.rounds for score in this.scores)
    assert gyros.isdisjoint(limit.effect for limit in detection_limits(told, effects))


@pytest.mark.evidence
def test_a_rate_of_each_drive_is_not_written_and_no_node_is_said_to_learn_it() -> None:
    runs = drifting()
    found = add_effects([find("reference_gyro_drift")], runs[:3], PLAIN, holdout=runs[3:])
    assert found.robot.effects[0].unknown == ("rate",)
    rates = found.parameters["rate"].of_runs
    np.testing.assert_allclose(rates, RATES[:3], atol=1e-5)
    assert found.holdout.sides.after < 0.5 * found.holdout.sides.before
    told = as_text(words_of(found))
    assert "find it anew in each drive" in told
    assert "the node" not in told


def test_the_prediction_turns_with_it_leg_by_leg() -> None:
    """Against a sum by hand: the heading's error, and what it makes of the way in its frame."""
    runs = runs_of(PLAIN, (5, 6), 30)
    laid = concatenated(match_for_fit(runs, PLAIN, 1.0, None))
    plain = fit_calibration(laid, PLAIN).point.model
    law = find("reference_gyro_drift").using(rate=0.0)
    rates = (3e-4, -2e-4)
    own = tuple(
        {**mine, "reference_gyro_drift.rate": rate}
        for mine, rate in zip(plain.own, rates, strict=True)
    )
    model = replace(plain, robot=replace(plain.robot, effects=(law,)), own=own)
    before, after = (predict_all(each, laid).relative for each in (plain, model))
    begin = np.concatenate([run.measured.time[:-1] - run.counters.time[0] for run in laid.runs])
    end = np.concatenate([run.measured.time[1:] - run.counters.time[0] for run in laid.runs])
    rate = np.array(rates)[laid.run_of_leg]
    np.testing.assert_allclose(
        after[:, 2] - before[:, 2], 0.5 * rate * (end**2 - begin**2), atol=1e-12
    )
    turned = np.exp(-0.5j * rate * begin**2) * (before[:, 0] + 1j * before[:, 1])
    np.testing.assert_allclose(after[:, 0] + 1j * after[:, 1], turned, atol=1e-12)
