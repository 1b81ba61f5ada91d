# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""CSV runs: every number exactly as it stands there, every bad cell named by line and column."""

from __future__ import annotations

import csv
import io
import os
import re
import time
import tracemalloc
import warnings
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.content_hash import mark_of
from werrimbi_odom.files.held_counts import without_held_counts
from werrimbi_odom.files.read_run import bag_at
from werrimbi_odom.files.run_folder import read_run_folder, write_run_folder
from werrimbi_odom.files.tables import csv_table
from werrimbi_odom.inference.legs.count_interpolation import counters_of

TICKS = "t_s,left_ticks,right_ticks\n"
REFERENCE = "t_s,x_m,y_m,yaw_rad\n"
FINE = TICKS + "0.0,1,2\n0.1,3,4\n"


def folder(path: Path, ticks: str | bytes = FINE, reference: str | None = None) -> Path:
    (path / "ticks.csv").write_bytes(ticks if isinstance(ticks, bytes) else ticks.encode())
    if reference is not None:
        (path / "reference.csv").write_text(reference)
    return path


def complaint(path: Path) -> str:
    with pytest.raises(InputError) as caught:
        read_run_folder(path)
    return str(caught.value).removeprefix(f"{path}/")


def test_a_plain_run(tmp_path: Path) -> None:
    run = read_run_folder(folder(tmp_path, FINE, REFERENCE + "0.0,1.5,-2,3.25\n"))
    assert run.name == tmp_path.name
    assert run.ticks.time.tolist() == [0.0, 0.1]
    assert run.ticks.left.dtype == run.ticks.right.dtype == np.int64
    assert run.ticks.left.tolist() == [1, 3]
    assert run.reference is not None
    pose = (run.reference.x[0], run.reference.y[0], run.reference.yaw[0])
    assert pose == (1.5, -2.0, 3.25)
    assert run.reference.sigma_xy is None


def test_the_name_of_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder(tmp_path))
    assert read_run_folder(".").name == tmp_path.name


@pytest.mark.parametrize(
    "text",
    [
        FINE.replace("\n", "\r\n"),
        "\ufeff" + FINE,
        FINE + "\n\n  \n",
        FINE.rstrip("\n"),
        FINE.replace("0.1,3", "\n0.1,3"),
        FINE.replace("0.1,3,4", " 0.1 , 3 ,\t4 "),
        '"t_s","left_ticks","right_ticks"\n"0.0","1","2"\n"0.1","3","4"\n',
        '"t_s", "left_ticks",\t"right_ticks"\n"0.0", "1", "2"\n"0.1", "3", "4"',
        FINE.replace("0.1,3,4", "1e-1,3.0,+4"),
        "right_ticks,t_s,left_ticks\n2,0.0,1\n4,0.1,3\n",
        "right_ticks, note,t_s,left_ticks\n2,,0.0,1\n4,,0.1,3\n",
    ],
)
def test_many_ways_to_write_the_same(tmp_path: Path, text: str) -> None:
    ticks = read_run_folder(folder(tmp_path, text)).ticks
    assert ticks.time.tolist() == [0.0, 0.1]
    assert ticks.left.tolist() == [1, 3]
    assert ticks.right.tolist() == [2, 4]
    assert ticks.left.dtype == np.int64


def test_other_columns_are_channels(tmp_path: Path) -> None:
    text = "t_s,left_ticks,temperature,right_ticks,load\n0,1,20.5,2,\n1,1,,2,3\n"
    channels = read_run_folder(folder(tmp_path, text)).ticks.channels
    assert list(channels) == ["temperature", "load"]
    np.testing.assert_array_equal(channels["temperature"], [20.5, np.nan])
    np.testing.assert_array_equal(channels["load"], [np.nan, 3.0])


def test_readings_that_failed_are_kept_for_the_model_to_count(tmp_path: Path) -> None:
    ticks = read_run_folder(folder(tmp_path, TICKS + "0,nan,2\n1,3.5,inf\n0.5,4,6\n")).ticks
    np.testing.assert_array_equal(ticks.left, [np.nan, 3.5, 4.0])
    np.testing.assert_array_equal(ticks.right, [2.0, np.nan, 6.0])
    assert ticks.time.tolist() == [0.0, 1.0, 0.5], "order is the model's business too"


