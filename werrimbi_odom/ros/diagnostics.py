# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Status messages for /diagnostics and the log."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from werrimbi_odom.ros.topics import publisher


def diagnostic(
    level: bytes, name: str, words: str, values: Mapping[str, object], of: str = "wheel encoders"
) -> DiagnosticStatus:
    """Create a status; `of` is the hardware."""
    return DiagnosticStatus(
        level=level,
        name=name,
        message=words,
        hardware_id=of,
        values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
    )


def diagnostics_publisher(node: Node) -> Callable[..., None]:
    """Create a publisher of /diagnostics: a function of statuses, which it stamps by the clock."""
    out = publisher(node, DiagnosticArray, "/diagnostics")

    def publish(*statuses: DiagnosticStatus) -> None:
        array = DiagnosticArray(status=list(statuses))
        array.header.stamp = node.get_clock().now().to_msg()
        out.publish(array)

    return publish


def tell(log: Any, words: str, *, fine: bool) -> None:
    """Log a message, as a warning unless all is well.

    In two statements, because rclpy identifies a logging call by its line and severity.
    """
    if fine:
        log.info(words)
    else:
        log.warning(words)
