# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: its rows, its figures, its words, its files, and what it refuses."""

from __future__ import annotations

import math
import os
import pty
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.odometry import ROBOT, TICK, command, figures, odom, reference, table, ticks
from test.command_line import ROOT, WERRIMBI, Complaint, Printed, Werrimbi
from werrimbi_odom.cli.main import main
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.model.odometer import Odometer

RECORDINGS = ROOT / "werrimbi_odom" / "recordings"


def test_a_row_for_each_row(place: Path, werrimbi: Werrimbi) -> None:
    said = werrimbi(*command(place))
    rows = table(place / "odom.csv")
    assert rows.shape == (11, 10)
    np.testing.assert_array_equal(rows[:, 0], [0.1 * n for n in range(11)])
    np.testing.assert_allclose(rows[:, 1], 10 * TICK * np.arange(11), rtol=1e-14)
    assert not rows[:, 2:4].any()
    assert rows[-1, 4] == pytest.approx((4.0e-4**2 + 5.8e-4**2) / 4.0 * 100 * TICK)
    assert said.err == ""
    assert f"written: {place / 'odom.csv'}\n" in said.out
    assert "0.063 m in 1.0 s" in said.words
    assert "1 line, 0 arcs, 0 spins" in said.words
    assert "the origin; there is no reference" in said.words


def test_rows_that_were_refused_repeat_the_latest_estimate(place: Path) -> None:
    ticks(
        place,
        [
            (0.0, "nan", 0),
            (0.1, 0, 0),
            (0.2, 10, 10),
            (0.2, 20, 20),
            (0.15, 12, 12),
            (0.3, "inf", 20),
            (0.4, 40, 40),
        ],
    )
    found = figures(place)
    rows = table(place / "odom.csv")
    assert rows[:, 0].tolist() == [0.0, 0.1, 0.2, 0.2, 0.15, 0.3, 0.4], "each at its own time"
    np.testing.assert_allclose(rows[:, 1] / TICK, [0, 0, 10, 10, 10, 10, 40], atol=1e-9)
    tally = found["rows"]
    assert (tally["messages"], tally["accepted"]) == (7, 3)
    assert (tally["not_finite"], tally["duplicates"], tally["out_of_order"]) == (2, 1, 1)


def test_numbers_read_back_as_they_were(place: Path) -> None:
    """Every digit: the streaming odometer gives the same floats to 1e-12."""
    rng = np.random.default_rng(3)
    steps = rng.integers(-30, 60, (300, 2))
    counts = np.cumsum(steps, axis=0)
    ticks(place, [(0.01 * n, left, right) for n, (left, right) in enumerate(counts.tolist())])
    assert odom(place) == 0
    rows = table(place / "odom.csv")
    odometer = Odometer(read_robot_file(place / "robot.yaml").robot)
    for n, (left, right) in enumerate(counts.tolist()):
        estimate = odometer.update(0.01 * n, left, right)
        if estimate is not None:
            np.testing.assert_allclose(rows[n, 1:3], estimate.pose[:2], atol=1e-12)
            np.testing.assert_allclose(rows[n, 4:], estimate.covariance, rtol=1e-6, atol=1e-15)


def test_yaw_stays_within_half_a_turn(place: Path) -> None:
    """Half a turn on the spot is 1000 ticks apart: exactly pi is +pi, never -pi."""
    ticks(place, [(0.1 * n, -100 * n, 100 * n) for n in range(101)])
    assert odom(place) == 0
    yaw = table(place / "odom.csv")[:, 3]
    assert yaw.max() <= math.pi
    assert yaw.min() > -math.pi
    turned = np.abs(np.exp(1j * yaw) - np.exp(1j * 200 * TICK / 0.4 * np.arange(101)))
    assert turned.max() < 1e-9
    reference(place, f"0,0,0,{-math.pi!r}")
    ticks(place, [(0, 0, 0), (1, 0, 0)])
    assert odom(place) == 0
    assert table(place / "odom.csv")[:, 3].tolist() == [math.pi, math.pi]


def test_the_end_against_the_reference(place: Path, printed: Printed) -> None:
    end = 100 * TICK
    reference(
        place, "0,1,2,0.5", f"1,{1 + math.cos(0.5) * end + 0.03},{2 + math.sin(0.5) * end},0.6"
    )
    found = figures(place)
    assert found["start"]["yaw_rad"] == 0.5
    assert found["end_error_m"] == pytest.approx(0.03)
    assert found["end_error_rad"] == pytest.approx(0.1)
    covariance = found["final"]["covariance"]
    assert found["end_error_heading_sigmas"] == pytest.approx(0.1 / math.sqrt(covariance["yawyaw"]))
    block = np.array([[covariance["xx"], covariance["xy"]], [covariance["xy"], covariance["yy"]]])
    error = np.array([0.03, 0.0])
    sigmas = math.sqrt(error @ np.linalg.solve(block, error))
    assert found["end_error_position_sigmas"] == pytest.approx(sigmas)
    assert f"0.0300 m ({sigmas:.1f} σ)" in printed()


