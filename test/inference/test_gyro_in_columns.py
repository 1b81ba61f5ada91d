# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Headings alone in a reference.csv: a gyro's, unless they are few or their noise is stated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.inference.driven import COMMON, of_headings
from test.model.drives import ROBOT, read
from werrimbi_odom.api.drives import recordings_of
from werrimbi_odom.api.next_command import next_command
from werrimbi_odom.files.run import ReferenceKind, Run, Ticks
from werrimbi_odom.inference.diagnosis.diagnosis import diagnose
from werrimbi_odom.inference.diagnosis.estimated_values import values_of
from werrimbi_odom.inference.manoeuvres.advice import significant
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory
from werrimbi_odom.report.diagnosis.reference_remarks import or_a_compass

FILE = Path(__file__).parents[2] / "config" / "robot.yaml"


def drive(true: Robot = ROBOT) -> tuple[Ticks, Floats]:
    """Rests of 20 s, curves to both sides and lines; counters, and the true heading."""
    still, line = np.zeros(400), np.zeros(100)
    turning = np.concatenate(
        [np.r_[still, rate * np.ones(80), line] for rate in (0.8, -0.8, 0.5, -0.5)]
    )
    speed = np.tile(np.r_[still, 0.3 * np.ones(80), 0.4 * np.ones(100)], 4)
    ticks = read(ROBOT, 20.0, speed, turning)
    counted = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float))
    return counted, trajectory(true, *ticks).yaw


def of_columns(ticks: Ticks, yaw: Floats, kind: ReferenceKind | None = None) -> Run:
    return Run("run", Path("run"), ticks, of_headings(ticks.time, yaw, kind))


def by_gyro(kind: ReferenceKind | None = None) -> Run:
    ticks, yaw = drive()
    walk = np.cumsum(np.random.default_rng(1).normal(0.0, 3e-4, yaw.size))
    return of_columns(ticks, yaw + walk, kind)


def taken(*runs: Run, **options: object) -> str | None:
    return recordings_of(wo.read_robot(FILE), list(runs), **options).how.reference_kind  # type: ignore[arg-type]


def test_a_gyro_that_walks_while_the_robot_stands_turned_no_robot() -> None:
    """Its columns do not say what it is; taken as absolute, the robot was turned twice at rest."""
    given = recordings_of(wo.read_robot(FILE), by_gyro())
    found = diagnose(given.runs, ROBOT, COMMON[:2], given.evaluation)
    assert not found.happened.events
    assert found.verdict == "none"


def test_a_base_by_a_compass_that_is_taken_for_a_gyro_is_right_within_what_is_said() -> None:
    """Errors of a compass are new in each heading: added up they only weigh less."""
    ticks, yaw = drive(replace(ROBOT, wheel_separation_multiplier=1.05))
    noise = np.random.default_rng(2).normal(0.0, 0.01, yaw.size)
    given = recordings_of(wo.read_robot(FILE), of_columns(ticks, yaw + noise))
    found = diagnose(given.runs, ROBOT, COMMON[:2], given.evaluation)
    assert (found.effect, found.happened.events) == ("track_width", ())
    base = values_of(found, "track_width")["multiplier"]
    assert 0.0 < base.std < 0.5 * 0.05
    assert abs(base.value - 1.05) < 3.0 * base.std


def test_headings_alone_are_a_gyro_s_unless_something_says_otherwise() -> None:
    run = by_gyro()
    assert run.reference is not None
    assert taken(run) == "incremental"
    assert taken(run, reference_kind="absolute") == "absolute"
    assert taken(run, reference_sigma_yaw=0.01) == "absolute", "of each heading"
    stated = replace(run.reference, sigma_yaw=np.full(run.reference.time.size, 0.01))
    assert taken(replace(run, reference=stated)) == "absolute"
    few = replace(run, reference=run.reference.chosen(np.array([0, run.reference.time.size - 1])))
    assert taken(few) == "absolute", "by tape or protractor"
    places = replace(run.reference, x=run.reference.yaw, y=run.reference.yaw)
    poses = replace(run, name="poses", reference=places)
    assert taken(run, poses) == "absolute", "one kind for all drives"


def test_a_compass_stays_one_in_the_next_command() -> None:
    given = recordings_of(wo.read_robot(FILE), by_gyro(), reference_kind="absolute")
    assert "--reference-kind absolute" in next_command(["diagnose"], given)


@pytest.mark.parametrize(("rows", "said"), [(slice(None), True), (slice(None, None, 1700), False)])
def test_the_command_line_says_how_headings_alone_are_taken(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rows: slice, said: bool
) -> None:
    from werrimbi_odom.cli.main import main

    ticks, yaw = drive()
    nothing = np.full(yaw.size, np.nan)
    poses = np.column_stack((ticks.time, nothing, nothing, yaw))[rows]
    run = wo.write_run(tmp_path / "run", ticks.time, ticks.left, ticks.right, poses)
    main(["compare", "--robot", str(FILE), str(run)])
    assert ("taken as a gyro's" in capsys.readouterr().err) == said


def test_iron_beside_a_compass_is_told_as_what_it_may_be() -> None:
    """No wheel knows the direction in the room, and a drafted law of it would mend no wheel."""
    random = np.random.default_rng(4)
    turning = np.repeat(random.uniform(-0.8, 0.8, 60), 60)
    ticks = read(ROBOT, 20.0, np.full(turning.size, 0.3), turning)
    counted = Ticks(ticks.time, ticks.left.astype(float), ticks.right.astype(float))
    yaw = trajectory(ROBOT, *ticks).yaw
    iron = 0.12 * np.sin(yaw + 0.4)
    run = of_columns(counted, yaw + iron + random.normal(0.0, 0.01, yaw.size))
    given = recordings_of(wo.read_robot(FILE), run)
    found = diagnose(given.runs, ROBOT, COMMON[:2], given.evaluation)
    assert found.verdict == "unknown"
    (said,) = or_a_compass(found, significant(found)[0].variable.name)
    assert said.startswith("A compass beside iron errs so")
    assert or_a_compass(found, "distance") == []
