# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Any 64 bits may come as a number: what is let in is a pose and a covariance, in any units."""

from __future__ import annotations

import math
import sys
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

pytest.importorskip("rclpy")

from geometry_msgs.msg import Quaternion

from test.ros.messages import PLANE
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.ros import planar

BLOCKS = arrays.arrays(np.float64, (3, 3), elements=st.floats())
SCALES = arrays.arrays(np.float64, 3, elements=st.floats(1e-9, 1e9))
SIXES = st.tuples(*[st.floats(-1e24, 1e24)] * 6)


def whole(block: Any) -> np.ndarray:
    entries = np.zeros((6, 6))
    entries[PLANE] = block
    return entries.ravel()


def is_covariance(matrix: np.ndarray, slack: float) -> bool:
    """Of correlations, so that metres and radians weigh alike."""
    variances = matrix.diagonal()
    if not np.isfinite(matrix).all() or (variances < 0.0).any() or (matrix != matrix.T).any():
        return False
    sigma = np.sqrt(np.where(variances > 0.0, variances, 1.0))
    with np.errstate(over="ignore"):
        correlation = matrix / sigma[:, None] / sigma
    return bool(np.isfinite(correlation).all()) and bool(
        np.linalg.eigvalsh(correlation)[0] >= -slack
    )


@given(BLOCKS)
@example(np.diag([1e6, 1.0, -1e-4]))
@example(np.diag([1e10, -1.0, -1.0]))
@example(np.array([[1e10, 0, 0], [0, 1, 2], [0, 2, 1]]))
@example(np.array([[0, 0, 1], [0, 1, 0], [1, 0, 1]]))
@example(np.diag([1.7e308, 1.7e308, 1.7e308]))
@example(np.array([[5e-324, 1e20, 0], [1e20, 1, 0], [0, 0, 1]]))
def test_what_is_let_in_is_a_covariance(block: np.ndarray) -> None:
    try:
        covariance = planar.covariance_of(whole(block))
    except InputError:
        return
    assert is_covariance(covariance.matrix(), 1e-6)
    assert covariance.matrix().max() <= planar.LARGEST


@given(BLOCKS.filter(lambda block: bool((np.abs(block) <= 1e3).all())), SCALES)
def test_a_covariance_is_let_in_whatever_its_units(root: np.ndarray, scale: np.ndarray) -> None:
    block = (root @ root.T + 1e-6 * np.eye(3)) * scale[:, None] * scale
    if np.abs(block).max() > planar.LARGEST:
        return
    got = planar.covariance_of(whole(block)).matrix()
    np.testing.assert_allclose(got, block, rtol=1e-5, atol=1e-5 * np.abs(block).max())


@given(st.tuples(*[st.floats()] * 4), st.sampled_from([1e-3, 1.0]))
@example((0.0, 0.0, 1e200, 0.0), 1e-3)
@example((1e200, 0.0, 0.0, 0.0), 1e-3)
@example((0.0, 0.0, 5e-324, 0.0), 1.0)
def test_a_heading_comes_of_a_rotation_alone(parts: Any, slack: float) -> None:
    x, y, z, w = parts
    try:
        yaw = planar.yaw_of(Quaternion(x=x, y=y, z=z, w=w), slack)
    except InputError:
        norm = math.hypot(*parts)
        assert not 1.0 / (1.0 + slack) <= norm <= 1.0 + slack
    else:
        assert abs(yaw) <= math.pi
        assert 0.4 < math.hypot(*parts) < 2.1


@given(st.floats(-math.pi, math.pi), st.floats(0.51, 1.99))
def test_a_heading_is_that_of_the_quaternion_whatever_its_norm(yaw: float, norm: float) -> None:
    turn = Quaternion(z=norm * math.sin(0.5 * yaw), w=norm * math.cos(0.5 * yaw))
    assert math.remainder(planar.yaw_of(turn, 1.0) - yaw, 2.0 * math.pi) == pytest.approx(
        0.0, abs=1e-9
    )


@given(SIXES)
@example((-1e-8, 0.0, 1e-9, 1.0, 0.0, 0.0))
@example((1.0, 2.0, 0.0, 1.0, 0.0, 0.0))
@example((6.6e-263, 7.3e-169, 0.0, 6.6e-263, 0.0, 0.0))
@example((5e-324, 0.0, 1.0, 1.0, 1.0, 1.0))
@example((1.2e-320, 9e-321, 4e-321, 1.2e-320, -8e-321, 1e-320))
@example((1e-320, 0.0, 1e-170, 1.0, 0.0, 1.0))
def test_what_is_published_is_semi_definite_whatever_rounding_made_of_it(entries: Any) -> None:
    given_in = PoseCovariance(*entries)
    rounded = planar.rounded_up(given_in)
    assert is_covariance(rounded.matrix(), 1e-14)
    if is_covariance(given_in.matrix(), 0.0):
        expected = given_in.matrix()
        gone = expected.diagonal() < sys.float_info.min
        expected[gone], expected[:, gone] = 0.0, 0.0
        # A covariance beside variances that are 1e8 times as large is known to their rounding.
        unit = np.sqrt(expected.diagonal())
        beside = np.abs(rounded.matrix() - expected) <= 1e-15 * np.outer(unit, unit)
        close = np.isclose(rounded.matrix(), expected, rtol=1e-9, atol=5e-324)
        assert (close | beside).all()


@given(BLOCKS, SCALES)
def test_the_short_way_lets_in_what_the_long_way_does(block: np.ndarray, scales: Any) -> None:
    """And both say the same of it: made of any numbers, so that covariances are among them."""
    with np.errstate(all="ignore"):
        product = (block @ block.T) * scales * scales[:, None]
    entries = whole(0.5 * (product + product.T))
    short = planar._plainly_sound(entries.tolist())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(planar, "_plainly_sound", lambda _: None)
        try:
            long = planar.covariance_of(entries)
        except InputError:
            assert short is None
        else:
            assert short in (None, long)


def test_an_ordinary_covariance_goes_the_short_way() -> None:
    entries = whole(np.array([[4e-4, 1e-4, 2e-4], [1e-4, 3e-4, -1e-4], [2e-4, -1e-4, 5e-4]]))
    assert planar._plainly_sound(entries.tolist()) is not None
    entries[1] = 2e-4  # as sent by nobody: the other entry differs
    assert planar._plainly_sound(entries.tolist()) is None
