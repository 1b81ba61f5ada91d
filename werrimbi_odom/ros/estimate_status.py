# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The estimate and its uncertainty as text, for `ros2 topic echo`."""

from __future__ import annotations

import math

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue

from werrimbi_odom.model.covariance import PoseCovariance, sigmas_along_and_across
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pose import Pose, wrap


def status_of(
    name: str,
    pose: Pose,
    covariance: PoseCovariance[float],
    piece: Piece,
    distance: float,
    mean_shift: tuple[float, float] | None = None,
) -> DiagnosticStatus:
    """Create a status message from the estimate.

    Parameters
    ----------
    name : str
        Name of the status.
    pose, covariance
        Present pose in the odometry frame.
    piece : Piece
        The open piece.
    distance : float
        Travel since the start [m].
    mean_shift : (float, float), optional
        Mean of the true position minus the pose, with exact moments [m].
    """
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
    return DiagnosticStatus(
        level=DiagnosticStatus.OK,
        name=name,
        message=f"{piece_in_words(piece)}; {distance:.2f} m driven; 1 sigma "
        f"{values['1 sigma along']} along, {values['1 sigma across']} across, "
        f"{values['1 sigma heading']}",
        hardware_id="wheel encoders",
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )


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
