# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays of a user who has them the wrong way round, in other units, or with holes."""

from __future__ import annotations

import errno
import os
import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, ROBOT_FILE
from test.inference.driven import run_of
from werrimbi_odom.api.arrays import ticks_of

ROWS = 200
TIME = 0.05 * np.arange(ROWS)
LEFT, RIGHT = (np.cumsum(np.full(ROWS, step)) for step in (40, 42))


@pytest.fixture
def robot(tmp_path: Path) -> Any:
    (tmp_path / "robot.yaml").write_text(ROBOT_FILE)
    return wo.read_robot(tmp_path / "robot.yaml")


def driven(robot: Any, **other: Any) -> Any:
    given = {"t": TIME, "left": LEFT, "right": RIGHT} | other
    return wo.odometry(robot, given["t"], given["left"], given["right"])


def test_any_kind_of_numbers_gives_the_same(robot: Any) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plain = driven(robot)
        for kind in (np.int32, np.uint16, np.float32, np.float64, object):
            other = driven(robot, left=LEFT.astype(kind), right=RIGHT.astype(kind))
            assert np.array_equal(other.x, plain.x)
        lists = driven(robot, t=TIME.tolist(), left=LEFT.tolist(), right=RIGHT.tolist())
    assert np.array_equal(lists.covariance, plain.covariance)


def test_it_shows_itself_in_one_line(robot: Any) -> None:
    shown = repr(driven(robot))
    assert "\n" not in shown
    assert shown.startswith(f"<Odometry of {ROWS} rows, to x ")
    assert " ± " in shown


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"left": LEFT[:-1]}, r"t \(200,\), left \(199,\), right \(200,\)"),
        ({"t": TIME[:, None], "left": LEFT[:, None], "right": RIGHT[:, None]}, "a column each"),
        ({"t": [], "left": [], "right": []}, "there are no ticks"),
        ({"left": ["a"] * ROWS}, "left must hold numbers"),
        ({"right": RIGHT > 0}, "right must hold numbers, and holds bool"),
        ({"t": np.datetime64("2026-01-01") + np.arange(ROWS)}, "t holds dates; give seconds"),
        ({"left": np.full(ROWS, np.nan)}, "no row has a finite time and finite counts"),
        ({"t": (1.7e9 + TIME).astype(np.float32)}, "199 with the stamp of the one before"),
    ],
)
def test_what_cannot_be_used_is_refused(robot: Any, wrong: dict[str, Any], told: str) -> None:
    with pytest.raises(wo.InputError, match=told):
        driven(robot, **wrong)


@pytest.mark.parametrize(
    ("odd", "told"),
    [
        ({"left": np.where(np.arange(ROWS) == 5, np.nan, LEFT)}, "1 not finite"),
        ({"t": TIME[::-1]}, "190 late"),
        ({"t": 1e3 * TIME}, "199 gaps; is t in seconds, and in the first place?"),
        ({"t": LEFT, "left": TIME}, "199 gaps; is t in seconds, and in the first place?"),
        ({"left": np.append(LEFT[:100], LEFT[100:] - LEFT[100])}, "1 resets"),
        ({"left": (20 * LEFT + 32768) % 65536 - 32768}, "wraps at 16 bits: write encoder_bits: 16"),
    ],
)
def test_what_is_odd_is_told(robot: Any, odd: dict[str, Any], told: str) -> None:
    with pytest.warns(UserWarning, match=re.escape(told)) as found:
        driven(robot, **odd)
    assert all(each.filename == __file__ for each in found)


def test_a_path_in_place_of_the_robot_is_told() -> None:
    with pytest.raises(TypeError, match="the robot comes first, from read_robot, and not str"):
        driven("robot.yaml")


