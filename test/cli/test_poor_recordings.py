# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings with what happens to recordings: said with what is there, and where."""

from __future__ import annotations

import random
import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.command_line import Werrimbi
from werrimbi_odom.cli.main import main
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.run_folder import read_run_folder
from werrimbi_odom.model.trajectory import trajectory

RECORDINGS = Path(__file__).parents[2] / "werrimbi_odom" / "recordings"
SQUARE = RECORDINGS / "square"
TICKS = (SQUARE / "ticks.csv").read_text()
REFERENCE = (SQUARE / "reference.csv").read_text()


@pytest.fixture
def run(tmp_path: Path) -> Path:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "ticks.csv").write_text(TICKS)
    (folder / "reference.csv").write_text(REFERENCE)
    return folder


@pytest.fixture
def said(werrimbi: Werrimbi) -> Callable[..., str]:
    """The line that `werrimbi compare` says of a run, with its exit code."""

    def compared(code: int, *words: str | Path) -> str:
        err = werrimbi("compare", "--robot", SQUARE / "robot.yaml", *words, code=code).err
        assert err.count("\n") == 1, err
        return err

    return compared


def later(text: str, seconds: float) -> str:
    header, *rows = text.splitlines()
    parts = (row.split(",", 1) for row in rows)
    return "\n".join([header, *(f"{float(t) + seconds!r},{rest}" for t, rest in parts)]) + "\n"


@pytest.mark.parametrize("seconds", [1.7e9, -1e4])
def test_clocks_apart_show_both_spans(run: Path, said: Callable[..., str], seconds: float) -> None:
    (run / "reference.csv").write_text(later(REFERENCE, seconds))
    err = said(2, run)
    for text in (TICKS, (run / "reference.csv").read_text()):
        rows = text.splitlines()[1:]
        first, last = (float(row.split(",")[0]) for row in (rows[0], rows[-1]))
        assert f"{first:.14g} to {last:.14g}" in err
    assert f"lies wholly {'after' if seconds > 0 else 'before'} the ticks" in err
    assert "else it is another drive's" in err, "two bags of one day are no two clocks"


def test_shuffled_rows_are_told_with_row_and_time(run: Path, said: Callable[..., str]) -> None:
    header, *rows = TICKS.splitlines()
    random.Random(1).shuffle(rows)
    (run / "ticks.csv").write_text("\n".join([header, *rows]) + "\n")
    err = said(2, run)
    assert "sort them by t_s" in err
    assert "first in row " in err
    assert " from t_s " in err


@pytest.mark.parametrize(("period", "unit"), [(2**32, 1e-6), (2**32, 1e-3), (2**16, 1e-3)])
def test_a_boards_clock_that_wraps_is_no_clock_that_was_set_back(
    run: Path, said: Callable[..., str], period: int, unit: float
) -> None:
    """Of an Arduino micros() begins anew after 71.6 minutes."""
    header, *rows = TICKS.splitlines()
    begun = period * unit - float(rows[100].split(",")[0])
    times = [(float(row.split(",")[0]) + begun) % (period * unit) for row in rows]
    rows = [f"{time:.6f},{row.partition(',')[2]}" for time, row in zip(times, rows, strict=True)]
    (run / "ticks.csv").write_text("\n".join([header, *rows]) + "\n")
    err = said(2, run)
    assert f"bits began anew there: add {period * unit:.10g} to t_s from that row on" in err


def test_a_clock_that_is_set_back_is_told_with_row_and_time(
    run: Path, said: Callable[..., str]
) -> None:
    header, *rows = TICKS.splitlines()
    again = later("\n".join([header, *rows[100:]]), -50.0).splitlines()[1:]
    (run / "ticks.csv").write_text("\n".join([header, *rows[:100], *again]) + "\n")
    err = said(2, run)
    assert "go back in time first in row 101 of" in err
    assert f"to {float(again[0].split(',')[0]):.10g}: the clock was set back; cut the run" in err


def _reordered(run: Path, order: Callable[[list[str]], list[str]]) -> str:
    """The reference with its rows in another order; its text as it was."""
    text = (run / "reference.csv").read_text()
    header, *rows = text.splitlines()
    (run / "reference.csv").write_text("\n".join([header, *order(rows)]) + "\n")
    return text


def _positions_then_headings(rows: list[str]) -> list[str]:
    cells = [row.split(",") for row in rows]
    positions = [",".join([t, x, y, ""]) for t, x, y, _ in cells]
    return positions + [",".join([t, "", "", yaw]) for t, _, _, yaw in cells]