def test_infinite_counts_print_no_warnings(tmp_path: Path) -> None:
    """Two in a row have no difference, which numpy told the user where he looked for his drive."""
    run = run_of(ROBOT, 1, 60)
    made = write_run_folder(tmp_path / "drive", run.ticks, run.reference)
    lines = (made / "ticks.csv").read_text().splitlines()
    for row in (300, 500, 501):
        lines[row] = re.sub(r",[^,]*$", ",inf", lines[row])
    (made / "ticks.csv").write_text("\n".join(lines) + "\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        counters = counters_of(without_held_counts(read_run_folder(made)), ROBOT, None)
    assert counters.time.size == len(lines) - 4


def test_counters_of_64_bits_without_a_sign_are_exact(tmp_path: Path) -> None:
    """Below zero they are 1.8e19, where floats are 2048 counts apart."""
    text = TICKS.strip()
    for n, count in enumerate((3, 1, -1, -4, -2, 5)):
        text += f"\n{n},{count % 2**64},{(count - 100) % 2**64}"
    ticks = read_run_folder(folder(tmp_path, text + "\n")).ticks
    assert np.diff(ticks.left).tolist() == [-2, -2, -3, 2, 7]
    assert np.diff(ticks.right).tolist() == [-2, -2, -3, 2, 7]
    said = complaint(folder(tmp_path, text + "\n6,nan,5\n"))
    assert said.startswith(
        "ticks.csv, line 8, column left_ticks: 'nan' is no count; leave the row out"
    )


def test_what_was_not_measured_is_nan(tmp_path: Path) -> None:
    text = "t_s,x_m,y_m,yaw_rad,sigma_xy_m,sigma_yaw_rad,z_m\n0,1,2,,0.01,,9\n1,,,3,,0.1,9\n"
    reference = read_run_folder(folder(tmp_path, FINE, text)).reference
    assert reference is not None
    np.testing.assert_array_equal(reference.x, [1.0, np.nan])
    np.testing.assert_array_equal(reference.yaw, [np.nan, 3.0])
    np.testing.assert_array_equal(reference.sigma_xy, [0.01, np.nan])
    np.testing.assert_array_equal(reference.sigma_yaw, [np.nan, 0.1])
    assert reference.has_position.tolist() == [True, False]
    assert reference.has_yaw.tolist() == [False, True]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "ticks.csv is empty; its first line must be t_s,left_ticks,right_ticks"),
        (TICKS, "ticks.csv has a header and no rows"),
        (TICKS + "\n\n", "ticks.csv has a header and no rows"),
        (
            "0,1,2\n1,2,3\n",
            "ticks.csv, line 1: there is no header; the first line must be t_s,left_ticks,",
        ),
        (
            "t_s,left\n0,1\n",
            "ticks.csv, line 1: no column left_ticks, right_ticks; the header is 't_s,left'; write "
            "these names into it in place of its own (perhaps left_ticks for left), and bring the",
        ),
        (
            "Time[s],enc_left,enc_right\n0,1,2\n",
            "ticks.csv, line 1: no column t_s, left_ticks, right_ticks; the header is "
            "'Time[s],enc_left,enc_right'; write these names into it in place of its own (perhaps "
            "t_s for Time[s], left_ticks for enc_left, right_ticks for enc_right), and bring the "
            "values to the units that they name",
        ),
        (
            "stamp,time,a,b\n0,0,1,2\n",
            "ticks.csv, line 1: no column t_s, left_ticks, right_ticks; the header is "
            "'stamp,time,a,b'; write these names into it in place of its own, and bring",
        ),
        (
            "t_s;left_ticks;right_ticks\n0;1;2\n",
            "ticks.csv, line 1: the columns are not separated by commas; separate them so, and the "
            "first line must be t_s,left_ticks,right_ticks",
        ),
        (
            "micros;enc_l;enc_r;volts\n20;1;2;12,4\n",
            "ticks.csv, line 1: the columns are not separated by commas; write a point for each "
            "comma in its numbers, separate them so, and",
        ),
        (
            "1248272272.841 \t 0.074 \t 0.229\n",
            "ticks.csv, line 1: the columns are not separated by commas",
        ),
        (
            "t_s,left_ticks,right_ticks,t_s\n0,1,2,3\n",
            "ticks.csv, line 1: the column t_s is there twice",
        ),
        (
            "t_s,left_ticks,right_ticks,\n0,1,2,\n",
            "ticks.csv, line 1: column 4 has no name",
        ),
        (FINE + "0.2,x,6\n", "ticks.csv, line 4, column left_ticks: 'x' is not a number"),
        (FINE + FINE, "ticks.csv, line 4: the column names again: the log was begun anew there"),
        (
            TICKS[:-1] + ",mode\n0,1,2,auto\n",
            "ticks.csv, line 2, column mode: 'auto' is not a number; leave the cell empty where "
            "there is none; leave a column of text out",
        ),
        (FINE + "\n0.2,5,1_0\n", "ticks.csv, line 5, column right_ticks: '1_0' is not a number"),
        (FINE + "0.2,5,٣\n", "ticks.csv, line 4, column right_ticks: '٣' is not a number"),
        (FINE + "0.2,5,6\0\n", "ticks.csv, line 4, column right_ticks: '6\\x00' is not a number"),
        (FINE + "noon,5,6\n", "ticks.csv, line 4, column t_s: 'noon' is not a number"),
        (FINE + '"0.2,5",6\n', "ticks.csv, line 4, column t_s: '0.2,5' is not a number"),
        (FINE + "0.2,5\n", "ticks.csv, line 4: 2 cells under 3 columns"),
        (FINE + "0.2,5,6,7\n", "ticks.csv, line 4: 4 cells under 3 columns"),
        (TICKS + "0,1\n1,2\n", "ticks.csv, line 2: 2 cells under 3 columns"),
        (FINE + "0.2,,6\n", "ticks.csv, line 4, column left_ticks: it is empty; write nan where"),
        (FINE + '0.2,5,""\n', "ticks.csv, line 4, column right_ticks: it is empty"),
        (FINE + "0.2,5,\n", "ticks.csv, line 4, column right_ticks: it is empty"),
        (FINE + ",5,6\n", "ticks.csv, line 4, column t_s: it is empty; every row needs its time"),
        (FINE + "nan,5,6\n", "ticks.csv, line 4, column t_s: 'nan' is not a time"),
        (
            FINE + "1767225600229169585,5,6\n",
            "ticks.csv, line 4, column t_s: '1767225600229169585' is not a time in seconds; is it",
        ),
        (FINE + "-inf,5,6\n", "ticks.csv, line 4, column t_s: '-inf' is not a time"),
        (FINE + "0.2," + "y" * 999 + ",6\n", f"ticks.csv, line 4, column left_ticks: '{'y' * 40}."),
        (FINE.encode() + b"0.2,\xe9,6\n", "ticks.csv, line 4: byte 0xe9 is not UTF-8 text"),
        (FINE.encode("utf-16"), "ticks.csv, line 1: byte 0xff is not UTF-8 text"),
    ],
)
def test_wrong_ticks(tmp_path: Path, text: str | bytes, said: str) -> None:
    assert complaint(folder(tmp_path, text)).startswith(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "reference.csv is empty; its first line must be t_s,x_m,y_m,yaw_rad"),
        (REFERENCE, "reference.csv has a header and no rows"),
        ("t_s,x_m,y_m,theta\n0,1,2,3\n", "reference.csv, line 1: no column yaw_rad"),
        (
            "t,x,y,theta\n0,1,2,3\n",
            "reference.csv, line 1: no column t_s, x_m, y_m, yaw_rad; the header is 't,x,y,theta'; "
            "write these names into it in place of its own (perhaps t_s for t, x_m for x, y_m for "
            "y, yaw_rad for theta), and",
        ),
        (REFERENCE + "0,1,2,3\n,1,2,3\n", "reference.csv, line 3, column t_s: it is empty"),
        (
            REFERENCE + "nan,1,2,3\n",
            "reference.csv, line 2, column t_s: 'nan' is not a time; leave",
        ),
        (
            REFERENCE + "0,,,\n1,,,\n",
            "reference.csv: x_m, y_m and yaw_rad are empty in all 2 rows: nothing is measured",
        ),
        (
            REFERENCE + "0,1,,\n1,2,,\n",
            "reference.csv: y_m and yaw_rad are empty in all 2 rows: nothing is measured; fill",
        ),
        (
            REFERENCE + "0,1,2,NULL\n",
            "reference.csv, line 2, column yaw_rad: 'NULL' is not a number; leave the cell empty",
        ),
        (REFERENCE + "0,1,inf,3\n", "reference.csv, line 2, column y_m: 'inf' cannot be measured"),
        (REFERENCE + "0,1,,north\n", "reference.csv, line 2, column yaw_rad: 'north' is not a nu"),
        (
            "t_s,x_m,y_m,yaw_rad,sigma_xy\n0,1,2,3,4\n",
            "reference.csv, line 1: unknown column sigma_xy; there are sigma_xy_m and",
        ),
        (
            "t_s,x_m,y_m,yaw_rad,sigma_xy_m\n0,1,2,3,1\n0,1,2,3,-1\n",
            "reference.csv, line 3, column sigma_xy_m: '-1' must not be less than 0",
        ),
    ],
)
def test_wrong_references(tmp_path: Path, text: str, said: str) -> None:
    assert complaint(folder(tmp_path, FINE, text)).startswith(said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            FINE + "0.2,x,6\n0.3,5,y\n0.4,5\n",
            "line 4, column left_ticks: 'x' is not a number; leave the cell empty where there is "
            "none; line 5, column right_ticks: 'y' is not a number; line 6: 2 cells under 3 "
            "columns",
        ),
        (
            FINE + ",5,\n0.3,nan,6\nnan,,6\n",
            "line 4, column t_s: it is empty; every row needs its time: fill it in, or leave the "
            "row out; line 4, column right_ticks: it is empty; write nan where a reading is "
            "missing, or leave the row out; line 6, column t_s: 'nan' is not a time; leave the row "
            "out; line 6, column left_ticks: it is empty; write nan where a reading is missing, or "
            "leave the row out",
        ),
        (
            "t_s,left_ticks,right_ticks,mode\n" + "0,1,2,auto\n" * 9 + "1,2,x,auto\n",
            "line 2, column mode: 'auto' is not a number; leave the cell empty where there is "
            "none; leave a column of text out; line 11, column right_ticks: 'x' is not a number; "
            "leave the cell empty where there is none",
        ),
    ],
)
def test_bad_cells_are_told_together(tmp_path: Path, text: str, said: str) -> None:
    """They were told one at a time, a command for each."""
    assert complaint(folder(tmp_path, text)) == f"ticks.csv, {said}"


