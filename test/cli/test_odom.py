# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""`werrimbi odom`: its rows, its figures, and what it says of runs that are not right."""

from __future__ import annotations

import csv
import json
import math
import os
import pty
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.command_line import ROOT, WERRIMBI, Printed
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects import find
from werrimbi_odom.files.robot_file import read_robot_file
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.odometer import Odometer
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.model.reference_measurement import shown
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

RECORDINGS = ROOT / "werrimbi_odom" / "recordings"
COLUMNS = "t_s,x_m,y_m,yaw_rad,xx,xy,xyaw,yy,yyaw,yawyaw"
ROBOT = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.4
    wheel_radius: 0.1
    left_ticks_per_revolution: 1000.0
    right_ticks_per_revolution: 1000.0
"""
TICK = 2.0 * math.pi * 0.1 / 1000.0


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A robot that drives straight on for 100 ticks."""
    (tmp_path / "robot.yaml").write_text(ROBOT)
    ticks(tmp_path, [(0.1 * n, 10 * n, 10 * n) for n in range(11)])
    return tmp_path


def ticks(place: Path, rows: list[tuple[Any, Any, Any]]) -> None:
    (place / "run").mkdir(exist_ok=True)
    text = "".join(",".join(map(str, row)) + "\n" for row in rows)
    (place / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + text)


def reference(place: Path, *rows: str) -> None:
    text = "".join(f"{row}\n" for row in rows)
    (place / "run" / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n" + text)


def odom(place: Path, *more: str | Path) -> int:
    words = ["odom", "--robot", place / "robot.yaml", place / "run", "--out", place / "odom.csv"]
    return main([str(word) for word in (*words, *more)])


def table(path: Path) -> np.ndarray:
    with path.open() as file:
        assert file.readline() == COLUMNS + "\n"
        return np.array([[float(cell) for cell in row] for row in csv.reader(file)])


def unwrapped(said: str) -> str:
    """What a table says, as if the terminal were wide."""
    return " ".join(said.replace("│", " ").split())


def figures(place: Path) -> dict[str, Any]:
    assert odom(place, "--json", place / "figures.json") == 0
    found: dict[str, Any] = json.loads((place / "figures.json").read_text())
    return found


def test_a_row_for_each_row(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert odom(place) == 0
    rows = table(place / "odom.csv")
    assert rows.shape == (11, 10)
    np.testing.assert_array_equal(rows[:, 0], [0.1 * n for n in range(11)])
    np.testing.assert_allclose(rows[:, 1], 10 * TICK * np.arange(11), rtol=1e-14)
    assert not rows[:, 2:4].any()
    assert rows[-1, 4] == pytest.approx((4.0e-4**2 + 5.8e-4**2) / 4.0 * 100 * TICK)
    out, err = capsys.readouterr()
    assert err == ""
    assert f"written: {place / 'odom.csv'}\n" in out
    told = unwrapped(out)
    assert "0.063 m in 1.0 s" in told
    assert "1 line, 0 arcs, 0 spins" in told
    assert "the origin; there is no reference" in told


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


def test_the_end_against_the_reference(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
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
    assert f"0.0300 m ({sigmas:.1f} σ)" in capsys.readouterr().out


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
            "robot.yaml: odom_node must also give left_ticks_per_revolution (ticks), right_ticks_",
        ),
    ],
)
def test_bad_input_is_one_line_and_writes_nothing(
    place: Path, capsys: pytest.CaptureFixture[str], spoil: Any, said: str
) -> None:
    spoil(place)
    before = sorted(path.name for path in place.iterdir())
    assert odom(place, "--json", place / "figures.json") == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith(f"werrimbi odom: {place}/{said}")
    assert err.count("\n") == 1
    assert sorted(path.name for path in place.iterdir()) == before


@pytest.mark.parametrize(
    ("out", "said"),
    [
        ("run/ticks.csv", "--out {0}/run/ticks.csv would overwrite {0}/run, which is read"),
        ("robot.yaml", "--out {0}/robot.yaml would overwrite {0}/robot.yaml, which is read"),
        ("run", "--out {}/run is a folder; give a file name in it"),
        ("nowhere/odom.csv", "--out {0}/nowhere/odom.csv: there is no folder {0}/nowhere"),
    ],
)
def test_places_that_are_not_for_writing(
    place: Path, capsys: pytest.CaptureFixture[str], out: str, said: str
) -> None:
    kept = {path: path.read_bytes() for path in place.rglob("*") if path.is_file()}
    assert odom(place, "--out", place / out) == 2
    assert capsys.readouterr().err == f"werrimbi odom: {said.format(place)}\n"
    assert {path: path.read_bytes() for path in place.rglob("*") if path.is_file()} == kept


