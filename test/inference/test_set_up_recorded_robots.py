# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The same mistakes put into drives of real robots, on top of what is wrong with them already."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import pytest

from test.inference.set_up_mistakes import DELAYS, FACTORS, ONE_SIDE, REFERENCE, SIZES, WIRING
from test.recorded_robots import ROBOTS, with_recordings
from werrimbi_odom.files.evaluation_options import EvaluationOptions
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import ReferenceKind, Run
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.inference.set_up.search import SetUp, look_for_mistakes
from werrimbi_odom.model.robot import Robot

WITH_POSES = ("optitrack_robot", "khepera_laser_to_the_side", "khepera_laser_moved")
MOUNTS = {"optitrack_robot": 0.0, "khepera_laser_to_the_side": -89.0, "khepera_laser_moved": -107.0}

pytestmark = with_recordings


def thinned(wrong: Sequence[object], every: int = 1) -> list[Any]:
    """Every so many of them with one of the robots; all with each robot in `make evidence`."""
    return [
        pytest.param(
            each,
            name,
            marks=[pytest.mark.evidence] * (row % every > 0 or (row // every - column) % 3 > 0),
        )
        for row, each in enumerate(wrong)
        for column, name in enumerate(WITH_POSES)
    ]


@lru_cache
def robot_and_runs(name: str) -> tuple[Robot, list[Run]]:
    runs = [read_run_folder(path.parent) for path in sorted(ROBOTS.glob(f"{name}/*/ticks.csv"))]
    return read_robot_file(ROBOTS / name / "robot.yaml").robot, runs


def looked_at(name: str, mistake_name: str = "") -> SetUp:
    robot, runs = robot_and_runs(name)
    every = {**WIRING, **SIZES, **ONE_SIDE, **REFERENCE, **DELAYS}
    if mistake_name:
        runs, robot = every[mistake_name].made(runs, robot)
    kind: ReferenceKind = "incremental" if "khepera" in name else "absolute"
    return look_for_mistakes(runs, robot, EvaluationOptions(reference_kind=kind))


def test_nothing_is_wrong_with_the_optitrack_robots_set_up() -> None:
    assert looked_at("optitrack_robot").findings == ()


@pytest.mark.parametrize("name", WITH_POSES[1:])
def test_the_kheperas_lasers_look_to_the_side(name: str) -> None:
    (finding,) = looked_at(name).findings
    assert finding.effect == "reference_yaw_offset"
    assert math.degrees(finding.values["angle"]) == pytest.approx(MOUNTS[name], abs=2.0)


def test_the_labyrinth_robot_has_half_its_base_and_a_mirrored_reference() -> None:
    findings = looked_at("labyrinth").findings
    assert [each.effect for each in findings] == ["wheels_swapped", "track_width"]
    assert "reference_mirrored" in findings[0].twins
    assert findings[1].factor == "2"


@pytest.mark.parametrize(
    ("mistake", "name"),
    [
        *thinned([*WIRING, "degrees", "millimetres"], every=3),
        *thinned([*SIZES, *ONE_SIDE], every=6),
    ],
)
def test_a_mistake_is_found_first(name: str, mistake: str) -> None:
    wanted = {**WIRING, **SIZES, **ONE_SIDE, **REFERENCE}[mistake]
    first = looked_at(name, mistake).findings[0]
    assert {first.effect, *first.twins} & set(wanted.names), first
    if wanted.factor is not None:
        assert first.factor == wanted.factor


@pytest.mark.parametrize(("late", "name"), thinned([0.6, 2.0, -1.5, 4.0], every=2))
def test_a_late_clock_is_found_to_a_twentieth_of_a_second(name: str, late: float) -> None:
    findings = looked_at(name, f"clock {late} s late").findings
    (delay,) = [each for each in findings if each.effect == "reference_delay"]
    assert delay.values["delay"] == pytest.approx(late, abs=0.05)


@pytest.mark.evidence
@pytest.mark.parametrize("name", WITH_POSES)
@pytest.mark.parametrize("degrees", [40, 90, 180, -90, -135])
def test_a_mount_adds_to_the_one_that_is_there(name: str, degrees: int) -> None:
    angle = math.remainder(math.radians(MOUNTS[name] + degrees), 2.0 * math.pi)
    findings = looked_at(name, f"mount {degrees}").findings
    if abs(angle) < 0.33:  # what was tampered with is nearly what was wrong
        assert findings == ()
    else:
        (finding,) = findings
        apart = math.remainder(finding.values["angle"] - angle, 2.0 * math.pi)
        assert abs(apart) < math.radians(2.0)


@pytest.mark.parametrize("name", WITH_POSES)
def test_a_long_lever_arm_is_found(name: str) -> None:
    assert "reference_lever_arm" in {each.effect for each in looked_at(name, "lever arm").findings}


@pytest.mark.evidence
@pytest.mark.parametrize("what", ["radius", "base"])
@pytest.mark.parametrize("factor", FACTORS)
def test_the_labyrinth_robots_own_mistakes_and_another(what: str, factor: str) -> None:
    """Its base is twice the one entered; a factor on top of that multiplies it."""
    values = {
        each.effect: each.values.get("multiplier", 1.0)
        for each in looked_at("labyrinth", f"{what} {factor}").findings
    }
    assert "wheels_swapped" in values
    base = 2.0 * (FACTORS[factor] if what == "base" else 1.0)
    radius = FACTORS[factor] if what == "radius" else 1.0
    assert values.get("track_width", 1.0) == pytest.approx(base, rel=0.1)
    assert values.get("wheel_radius_scale", 1.0) == pytest.approx(radius, rel=0.1)


@pytest.mark.parametrize(
    "mistake",
    [
        pytest.param(each, marks=[pytest.mark.evidence] * (row % 3 > 0))
        for row, each in enumerate(ONE_SIDE)
    ],
)
def test_the_labyrinth_robots_own_mistakes_and_one_encoder(mistake: str) -> None:
    assert "unequal_wheel_radii" in {
        each.effect for each in looked_at("labyrinth", mistake).findings
    }