def test_of_many_bad_cells_the_number_is_told(tmp_path: Path) -> None:
    said = complaint(folder(tmp_path, FINE, REFERENCE + "0,1,inf,3\n" * 20))
    begin = "reference.csv, line 2, column y_m: 'inf' cannot be measured; leave the cell empty"
    assert said.startswith(f"{begin} where nothing was; line 3, column y_m: 'inf'")
    assert said.endswith("line 6, column y_m: 'inf' cannot be measured; and 15 more like these")


def test_rows_without_a_single_value_are_blank_lines(tmp_path: Path) -> None:
    """A spreadsheet writes them between tables, and at the end."""
    blank = ' , ,"",\n,,,\n'
    folder(tmp_path, FINE + ",,\n0.2,5,6\n,,\n", REFERENCE + "0,1,2,3\n" + blank + "1,2,,3\n,,,\n")
    run = read_run_folder(tmp_path)
    assert run.reference is not None
    np.testing.assert_array_equal(run.reference.time, [0.0, 1.0])
    assert run.ticks.rows == 3
    folder(tmp_path, FINE, REFERENCE + blank + "0,1,two,3\n")
    assert complaint(tmp_path).startswith("reference.csv, line 4, column y_m: 'two' is not a nu")


def test_folders_and_dead_links_in_the_place_of_files(tmp_path: Path) -> None:
    (folder(tmp_path) / "reference.csv").symlink_to("nowhere")
    assert complaint(tmp_path) == "reference.csv: there is no such file"
    (tmp_path / "reference.csv").unlink()
    (tmp_path / "reference.csv").mkdir()
    assert complaint(tmp_path) == "reference.csv is a folder; it must be a CSV file"


