# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Fits use each pose of a reference, as long as its error is new in each."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.effects import find
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.adding.adding import add_effects
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns, finely, prepare
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration
from werrimbi_odom.inference.diagnosis.penalised_likelihood import fitted
from werrimbi_odom.inference.fitting import filtering, likelihood
from werrimbi_odom.inference.fitting.candidate_starts import with_candidate
from werrimbi_odom.inference.fitting.free_parameters import CALIBRATION
from werrimbi_odom.inference.fitting.score_tests import (
    candidates,
    parameters_with,
    scores,
    signatures,
)

ROBOT = WhiteNoiseRobot(left_noise=4e-4, right_noise=5e-4)


def drives(seconds: float = 60.0, count: int = 4, **sensor: float) -> list[Run]:
    """Calm drives with a pose of motion capture 17 times a second."""
    random = np.random.default_rng(5)
    return [
        replace(drive(ROBOT, wandering(random, seconds), random, **sensor), name=f"drive {number}")
        for number in range(count)
    ]


def prepared(runs: list[Run], **options: object) -> PreparedRuns:
    return prepare(runs, ROBOT.entered(), EvaluationOptions(**options))


def with_slow_error(run: Run, seconds: float, sigma: float) -> Run:
    """An error of the reference that lasts, drawn back to zero, in each of its axes."""
    reference, random = run.reference, np.random.default_rng(len(run.name))
    assert reference is not None
    stay = float(np.exp(-np.diff(reference.time).mean() / seconds))
    slow = np.zeros((2, reference.time.size))
    for row in range(1, reference.time.size):
        new = sigma * np.sqrt(1.0 - stay**2) * random.standard_normal(2)
        slow[:, row] = stay * slow[:, row - 1] + new
    moved = replace(reference, x=reference.x + slow[0], y=reference.y + slow[1])
    return replace(run, reference=moved)


def test_short_drives_with_independent_poses_are_fitted_by_each_pose() -> None:
    given = prepared(drives())
    poses = sum(run.reference.time.size for run in given.runs if run.reference)
    assert given.parts > 5 * rules.PARTS_OF_A_LEG
    assert 0.5 * poses < finely(given).begin.size <= rules.LEGS_OF_A_FIT


@pytest.mark.parametrize("lasting_s", [0.3, 1.0])
def test_an_error_that_lasts_longer_than_a_pose_is_not_averaged_away(lasting_s: float) -> None:
    slow = [with_slow_error(run, lasting_s, 2e-3) for run in drives()]
    assert prepared(slow).parts == rules.PARTS_OF_A_LEG


def test_many_drives_are_fitted_by_longer_legs() -> None:
    parts = [prepared(drives(60.0, count)).parts for count in (2, 8)]
    assert parts[0] > parts[1] > rules.PARTS_OF_A_LEG


@pytest.mark.parametrize("kind", ["incremental", "local_map"])
def test_a_reference_whose_error_goes_on_keeps_the_usual_legs(kind: str) -> None:
    assert prepared(drives(30.0, 2), reference_kind=kind).parts == rules.PARTS_OF_A_LEG


@pytest.mark.evidence
def test_each_pose_tells_where_the_marker_points(monkeypatch: pytest.MonkeyPatch) -> None:
    """A mount askew is found twice as well as by the poses at the ends of the usual legs."""
    askew = 5e-3
    turned = [
        replace(run, reference=replace(run.reference, yaw=run.reference.yaw + askew))
        for run in drives(30.0)
        if run.reference is not None
    ]
    found = {}
    for most in (rules.LEGS_OF_A_FIT, 0):
        monkeypatch.setattr(rules, "LEGS_OF_A_FIT", most)
        mount = [find("reference_yaw_offset")]
        added = add_effects(mount, turned[:3], ROBOT.entered(), holdout=turned[3:])
        found[most] = added.parameters["angle"]
    every, ends = found.values()
    assert every.value is not None
    assert every.std is not None
    assert ends.std is not None
    assert abs(every.value - askew) < 4.0 * every.std
    assert every.std < 0.6 * ends.std


@pytest.mark.parametrize("name", ["sideways_drift", "lateral_slip"])
def test_where_each_pose_is_a_leg_restarts_of_the_filter_lose_little(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the robot is the poses before tell it: thirty of them, not the last one alone."""
    runs = finely(prepared(drives()))
    point = fit_calibration(runs, ROBOT.entered()).point
    tried = candidates([find(name)], (), runs.channels, len(runs.runs))
    told = []
    for stretch in (filtering.STRETCH, runs.count):
        monkeypatch.setitem(likelihood.innovations.__kwdefaults__ or {}, "stretch", stretch)
        runs.cache.forget_steps()
        other = replace(point)
        ((_, _, free),) = signatures(runs, other, CALIBRATION, tried)[1]
        told.append(float(np.sum(free**2)))
    restarted, never = told
    assert 0.9 * never < restarted < never


def added_up(run: Run, sigma: float) -> Run:
    """A reference whose increments err, each for itself, and not its poses."""
    reference, random = run.reference, np.random.default_rng(int(run.name[-1]))
    assert reference is not None
    x, y, yaw = (
        clean + np.cumsum(sigma * random.standard_normal(clean.size))
        for clean in (reference.x, reference.y, reference.yaw)
    )
    return replace(run, reference=replace(reference, x=x, y=y, yaw=yaw))


@pytest.mark.parametrize("of_poses", [True, False], ids=["poses", "increments"])
def test_legs_that_share_a_pose_of_an_incremental_reference_are_less_sure(of_poses: bool) -> None:
    """What goes twice round within a leg fits the poses' noise: its gain is too large by chance."""
    noise = {} if of_poses else {"sigma_xy": 0.0, "sigma_yaw": 0.0}
    runs = [run if of_poses else added_up(run, 1e-3) for run in drives(every=10, **noise)]
    laid = finely(prepared(runs, reference_kind="incremental"))
    given = ROBOT.entered()
    before = fit_calibration(laid, given, EvaluationOptions(reference_kind="incremental"))
    tried = candidates([find("oval_left_wheel")], (), (), len(laid.runs))[-1]
    (score,) = scores(laid, before.point, CALIBRATION, [tried])
    start = replace(before.point, model=with_candidate(before.point.model, score))
    fit = fitted(laid, start, (tried.name,), parameters_with((), tried), given, rounds=1)
    assert (fit.neighbours > 1.25) if of_poses else (fit.neighbours < 1.2)


def test_what_each_drive_has_of_its_own_costs_what_its_own_data_are_worth() -> None:
    """By BIC: a rate of one drive is told by that drive alone, a size by all of them."""
    runs = finely(prepared(drives()))
    before = fit_calibration(runs, ROBOT.entered())
    (tried,) = candidates([find("reference_gyro_drift")], (), runs.channels, len(runs.runs))[:1]
    (score,) = scores(runs, before.point, CALIBRATION, [tried])
    start = replace(before.point, model=with_candidate(before.point.model, score))
    names, numbers = (tried.name,), parameters_with((), tried)
    fit = fitted(runs, start, names, numbers, ROBOT.entered(), rounds=1)
    assert fit.paid - before.paid == len(runs.runs) == 4
    assert fit.penalty - before.penalty == pytest.approx(4.0 * np.log(runs.data / 4.0))
