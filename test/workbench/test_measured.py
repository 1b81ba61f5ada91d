# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The measured paths stand on the page to scale, before any program draws them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.workbench.drawings import EDGE, HEIGHT, WIDTH, measured_drawing

SVG = "{http://www.w3.org/2000/svg}"


def driven(x: list[float], y: list[float]) -> Run:
    """A run of which the places alone matter."""
    n = len(x)
    time = np.arange(n, dtype=np.float64)
    ticks = Ticks(time, np.zeros(n, dtype=np.int64), np.zeros(n, dtype=np.int64))
    reference = Reference(time, np.array(x), np.array(y), np.full(n, np.nan))
    return Run("drive", Path("drive"), ticks, reference)


def drawn(runs: list[Run]) -> tuple[list[np.ndarray], float, float]:
    """Corners of the lines [page units], length of the bar [page units], and what it says [m]."""
    words = measured_drawing(runs)
    assert words is not None
    tree = ElementTree.fromstring(words)
    lines, bar = (path.attrib["d"] for path in tree.iter("path"))
    begin, end = (float(number) for number in re.findall(r"[\d.]+", bar)[0::2])
    label = next(tree.iter("text")).text
    assert label is not None
    assert label.endswith(" m")
    corners = [
        np.array(line.split(), dtype=np.float64).reshape(-1, 2) for line in lines.split("M")[1:]
    ]
    return corners, end - begin, float(label[:-2])


@given(st.floats(1e-2, 1e3), st.floats(-1e3, 1e3))
def test_a_rectangle_keeps_its_shape_and_the_bar_its_scale(size: float, at: float) -> None:
    x, y = [at, at + 2 * size, at + 2 * size, at], [at, at, at + size, at + size]
    (corners,), bar, says = drawn([driven(x, y)])
    wide, high = np.ptp(corners, axis=0)
    assert wide == pytest.approx(2 * high, abs=0.3)
    assert wide / (2 * size) == pytest.approx(bar / says, rel=2e-3)
    assert corners[0, 1] > corners[2, 1], "y points up"
    assert corners.min() >= EDGE - 0.1
    assert (corners <= [WIDTH - EDGE + 0.1, HEIGHT - 2 * EDGE + 0.1]).all()


def test_each_drive_is_a_line_of_its_own_and_gaps_are_left_out() -> None:
    corners, _, _ = drawn([driven([0.0, np.nan, 1.0], [0.0, np.nan, 0.0]), driven([2.0], [3.0])])
    assert [len(line) for line in corners] == [2, 1]


def test_a_robot_that_never_moved_is_a_point() -> None:
    (corners,), _, _ = drawn([driven([1.0, 1.0], [2.0, 2.0])])
    assert np.isfinite(corners).all()


def test_long_drives_are_drawn_with_few_points() -> None:
    turn = np.linspace(0.0, 40.0, 20_000)
    run = driven(list(turn * np.cos(turn)), list(turn * np.sin(turn)))
    corners, _, _ = drawn([run] * 12)
    assert sum(len(line) for line in corners) < 4000
    assert len(corners) == 12


def test_nothing_is_drawn_where_no_position_was_measured() -> None:
    run = driven([np.nan, np.nan], [np.nan, np.nan])
    assert measured_drawing([run, replace(run, reference=None)]) is None
