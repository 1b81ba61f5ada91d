# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A part's legs are the legs whose figures stand beside it."""

from __future__ import annotations

import numpy as np
import pytest

from test.workbench.session import written
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_file import read_robot_file
from werrimbi_odom.inference.comparison.compare import Comparison, compare
from werrimbi_odom.workbench import drawings
from werrimbi_odom.workbench.drawings import classes_of, floor_figure, shown
from werrimbi_odom.workbench.parts import (
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
