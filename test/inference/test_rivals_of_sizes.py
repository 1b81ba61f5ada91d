# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A size that is needless beside an effect as likely may be that effect's doing."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

import pytest

from test.inference.driven import runs_of
from werrimbi_odom.effects import find
from werrimbi_odom.inference.diagnosis.forward_selection import Round, fit_calibration, search_round
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.rivals import rivals_of
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.inference.rules import RIVAL
from werrimbi_odom.model.robot import Robot

GIVEN = Robot(0.35, 0.05, 2000.0, 2000.0, left_wheel_noise=4e-4, right_wheel_noise=4e-4)


@lru_cache
def a_round() -> Round:
    """Of a robot whose tyres creep in curves: an effect was tried beside the sizes."""
    truth = replace(GIVEN, effects=(find("lateral_slip").using(creep=0.01),))
    runs = concatenated(match_for_fit(runs_of(truth, range(1, 3), seconds=40), GIVEN, 1.0))
    return search_round(runs, fit_calibration(runs, GIVEN), [find("lateral_slip")], GIVEN)


def of_sizes(needed: tuple[str, ...], dearer: float, **what: object) -> tuple[str, ...]:
    """Rivals of unequal radii where an effect needs some sizes, and costs so much more."""
    found = a_round()
    final: Fitted = replace(
        found.before, calibrated=("unequal_wheel_radii", "wheel_radius_scale"), alternatives=()
    )
    (tried,) = found.tried
    cost = tried.cost + final.total - tried.total + dearer
    tried = replace(tried, calibrated=needed, cost=cost, **what)  # type: ignore[arg-type]
    this = replace(found, before=final, tried=(tried,))
    return rivals_of("unequal_wheel_radii", (this,), final, ())


@pytest.mark.parametrize("needed", [(), ("wheel_radius_scale",)])
def test_an_effect_beside_which_the_size_is_needless_is_its_rival(needed: tuple[str, ...]) -> None:
    assert of_sizes(needed, 0.5 * RIVAL) == ("unequal_wheel_radii", "lateral_slip")


def test_one_that_needs_the_size_as_well_is_none() -> None:
    assert of_sizes(("unequal_wheel_radii",), 0.5 * RIVAL) == ()


def test_nor_one_that_needs_another_size_in_its_place() -> None:
    assert of_sizes(("track_width", "wheel_radius_scale"), 0.5 * RIVAL) == ()


def test_nor_one_that_costs_more_than_chance_makes() -> None:
    assert of_sizes((), 1.5 * RIVAL) == ()


def test_nor_one_that_ran_against_what_physics_allows() -> None:
    assert of_sizes((), 0.5 * RIVAL, at_bound=("lateral_slip.creep",)) == ()
