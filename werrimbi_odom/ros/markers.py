# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Pieces as markers for RViz: exact arcs in three colours, with their error ellipses."""

from __future__ import annotations

import math
from collections import deque
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pieces import Piece
from werrimbi_odom.model.pose import Pose

KEPT = 200
"""Pieces on display; each further one deletes the oldest."""

# Blue, orange and reddish purple of Okabe and Ito, distinguishable with any colour vision.
COLOURS = {"line": (0.0, 0.447, 0.698), "arc": (0.902, 0.624, 0.0), "spin": (0.8, 0.475, 0.655)}

_SIGMAS_95 = math.sqrt(-2.0 * math.log(0.05))  # of a normal vector in the plane
_CHORD = 0.1  # rad: angle between the points of an arc ...
_MOST_POINTS = 128  # ... but at most this many points
_FLAT = 1e-3  # m: thickness of an ellipse, and the smallest width that RViz draws


class PieceTrail:
    """The last pieces, and the messages that show them.

    A piece's path is in the namespace of its kind, its ellipse in "line ellipse" and so on, so that
    RViz can show and hide them by kind. Both have the piece's number. The open piece is in "open"
    and "open ellipse". The wheel separation `track` [m] is the size of a spin, which has no radius.
    """

    def __init__(self, frame: str, track: float) -> None:
        self._frame = frame
        self.track = track
        self._number = 0
        self._kept: deque[tuple[int, Piece, PoseCovariance[float]]] = deque()

    def __len__(self) -> int:
        return len(self._kept)

    def clear(self) -> None:
        """Delete all pieces; numbering continues."""
        self._kept.clear()

    def add(
        self, stamp: Stamp, piece: Piece, covariance: PoseCovariance[float], shown: bool
    ) -> MarkerArray | None:
        """Store a finished piece, and the covariance of the pose at its end.

        Returns the message to publish; None if `shown` is false.
        """
        oldest = self._kept.popleft() if len(self._kept) == KEPT else None
        self._kept.append((self._number, piece, covariance))
        self._number += 1
        if not shown:
            return None
        markers = self._markers(stamp, piece.kind, *self._kept[-1])
        if oldest is not None:
            number, old, _ = oldest
            markers += [
                self._marker(stamp, namespace, number, action=Marker.DELETE)
                for namespace in (old.kind, f"{old.kind} ellipse")
            ]
        return MarkerArray(markers=markers)

    def unfinished(
        self, stamp: Stamp, piece: Piece, covariance: PoseCovariance[float]
    ) -> MarkerArray:
        """The open piece; each message replaces the last."""
        return MarkerArray(markers=self._markers(stamp, "open", 0, piece, covariance))

    def everything(self, stamp: Stamp) -> MarkerArray:
        """All stored pieces; everything displayed before is deleted."""
        markers = [self._marker(stamp, "", 0, action=Marker.DELETEALL)]
        for number, piece, covariance in self._kept:
            markers += self._markers(stamp, piece.kind, number, piece, covariance)
        return MarkerArray(markers=markers)

    def _markers(
        self,
        stamp: Stamp,
        namespace: str,
        number: int,
        piece: Piece,
        covariance: PoseCovariance[float],
    ) -> list[Marker]:
        path = self._marker(stamp, namespace, number, type=Marker.LINE_STRIP)
        path.pose.orientation.w = 1.0
        path.scale.x = 0.05 * self.track
        path.color = _colour(piece, alpha=1.0)
        path.points = [Point(x=x, y=y, z=0.0) for x, y in path_points(piece, self.track)]
        ellipse = self._marker(stamp, f"{namespace} ellipse", number, type=Marker.CYLINDER)
        end = end_of(piece)
        major, minor, angle = ellipse_95(covariance)
        ellipse.pose.position.x, ellipse.pose.position.y = end.x, end.y
        ellipse.pose.orientation.z = math.sin(0.5 * angle)
        ellipse.pose.orientation.w = math.cos(0.5 * angle)
        ellipse.scale.x, ellipse.scale.y = max(2.0 * major, _FLAT), max(2.0 * minor, _FLAT)
        ellipse.scale.z = _FLAT
        ellipse.color = _colour(piece, alpha=0.25)
        return [path, ellipse]

    def _marker(self, stamp: Stamp, namespace: str, number: int, **fields: Any) -> Marker:
        marker = Marker(ns=namespace, id=number, **fields)
        marker.header.frame_id = self._frame
        marker.header.stamp = stamp
        return marker


def path_points(piece: Piece, track: float) -> list[tuple[float, float]]:
    """Points on the path of the axle's midpoint; for a spin, on that of the right wheel."""
    turn = math.copysign(min(abs(piece.turn), 2.0 * math.pi), piece.turn)
    if piece.kind == "spin":
        radius, start = 0.5 * track, piece.start.yaw - 0.5 * math.pi
        return [
            (piece.start.x + radius * math.cos(angle), piece.start.y + radius * math.sin(angle))
            for angle in (start + share * turn for share in _shares(turn))
        ]
    points = []
    for share in _shares(piece.turn):
        along, sideways, angle = (share * part for part in piece.motion)
        dx, dy = displacement(BodyMotion(along, sideways, angle), piece.start.yaw)
        points.append((piece.start.x + dx, piece.start.y + dy))
    return points


def end_of(piece: Piece) -> Pose:
    """Pose at the end of a piece."""
    dx, dy = displacement(piece.motion, piece.start.yaw)
    return Pose(piece.start.x + dx, piece.start.y + dy, piece.start.yaw + piece.turn)


def ellipse_95(covariance: PoseCovariance[float]) -> tuple[float, float, float]:
    """Semi-axes [m] of the 95 % ellipse of the position, and the angle of the first."""
    middle = 0.5 * (covariance.xx + covariance.yy)
    half = 0.5 * (covariance.xx - covariance.yy)
    spread = math.hypot(half, covariance.xy)
    major = _SIGMAS_95 * math.sqrt(max(middle + spread, 0.0))
    minor = _SIGMAS_95 * math.sqrt(max(middle - spread, 0.0))
    return major, minor, 0.5 * math.atan2(covariance.xy, half)


def _shares(turn: float) -> list[float]:
    count = min(1 + math.ceil(abs(turn) / _CHORD), _MOST_POINTS)
    return [index / count for index in range(count + 1)]


def _colour(piece: Piece, alpha: float) -> ColorRGBA:
    red, green, blue = COLOURS[piece.kind]
    return ColorRGBA(r=red, g=green, b=blue, a=alpha)
