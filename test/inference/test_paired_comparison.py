# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Two models over the same legs: chance raises an error in as many cases as the rule says."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from test.inference.driven import run_of
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import Legs, judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import prepare
from werrimbi_odom.inference.diagnosis.paired_comparison import sides_of
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.model.robot import Robot

PLAIN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)
RANDOM = np.random.default_rng(13)


@pytest.fixture(scope="module")
def legs() -> Legs:
    prepared = prepare([run_of(PLAIN, seed, 40) for seed in (1, 2)], PLAIN)
    return judged_legs(prepared, Model(PLAIN, ({}, {})), 1.0)


def erring(legs: Legs, error: np.ndarray) -> Legs:
    return replace(legs, errors=replace(legs.errors, error=error))


def share_that_rises(legs: Legs, differing: np.ndarray | float) -> float:
    """Of 1000 pairs of models that err alike, those said to differ; `differing` [m]: by how much.

    Errors of a leg are alike but for a little, which is what two models of one robot do.
    """
    count, rose = 1000, 0
    for _ in range(count):
        common = RANDOM.normal(0.0, 1e-2, legs.errors.error.shape)
        one, other = (common + differing * RANDOM.normal(size=common.shape) for _ in range(2))
        rose += sides_of(erring(legs, one), erring(legs, other), "m").rose
    return rose / count


@pytest.mark.evidence
def test_two_models_that_err_alike_differ_beyond_chance_as_seldom_as_the_rule_says(
    legs: Legs,
) -> None:
    share = share_that_rises(legs, 1e-3)
    assert rules.SURE_WHEN_ASKED / 5 < share < 2.5 * rules.SURE_WHEN_ASKED


@pytest.mark.evidence
def test_two_models_that_differ_on_a_few_legs_alone_do_not_differ_beyond_chance_either(
    legs: Legs,
) -> None:
    """As by a reference's delay: only where the robot sped up or turned as a leg began."""
    count = len(legs.run)
    few = (np.arange(count) % (count // 5) == 0)[:, None]
    assert share_that_rises(legs, 2e-3 * few) < 2.5 * rules.SURE_WHEN_ASKED


def test_a_rise_that_two_totals_hide_is_seen_leg_by_leg(legs: Legs) -> None:
    """Noise of 10 mm a leg, and 3 % more of it on every leg."""
    noise = RANDOM.normal(0.0, 1e-2, legs.errors.error.shape)
    before, after = erring(legs, noise), erring(legs, 1.03 * noise)
    for unit in ("m", "rad"):
        assert sides_of(before, after, unit).rose
        assert not sides_of(before, after, unit).fell
        assert sides_of(after, before, unit).fell
        assert not sides_of(after, before, unit).rose


def test_what_the_legs_do_not_show_at_all_rose_by_nothing(legs: Legs) -> None:
    assert sides_of(legs, legs, "m").chance == 1.0
    alone = legs.chosen(np.arange(1))
    assert sides_of(alone, erring(alone, alone.errors.error + 1.0), "m").chance == 1.0
    nothing = erring(legs, np.full(legs.errors.error.shape, np.nan))
    assert sides_of(nothing, nothing, "m").chance == 1.0


def test_an_event_that_one_model_alone_sees_is_left_out_of_both(legs: Legs) -> None:
    """Two laws each find for themselves what happened at once."""
    noise = RANDOM.normal(0.0, 1e-2, legs.errors.error.shape)
    pushed = 1.03 * noise
    pushed[0] = 1.0
    event = np.zeros(len(noise), dtype=bool)
    event[0] = True
    before, after = erring(legs, noise), replace(erring(legs, pushed), event=event)
    without = (each.chosen(~event) for each in (before, after))
    assert sides_of(before, after, "m").chance == sides_of(*without, "m").chance < 0.01