def test_what_is_too_large_is_refused_before_it_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder(tmp_path, FINE * 10)
    monkeypatch.setattr(csv_table, "MAX_ROWS", 20)
    assert complaint(tmp_path).startswith("ticks.csv has more than 20 rows or")
    folder(tmp_path, "t_s," + "a" * 2**21)
    assert complaint(tmp_path).startswith("ticks.csv, line 1 is longer than 1,048,576 bytes")
    folder(tmp_path, TICKS[:-1] + "," + ",".join(f"c{i}" for i in range(300)) + "\n")
    assert complaint(tmp_path).startswith("ticks.csv, line 1: 303 columns are more than 256")
    (tmp_path / "ticks.csv").unlink()
    (tmp_path / "ticks.csv").symlink_to("/dev/zero")
    assert complaint(tmp_path).startswith("ticks.csv, line 1 is longer than")


INT64 = st.integers(-(2**63), 2**63 - 1)
FINITE = st.floats(allow_nan=False, allow_infinity=False)
TIMES = st.floats(-1e11, 1e11)
ROWS = st.lists(st.tuples(TIMES, INT64, FINITE, st.one_of(st.none(), FINITE)), min_size=1)


@settings(
    max_examples=80,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(rows=ROWS, order=st.permutations(["t_s", "left_ticks", "right_ticks", "current"]))
def test_any_finite_numbers_are_read_back_exactly(
    tmp_path: Path, rows: list[tuple[float, int, float, float | None]], order: list[str]
) -> None:
    names = ["t_s", "left_ticks", "right_ticks", "current"]
    text = io.StringIO()
    writer = csv.DictWriter(text, order)
    writer.writeheader()
    writer.writerows(dict(zip(names, row, strict=True)) for row in rows)
    ticks = read_run_folder(folder(tmp_path, text.getvalue())).ticks
    columns = [list(column) for column in zip(*rows, strict=True)]
    assert ticks.time.tolist() == columns[0]
    assert ticks.left.dtype == np.int64
    assert ticks.left.tolist() == columns[1], "integers are exact to their last digit"
    assert ticks.right.tolist() == columns[2]
    expected = [np.nan if value is None else value for value in columns[3]]
    np.testing.assert_array_equal(ticks.channels["current"], expected)


@settings(
    max_examples=80,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.binary(max_size=60), st.text("0123456789,.\n\r \"-e;nai'", max_size=60))
def test_whatever_is_in_the_file_nothing_but_an_input_error(
    tmp_path: Path, raw: bytes, text: str
) -> None:
    for content in (raw, TICKS.encode() + raw, TICKS.encode() + text.encode()):
        try:
            run = read_run_folder(folder(tmp_path, content))
        except InputError as error:
            said = str(error)
        else:
            said = f"{tmp_path}: all {'' if np.isfinite(run.ticks.time).all() else 'not '}well"
        assert str(tmp_path) in said
        assert "not well" not in said


def test_a_million_rows_in_little_time(tmp_path: Path) -> None:
    rows = "".join(f"{0.001 * i:.3f},{i},{2 * i}\n" for i in range(1_000_000))
    folder(tmp_path, TICKS + rows)
    began = time.process_time()
    ticks = read_run_folder(tmp_path).ticks
    took = time.process_time() - began
    assert ticks.rows == 1_000_000
    assert ticks.right[-1] == 1_999_998
    assert took < 4.0, "about a second on a machine that does nothing else"


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_no_permission(tmp_path: Path) -> None:
    (folder(tmp_path) / "ticks.csv").chmod(0)
    assert complaint(tmp_path) == "ticks.csv cannot be read: Permission denied"


RENAMED = {
    "time_ms,enc_l,enc_r,rpm_l,rpm_r": "(perhaps t_s for time_ms, divided by 1000; left_ticks for "
    "enc_l, right_ticks for enc_r)",
    "t,left_rpm,right_rpm": "right_ticks for right_rpm, a speed: the running sum of it / 60 (turns)"
    " times the seconds since the row before, as whole numbers of small steps)",
    "time,s_right,s_left": "right_ticks for s_right, a way or an angle: as whole numbers of small",
    "time,dL,dR": "right_ticks for dR, if that is what came since the row before, its running sum)",
    "time,left_cmd,right_cmd": "in place of its own (perhaps t_s for time), and bring",
    "sec,nanosec,left,right": "(perhaps t_s for sec, plus nanosec divided by 10^9; left_ticks for",
    "stamp.secs,stamp.nsecs,l,r": "(perhaps t_s for stamp.secs, plus stamp.nsecs divided by 10^9;",
    "leftEncoder,rightEncoder": "no column is called like a time: where rows come at a steady rate",
}


@pytest.mark.parametrize("header", RENAMED)
def test_what_a_strangers_columns_may_be_and_how_they_become_ours(
    tmp_path: Path, header: str
) -> None:
    assert RENAMED[header] in complaint(folder(tmp_path, f"{header}\n1,2,3,4,5\n"))


def test_the_robots_own_pose_is_not_offered_as_a_reference(tmp_path: Path) -> None:
    columns = "time_us,x_cm,y_cm,x_acc,encoder_heading_deg,yaw_rate"
    said = complaint(folder(tmp_path, FINE, f"{columns}\n1,2,3,4,5,6\n"))
    assert "t_s for time_us, divided by 10^6; x_m for x_cm, y_m for y_cm, divided by 100)" in said
    assert "the cells of what was not measured may be empty, but the name must be there" in said


@pytest.mark.parametrize(
    ("columns", "row"), [("t_s,x_m,y_m", "0,1,2"), ("yaw_rad,t_s", "3,0"), ("t_s,yaw_rad", "0,3")]
)
def test_columns_of_what_was_not_measured_may_be_left_out(
    tmp_path: Path, columns: str, row: str
) -> None:
    """A camera's positions, or a gyro's headings: nothing else in the file may be meant."""
    reference = read_run_folder(folder(tmp_path, FINE, f"{columns}\n{row}\n")).reference
    assert reference is not None
    assert reference.has_position.tolist() == ["x_m" in columns]
    assert reference.has_yaw.tolist() == ["yaw_rad" in columns]


@pytest.mark.parametrize("columns", ["t_s,x_m,y_m,theta", "t_s,x_m,yaw_rad", "t_s,x_m"])
def test_columns_that_others_may_be_meant_for_are_asked_for(tmp_path: Path, columns: str) -> None:
    assert "no column y" in complaint(folder(tmp_path, FINE, f"{columns}\n1,2,3,4\n"))


def test_a_header_that_numpy_wrote_as_a_remark(tmp_path: Path) -> None:
    assert read_run_folder(folder(tmp_path, "# " + FINE)).ticks.left.tolist() == [1, 3]


def test_remarks_before_the_rows_are_named(tmp_path: Path) -> None:
    said = complaint(folder(tmp_path, "%% logfile of a robot:\n% 1 time\n0.1 2 3\n"))
    assert said.startswith("ticks.csv, line 1 is a remark, '%% logfile of a robot:'; leave such")


def test_a_header_that_fits_no_row(tmp_path: Path) -> None:
    """A logger named the time, and did not write it: what it calls time is x."""
    rows = "".join(f"{0.1 * row},2.0,0.5\n" for row in range(5))
    said = complaint(folder(tmp_path, FINE, REFERENCE + rows))
    assert "line 2: 3 cells under 4 columns, as in all rows: one that it names was not" in said


@pytest.mark.parametrize("name", ["odom.mat", "log.xlsx", "run.npz"])
def test_logs_of_other_programs_are_to_be_saved_as_text(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_bytes(b"MATLAB 5.0 MAT-file")
    for path in (tmp_path, tmp_path / name):
        with pytest.raises(InputError, match=f"; save what {name} holds as text: "):
            bag_at(path)


@pytest.mark.parametrize(("interval", "told"), [(1.0, 2), (0.5, 0), (10.0, 0)])
def test_times_without_a_fraction_may_be_rounded(
    tmp_path: Path, interval: float, told: int
) -> None:
    times = [1539699406 + interval * row for row in range(24)]
    ticks = "".join(f"{time:.12g},{row},{row}\n" for row, time in enumerate(times))
    poses = "".join(f"{time:.12g},{row},0,0\n" for row, time in enumerate(times))
    run = read_run_folder(folder(tmp_path, TICKS + ticks, REFERENCE + poses))
    assert sum("all its times are whole seconds" in each for each in run.damage) == told


def test_the_mark_of_a_bag_needs_no_memory_for_it(tmp_path: Path) -> None:
    """A recording of an hour with pictures is larger than the memory of a robot's computer."""
    with (tmp_path / "drive.BAG").open("wb") as file:
        file.truncate(2**25)
    tracemalloc.start()
    marks = {mark_of([tmp_path])}
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 2**23
    with (tmp_path / "drive.BAG").open("ab") as file:
        file.write(b"more")
    assert mark_of([tmp_path]) not in marks, "another content, another mark"


def test_what_is_wrong_with_both_files_is_told_at_once(tmp_path: Path) -> None:
    """Of a log of speeds in rpm each run of the command found the next mistake."""
    said = complaint(
        folder(
            tmp_path, "time_ms,left_rpm,right_rpm\n1,2,3\n", "time_ms,x_cm,y_cm,yaw_deg\n1,2,3,4\n"
        )
    )
    assert "right_ticks for right_rpm, a speed: the running sum of it / 60" in said
    assert "; and " in said
    assert "x_m for x_cm, y_m for y_cm, divided by 100" in said
