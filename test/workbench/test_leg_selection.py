# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A part's legs are those whose figures stand beside it; measured paths are drawn to scale."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from test.workbench.session import written
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.compare import Comparison, compare
from werrimbi_odom.workbench import drawings
from werrimbi_odom.workbench.drawings import (
    EDGE,
    HEIGHT,
    WIDTH,
    classes_of,
    floor_figure,
    leg_told,
    measured_drawing,
    shown,
)
from werrimbi_odom.workbench.leg_selection import (
    CellPart,
    bin_parts,
    channel_error,
    figures_of,
    motion_parts,
    worst,
)


@pytest.fixture(scope="module")
def comparison(tmp_path_factory: pytest.TempPathFactory) -> Comparison:
    robot, train, _ = written(tmp_path_factory.mktemp("day"))
    source = read_robot_file(robot)
    return compare([read_run(run, source) for run in train], source.robot)


def test_types_of_motion_share_out_all_legs(comparison: Comparison) -> None:
    parts = motion_parts(comparison)
    every = np.stack([part.legs(comparison) for part in parts])
    assert (every.sum(axis=0) == 1).all()
    for part in parts:
        figures = comparison.main.by_motion[part.kind].figures
        assert figures_of(comparison, part.legs(comparison)) == figures


def test_what_was_not_measured_of_a_leg_is_not_told(comparison: Comparison) -> None:
    """Satellites measure positions alone: nothing is known of the heading."""
    run = comparison.runs[0].run
    assert run.reference is not None
    blind = np.full(run.reference.time.size, np.nan)
    alone = replace(run, reference=replace(run.reference, yaw=blind))
    told = leg_told(compare([alone], comparison.model.robot), 0)
    assert re.search(r"along [+-]\d+\.\d mm, sideways [+-]\d+\.\d mm$", told)


def test_bins_hold_the_legs_that_their_figures_count(comparison: Comparison) -> None:
    found = bin_parts(comparison)
    assert found
    for bins in found.values():
        for part, figures in bins:
            chosen = part.legs(comparison)
            assert figures_of(comparison, chosen).count == figures.count
            assert figures_of(comparison, chosen).nees == pytest.approx(figures.nees)


def test_a_wheels_error_is_the_sum_of_way_and_turn(comparison: Comparison) -> None:
    left, right = (channel_error(comparison, name) for name in ("left", "right"))
    along, _, heading = comparison.legs.errors.error.T
    np.testing.assert_allclose(0.5 * (left + right), along)
    np.testing.assert_allclose((right - left) / comparison.model.robot.track, heading)


def test_a_cell_shows_the_legs_that_err_most_there(comparison: Comparison) -> None:
    chosen = CellPart("heading", "speed").legs(comparison)
    size = np.abs(channel_error(comparison, "heading"))
    assert 0 < chosen.sum() < 0.3 * chosen.size
    assert size[chosen].min() >= np.nanmax(size[~chosen & ~comparison.legs.outlier])


def test_the_floor_draws_every_leg_once_in_its_class(comparison: Comparison) -> None:
    figure = floor_figure(comparison)
    counted = sum(
        int(line.name.rpartition(": ")[2]) for line in figure.data if ": " in (line.name or "")
    )
    assert counted == comparison.legs.run.size
    outside = (classes_of(comparison) > 0) & ~comparison.legs.outlier
    kept = ~comparison.legs.outlier
    share = 1.0 - comparison.main.all.figures.coverage_95
    assert outside.sum() / kept.sum() == pytest.approx(share)


def test_more_legs_than_can_be_told_apart_are_counted_but_not_all_drawn(
    comparison: Comparison, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = floor_figure(comparison)
    monkeypatch.setattr(drawings, "_LEGS", 5)
    thin = floor_figure(comparison)
    assert [line.name for line in thin.data] == [line.name for line in whole.data]
    for line in thin.data[:-1]:
        assert np.isnan(line.x).sum() <= 5
    assert all(line.mode == "lines" for line in whole.data), "marks are dear"


def test_the_worst_legs_come_first(comparison: Comparison) -> None:
    every = np.ones(comparison.legs.run.size, dtype=np.bool_)
    found = worst(comparison, every, 5)
    deviation = comparison.legs.errors.deviation
    assert found[0] == int(np.argmax(np.where(comparison.legs.outlier, -1.0, deviation)))
    assert list(deviation[found]) == sorted(deviation[found], reverse=True)


def test_in_the_dark_no_colour_of_the_light_is_left(comparison: Comparison) -> None:
    light, dark = (str(shown(floor_figure(comparison), dark)) for dark in (False, True))
    assert "#0072B2" in light
    assert "#0072B2" not in dark
    assert "#56B4E9" in dark


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