def test_both_files_or_neither(place: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (place / "odom.csv").write_text("old")
    assert odom(place, "--json", place / "nowhere" / "figures.json") == 2
    assert (place / "odom.csv").read_text() == "old"
    assert odom(place, "--json", place / "odom.csv") == 2
    assert "odom.csv would overwrite --out" in capsys.readouterr().err


def test_on_a_terminal_a_bar_is_shown_and_taken_away(place: Path) -> None:
    pytest.importorskip("rich", reason="without rich there is no bar")
    words = ["odom", "--robot", place / "robot.yaml", place / "run", "--out", place / "odom.csv"]
    screen, terminal = pty.openpty()
    done = subprocess.run(
        [*WERRIMBI, *map(str, words)],
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


def test_a_device_is_written_to_and_stays_one(place: Path) -> None:
    assert odom(place, "--out", "/dev/null") == 0
    assert not Path("/dev/null").is_file()


def test_it_prints_the_words_of_the_python_api(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert odom(place) == 0
    told = wo.odom(wo.read_robot(place / "robot.yaml"), place / "run").summary()
    assert capsys.readouterr().out.startswith(f"{told}\nwritten: ")
    assert "  distance       0.063 m in 1.0 s\n" in told


@pytest.mark.skipif(not (RECORDINGS / "square_bag").exists(), reason="no recordings/square_bag")
def test_the_shipped_drive_as_folder_and_as_bag(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
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
    assert "ticks from /joint_states" in capsys.readouterr().out


@pytest.mark.evidence
def test_a_million_rows(place: Path) -> None:
    count = 1_000_000
    ticks(place, [(0.001 * n, 3 * n, 3 * n + n // 7) for n in range(count)])
    assert odom(place) == 0
    with (place / "odom.csv").open() as file:
        assert sum(1 for _ in file) == count + 1


# ------------------------------------------------------------------------ effects


def robot_with(place: Path, effects: str, *lines: str) -> None:
    text = ROBOT + f"    effects: [{effects}]\n" + "".join(f"    {line}\n" for line in lines)
    (place / "robot.yaml").write_text(text)


def turning(place: Path) -> np.ndarray:
    """A drive that curves, spins and goes back; returns time, left and right counts."""
    time = 0.05 * np.arange(600)
    speed, yaw_rate = 0.4 * np.cos(0.3 * time), 0.9 * np.sin(0.21 * time)
    left = np.rint(np.cumsum((speed - 0.2 * yaw_rate) * 0.05) / TICK).astype(int)
    right = np.rint(np.cumsum((speed + 0.2 * yaw_rate) * 0.05) / TICK).astype(int)
    rows = list(zip(np.round(time, 6).tolist(), left.tolist(), right.tolist(), strict=True))
    ticks(place, rows)
    return np.array(rows)


def measured(place: Path, effects: tuple[Any, ...], start: Pose = Pose(2.0, -1.0, 0.8)) -> None:  # noqa: B008
    """Let a reference look at the robot, at each row; a view of the model itself, so exact."""
    time, left, right = turning(place).T
    robot = Robot(0.4, 0.1, 1000.0, 1000.0, effects=effects)
    seen = shown(trajectory(robot, time, left, right, start=start), view_of(effects))
    rows = zip(time, seen.x, seen.y, seen.yaw, strict=True)
    reference(place, *(",".join(repr(float(cell)) for cell in row) for row in rows))


VIEWS = {
    "an arm": (("reference_lever_arm", {"x": 0.2, "y": -0.1}),),
    "an axis askew": (("reference_yaw_offset", {"angle": 1.2}),),
    "late": (("reference_delay", {"delay": 0.17}),),
    "early": (("reference_delay", {"delay": -0.17}),),
    "a late heading": (("reference_heading_delay", {"delay": 0.1}),),
    "mirrored": (("reference_mirrored", {}),),
    "all at once": (
        ("reference_mirrored", {}),
        ("reference_delay", {"delay": -0.1}),
        ("reference_yaw_offset", {"angle": -0.4}),
        ("reference_lever_arm", {"x": -0.3, "y": 0.05}),
        ("lateral_slip", {"creep": 0.05}),
        ("floor_slope", {"x": 0.01}),
    ),
}


@pytest.mark.parametrize("view", VIEWS)
def test_as_reference_shows_what_the_reference_shows(place: Path, view: str) -> None:
    """From the first row to the last, with nothing but the first pose taken from it."""
    effects = tuple(find(name).using(**values) for name, values in VIEWS[view])
    measured(place, effects)
    blocks = [f"{name}: {json.dumps(values)}" for name, values in VIEWS[view] if values]
    robot_with(place, ", ".join(name for name, _ in VIEWS[view]), *blocks)
    assert odom(place, "--as-reference") == 0
    rows = table(place / "odom.csv")
    seen = np.genfromtxt(place / "run" / "reference.csv", delimiter=",", skip_header=1)
    assert rows.shape[0] == seen.shape[0], "a row for each row of ticks"
    np.testing.assert_allclose(rows[:, 1:3], seen[:, 1:3], atol=1e-9)
    np.testing.assert_allclose(np.exp(1j * rows[:, 3]), np.exp(1j * seen[:, 3]), atol=1e-9)
    found = figures(place)
    assert found["end_error_m"] < 1e-9, "what is compared is what the reference shows"
    assert abs(found["end_error_rad"]) < 1e-9


def test_without_as_reference_it_is_the_axle_that_starts_where_the_arm_says(place: Path) -> None:
    arm = find("reference_lever_arm").using(x=0.2, y=-0.1)
    measured(place, (arm,), Pose(2.0, -1.0, 0.8))
    robot_with(place, "reference_lever_arm", "reference_lever_arm: {x: 0.2, y: -0.1}")
    found = figures(place)
    rows = table(place / "odom.csv")
    np.testing.assert_allclose(rows[0, 1:4], (2.0, -1.0, 0.8), atol=1e-12)
    assert "measures 200 mm ahead and -100 mm to the left" in found["start"]["says"]


def test_an_eccentric_wheel_is_learnt_from_the_run_s_reference(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    wheel = find("eccentric_left_wheel")
    measured(place, (wheel.using(amplitude=0.002, phase=2.0),))
    robot_with(place, "eccentric_left_wheel", "eccentric_left_wheel: {amplitude: 0.002}")
    learnt = figures(place)
    assert learnt["end_error_m"] < 1e-5
    told = unwrapped(capsys.readouterr().out)
    assert "phase 2.000 ± 0.000 rad, learnt from the reference of this run" in told
    odom(place)
    with_it = table(place / "odom.csv")
    (place / "run" / "reference.csv").unlink()
    told = figures(place)["notes"]
    assert any(
        "eccentric_left_wheel is left out: its phase is another in each run" in n for n in told
    )
    (place / "robot.yaml").write_text(ROBOT)
    without = table(place / "odom.csv")
    assert odom(place) == 0
    np.testing.assert_array_equal(table(place / "odom.csv"), without)
    assert np.abs(np.diff(with_it[:, 3]) - np.diff(without[:, 3])).max() > 1e-4


OWN = """\
from werrimbi_odom.model.effect import Parameter, wheel_effect
from werrimbi_odom.model.motion import WheelTravel


@wheel_effect(
    channels=("payload_kg",),
    loss=Parameter("1/kg", 0.0, 2e-3, (0.0, 0.05), "loss of radius per kilogram"),
)
def my_robot_sinks_in(travel, drive, loss):
    \"\"\"Tyres give way under a load.

    Formula    travel *= 1 - loss * payload
    Signature  distances too long by a share that follows the payload
    Ruler      measure the axle's height, empty and loaded
    \"\"\"
    share = 1.0 - loss * drive.channels["payload_kg"].mean
    return WheelTravel(travel.left * share, travel.right * share)
"""


def test_a_file_of_one_s_own_with_a_channel_of_the_record(
    place: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (place / "mine.py").write_text(OWN)
    robot_with(place, "my_robot_sinks_in", "my_robot_sinks_in: {loss: 0.01}")
    assert odom(place) == 2
    assert "unknown effect my_robot_sinks_in" in capsys.readouterr().err
    assert odom(place, "--effects", place / "mine.py") == 2
    assert "my_robot_sinks_in needs the measured channel payload_kg" in capsys.readouterr().err
    rows = "".join(f"{0.1 * n!r},{10 * n},{10 * n},10.0\n" for n in range(11))
    (place / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks,payload_kg\n" + rows)
    assert odom(place, "--effects", place / "mine.py") == 0
    np.testing.assert_allclose(table(place / "odom.csv")[-1, 1], 0.9 * 100 * TICK, rtol=1e-12)
    assert odom(place, "--effects", place / "none.py") == 2
    assert "none.py: there is no such file" in capsys.readouterr().err
