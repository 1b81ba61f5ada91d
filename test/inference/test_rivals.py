# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A name that half of the data would change is no certainty, nor a size beside a likely effect."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from test.inference.driven import parts, run_of, runs_of
from test.model.drives import ROBOT
from werrimbi_odom.effects import find
from werrimbi_odom.effects.library import LIBRARY as ALL
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.effect_support import askable
from werrimbi_odom.inference.diagnosis.forward_selection import (
    Round,
    fit_calibration,
    search_round,
)
from werrimbi_odom.inference.diagnosis.instead_of_calibration import instead_of_calibration
from werrimbi_odom.inference.diagnosis.p_values import p_value_of_size
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.diagnosis.rivals import halves, rivals_in_halves, rivals_of
from werrimbi_odom.inference.fitting.concatenated_runs import concatenated
from werrimbi_odom.inference.legs.cutting import match_for_fit
from werrimbi_odom.model.robot import Robot

RADII = ("left_wheel_radius_multiplier", "right_wheel_radius_multiplier")
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


def test_what_differs_from_a_rough_set_up_need_not_differ_from_the_file() -> None:
    """Counts times four were found as a factor of 4.05, and sound wheels then as unequal."""
    fit = replace(a_round().before, importance={"wheel_radius_scale": 300.0})
    near = fit.point.model.robot.left_wheel_radius_multiplier
    file, rough = (replace(GIVEN, **dict.fromkeys(RADII, near * by)) for by in (1.0, 1.01))
    assert p_value_of_size(fit, "wheel_radius_scale", rough, rough) < rules.SURE
    assert p_value_of_size(fit, "wheel_radius_scale", file, rough) > rules.SURE


def test_a_reference_without_headings_has_none_that_are_late_or_drift() -> None:
    """By positions alone a gyro that nobody has was a rival of the wheels' size."""
    (run,) = runs_of(GIVEN, [1], seconds=20)
    laid = [
        concatenated(match_for_fit([each], GIVEN, 1.0)) for each in (run, parts(run, "positions"))
    ]
    known, unknown = ({each.name for each in askable(ALL, runs, GIVEN)} for runs in laid)
    assert known - unknown == {"reference_heading_delay", "reference_gyro_drift"}


def test_a_size_that_is_wrong_in_any_case_is_no_rival_of_the_others() -> None:
    """Squares by tape tell the ratio of the radii, and neither their mean nor the base."""
    names = ("wheel_radius_scale", "unequal_wheel_radii", "track_width")
    scale, ratio, base = names
    final: Fitted = replace(
        a_round().before, calibrated=(scale, ratio), alternatives=((ratio, base),)
    )
    assert rivals_of(scale, (), final, ()) == (scale, base)
    assert rivals_of(ratio, (), final, ()) == ()
    final = replace(final, alternatives=((ratio, base), (scale, base)))
    assert set(rivals_of(scale, (), final, ())) == set(names)


@pytest.mark.parametrize("needed", [(), ("wheel_radius_scale",)])
def test_an_effect_beside_which_the_size_is_needless_is_its_rival(needed: tuple[str, ...]) -> None:
    assert of_sizes(needed, 0.5 * rules.RIVAL) == ("unequal_wheel_radii", "lateral_slip")


def test_one_that_needs_the_size_as_well_is_none() -> None:
    assert of_sizes(("unequal_wheel_radii",), 0.5 * rules.RIVAL) == ()


def test_nor_one_that_needs_another_size_in_its_place() -> None:
    assert of_sizes(("track_width", "wheel_radius_scale"), 0.5 * rules.RIVAL) == ()


def test_nor_one_that_costs_more_than_chance_makes() -> None:
    assert of_sizes((), 1.5 * rules.RIVAL) == ()


def test_nor_one_that_ran_against_what_physics_allows() -> None:
    assert of_sizes((), 0.5 * rules.RIVAL, at_bound=("lateral_slip.creep",)) == ()


def having(name: str, **values: float) -> Robot:
    return replace(GIVEN, effects=(find(name).using(**values),))


LIBRARY = tuple(find(name) for name in ("lateral_slip", "turn_dependent_track", "sideways_drift"))


