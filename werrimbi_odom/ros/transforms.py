# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Broadcasts transforms on /tf, where tf2_ros is installed."""

from __future__ import annotations

from collections.abc import Callable

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node

from werrimbi_odom.errors import InputError

SendTransform = Callable[[TransformStamped], None]


def transform_sender(node: Node, parameter: str) -> SendTransform:
    """Create a function that broadcasts a transform.

    Raises
    ------
    InputError
        If tf2_ros is not installed; `parameter` is the one that requests it.
    """
    try:
        from tf2_ros import TransformBroadcaster
    except ImportError as error:
        raise InputError(
            f"{parameter} needs tf2_ros, which is not installed here: install the package "
            f"ros-jazzy-tf2-ros-py, or set {parameter}: false"
            + (" and let an EKF broadcast" if parameter == "enable_odom_tf" else "")
        ) from error
    sender: SendTransform = TransformBroadcaster(node).sendTransform
    return sender