def test_a_reference_that_begins_late_judges_the_way_since_then(place: Path) -> None:
    """In sigmas too: what happened before it began is no part of the error at the end."""
    way = [(0.1 * n, 80 * n, 120 * n) for n in range(11)]
    poses = ("0.5,1,2,0.5", "1,1.2,2.2,0.9")
    reference(place, *poses)
    ticks(place, way)
    late = figures(place)
    ticks(place, way[5:])
    of_the_rest = figures(place)
    for name in ("end_error_m", "end_error_position_sigmas", "end_error_heading_sigmas"):
        assert late[name] == pytest.approx(of_the_rest[name], rel=1e-6), name


def test_sigmas_along_and_across_go_with_the_heading(place: Path) -> None:
    """The same drive, begun in another direction, has the same spread as the robot sees it."""
    straight = figures(place)["final"]
    reference(place, "0,0,0,1.0")
    turned = figures(place)["final"]
    for name in ("sigma_along_m", "sigma_across_m", "sigma_yaw_rad"):
        assert turned[name] == pytest.approx(straight[name])
    assert turned["covariance"]["xx"] != pytest.approx(straight["covariance"]["xx"])


def test_only_positions_were_measured(place: Path, printed: Printed) -> None:
    reference(place, "0,1,2,", f"1,1,{2 + 100 * TICK + 0.01},")
    found = figures(place)
    assert found["start"]["yaw_rad"] == pytest.approx(math.pi / 2)
    assert found["end_error_m"] == pytest.approx(0.01)
    assert found["end_error_rad"] is None
    assert found["reference_last"]["yaw_rad"] is None
    assert "least squares" in printed()


def test_a_reference_that_begins_in_mid_drive(place: Path) -> None:
    reference(place, f"0.5,{50 * TICK!r},0,0", f"1,{100 * TICK!r},0,0")
    found = figures(place)
    assert table(place / "odom.csv")[0, 1] == 50 * TICK, "the contract's start"
    assert found["end_error_m"] == pytest.approx(0.0, abs=1e-12), "and a fair comparison"
    assert any("begins 0.50 s after the ticks" in note for note in found["notes"])


@pytest.mark.parametrize("times", [(100, 200), (-200, -100)])
def test_clocks_that_have_nothing_in_common(place: Path, times: tuple[int, int]) -> None:
    reference(place, *(f"{t},1,2,3" for t in times))
    found = figures(place)
    assert found["start"]["x_m"] == 1.0
    assert found["end_error_m"] is None
    assert any("are both clocks the same" in note for note in found["notes"])


def test_one_pose_tells_where_the_way_begins_and_no_error(place: Path) -> None:
    reference(place, "0,1,2,3")
    found = figures(place)
    assert found["start"]["x_m"] == 1.0
    assert found["end_error_m"] is None
    assert any("measured one pose" in note for note in found["notes"])
    assert not any("clock" in note for note in found["notes"])


def test_what_happened_to_the_counters_is_told(place: Path, printed: Printed) -> None:
    (place / "robot.yaml").write_text(ROBOT + "    encoder_bits: 8\n")
    ticks(place, [(0, 100, 100), (0.1, 120, 120), (0.2, -116, -116), (5.0, -100, -100)])
    found = figures(place)
    assert found["rows"]["wraps"] == 2
    assert found["rows"]["gaps"] == 1
    assert found["final"]["x_m"] == pytest.approx(56 * TICK)
    assert "4, 4 used, 1 gaps, 2 wraps" in printed()


def test_a_clock_that_was_set_back(place: Path) -> None:
    ticks(place, [(100, 0, 0), (101, 10, 10), (5, 20, 20), (6, 30, 30)])
    reference(place, "100,0,0,0", f"6,{30 * TICK!r},0,0")
    found = figures(place)
    assert found["duration_s"] == 2.0
    assert found["rows"]["clock_jumps"] == 1
    assert found["end_error_m"] is None
    assert found["final"]["x_m"] == pytest.approx(30 * TICK)


@pytest.mark.parametrize("pose", ["0,1,2,3", "0,1,2,", None])
def test_a_run_of_one_row(place: Path, pose: str | None) -> None:
    ticks(place, [(0, 5, 5)])
    if pose:
        reference(place, pose)
    found = figures(place)
    assert found["distance_m"] == 0.0
    assert found["end_error_m"] is None
    assert table(place / "odom.csv").tolist() == [
        [0.0, *((1.0, 2.0) if pose else (0.0, 0.0)), 3.0 if pose == "0,1,2,3" else 0.0, *[0.0] * 6]
    ]


