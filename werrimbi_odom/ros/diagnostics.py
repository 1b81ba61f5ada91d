# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Status messages for /diagnostics, /odom/status and the log."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.node import Node

from werrimbi_odom.model.covariance import sigmas_along_and_across
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pose import wrap
from werrimbi_odom.ros.live_odometer import LiveOdometer
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


def status_of(name: str, tracker: LiveOdometer) -> DiagnosticStatus:
    """Create a status message from the present estimate, which is in the odometry frame."""
    pose, odometer = tracker.pose, tracker.odometer
    covariance, piece, distance = odometer.covariance(), odometer.piece, odometer.distance
    mean_shift = odometer.errors().mean_shift
    along, across = sigmas_along_and_across(covariance, pose.yaw)
    heading = math.degrees(math.sqrt(covariance.yawyaw))
    values = {
        "piece": piece.kind,
        "piece length": f"{piece.length:.3f} m",
        "piece turn": f"{math.degrees(piece.turn):.1f} deg",
        "piece radius": "straight" if math.isinf(piece.radius) else f"{piece.radius:.3f} m",
        "distance": f"{distance:.3f} m",
        "x": f"{pose.x:.3f} m",
        "y": f"{pose.y:.3f} m",
        "heading": f"{math.degrees(wrap(pose.yaw)):.1f} deg",
        "1 sigma along": length_in_words(along),
        "1 sigma across": length_in_words(across),
        "1 sigma heading": f"{heading:.2f} deg",
    }
    if mean_shift is not None:
        x, y = mean_shift
        values["mean shift"] = f"x {1e3 * x:+.1f} mm, y {1e3 * y:+.1f} mm (not applied)"
    words = (
        f"{piece_in_words(piece)}; {distance:.2f} m driven; 1 sigma "
        f"{values['1 sigma along']} along, {values['1 sigma across']} across, "
        f"{values['1 sigma heading']}"
    )
    return diagnostic(DiagnosticStatus.OK, name, words, values)


def length_in_words(length: float) -> str:
    """A standard deviation in a convenient unit."""
    return f"{length:.3f} m" if length >= 1.0 else f"{1e3 * length:.1f} mm"


def piece_in_words(piece: Piece) -> str:
    """Describe a piece, such as "arc 1.57 m, 90.0 deg to the left"."""
    side = "left" if piece.turn >= 0.0 else "right"
    turn = f"{abs(math.degrees(piece.turn)):.1f} deg to the {side}"
    if piece.kind == "spin":
        return f"spin {turn}"
    way = "" if piece.length >= 0.0 else " backwards"
    path = f"{piece.kind} {abs(piece.length):.2f} m{way}"
    return path if piece.kind == "line" else f"{path}, {turn}"
