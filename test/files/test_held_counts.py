# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Counters that are logged oftener than they are read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.files.conftest import MakeRobot
from werrimbi_odom.files.held_counts import without_held_counts
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.run import Run, Ticks
from werrimbi_odom.model.pose import Floats

TIME = np.arange(0.0, 20.0, 0.02)


def counts(per_second: float) -> np.ndarray:
    """Of a wheel that speeds up, goes on, stops, and goes back."""
    speed = per_second * np.clip(np.sin(0.5 * TIME) * 1.5, -1.0, 1.0)
    return np.floor(np.cumsum(speed) * 0.02).astype(np.int64)


def held(values: np.ndarray, new: np.ndarray) -> np.ndarray:
    """The last value of a new row, in each row."""
    return values[np.maximum.accumulate(np.where(new, np.arange(values.size), 0))]


def run(left: np.ndarray, right: np.ndarray, time: Floats = TIME) -> Run:
    return Run("run", Path("run"), Ticks(time, left, right, {}))


ROWS = np.arange(TIME.size)


@pytest.mark.parametrize(
    ("left", "right"),
    [
        pytest.param(ROWS % 2 == 0, ROWS % 2 == 1, id="a row for each message of either wheel"),
        pytest.param(ROWS % 2 == 0, ROWS % 2 == 0, id="published twice as often as read"),
        pytest.param(ROWS % 3 == 0, ROWS % 3 == 0, id="published three times as often"),
        pytest.param(ROWS % 6 != 0, ROWS % 6 != 0, id="published at 60 Hz, read at 50"),
        pytest.param(ROWS % 2 == 0, ROWS >= 0, id="one wheel alone"),
    ],
)
def test_counts_between_two_readings_are_those_of_the_wheel(
    left: np.ndarray, right: np.ndarray
) -> None:
    true = counts(1500.0), counts(1200.0)
    given = run(held(true[0], left), held(true[1], right))
    found = without_held_counts(given).ticks
    for each, recorded, truth in (
        (found.left, given.ticks.left, true[0]),
        (found.right, given.ticks.right, true[1]),
    ):
        off = np.abs(each - truth)[:-2]  # after the last reading nothing is known
        assert off.max() <= 4, "rows beside a rest stay as they are"
        assert off.mean() <= 0.1 + 0.05 * np.abs(recorded - truth).mean()


@given(st.floats(1.0, 3000.0), st.integers(0, 2**31))
def test_a_wheel_that_is_read_in_each_row_stays_as_it_is(per_second: float, seed: int) -> None:
    """Also a coarse counter, whose rows without a step are its own, and one that flickers."""
    wheel = counts(per_second) + np.random.default_rng(seed).integers(0, 2, TIME.size)
    same = run(wheel, wheel[::-1].copy())
    assert without_held_counts(same) is same


def test_a_counter_of_64_bits_is_compared_exactly() -> None:
    """As floats its counts would stand still for 2048 of them."""
    far = counts(1500.0) + 2**62
    same = run(far, far)
    assert without_held_counts(same) is same


def test_it_is_said_where_a_run_is_read(tmp_path: Path, robot: MakeRobot) -> None:
    wheel = held(counts(1500.0), ROWS % 2 == 0)
    rows = zip(TIME.tolist(), wheel.tolist(), counts(1500.0).tolist(), strict=True)
    text = "".join(f"{time},{left},{right}\n" for time, left, right in rows)
    (tmp_path / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + text)
    (words,) = read_run(tmp_path, robot()).damage
    assert "of the left wheel repeat the one before" in words