def test_a_run_of_arrays_is_read_again_without_loss(robot: Any, tmp_path: Path) -> None:
    drive = run_of(PLAIN, 1, 30)
    ticks, seen = drive.ticks, drive.reference
    assert seen is not None
    poses = np.stack([seen.time, seen.x, seen.y, seen.yaw], axis=1)
    poses[1, 1:] = np.nan
    warmth = np.linspace(20.0, 21.0, ticks.rows)
    folder = wo.write_run(
        tmp_path / "drive", ticks.time, ticks.left, ticks.right, poses, {"warmth_c": warmth}
    )
    again = wo.read_run(folder, robot)
    assert again.reference is not None
    for one, other in ((again.ticks.time, ticks.time), (again.ticks.left, ticks.left)):
        assert np.array_equal(one, other)
    assert np.array_equal(again.ticks.channels["warmth_c"], warmth)
    assert np.array_equal(again.reference.yaw, poses[:, 3], equal_nan=True)
    assert "legs of" in wo.compare(robot, folder).summary()
    with pytest.raises(wo.InputError, match="File exists; a new folder is wanted"):
        wo.write_run(folder, TIME, LEFT, RIGHT)
    with pytest.raises(wo.InputError, match=r"four columns, .* has the shape \(200, 3\)"):
        wo.write_run(tmp_path / "other", TIME, LEFT, RIGHT, np.zeros((ROWS, 3)))
    with pytest.raises(wo.InputError, match="reference has no poses"):  # no verb would take it
        wo.write_run(tmp_path / "other", TIME, LEFT, RIGHT, np.zeros((0, 4)))


def test_a_channel_takes_no_counters_place(robot: Any, tmp_path: Path) -> None:
    """A current of the left motor may be called `left`, as the wheel's counter is."""
    ticks = ticks_of(TIME, LEFT, RIGHT, {"left": np.ones(ROWS), "t": np.zeros(ROWS)})
    assert np.array_equal(ticks.left, LEFT)
    assert np.array_equal(ticks.time, TIME)
    folder = wo.write_run(tmp_path / "drive", TIME, LEFT, RIGHT, channels=ticks.channels)
    again = wo.read_run(folder, robot, reference_topic="none").ticks
    assert np.array_equal(again.left, LEFT)
    assert np.array_equal(again.channels["left"], np.ones(ROWS))
    for name in ("left_ticks", "t_s", "motor, left", "", " a", "a\n"):
        with pytest.raises(wo.InputError, match="a channel cannot be called"):
            wo.write_run(tmp_path / "other", TIME, LEFT, RIGHT, channels={name: np.ones(ROWS)})
    assert not (tmp_path / "other").exists()


def test_without_any_recording_there_is_nothing_to_look_into() -> None:
    with pytest.raises(wo.InputError, match="no recordings were given"):
        wo.info([])


def test_what_a_mask_hides_was_not_measured() -> None:
    """As netCDF4 reads a missing count."""
    left = np.ma.array([0, 2**31 - 1, 2], mask=[False, True, False])
    assert np.array_equal(ticks_of([0, 1, 2], left, [0, 1, 2]).left, [0, np.nan, 2], equal_nan=True)
    whole = np.ma.array([0, 1, 2])
    assert ticks_of([0, 1, 2], whole, [0, 1, 2]).left.dtype == np.int64


def test_a_full_disk_leaves_no_drive_without_its_reference(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    written: list[int] = []

    def full(file: int) -> None:
        written.append(file)
        if len(written) > 1:
            raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(wo.InputError, match="No space left on device"):
        wo.write_run(tmp_path / "drive", TIME, LEFT, RIGHT, np.zeros((ROWS, 4)))
    assert not (tmp_path / "drive" / "ticks.csv").exists()


@pytest.mark.parametrize("of", ["ticks", "reference"])
def test_rows_in_reverse_are_told(robot: Any, tmp_path: Path, of: str) -> None:
    poses = np.zeros((ROWS, 4))
    poses[:, 0] = TIME if of == "ticks" else TIME[::-1]
    time = TIME[::-1] if of == "ticks" else TIME
    folder = wo.write_run(tmp_path / "drive", time, LEFT, RIGHT, poses)
    with pytest.raises(wo.InputError, match=f"the {of} go.* the last row comes first; sort"):
        wo.compare(robot, folder)


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ({"leg": -1}, r"leg must be a number greater than zero \(.*\), and is -1"),
        ({"leg": "1 m"}, r"leg must be a number greater than zero \(.*\), and is '1 m'"),
        ({"reference_sigma_xy": 1e300}, "from 1e-09 to 1e.06"),
        ({"reference_kind": "map"}, "one of absolute, incremental, local_map, and is 'map'"),
        ({"reference_sigma_yaw": float("nan")}, "reference_sigma_yaw must be a number"),
    ],
)
def test_an_option_that_cannot_be_is_refused(robot: Any, option: Any, told: str) -> None:
    with pytest.raises(wo.InputError, match=told):
        wo.compare(robot, "drive", **option)


def test_arrays_in_place_of_drives_are_told(robot: Any) -> None:
    with pytest.raises(TypeError, match="not ndarray; write_run makes a folder of arrays"):
        wo.compare(robot, [LEFT, RIGHT])  # type: ignore[list-item]
