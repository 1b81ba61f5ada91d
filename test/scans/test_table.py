# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What is asked of matches in every case of the table of docs/scans.md, and for an hour."""

from __future__ import annotations

import math

import pytest

from test.scans.hour import hour
from test.scans.table import BRISK, CASES, ROOMS, row
from werrimbi_odom.simulation.lidar import Lidar


@pytest.mark.evidence
@pytest.mark.parametrize("name", ROOMS)
def test_the_covariance_of_matches_is_consistent_in_every_room(name: str) -> None:
    seen = row(name)
    assert 0.8 < seen.nees < 1.5
    assert 0.8 < seen.nees_of_legs < 1.5
    assert seen.none < 0.05 * seen.scans
    calm = CASES[name][0] is not BRISK
    if calm and "15 mm" not in name and "corridor" not in name:  # an ordinary lidar, in rooms
        # Fewer echoes measure worse, by the root of their number.
        echoes = (1.0 - CASES[name][2].lost) / (1.0 - Lidar().lost)
        assert max(seen.leg) < 2.5 / math.sqrt(echoes)


@pytest.mark.evidence
@pytest.mark.parametrize("name", sorted(set(CASES) - set(ROOMS)))
def test_where_nothing_holds_the_robot_there_are_no_poses(name: str) -> None:
    seen = row(name)
    assert seen.none == seen.scans


@pytest.mark.evidence
def test_an_hour_of_scans_takes_no_more_memory_than_ten_minutes() -> None:
    """A pose is kept as 14 numbers: 36,000 of them are 4 MB."""
    first, *_, last = hour()
    assert last.megabytes < first.megabytes + 12.0
    assert last.a_second > 50.0
