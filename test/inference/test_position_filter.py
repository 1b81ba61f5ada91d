# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings that positions tell: of a model that is doubted, and at the start of a drive."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import parts, run_of
from test.inference.positions import FRAME, positions_of_a_point
from test.model.drives import ROBOT
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.run import Run
from werrimbi_odom.inference.comparison.compare import compare
from werrimbi_odom.inference.comparison.position_filter import position_errors
from werrimbi_odom.inference.comparison.residuals import chained, fitted_heading
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.fitting.fit import ModelFit, fit_model, start_point
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS, START_YAW, Model
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.pose import wrap


@pytest.mark.parametrize("noises", [(4e-3, 5e-4), (5e-4, 4e-3), (2e-3, 2e-3)])
def test_an_error_along_the_way_turns_nobody(noises: tuple[float, float]) -> None:
    """Twenty straight legs of a metre; the robot goes 7 cm less than its wheels on each of them."""
    count, separation = 20, 0.18
    relative = np.tile([1.0, 0.0, 0.0], (count, 1))
    places = 0.93 * np.stack([np.arange(count + 1.0), np.zeros(count + 1)], axis=-1)
    sides = []
    for sign in (-1.0, 1.0):
        way = np.array([0.5, 0.0, sign / separation])
        sides.append(np.outer(way, way))
    wheels, alike = (
        np.tile(left**2 * sides[0] + right**2 * sides[1], (count, 1, 1))
        for left, right in (noises, (np.hypot(*noises) / np.sqrt(2.0),) * 2)
    )
    found = position_errors(
        relative,
        wheels,
        alike,
        places[:-1],
        places[1:],
        25e-6,
        np.array([0, count]),
        np.zeros(1),
        np.zeros(count, dtype=np.bool_),
    )
    assert np.abs(found.heading).max() < 0.02
    assert found.error[1:, 0] == pytest.approx(-0.07, abs=0.01)
    assert np.abs(found.error[1:, 1]).max() < 0.02


def test_a_spin_on_the_spot_takes_no_heading_away() -> None:
    """Drives that begin with a spin, by satellites (8 mm): legs of 1 m after it ended 33 cm off."""
    noise, size, nothing = 8e-3, [], np.zeros((8, 3, 3))
    relative = np.array([[0.02, 0.01, 1.5], *[[1.0, 0.0, 0.3]] * 7])
    path = chained(relative)[0]
    for seed in range(40):
        random = np.random.default_rng(seed)
        seen = path + noise * random.normal(size=(2, path.size)).T @ [1.0, 1j]
        places = np.stack([seen.real, seen.imag], axis=-1)
        heading = np.array([fitted_heading(path, seen)])
        ends = np.array([0, 8])
        standing = np.zeros(8, dtype=np.bool_)
        found = position_errors(
            relative, nothing, nothing, places[:-1], places[1:], noise**2, ends, heading, standing
        )
        size.append(np.linalg.norm(found.error[1:, :2], axis=1))
        # of no leg more is promised than of its own noise and of a heading by a whole leg of 1 m
        assert found.reference[2:, 0, 0] == pytest.approx(2.0 * noise**2, rel=0.5)
    assert np.sqrt(np.mean(np.square(size))) < 2.0 * np.sqrt(2.0) * noise
    assert np.max(size) < 6.0 * np.sqrt(2.0) * noise


