# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Several wheels as one counter; no ROS here."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("rclpy")

from werrimbi_odom.files.bag_joints import side_counts
from werrimbi_odom.ros.wheel_side import WheelSide

STEPS = st.lists(
    st.tuples(st.integers(-90, 90), st.integers(-3, 3), st.sampled_from("....fra")), max_size=60
)
"""What both wheels roll, how much more the second, and which of them restart, if any."""


@given(steps=STEPS, bits=st.sampled_from([0, 10]), start=st.integers(-400, 400))
def test_live_is_as_recorded(steps: list[tuple[int, int, str]], bits: int, start: int) -> None:
    counts = [np.array([start, -start], dtype=np.float64)]
    for roll, more, event in steps:
        new = counts[-1] + (roll, roll + more)
        if event in "fa":
            new[0] = 0.0
        if event in "ra":
            new[1] = 0.0
        if bits:
            new = (new + 2 ** (bits - 1)) % 2**bits - 2 ** (bits - 1)
        counts.append(new)
    recorded = side_counts(np.array(counts), 100.0, bits)
    side = WheelSide(1.0, 100.0, bits)
    live = [side.count(row.tolist()) for row in counts]
    np.testing.assert_allclose(live, recorded, atol=1e-9)


def test_one_wheel_is_itself() -> None:
    assert WheelSide(2.0, 100.0).count([21.0]) == 42.0


def test_a_wheel_that_is_not_finite_makes_the_side_so_and_is_forgotten() -> None:
    side = WheelSide(1.0, 100.0, 16)
    assert side.count([10.0, 20.0]) == 15.0
    assert math.isnan(side.count([math.inf, 20.0]))
    assert side.count([12.0, 24.0]) == 18.0
    assert (side.wraps, side.resets) == (0, 0)


def test_what_happened_is_counted() -> None:
    side = WheelSide(1.0, 100.0, 16)
    side.count([32_760.0, 5000.0])
    assert side.count([-32_760.0, 5016.0]) == 0.5 * (32_760 + 5000) + 16
    assert (side.wraps, side.resets) == (1, 0)
    assert side.count([-32_744.0, 7.0]) == 0.5 * (32_760 + 5000) + 32
    assert (side.wraps, side.resets) == (1, 1)
