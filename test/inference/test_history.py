# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The course of a robot's numbers over many drives, put together from what each drive tells."""

from __future__ import annotations

import numpy as np
import pytest

from werrimbi_odom.inference.changes.history import Course, DriveEstimate, course_of
from werrimbi_odom.inference.fitting.free_parameters import MULTIPLIERS
from werrimbi_odom.model.robot import Robot

ROBOT = Robot(0.35, 0.05, 2000.0, 2000.0)
DAY = 86400.0
STD = 3e-4


def course(
    levels: np.ndarray,
    random: np.random.Generator,
    scatter: float = 0.0,
    dumb: tuple[int, ...] = (),
) -> Course:
    """Of drives that tell base and radii with an error of `STD`; the `dumb` ones hardly."""
    told = []
    for number, level in enumerate(levels):
        std = STD * (300.0 if number in dumb else 1.0)
        seen = level + random.normal(size=3) * np.hypot(std, scatter)
        information = np.eye(3) / std**2
        told.append(DriveEstimate(MULTIPLIERS, information, information @ seen, 0.0, 500, 20.0))
    return course_of(told, ROBOT, DAY * np.arange(len(levels)))


def changed(found: Course) -> list[tuple[str, str, str]]:
    return [(move.what, move.kind, move.from_run) for move in found.changes]


def number(found: Course, name: str) -> int:
    return [each.name for each in found.numbers].index(name)


def test_drives_that_scatter_alike_tell_no_change_and_how_much_they_scatter() -> None:
    random = np.random.default_rng(6)
    told, sizes = 0, []
    for _ in range(60):
        found = course(np.ones((40, 3)), random, scatter=3.0 * STD)
        told += bool(found.changes)
        sizes.append(found.numbers[0].scatter)
        assert found.off == ()
    assert told <= 1
    assert np.median(sizes) == pytest.approx(3.0 * STD, rel=0.15)


def test_a_change_is_found_above_the_scatter() -> None:
    random = np.random.default_rng(7)
    levels = np.ones((40, 3))
    levels[25:, 2] += 12.0 * STD
    found = course(levels, random, scatter=2.0 * STD)
    assert changed(found) == [("right_wheel_radius_multiplier", "step", "25")]
    assert [each.name for each in found.off] == ["right_wheel_radius_multiplier"]
    ratio = found.numbers[number(found, "unequal_wheel_radii")]
    assert ratio.level[[0, -1]] == pytest.approx([1.0, 1.0 + 12.0 * STD], abs=2.0 * STD)


def test_of_few_drives_a_change_is_held_against_what_they_differ_by() -> None:
    random = np.random.default_rng(8)
    told = sum(
        bool(course(np.ones((5, 3)), random, scatter=20.0 * STD).changes) for _ in range(100)
    )
    assert told <= 2


def test_a_drive_that_tells_little_is_taken_for_what_those_around_it_are() -> None:
    random = np.random.default_rng(9)
    levels = np.ones((20, 3))
    levels[10:, 1] -= 20.0 * STD
    found = course(levels, random, scatter=2.0 * STD, dumb=(14,))
    left = found.numbers[number(found, "left_wheel_radius_multiplier")]
    assert np.isnan(left.own[14])
    assert left.pooled[14] == pytest.approx(levels[14, 1], abs=2.0 * STD)
    assert left.pooled_std[14] > left.pooled_std[13]
    # A drive that tells much keeps most of its own.
    kept = (left.pooled[13] - left.level[13]) / (left.own[13] - left.level[13])
    assert 0.5 < kept <= 1.0


def test_wear_over_a_thousand_drives_is_one_trend() -> None:
    random = np.random.default_rng(10)
    levels = np.ones((1000, 3))
    levels[:, 1] -= 0.01 * np.arange(1000) / 1000.0
    levels[600:, 2] += 2e-3
    found = course(levels, random, scatter=STD)
    assert ("right_wheel_radius_multiplier", "step", "600") in changed(found)
    (wear,) = [move for move in found.changes if move.what == "left_wheel_radius_multiplier"]
    assert wear.kind == "trend"
    assert wear.after - wear.before == pytest.approx(-0.01, abs=5e-4)
    assert len(found.changes) == 2