def test_on_a_terminal_a_bar_is_shown_and_taken_away(place: Path) -> None:
    pytest.importorskip("rich", reason="without rich there is no bar")
    screen, terminal = pty.openpty()
    done = subprocess.run(
        [*WERRIMBI, *command(place)],
        stdout=subprocess.PIPE,
        stderr=terminal,
        env={**os.environ, "PYTHONPATH": str(ROOT), "TERM": "xterm"},
        timeout=60,
    )
    os.close(terminal)
    shown = os.read(screen, 65536).decode()
    os.close(screen)
    assert done.returncode == 0
    assert "writing" in shown
    assert shown.rstrip().endswith("\x1b[2K"), "the line is erased at the end"
    assert b"distance" in done.stdout


def test_it_prints_the_words_of_the_python_api(place: Path, werrimbi: Werrimbi) -> None:
    printed = werrimbi(*command(place)).out
    told = wo.odom(wo.read_robot(place / "robot.yaml"), place / "run").summary()
    assert printed.startswith(f"{told}\nwritten: ")
    assert "  distance       0.063 m in 1.0 s\n" in told


@pytest.mark.skipif(not (RECORDINGS / "square_bag").exists(), reason="no recordings/square_bag")
def test_the_shipped_drive_as_folder_and_as_bag(tmp_path: Path, printed: Printed) -> None:
    pytest.importorskip("rosbags.rosbag2", reason="rosbags is not installed")
    robot = RECORDINGS / "square" / "robot.yaml"
    tables = []
    for name in ("square", "square_bag"):
        out = tmp_path / f"{name}.csv"
        assert main(["odom", "--robot", str(robot), str(RECORDINGS / name), "--out", str(out)]) == 0
        tables.append(table(out))
    assert tables[0].shape == tables[1].shape
    # the folder's reference, and so its start, is rounded to micrometres
    np.testing.assert_allclose(tables[1][:, 1:3], tables[0][:, 1:3], atol=1e-5)
    np.testing.assert_allclose(tables[1][:, 4:], tables[0][:, 4:], rtol=1e-3, atol=1e-9)
    assert "ticks from /joint_states" in printed()


@pytest.mark.evidence
def test_a_million_rows(place: Path) -> None:
    count = 1_000_000
    ticks(place, [(0.001 * n, 3 * n, 3 * n + n // 7) for n in range(count)])
    assert odom(place) == 0
    with (place / "odom.csv").open() as file:
        assert sum(1 for _ in file) == count + 1


def test_an_existing_file_is_replaced_and_parts_are_gone(place: Path) -> None:
    (place / "odom.csv").write_text("old")
    assert odom(place) == 0
    assert len(table(place / "odom.csv")) == 11
    names = ["odom.csv", "robot.yaml", "run"]
    assert sorted(path.name for path in place.iterdir()) == names


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda p: ticks(p, [(0, 0, 0), (1, "x", 2)]), "run/ticks.csv, line 3, column left_ticks"),
        (lambda p: ticks(p, [(0, "nan", 0)]), "run: no row has a finite time and finite counts"),
        (lambda p: ticks(p, [(0, 0, 0), (1, "1e308", 2)]), "run: the pose grows beyond all numb"),
        (lambda p: (p / "run" / "ticks.csv").unlink(), "run holds neither ticks.csv nor a bag"),
        (lambda p: reference(p, "0,a,0,0"), "run/reference.csv, line 2, column x_m: 'a' is not"),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT.replace("0.1", "-0.1")),
            "robot.yaml, line 4: wheel_radius must be a number greater than 0 (m), not -0.1",
        ),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT.replace("wheel_radius", "wheel_radus")),
            "robot.yaml, line 4: unknown parameter wheel_radus; the nearest known one is wheel_ra",
        ),
        (
            lambda p: (p / "robot.yaml").write_text(ROBOT[: ROBOT.index("    left_ticks")]),
            "run/ticks.csv holds counts, and {place}/robot.yaml does not say how many there are in",
        ),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    place: Path, complaint: Complaint, spoil: Any, said: str
) -> None:
    spoil(place)
    before = sorted(path.name for path in place.iterdir())
    told = complaint(*command(place, "--json", place / "figures.json"))
    assert told.startswith(f"werrimbi odom: {place}/{said.format(place=place)}")
    assert sorted(path.name for path in place.iterdir()) == before


def test_both_files_or_neither(place: Path, complaint: Complaint) -> None:
    (place / "odom.csv").write_text("old")
    complaint(*command(place, "--json", place / "nowhere" / "figures.json"))
    assert (place / "odom.csv").read_text() == "old"
    told = complaint(*command(place, "--json", place / "odom.csv"))
    assert "odom.csv would overwrite --out" in told


def test_a_device_is_written_to_and_stays_one(place: Path) -> None:
    assert odom(place, "--out", "/dev/null") == 0
    assert not Path("/dev/null").is_file()