def test_halves_are_halves_of_every_drive() -> None:
    runs = concatenated(match_for_fit(runs_of(GIVEN, range(1, 4), seconds=60), GIVEN, 1.0))
    masks = list(halves(runs))
    assert len(masks) == 4
    for mask in masks:
        for run in range(3):
            assert abs(np.mean(mask[runs.run_of_leg == run]) - 0.5) < 0.06
    for one, other in zip(masks[::2], masks[1::2], strict=True):
        assert np.array_equal(one, ~other)


def test_one_effect_in_all_drives_is_named() -> None:
    truth = having("lateral_slip", creep=0.01)
    found = diagnose(runs_of(truth, range(1, 5), seconds=60), GIVEN, LIBRARY)
    assert (found.verdict, found.effect, found.torn) == ("named", "lateral_slip", ())


@pytest.mark.evidence
def test_an_effect_that_another_beats_in_half_of_the_data_is_not_certain() -> None:
    """In the first half of every drive the robot slips, in the second it crabs, less in all."""
    slipping = runs_of(having("lateral_slip", creep=0.012), range(1, 4), seconds=50)
    crabbing = runs_of(having("sideways_drift", angle=0.008), range(1, 4), seconds=50)
    mixed = []
    for one, other in zip(slipping, crabbing, strict=True):
        assert one.reference is not None
        assert other.reference is not None
        middle = one.ticks.time[one.ticks.time.size // 2]
        before, after = one.reference, other.reference
        at = int(np.searchsorted(before.time, middle))
        turn = before.yaw[at] - after.yaw[at]
        moved = (after.x - after.x[at] + 1j * (after.y - after.y[at])) * np.exp(1j * turn)
        x, y = moved.real + before.x[at], moved.imag + before.y[at]
        joined = [
            np.concatenate([first[:at], second[at:]])
            for first, second in ((before.x, x), (before.y, y), (before.yaw, after.yaw + turn))
        ]
        mixed.append(
            replace(one, reference=replace(before, x=joined[0], y=joined[1], yaw=joined[2]))
        )
    runs = concatenated(match_for_fit(mixed, GIVEN, 1.0))
    before = fit_calibration(runs, GIVEN)
    this = search_round(runs, before, (LIBRARY[0], LIBRARY[2]), GIVEN)
    best = this.tried[0]
    others = {"lateral_slip", "sideways_drift"} - {best.names[-1]}
    assert set(rivals_in_halves(runs, this, best)) == others
    assert diagnose(mixed, GIVEN, (LIBRARY[0], LIBRARY[2])).verdict != "named"


@pytest.mark.parametrize(("also_found", "rivals"), [(False, ("a", "b")), (True, ())])
def test_what_was_found_beside_an_effect_is_no_rival_of_it(
    rivals: tuple[str, ...], *, also_found: bool
) -> None:
    """Slip along and creep aside gained as much in the first round, and both were found."""
    slip, creep = find("longitudinal_slip"), find("lateral_slip")
    tried = [
        SimpleNamespace(names=(name,), newest=effect, at_bound=(), total=total, scatter=1.0)
        for name, effect, total in (("a", slip, 900.0), ("b", creep, 905.0))
    ]
    first: Any = SimpleNamespace(tried=tried)
    beside: Any = SimpleNamespace(tried=[SimpleNamespace(names=("a", "b"), at_bound=())])
    final: Any = SimpleNamespace(names=("a", "b") if also_found else ("a",))
    assert rivals_of("a", (first, beside), final, ()) == rivals


@pytest.mark.parametrize("amplitude", [0.0, 8e-4])
def test_in_place_of_a_calibration_the_phases_of_each_drive_cost_what_they_cost(
    amplitude: float,
) -> None:
    """A base that is 0.1 % wider, and a file that holds an eccentric wheel, or does not."""
    held = (find("eccentric_left_wheel").using(amplitude=amplitude),) if amplitude else ()
    file = replace(ROBOT, effects=held)
    random = np.random.default_rng(0)
    drives = []
    for seed in range(1, 9):
        wheel = (each.learnt(phase=random.uniform(-3, 3)) for each in held)
        truth = replace(ROBOT, wheel_separation_multiplier=1.001, effects=tuple(wheel))
        drives.append(run_of(truth, seed, 40))
    laid = concatenated(match_for_fit(drives, file, leg=1.0))
    calibrated = fit_calibration(laid, file)
    assert calibrated.calibrated == ("track_width",)
    (instead,) = instead_of_calibration(laid, calibrated, [find("turn_dependent_track")], file)
    assert instead.total - calibrated.total > 30.0
