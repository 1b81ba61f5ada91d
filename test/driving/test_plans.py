# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What can be driven: where manoeuvres lead, how long they take, whether they fit in the area."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.driving.limits import Area, Limits
from werrimbi_odom.driving.manoeuvres import NAMES, plan_of, proposed
from werrimbi_odom.driving.plan import Move, Profile, room_of
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference.manoeuvres.library import MANOEUVRES
from werrimbi_odom.model.pose import Pose

LIMITS = Limits(0.4, 1.2, 0.8, 2.5)


@pytest.mark.parametrize("name", ["umbmark_ccw", "umbmark_cw", "umbmark", "square", "spins"])
def test_a_closed_manoeuvre_ends_where_it_began(name: str) -> None:
    end = plan_of(name).starts()[-1]
    assert math.hypot(end.x, end.y) < 1e-9
    assert abs(math.remainder(end.yaw, 2.0 * math.pi)) < 1e-9


def test_every_manoeuvre_that_diagnose_can_propose_can_be_driven() -> None:
    assert {each.name for each in MANOEUVRES} <= set(NAMES)
    for name in NAMES:
        plan = plan_of(name, size=0.5, length=1.0)
        assert 5.0 < plan.duration(LIMITS) < 1000.0
        twice = plan_of(name, size=0.5, length=1.0, repetitions=2)
        assert twice.duration(LIMITS) > 1.8 * plan.duration(LIMITS) - 2.0


def test_an_unknown_name_is_told_with_the_nearest() -> None:
    with pytest.raises(InputError, match="umbmark_ccw"):
        plan_of("umbmark_ccv")


@pytest.mark.parametrize(
    "move", [Move(2.0, 0.0), Move(-0.05, 0.0), Move(1.0, -3.0), Move(0.0, 9.0)]
)
def test_a_move_goes_from_rest_to_rest_within_the_limits(move: Move) -> None:
    profile = Profile.of(move, LIMITS)
    time = np.linspace(0.0, profile.duration, 4001)
    share, rate = np.array([profile.at(float(each)) for each in time]).T
    assert share[0] == 0.0
    assert share[-1] == pytest.approx(1.0)
    np.testing.assert_allclose(
        np.diff(share), 0.5 * np.diff(time) * (rate[1:] + rate[:-1]), atol=1e-6
    )
    change = np.diff(rate) / np.diff(time)
    assert np.abs(rate * move.length).max() <= LIMITS.speed
    assert np.abs(rate * move.turn).max() <= LIMITS.yaw_rate
    assert np.abs(change * move.length).max() <= LIMITS.acceleration
    assert np.abs(change * move.turn).max() <= LIMITS.yaw_acceleration


def test_room_is_what_the_robots_circle_leaves_to_the_border() -> None:
    area = Area(ahead=3.0, behind=0.5, left=2.5, right=0.5, robot_radius=0.3)
    here = Pose(0.0, 0.0, 0.0)
    square = plan_of("umbmark_ccw", length=2.0)
    assert room_of(square.path(), area, here) == pytest.approx(0.2)  # the left side
    assert room_of(plan_of("umbmark_cw", length=2.0).path(), area, here) < 0.0
    circle = Area(radius=3.0, robot_radius=0.1)
    far = math.hypot(2.0, 2.0)
    assert room_of(square.path(), circle, here) == pytest.approx(2.9 - far)
    assert room_of(square.path(), circle, Pose(1.0, 0.0, math.pi)) > 2.9 - far


def diagnosis(path: Path, **next_manoeuvre: object) -> Path:
    path.write_text(json.dumps({"verdict": "ambiguous", "next_manoeuvre": next_manoeuvre or None}))
    return path


def test_what_diagnose_proposes_is_driven_for_as_long_as_it_says(tmp_path: Path) -> None:
    file = diagnosis(tmp_path / "d.json", name="spins", why="they differ", do="spin", minutes=5.0)
    plan = proposed(file, LIMITS)
    once = plan_of("spins").duration(LIMITS)
    assert plan.name == "spins"
    assert 300.0 <= plan.duration(LIMITS) < 300.0 + 2.0 * once


@pytest.mark.parametrize(
    ("told", "says"),
    [
        ({}, "no manoeuvre tells its rivals apart in reasonable time; a ruler may"),
        ({"name": "push", "why": "w", "do": "push it by hand"}, "work by hand: push it by hand"),
    ],
)
def test_what_cannot_be_driven_is_said(tmp_path: Path, told: dict[str, object], says: str) -> None:
    with pytest.raises(InputError, match=says):
        proposed(diagnosis(tmp_path / "d.json", **told), LIMITS)
    found = tmp_path / "named.json"
    found.write_text(json.dumps({"verdict": "named", "next_manoeuvre": None}))
    with pytest.raises(InputError, match="nothing needs to be driven next: the verdict is named"):
        proposed(found, LIMITS)
    found.write_text(json.dumps({"verdict": "unknown", "next_manoeuvre": None}))
    with pytest.raises(InputError, match="depend on nothing that was measured"):
        proposed(found, LIMITS)
    told = {"verdict": "unknown", "next_manoeuvre": None, "drives_differ": True}
    found.write_text(json.dumps(told))
    with pytest.raises(InputError, match="diagnose those since the change alone"):
        proposed(found, LIMITS)
    with pytest.raises(InputError, match="cannot be read as JSON"):
        proposed(tmp_path / "none.json", LIMITS)


@pytest.mark.parametrize(
    ("ahead", "says"),
    [
        ("spins", "is no manoeuvre of werrimbi diagnose"),
        ({"why": "no name"}, "is no manoeuvre of werrimbi diagnose"),
        ({"name": 7}, "is no manoeuvre of werrimbi diagnose"),
        ({"name": "spins", "minutes": "two"}, "minutes in .* must be a number from 0 .* not 'two'"),
        ({"name": "spins", "minutes": math.inf}, "minutes in .* must be a number .* not inf"),
        ({"name": "spins", "minutes": 1e300}, "minutes in .* must be .* to 1440, not 1e.300"),
    ],
)
def test_a_file_that_somebody_wrote_by_hand_is_refused_in_words(
    tmp_path: Path, ahead: object, says: str
) -> None:
    file = tmp_path / "by_hand.json"
    file.write_text(json.dumps({"verdict": "ambiguous", "next_manoeuvre": ahead}))
    with pytest.raises(InputError, match=says):
        proposed(file, LIMITS)
