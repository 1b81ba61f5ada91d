# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A model is chosen by legs that its fit has not seen, of the fitted drives alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

from test.inference.driven import runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.cross_validation import (
    cross_validated_cost,
    fold_of_leg,
    holds_when_cross_validated,
)
from werrimbi_odom.inference.diagnosis.forward_selection import fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated, concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.robot import Robot

GIVEN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


def laid_out(truth: Robot, seeds: range) -> Concatenated:
    return concatenated(match_for_fit(runs_of(truth, seeds, seconds=60), GIVEN, 1.0))


def with_effect(runs: Concatenated, name: str) -> tuple[Fitted, Fitted]:
    before = fit_calibration(runs, GIVEN)
    (after,) = search_round(runs, before, [find(name)], GIVEN).tried
    return before, after


def test_every_fold_holds_some_of_every_drive() -> None:
    runs = laid_out(GIVEN, range(1, 4))
    fold = fold_of_leg(runs)
    for run in range(3):
        assert set(fold[runs.run_of_leg == run].tolist()) == set(range(rules.FOLDS))


def test_an_effect_that_is_there_holds() -> None:
    truth = replace(GIVEN, effects=(find("lateral_slip").using(creep=0.01),))
    before, after = with_effect(laid_out(truth, range(1, 4)), "lateral_slip")
    runs = laid_out(truth, range(1, 4))
    assert holds_when_cross_validated(runs, before, after)
    fall = before.cost - after.cost
    promised = cross_validated_cost(runs, before) - cross_validated_cost(runs, after)
    assert promised == pytest.approx(fall, rel=0.1)


def test_a_direction_that_the_fit_held_takes_no_part() -> None:
    """A spin hardly tells a point beside the axle from unequal wheels: one of them is held."""
    runs = laid_out(GIVEN, range(1, 3))
    fit = fit_calibration(runs, GIVEN)
    white, slopes = fit.design.flat()
    almost = slopes[:, 0] * (1.0 + 1e-3 * np.random.default_rng(2).normal(size=white.size))
    design = replace(
        fit.design,
        slopes=np.column_stack([slopes, almost]).reshape(*fit.design.white.shape, -1),
        columns=(*fit.design.columns, fit.design.columns[0]),
    )
    moves = np.vstack([fit.moves, np.zeros(fit.moves.shape[1])])
    with_held = replace(fit, design=design, moves=moves)
    assert cross_validated_cost(runs, with_held) == pytest.approx(cross_validated_cost(runs, fit))


def test_leaving_a_fold_out_is_what_refitting_without_it_gives() -> None:
    """The linear short cut against least squares done anew for every fold."""
    runs = laid_out(GIVEN, range(1, 3))
    fit = fit_calibration(runs, GIVEN)
    white, slopes = fit.design.flat()
    rows = np.repeat(fold_of_leg(runs), 3)
    brute = fit.cost
    for fold in range(rules.FOLDS):
        here = rows == fold
        step = np.linalg.pinv(slopes[~here]) @ -white[~here]
        left = white[here] + slopes[here] @ step
        brute += left @ left - white[here] @ white[here]
    assert cross_validated_cost(runs, fit) == pytest.approx(brute, abs=1e-6)


def losses_with(column_of: Callable[[np.ndarray], np.ndarray], run: int) -> list[float]:
    """What legs left out lose by a number that stands for nothing, sixty times.

    Its column is made of normal deviates, one for each innovation; `run` is -1 where all drives
    share the number.
    """
    runs = laid_out(GIVEN, range(1, 3))
    fit = fit_calibration(runs, GIVEN)
    white, slopes = fit.design.flat()
    alone = cross_validated_cost(runs, fit)
    random = np.random.default_rng(5)
    losses = []
    for _ in range(60):
        column = column_of(random.normal(size=white.size)) * (white != 0.0)
        wide = np.column_stack([slopes, column])
        step = np.linalg.lstsq(wide, -white, rcond=None)[0]
        left = white + wide @ step
        design = replace(
            fit.design,
            white=left.reshape(fit.design.white.shape),
            slopes=wide.reshape(*fit.design.white.shape, -1),
            columns=(*fit.design.columns, (fit.design.columns[0][0], run)),
        )
        sum_of_squares = float(left @ left - white @ white)
        moves = block_diag(fit.moves, 1.0)
        more = replace(fit, design=design, moves=moves, cost=fit.cost + sum_of_squares)
        losses.append(cross_validated_cost(runs, more) - alone)
    return losses


def test_a_useless_number_costs_about_as_much_as_chance_gave_it() -> None:
    """Fitted to the noise it gains 1 on the average; on legs left out it must lose as much."""
    assert 0.3 < np.mean(losses_with(lambda deviates: deviates, -1)) < 3.0


@pytest.mark.parametrize("run", [0, -1])
def test_what_one_fold_knows_better_than_the_others_is_not_carried_over_to_it(run: int) -> None:
    """A first heading, seen by positions alone: of it a drive's end tells a thousandth.

    And the base of a robot that turned once: of 15 legs one told it, and the others, which were
    straight, sent it anywhere. So a clock that was late by 0.33 s was refused.
    """
    rows = np.repeat(fold_of_leg(laid_out(GIVEN, range(1, 3))), 3)
    told = np.where(rows == 0, 1.0, 0.02)
    assert np.mean(losses_with(lambda deviates: told * deviates, run)) < 3.0
