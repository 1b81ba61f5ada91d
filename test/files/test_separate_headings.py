# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference.csv with headings oftener than positions, as of a gyro beside a tracker."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from werrimbi_odom.files.references.separate_headings import one_kind_of_row
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.inference.comparison.residuals import measured_alike
from werrimbi_odom.model.pose import Floats, wrap_all

SECONDS = np.arange(0.0, 40.0, 0.05)
"""Of headings [s]."""


def course(time: Floats) -> tuple[Floats, Floats, Floats]:
    """A circle of 1 m at 0.2 rad/s: it passes the heading of pi."""
    turned = 0.2 * time
    return np.sin(turned), 1.0 - np.cos(turned), wrap_all(turned)


def reference(where: np.ndarray, stamps: Floats = SECONDS) -> Reference:
    """Headings at all stamps, positions where it is said."""
    x, y, yaw = course(stamps)
    return Reference(stamps, np.where(where, x, np.nan), np.where(where, y, np.nan), yaw)


def test_positions_in_every_fourth_row_of_headings_are_poses() -> None:
    every_fourth = np.arange(SECONDS.size) % 4 == 0
    found, words = one_kind_of_row(reference(every_fourth))
    assert found.has_position.all()
    assert found.has_yaw.all()
    assert found.time == pytest.approx(SECONDS[::4])
    assert "positions stand in 200 of its 800 rows" in words


def test_a_position_between_two_headings_gets_the_heading_between_them() -> None:
    between = SECONDS[2::5] + 0.02
    stamps = np.sort(np.concatenate([SECONDS, between]))
    x, y, yaw = course(stamps)
    place = np.isin(stamps, between)
    mixed = Reference(
        stamps,
        np.where(place, x, np.nan),
        np.where(place, y, np.nan),
        np.where(place, np.nan, yaw),
    )
    found, _ = one_kind_of_row(mixed)
    assert found.time == pytest.approx(between)
    assert wrap_all(found.yaw - course(between)[2]) == pytest.approx(0.0, abs=1e-9)


def test_no_heading_is_made_up_where_none_was_measured_for_a_second() -> None:
    every_fourth = np.arange(SECONDS.size) % 4 == 0
    silent = (SECONDS > 10.0) & (SECONDS < 11.0)
    whole = reference(every_fourth)
    found, words = one_kind_of_row(
        Reference(whole.time, whole.x, whole.y, np.where(silent, np.nan, whole.yaw))
    )
    lacking = (found.time > 10.0) & (found.time < 11.0)
    assert not found.has_yaw[lacking].any()
    assert found.has_yaw[~lacking].all()
    assert f"(but {lacking.sum()}, where none is near)" in words


def test_a_tape_at_both_ends_leaves_the_headings_between() -> None:
    ends = np.isin(np.arange(SECONDS.size), [0, SECONDS.size - 1])
    found, words = one_kind_of_row(reference(ends))
    assert not found.has_position.any()
    assert found.has_yaw.all()
    assert "the headings alone are judged" in words


@pytest.mark.parametrize("share", [1, 2])
def test_rows_that_are_mostly_poses_stay_as_they_are(share: int) -> None:
    given = reference(np.arange(SECONDS.size) % share == 0)
    assert one_kind_of_row(given) == (given, "")


def test_a_compass_every_second_does_not_make_poses_of_positions_ten_times_a_second() -> None:
    x, y, yaw = course(SECONDS)
    seldom = np.arange(SECONDS.size) % 20 == 0
    given = Reference(SECONDS, x, y, np.where(seldom, yaw, np.nan))
    assert one_kind_of_row(given) == (given, "")


def test_what_is_judged_by_headings_keeps_no_position() -> None:
    """A few positions among headings would predict some legs and not others."""
    given = reference(np.arange(SECONDS.size) % 4 == 0)
    counts = np.arange(SECONDS.size)
    judged, measure = measured_alike(
        Run("run", Path("run"), Ticks(SECONDS, counts, counts, {}), given)
    )
    assert measure == "heading"
    assert judged.reference is not None
    assert not judged.reference.has_position.any()
