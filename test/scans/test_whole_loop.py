# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Every verb in its turn with /scan as the only reference, each command as the last printed it."""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.command_line import Werrimbi
from test.loops import awaited
from test.scans.turtlebot import LIDAR, ROBOT, recorded
from werrimbi_odom import simulation as sim
from werrimbi_odom.effects.lookup import all_effects
from werrimbi_odom.files import recordings
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.recordings import DriveOptions, Recordings
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Run
from werrimbi_odom.simulation.hidden.beyond_library import OneTyreBackwards
from werrimbi_odom.workbench.job import Job
from werrimbi_odom.workbench.saving import Target
from werrimbi_odom.workbench.tab import Opening, Shared
from werrimbi_odom.workbench.task import Open

SCAN = "/scan"
MOUNT = sim.AxlePose(-0.032, 0.0, 0.0)
SLOW = replace(LIDAR, mount=MOUNT, rate_hz=5.0)
WIDE = replace(ROBOT, left_wheel_radius=0.033, right_wheel_radius=0.033)
"""Its base is 5 % wider than entered, and nothing else is wrong."""
TYRE = 0.03
"""Share by which a tyre of the other robot, which is right otherwise, rolls shorter backwards."""

pytestmark = pytest.mark.usefixtures("few_effects", "read_once")


def to_and_fro(seed: int) -> sim.Manoeuvre:
    """Ten bends of either sense, each second one backwards, after a second's rest."""
    rng = np.random.default_rng([seed, 6])
    knots = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]
    for forwards in (0.25, -0.25) * 5:
        begins, speed = knots[-1][0] + 0.5, forwards * rng.uniform(0.6, 1.2)
        turning = rng.uniform(-0.7, 0.7)
        knots += [(begins, speed, turning), (begins + 1.5, speed, turning)]
    return sim.Manoeuvre("to_and_fro", (*knots, (knots[-1][0] + 0.5, 0.0, 0.0)))


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two drives of each robot, and the files that say what their makers believe."""
    folder = tmp_path_factory.mktemp("drives")
    right = replace(WIDE, wheel_separation=0.16)
    robots: dict[str, tuple[sim.TrueRobot, tuple[sim.Peculiarity, ...]]] = {
        "wide": (WIDE, ()),
        "tyre": (right, (OneTyreBackwards("left", TYRE),)),
    }
    for name, (robot, hidden) in robots.items():
        sim.write_robot_file(robot, folder / f"{name}.yaml")
        for seed in (3, 4):
            recorded(to_and_fro(seed), seed, folder / f"{name}_{seed}", SLOW, MOUNT, robot, hidden)
    return folder


@pytest.fixture(scope="module")
def read_once() -> Iterator[None]:
    """Each verb gets what the first one read: matching is most of the work."""

    @cache
    def read(path: Path) -> Run:
        robot = read_robot_file(path.with_name(f"{path.name[:4]}.yaml"))
        return read_run(path, robot, reference_topic=SCAN)

    def again(path: Path, source: RobotFile, **asked: Any) -> Run:
        assert asked["reference_topic"] == SCAN
        return read(path)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recordings, "read_run", again)
        yield


def proposed(said: str, verb: str) -> list[str]:
    """The command that was printed, in words."""
    (command,) = re.findall(rf"^    werrimbi ({verb} (?:.*\\\n)*.*)$", said, re.MULTILINE)
    return shlex.split(command.replace("\\\n", " "))


def test_from_a_bag_to_a_robot_file_that_is_right(
    drives: Path, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    robot, bags = drives / "wide.yaml", [drives / "wide_3", drives / "wide_4"]
    asked = ["--robot", robot, "--reference-topic", "/scan"]
    said = werrimbi("info", *asked, *bags)
    assert "Reference /scan: poses at 5 Hz (walls and furniture" in said.words
    assert "by /tf_static the lidar sits 32 mm behind" in said.words
    said = werrimbi(*proposed(said.out, "compare"))
    assert re.search(r"the robot turns [45]\.\d+ ± [\d.]+ % less than the model says", said.words)
    told = tmp_path / "diagnosis.json"
    said = werrimbi(*proposed(said.out, "diagnose"), "--json", told)
    assert json.loads(told.read_text())["effect"] == "track_width"
    add = proposed(said.out, "add")
    better = tmp_path / "better.yaml"
    said = werrimbi(*add[:-1], better)
    found = read_robot_file(better).robot
    assert found.wheel_separation_multiplier == pytest.approx(1.05, abs=0.002)
    assert "is seen in the errors" in said.words

    fitted = tmp_path / "fitted.yaml"
    werrimbi("calibrate", "fit", *asked, *bags, "--out", fitted)
    assert read_robot_file(fitted).robot.wheel_separation_multiplier == pytest.approx(
        found.wheel_separation_multiplier, abs=0.001
    )
    months = tmp_path / "months.json"
    werrimbi("history", *asked, *bags, "--leg", "0.25", "--jobs", "1", "--json", months)
    for drive in json.loads(months.read_text())["drives"]:
        base = drive["numbers"]["wheel_separation_multiplier"]
        assert base["value"] == pytest.approx(1.05, abs=max(3.0 * base["std"], 1e-3))
        assert base["std"] < 2e-3


@pytest.mark.evidence
def test_a_law_that_the_library_lacks_is_drafted_and_added(
    drives: Path, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    package, told = tmp_path / "package", tmp_path / "draft.json"
    words = ["draft", "--robot", drives / "tyre.yaml", "--reference-topic", "/scan", "--leg", 0.25]
    words += [drives / "tyre_3", drives / "tyre_4", "--out", package, "--json", told]
    said = werrimbi(*words)
    found = json.loads(told.read_text())
    assert found["draft"]["variable"] == "direction"
    assert 2.0 * found["parameters"]["slope"]["value"] == pytest.approx(TYRE, rel=0.1)
    assert found["holdout"]["after"] < 0.8 * found["holdout"]["before"]
    add = proposed(said.out, "add")
    werrimbi(*add[:-1], tmp_path / "new.yaml")
    assert "left_by_direction" in (tmp_path / "new.yaml").read_text()


def test_the_workbench_opens_such_drives(drives: Path) -> None:
    source = read_robot_file(drives / "wide.yaml")
    options = DriveOptions(reference_topic=SCAN)
    runs = [
        recordings.read_run(drives / f"wide_{seed}", source, reference_topic=SCAN)
        for seed in (3, 4)
    ]
    given = Recordings(source, all_effects([]), (runs[0],), (runs[1],), options)

    async def look() -> Shared:
        job = Job(Open())
        job.start()
        return await Opening(job, given, Target(Path("new.yaml"))).result()

    shared: Shared = awaited(look())
    assert len(shared.look.train.legs.errors.error) > 3
    assert not shared.look.verdict.good
    seen = shared.look.train.runs[0].run.reference
    assert seen is not None
    assert seen.own_axes
