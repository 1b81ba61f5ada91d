# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What a wrong transform of a lidar does to the base's path, and how it is put right."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from werrimbi_odom.files.bags.bag_laser_scans import of_base
from werrimbi_odom.files.mount import Mount
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.three_pass_odometry import ScanPath

LENGTH, ANGLE = st.floats(-1.0, 1.0), st.floats(-3.0, 3.0)
POSES = st.tuples(LENGTH, LENGTH, ANGLE)
MOUNTS = st.builds(Mount, LENGTH, LENGTH, ANGLE, st.booleans())


def as_matrices(poses: Floats) -> Floats:
    """Poses (n, 3) as (n, 3, 3)."""
    x, y, yaw = poses.T
    zero, one = np.zeros(x.size), np.ones(x.size)
    rows = [[np.cos(yaw), -np.sin(yaw), x], [np.sin(yaw), np.cos(yaw), y], [zero, zero, one]]
    return np.moveaxis(np.array(rows), 2, 0)


def seen_by(mount: Mount, base: Floats) -> ScanPath:
    """Motion of a lidar that sits there, in its own axes, as the base moves."""
    flip = np.diag([1.0, -1.0 if mount.inverted else 1.0, 1.0])
    sits = as_matrices(np.array([mount[:3]]))[0] @ flip
    moved = as_matrices(base) @ sits
    own = np.linalg.inv(moved[0]) @ moved
    yaw = base[:, 2] * (-1.0 if mount.inverted else 1.0)
    poses = np.column_stack([own[:, 0, 2], own[:, 1, 2], yaw - yaw[0]])
    count = len(base)
    spread, walked = np.tile(np.eye(3), (count, 1, 1)), np.zeros((count, 2))
    whole = np.zeros(count, dtype=np.intp)
    return ScanPath(np.arange(float(count)), poses, spread, walked, whole, (1.0, 0.0), count, {})


@given(MOUNTS, POSES)
def test_told_from_its_own_place_and_back_a_mount_is_itself(
    entered: Mount, off: tuple[float, float, float]
) -> None:
    x, y, yaw = off
    back = -complex(x, y) * np.exp(-1j * yaw)
    found = entered.with_base_at(*off).with_base_at(back.real, back.imag, -yaw)
    assert found[:2] == pytest.approx(entered[:2], abs=1e-12)
    assert math.remainder(found.yaw - entered.yaw, math.tau) == pytest.approx(0.0, abs=1e-12)
    assert found[3:] == entered[3:]


@given(MOUNTS, POSES, st.lists(POSES, min_size=2, max_size=5))
def test_a_path_freed_of_a_wrong_mount_is_that_of_a_point_which_tells_the_right_one(
    entered: Mount, off: tuple[float, float, float], driven: list[tuple[float, float, float]]
) -> None:
    """As `reference_lever_arm` and `reference_yaw_offset` have it."""
    base = np.array(driven)
    freed, _, _ = of_base(seen_by(entered.with_base_at(*off), base), entered)
    point = as_matrices(base) @ as_matrices(np.array([off]))[0]
    expected = np.linalg.inv(point[0]) @ point
    measured = as_matrices(freed)
    np.testing.assert_allclose(np.linalg.inv(measured[0]) @ measured, expected, atol=1e-9)