@pytest.mark.parametrize(
    "order",
    [
        lambda rows: rows[len(rows) // 2 :] + rows[: len(rows) // 2],
        lambda rows: [rows[(n * 7919) % len(rows)] for n in range(len(rows))],
        _positions_then_headings,
    ],
    ids=["halves", "shuffled", "positions and headings"],
)
def test_rows_of_a_reference_in_another_order_are_sorted(
    run: Path, order: Callable[[list[str]], list[str]]
) -> None:
    """Those that go back in time were dropped without a word, and the rest was judged."""
    first = read_run_folder(run).reference
    _reordered(run, order)
    read = read_run_folder(run)
    assert first is not None
    assert read.reference is not None
    for name in ("x", "y", "yaw"):
        known = np.isfinite(values := getattr(read.reference, name))
        assert np.array_equal(read.reference.time[known], first.time)
        assert np.array_equal(values[known], getattr(first, name))
    assert any("not in the order of time; they are sorted by t_s" in each for each in read.damage)


@pytest.mark.parametrize(
    ("by", "told"),
    [(-5.0, "the clock was set back; cut the run"), (-65.536, "a clock of 16 bits began anew")],
)
def test_a_reference_whose_clock_is_set_back_is_told(
    run: Path, said: Callable[..., str], by: float, told: str
) -> None:
    def order(rows: list[str]) -> list[str]:
        return rows[:100] + later("\n".join(["t_s", *rows[100:]]), by).splitlines()[1:]

    _reordered(run, order)
    err = said(2, run)
    assert "the reference goes back in time first in row 101 of" in err
    assert told in err


def test_a_bag_without_a_reference_lists_what_it_has_and_what_can_be_one(
    said: Callable[..., str],
) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    err = said(2, RECORDINGS / "square_bag", "--reference-topic", "none")
    assert "there is no reference to compare with (Imu, LaserScan, NavSatFix, Odometry," in err
    assert "the bag has /" in err
    assert "(sensor_msgs/msg/JointState)" in err


CUTS: dict[str, Callable[[str], str]] = {
    "in a number": lambda row: row[:-1].rsplit(",", 1)[0] + ",-",
    "before the last cell": lambda row: row.rsplit(",", 1)[0] + ",",
    "after one cell": lambda row: row.split(",")[0],
    "blocks of zeros": lambda row: "\0" * 512,
}


@pytest.mark.parametrize(
    ("name", "how"),
    [
        pytest.param(name, how, marks=[pytest.mark.evidence] * ((row + column) % 2))
        for row, name in enumerate(("ticks.csv", "reference.csv"))
        for column, how in enumerate(CUTS)
        if (name, how) != ("reference.csv", "before the last cell")  # a heading not measured
    ],
)
def test_a_file_cut_by_a_power_failure_is_read_up_to_there(
    run: Path, said: Callable[..., str], werrimbi: Werrimbi, how: str, name: str
) -> None:
    rows = (run / name).read_text().splitlines()
    rows[-1] = CUTS[how](rows[-1])
    (run / name).write_text("\n".join(rows))
    err = said(0, run)
    wanted = f"warning: {run}: {name}, line {len(rows)}: cut off in mid-row; read up to there\n"
    assert err == wanted
    words = ("odom", "--robot", SQUARE / "robot.yaml", run, "--out", run.parent / "odom.csv")
    assert werrimbi(*words).err == wanted
    (run / name).write_text("\n".join(rows) + "\n")
    assert "read up to there" not in said(2, run), "a whole line is no cut"


def test_a_file_without_a_last_line_end_is_whole(run: Path) -> None:
    for name, text in (("ticks.csv", TICKS), ("reference.csv", REFERENCE)):
        (run / name).write_text(text.rstrip("\n"))
    outs = []
    for number, folder in enumerate((run, SQUARE)):
        out = run.parent / f"{number}.csv"
        words = ["odom", "--robot", str(SQUARE / "robot.yaml"), str(folder), "--out", str(out)]
        assert main(words) == 0
        outs.append(out.read_bytes())
    assert outs[0] == outs[1]


def test_ticks_that_are_no_number_are_told_by_compare_too(
    run: Path, said: Callable[..., str]
) -> None:
    rows = TICKS.splitlines()
    for line in (50, 51, 70):
        rows[line] = rows[line].rsplit(",", 1)[0] + ",nan"
    (run / "ticks.csv").write_text("\n".join(rows) + "\n")
    err = said(0, run)
    first = float(rows[50].split(",")[0])
    assert f"3 of {len(rows) - 1} rows of ticks are not finite, the first at t_s {first:g}" in err


def test_a_copy_is_as_good(run: Path, werrimbi: Werrimbi) -> None:
    """What the others are measured by: nothing is said of a whole recording."""
    shutil.copytree(run, run.parent / "copy")
    copy = run.parent / "copy"
    assert werrimbi("compare", "--robot", SQUARE / "robot.yaml", copy).err == ""


ROBOT = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.3
    wheel_radius: 0.05
    left_ticks_per_revolution: 1000.0
    right_ticks_per_revolution: 1000.0
"""


@pytest.fixture
def drive(tmp_path: Path) -> tuple[Path, Path]:
    """A robot file, and a run whose reference was integrated from its counts."""
    robot, run = tmp_path / "robot.yaml", tmp_path / "run"
    robot.write_text(ROBOT)
    run.mkdir()
    rng = np.random.default_rng(2)
    time = 0.05 * np.arange(1200)
    speeds = np.repeat(rng.uniform(200.0, 1500.0, (30, 2)), 40, axis=0)
    counts = np.rint(np.cumsum(0.05 * speeds, axis=0))
    path = trajectory(wo.read_robot(robot).robot, time, counts[:, 0], counts[:, 1])
    ticks = np.column_stack([time, counts])
    poses = np.column_stack([time, path.x, path.y, path.yaw])
    for name, header, table in (
        ("ticks.csv", "t_s,left_ticks,right_ticks", ticks),
        ("reference.csv", "t_s,x_m,y_m,yaw_rad", poses),
    ):
        np.savetxt(run / name, table, "%.12g", delimiter=",", header=header, comments="")
    return robot, run


def test_the_command_line(drive: tuple[Path, Path], werrimbi: Werrimbi) -> None:
    robot, run = drive
    command = ["compare", "--robot", str(robot), str(run)]
    said = werrimbi(*command, code=2).err
    assert said.count("\n") == 1
    assert "it was made from the same counts, and cannot judge them (--force takes it" in said
    said = werrimbi(*command, "--force").err
    assert "warning: " in said
    assert "taken all the same" in said


def test_from_python(drive: tuple[Path, Path]) -> None:
    robot = wo.read_robot(drive[0])
    with pytest.raises(InputError, match="made from the same counts"):
        wo.compare(robot, drive[1])
    with pytest.warns(UserWarning, match="taken all the same"):
        wo.compare(robot, drive[1], force_reference=True)
