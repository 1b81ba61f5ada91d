# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What plain driving leaves open is driven on by the robot itself, and then named, and right."""

from __future__ import annotations

from itertools import islice

import pytest

pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

from test.driving.closing import cases, closed, table


@pytest.mark.evidence
def test_a_point_that_is_off_the_axle_is_told_from_a_late_clock_by_one_drive() -> None:
    found = closed("reference_lever_arm", "circle", "poses", 7001)
    assert found.verdicts == ("ambiguous", "named")
    assert found.driven in (("arcs",), ("spins",))  # at one speed on one circle they were alike
    assert found.right


@pytest.mark.evidence
def test_positions_of_a_point_far_off_the_axle_hold_it_after_spins() -> None:
    found = closed("reference_lever_arm", "circle", "positions", 20261124)
    assert found.verdicts == ("ambiguous", "named")
    assert found.right


@pytest.mark.evidence
def test_what_is_left_open_is_closed() -> None:
    found = list(islice(cases(7001), 70))
    print(table(found))
    left_open = [each for each in found if each.open_at_first]
    assert len(left_open) >= 5
    closed_since = [each for each in left_open if each.right or each.twins]
    assert len(closed_since) >= 0.95 * len(left_open)
