# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What tests read out of messages, and what they put in; parameters as ROS itself reads them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

rclpy = pytest.importorskip("rclpy")

from rclpy.context import Context  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.time import Time  # noqa: E402

PLANE = np.ix_((0, 1, 5), (0, 1, 5))
"""x, y and yaw in a matrix of 6 by 6."""


def stamp_at(seconds: float) -> Any:
    """Of a header."""
    return Time(nanoseconds=round(1e9 * seconds)).to_msg()


def seconds_of(message: Any) -> float:
    """Stamp of a message [s]."""
    stamp = message.header.stamp
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def yaw_of(pose: Any) -> float:
    """Heading of a pose [rad]."""
    return 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)


def turn(pose: Any, yaw: float) -> None:
    """Give a pose a heading [rad]."""
    pose.orientation.z, pose.orientation.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)


def values_of(status: Any) -> dict[str, str]:
    """Keys and values of a DiagnosticStatus."""
    return {item.key: item.value for item in status.values}


def matrix_of(covariance: Any) -> np.ndarray:
    """Its 36 entries, 6 by 6."""
    return np.asarray(covariance, dtype=np.float64).reshape(6, 6)


def in_plane(covariance: Any) -> np.ndarray:
    """Of x, y and yaw, 3 by 3."""
    return matrix_of(covariance)[PLANE]


def assert_covariances(odometry: Any) -> None:
    """Both of an odometry are finite, symmetric and semi-definite; metres and radians alike."""
    for covariance in (odometry.pose.covariance, odometry.twist.covariance):
        matrix = matrix_of(covariance)
        assert np.isfinite(matrix).all(), odometry
        assert (matrix == matrix.T).all(), odometry
        assert (matrix.diagonal() >= 0.0).all(), odometry
        size = np.sqrt(np.where(matrix.diagonal() > 0.0, matrix.diagonal(), 1.0))
        assert np.linalg.eigvalsh(matrix / size[:, None] / size)[0] >= -1e-14, odometry


def read_by_ros(
    name: str, arguments: list[str], domain: int | None = None
) -> tuple[str, dict[str, Any]]:
    """Namespace and parameters of a node as ROS's own reader gives them to it."""
    context = Context()
    rclpy.init(context=context, args=[], domain_id=domain)
    try:
        node = rclpy.create_node(name, context=context, cli_args=arguments)
        with node.handle:
            given = node.handle.get_parameters(Parameter)
        namespace = node.get_namespace()
        node.destroy_node()
    finally:
        rclpy.shutdown(context=context)
    return namespace, {key: each.value for key, each in given.items()}