@pytest.mark.parametrize(
    ("kind", "size"),
    [
        pytest.param(kind, size, marks=[pytest.mark.evidence] * ((row + column) % 2 > 0))
        for row, kind in enumerate(("jump", "to and fro", "spike"))
        for column, size in enumerate((0.3, 3.0))
    ],
)
def test_a_tracker_that_jumps_turns_no_robot(kind: str, size: float) -> None:
    """One jump of 30 cm, of positions alone, and all legs after it erred by 15 cm."""
    sound = parts(run_of(ROBOT, 4), "positions")
    assert sound.reference is not None
    time = sound.reference.time
    until = {"jump": np.inf, "to and fro": 70.0, "spike": 45.5}[kind]
    off = size * ((time > 45.0) & (time < until))
    seen = replace(sound.reference, x=sound.reference.x + off, y=sound.reference.y + 0.5 * off)
    found, plain = (compare([run], ROBOT) for run in (replace(sound, reference=seen), sound))
    legs = found.legs
    jumped = [(legs.start_time < at) & (legs.end_time > at) for at in (45.1, until - 0.1)]
    assert legs.outlier[jumped[0]].all() == (kind != "spike")
    assert not legs.outlier[~np.logical_or(*jumped)].any()
    within = ~legs.outlier
    changed = (legs.errors.error - plain.legs.errors.error)[within, :2]
    assert (
        np.abs(changed).max() < 4e-3
    )  # once or twice a heading of few poses and a position of one
    assert np.abs(changed[legs.end_time[within] < 45.0]).max() < 2e-4
    assert found.main.all.figures.nees < 1.1
    (path,), (straight,) = found.paths, plain.paths
    assert path.predicted_yaw[0] == pytest.approx(straight.predicted_yaw[0], abs=1e-3)


SPINS, BENDS = [1.0, -1.0, 1.0, -1.0], [0.3, -0.3, 0.2]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("off", [2.0, 3.0, -2.0])
def test_a_drive_that_begins_on_the_spot_finds_its_heading_later(seed: int, off: float) -> None:
    drive = positions_of_a_point("late", [0.0] * 4 + [0.3] * 3, SPINS + BENDS, seed=seed)
    runs = concatenated(match_for_fit([drive], ROBOT, 1.0))
    point = start_point(runs, ROBOT)
    wrong = Model(point.model.robot, ({START_YAW: FRAME + off},))
    fit = fit_model(runs, replace(point, model=wrong), find_jumps=False)
    (own,) = fit.point.model.own
    assert wrap(own[START_YAW] - FRAME) == pytest.approx(0.0, abs=0.02)


def with_first_heading(run: Run, heading: float) -> Run:
    assert run.reference is not None
    first = np.where(np.arange(run.reference.time.size) == 0, heading, np.nan)
    return replace(run, reference=replace(run.reference, yaw=first))


def started(drive: Run, options: EvaluationOptions = EvaluationOptions()) -> ModelFit:
    runs = concatenated(match_for_fit([drive], ROBOT, 1.0))
    return fit_model(runs, start_point(runs, ROBOT, options), find_jumps=False)


@pytest.mark.parametrize("off", [0.0, 0.03, -0.1])
def test_a_first_heading_that_is_guessed_makes_no_wheel_noisy(off: float) -> None:
    """It was held for exact to 2 mrad: 2° off, and wheels had 50 times their noise."""
    drive = positions_of_a_point("guessed", [0.3] * 4, [*BENDS, 0.0])
    guessed, plain = (started(run) for run in (with_first_heading(drive, FRAME + off), drive))
    of_guessed, of_plain = (
        [np.sqrt(part[0]) for part in (fit.point.variances.left, fit.point.variances.right)]
        for fit in (guessed, plain)
    )
    assert of_guessed == pytest.approx(of_plain, rel=0.2)
    sizes = [getattr(guessed.robot, name) for name in MULTIPLIERS]
    assert sizes == pytest.approx([getattr(plain.robot, name) for name in MULTIPLIERS], abs=1e-4)
    assert guessed.point.model.start_yaw(0) == pytest.approx(FRAME, abs=5e-3)


def test_a_first_heading_stays_where_it_is_known_or_all_that_there_is() -> None:
    """Its noise is stated, or of a drive there are its start and its end, measured by tape."""
    drive = with_first_heading(positions_of_a_point("known", [0.3] * 4, [*BENDS, 0.0]), FRAME)
    assert started(drive, EvaluationOptions(sigma_yaw=2e-3)).point.model.start_yaw(0) is None
    assert drive.reference is not None
    by_tape = replace(drive, reference=drive.reference.chosen(np.array([0, -1])))
    assert started(by_tape).point.model.start_yaw(0) is None
