# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Run folders made from published recordings hold what those say, and are those that are judged."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from test.recorded_robots import RECORDINGS, ROBOTS, converters, robots, with_recordings
from test.recorded_robots.make_runs import main, make, reader
from test.recorded_robots.runs import Read, write
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run_folder import read_run_folder

CLONES = Path(os.environ.get("WERRIMBI_CLONES", RECORDINGS / "clones"))
HERE = [robot for robot in robots.ROBOTS if (CLONES / robot.source.name.split("/")[1]).is_dir()]


def of(**files: str) -> Read:
    """A repository of few files, named by the end of their path."""
    return lambda path: next(
        text.encode() for name, text in files.items() if path.endswith(name.replace("__", "."))
    )


def test_counts_of_right_and_left_become_counters_of_left_and_right(tmp_path: Path) -> None:
    read = of(csv="0,0,0,3.1,0,0\n0.05,0.1,0.2,-3.1,5,-3\n0.1,0.2,0.4,-3.0,5,7\n")
    (drive,) = converters.optitrack(read, ("square_1_01",))
    write(drive, tmp_path)
    assert (tmp_path / "ticks.csv").read_text().split() == [
        *("t_s,left_ticks,right_ticks", "0.000,0,0", "0.050,-3,5", "0.100,4,10")
    ]
    run = read_run_folder(tmp_path)
    assert run.reference is not None
    assert run.reference.yaw[-1] == pytest.approx(2 * np.pi - 3.0, abs=1e-5)  # not back by a turn


def test_steps_of_a_scan_matcher_are_put_end_to_end() -> None:
    line = '{"T": 2.0, "phi_l": 0.0, "phi_r": 3.14159265, "sm": [1.0, 0.0, 1.57079633]}\n'
    drive = next(iter(converters.khepera(of(tuple=4 * line), "l90")))
    np.testing.assert_allclose(drive.pose[:3, :2], [[0, 0], [1, 0], [1, 1]], atol=1e-7)
    np.testing.assert_allclose(drive.pose[4], [0, 0, 2 * np.pi], atol=1e-7)
    assert drive.counts[1].tolist() == [0, converters.COUNTS_A_TURN]  # half a turn a second, 2 s


def test_speeds_are_held_over_the_interval_that_they_end() -> None:
    turn = 2 * np.pi * 0.016
    given = f"range2 0 1\nodom2diff 0 9 9\nodom2diff 1 {turn} 0\nodom2diff 3 0 {turn}\n"
    (drive,) = converters.labyrinth(of(Input__txt=given, GT__txt="point2 0 1.5 2.5\n"))
    assert drive.counts.tolist() == [[0, 0], [0, 1_000_000], [2_000_000, 1_000_000]]
    assert drive.pose[0, :2].tolist() == [1.5, 2.5]
    assert np.isnan(drive.pose[0, 2])


def test_a_camera_s_millimetres_are_metres() -> None:
    motors = "M 204 20795 20795 3000 0 16067 16066 3000 0 0 0 6000 0\n"
    (drive,) = converters.lego(of(motors__txt=2 * motors, reference__txt="P 378 1850 1897\n"))
    assert drive.t[0] == pytest.approx(0.204)
    assert drive.counts.tolist() == [[20795, 16067]] * 2
    assert drive.pose[0, :2].tolist() == [1.85, 1.897]
    assert np.isnan(drive.pose[0, 2])


def test_robot_files_are_read_as_any_other_and_say_where_the_robot_is_from(tmp_path: Path) -> None:
    for robot in robots.ROBOTS:
        path = tmp_path / f"{robot.folder}.yaml"
        path.write_text(robot.robot_file(), encoding="utf-8")
        file = read_robot_file(path)
        assert file.robot.wheel_separation == robot.separation
        assert robot.source.commit[:12] in path.read_text()
        assert robot.source.licence in path.read_text()


def test_a_repository_that_cannot_be_had_is_said(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for robot in robots.ROBOTS:
        (tmp_path / "clones" / robot.source.name.split("/")[1]).mkdir(parents=True, exist_ok=True)
    (tmp_path / "clones" / robots.TURTLEBOT3.name.split("/")[1]).mkdir()
    assert main(["--out", str(tmp_path)]) == 1
    said = capsys.readouterr().err.splitlines()
    assert [line.split(":")[0] for line in said if "not made" in line] == [
        *(robot.folder for robot in robots.ROBOTS),
        "bags/turtlebot3",
    ]
    clones = [line.split()[-2:] for line in said if line.strip().startswith("git clone ")]
    assert [url for url, _ in clones] == [
        *dict.fromkeys(r.source.url for r in robots.ROBOTS),
        robots.TURTLEBOT3.url,
    ]
    assert all(Path(place).parent == tmp_path / "clones" for _, place in clones)


@pytest.mark.evidence
@with_recordings
@pytest.mark.skipif(not HERE, reason="no clones: `make recordings` gets them (or WERRIMBI_CLONES)")
@pytest.mark.parametrize("robot", HERE, ids=lambda robot: robot.folder)
def test_the_runs_that_are_judged_are_made_by_this_script(
    robot: robots.Robot, tmp_path: Path
) -> None:
    """Counters and times to the last digit; a heading that was integrated to one unit of it."""
    count = make(robot, reader(robot.source, CLONES), tmp_path)
    kept = ROBOTS / robot.folder
    assert count == len(list(kept.glob("*/ticks.csv")))
    assert (
        read_robot_file(tmp_path / "robot.yaml").robot == read_robot_file(kept / "robot.yaml").robot
    )
    for path in sorted(kept.glob("*/*.csv")):
        made = (tmp_path / path.relative_to(kept)).read_text().splitlines()
        if path.name == "ticks.csv":
            assert made == path.read_text().splitlines(), path
            continue
        for line, other in zip(made, path.read_text().splitlines(), strict=True):
            *before, yaw = line.split(",")
            *same, there = other.split(",")
            assert before == same, path
            if yaw != there:
                assert float(yaw) == pytest.approx(float(there), abs=1.5e-6), path
