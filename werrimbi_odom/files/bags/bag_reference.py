# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference from the messages of a bag: poses, transforms, fixes, or an integrated gyro."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, stamp_of
from werrimbi_odom.files.bags.bag_contents import FIX, IMU, SCAN
from werrimbi_odom.files.bags.frames import frame
from werrimbi_odom.files.bags.measured_topic import Measured
from werrimbi_odom.files.bags.own_odometry import is_map
from werrimbi_odom.files.bags.reference_choice import NONE
from werrimbi_odom.files.bags.stamps import newest_of_bursts
from werrimbi_odom.files.references.gyro import yaw_rate
from werrimbi_odom.files.references.levelled import levelled
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import Collected, Reference, ReferenceKind, integrated
from werrimbi_odom.model.pose import Floats

NAN = math.nan


LOCALISED = "geometry_msgs/msg/PoseWithCovarianceStamped"
"""Message type of localisers."""
UNKNOWN_PLACE, UNKNOWN_TURN = 1e3, math.pi**2
"""Variances [m^2, rad^2] from which they stand for "unknown" (1e6, 99999, 1000): 32 m, or half a
turn, is the noise of no reference by which legs can be judged."""

_Sigmas = tuple[float, float]


class _Row(NamedTuple):
    frames: tuple[str, str]
    """Parent and child frame."""
    values: tuple[float, float, float, float, float, float]
    """Stamp, x, y, yaw, and the two sigmas."""
    solid: tuple[float, ...] = ()
    """x, y, z and a quaternion x, y, z, w, of poses in space."""


def kinds_in_words() -> str:
    """Message types that can be a reference."""
    names = sorted({kind.rpartition("/")[2] for kind in (*_ROWS, SCAN, "tf2_msgs/msg/TFMessage")})
    return f"{', '.join(names[:-1])} or {names[-1]}"


class ReferenceCollector:
    """Collects messages, and computes the reference at the end."""

    def __init__(
        self, path: Path, source: Measured, robot_file: RobotFile, child: str = ""
    ) -> None:
        """`child` is the frame of interest, if messages contain several."""
        self._place = f"{path}: {source.name}"
        self._child = child
        self.topics = (source.name,)
        self._source = source
        self._base = str(robot_file.values["base_frame_id"])
        self._rows = _ROWS[source.kind]
        self._found: dict[tuple[str, str], array[float]] = {}
        self._solid: dict[tuple[str, str], array[float]] = {}
        self._forces: dict[str, array[float]] = {}  # by frame

    def take(self, message: BagMessage) -> None:
        """Add a message of the source's topic."""
        if self._source.kind == IMU and message.content.linear_acceleration_covariance[0] != -1.0:
            force = message.content.linear_acceleration
            name = frame(message.content.header.frame_id)
            forces = self._forces.setdefault(name, array("d"))
            forces.extend((float(force.x), float(force.y), float(force.z)))
        if (row := self._rows(message)) is not None:
            self._found.setdefault(row.frames, array("d")).extend(row.values)
            self._solid.setdefault(row.frames, array("d")).extend(row.solid)

    def reference(self) -> Collected:
        """The reference, and its frames in words.

        InputError if nothing was measured, or there are several frames and none is named.
        """
        parent, child = self._frames()
        table, mounted = np.array(self._found[parent, child]).reshape(-1, 6), ""
        if self._source.kind == IMU:
            forces = np.array(self._forces.get(child, array("d"))).reshape(-1, 3)
            rate, mounted = yaw_rate(table[:, 1:4], forces)
            table[:, 1:3], table[:, 3] = NAN, integrated(table[:, 0], rate)
        if self._source.kind == FIX:
            table[:, 1], table[:, 2] = east_and_north(self._place, *table[:, 1:4].T)
            table[:, 3] = NAN
        solid = np.array(self._solid[parent, child]).reshape(-1, 7)
        if on_plane := levelled(solid[:, :3], solid[:, 3:]):
            table[:, 1], table[:, 2], table[:, 3], mounted = on_plane
        newest, left_out = newest_of_bursts(table[:, 0])
        time, x, y, yaw, sigma_xy, sigma_yaw = table[newest].T.copy()
        if not (np.isfinite(yaw) | np.isfinite(x + y)).any():
            raise InputError(f"{self._place}: no message holds a finite pose")
        sigmas = (each if np.isfinite(each).any() else None for each in (sigma_xy, sigma_yaw))
        told = (
            f"{parent} -> {child}" if parent and child else f"frame {parent or child or 'unnamed'}"
        )
        told = f"{told}, {mounted}" if mounted else told
        told = f"{told}; {left_out}" if left_out else told
        kind: ReferenceKind | None = "incremental" if self._source.kind == IMU else None
        if self._source.kind == LOCALISED and is_map(parent):
            kind = "local_map"  # AMCL, SLAM: their errors drift
        if self._source.kind == FIX:
            kind = "local_map"  # atmosphere and multipath: errors persist for a minute
        return Collected(Reference(time, x, y, yaw, *sigmas, kind=kind), told)

    def _frames(self) -> tuple[str, str]:
        wished = self._child
        pairs = [pair for pair in self._found if not wished or pair[1] == wished]
        if len(pairs) > 1:
            pairs = [pair for pair in pairs if pair[1] == self._base] or pairs
        if len(pairs) == 1:
            return pairs[0]
        if not self._found and self._source.kind == IMU:
            raise InputError(
                f"{self._place}: no message holds a yaw rate: angular_velocity_covariance[0] is "
                "-1, which states that there is none, or angular_velocity.z is no number; choose "
                f"another with --reference-topic ({NONE} for no reference)"
            )
        listed = ", ".join(f"{parent} -> {child}" for parent, child in self._found) or "none"
        raise InputError(
            f"{self._place}: name the frame with --reference-topic "
            f"{self._source.name}:CHILD_FRAME; it has: {listed}"
        )


def _yaw(q: Any) -> float:
    """Yaw of a quaternion; NaN if it is invalid."""
    squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if not 0.5 < squared < 2.0:  # not a rotation: (0, 0, 0, 0) marks a missing measurement
        return NAN
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), squared - 2.0 * (q.y * q.y + q.z * q.z))


def planar(point: Any, orientation: Any) -> tuple[float, float, float]:
    """Pose on the floor; NaN where a component is not finite."""
    x, y = float(point.x), float(point.y)
    if not (math.isfinite(x) and math.isfinite(y)):
        x = y = NAN
    return x, y, _yaw(orientation)


def _solid(point: Any, q: Any) -> tuple[float, ...]:
    return tuple(float(each) for each in (point.x, point.y, point.z, q.x, q.y, q.z, q.w))


def _in_space(
    message: BagMessage, where: Any, turn: Any, child: str = "", sigmas: _Sigmas = (NAN, NAN)
) -> _Row:
    frames = frame(message.content.header.frame_id), frame(child)
    values = stamp_of(message), *planar(where, turn), *sigmas
    return _Row(frames, values, _solid(where, turn))


def _of_pose(message: BagMessage) -> _Row:
    pose = message.content.pose
    return _in_space(message, pose.position, pose.orientation)


def _of_plane_pose(message: BagMessage) -> _Row:
    """Motion capture and scan matchers publish it; it has no stamp and no frame."""
    pose = message.content
    x, y, yaw = (float(each) for each in (pose.x, pose.y, pose.theta))
    if not (math.isfinite(x) and math.isfinite(y)):
        x = y = NAN
    return _Row(("", ""), (message.received / 1e9, x, y, yaw, NAN, NAN))


def _of_odometry(message: BagMessage) -> _Row:
    """The covariance is ignored: it grows along the path and does not describe a single pose."""
    content, pose = message.content, message.content.pose.pose
    return _in_space(message, pose.position, pose.orientation, content.child_frame_id)


def _of_pose_with_covariance(message: BagMessage) -> _Row:
    pose, covariance = message.content.pose.pose, message.content.pose.covariance
    xx, yy, yawyaw = (float(covariance[place]) for place in (0, 7, 35))
    sigmas = _deviation(0.5 * (xx + yy)), _deviation(yawyaw, UNKNOWN_TURN)
    return _in_space(message, pose.position, pose.orientation, sigmas=sigmas)


def _deviation(variance: float, unknown: float = UNKNOWN_PLACE) -> float:
    """Standard deviation of a variance; publishers write zero, or a huge one, for unknown."""
    return math.sqrt(variance) if 0.0 < variance < unknown else NAN


def _of_transform(message: BagMessage) -> _Row:
    content, pose = message.content, message.content.transform
    return _in_space(message, pose.translation, pose.rotation, content.child_frame_id)


def _of_imu(message: BagMessage) -> _Row | None:
    """Rates about x, y and z take the place of a pose until the vertical is known."""
    turning = message.content.angular_velocity
    # Single-axis gyros leave the other axes empty.
    x, y = (each if math.isfinite(each) else 0.0 for each in (float(turning.x), float(turning.y)))
    rates = x, y, float(turning.z)
    unknown = float(message.content.angular_velocity_covariance[0]) == -1.0
    if unknown or not math.isfinite(rates[2]):
        return None
    name = frame(message.content.header.frame_id)
    return _Row(("", name), (stamp_of(message), *rates, NAN, NAN))


def _of_point(message: BagMessage) -> _Row:
    point = message.content.point
    x, y = float(point.x), float(point.y)
    name = frame(message.content.header.frame_id)
    return _Row((name, ""), (stamp_of(message), x, y, NAN, NAN, NAN))


def _of_fix(message: BagMessage) -> _Row:
    """Degrees and altitude take the place of a pose until the first fix is known."""
    content = message.content
    degrees = float(content.latitude), float(content.longitude)
    # STATUS_NO_FIX; or zeros, which drivers send without a fix and with the status of one.
    if content.status.status < 0 or degrees == (0.0, 0.0):
        degrees = NAN, NAN
    east, north = (float(content.position_covariance[place]) for place in (0, 4))
    sigma = _deviation(0.5 * (east + north)) if content.position_covariance_type > 0 else NAN
    name = frame(content.header.frame_id)
    return _Row(("", name), (stamp_of(message), *degrees, float(content.altitude), sigma, NAN))


_ROWS: dict[str, Callable[[BagMessage], _Row | None]] = {
    "nav_msgs/msg/Odometry": _of_odometry,
    "geometry_msgs/msg/PoseStamped": _of_pose,
    "geometry_msgs/msg/Pose2D": _of_plane_pose,
    LOCALISED: _of_pose_with_covariance,
    "geometry_msgs/msg/TransformStamped": _of_transform,
    "geometry_msgs/msg/PointStamped": _of_point,
    FIX: _of_fix,
    IMU: _of_imu,
}


def east_and_north(
    place: str, latitude: Floats, longitude: Floats, altitude: Floats
) -> tuple[Floats, Floats]:
    """Project to metres east and north of the first fix, in the tangent plane of the ellipsoid.

    `place`: location of the data, for error messages. `latitude`, `longitude`, `altitude` (n,): WGS
    84 [degrees, degrees, m]; NaN without a fix. If only the altitude is NaN, the first known
    altitude is used. InputError if pyproj is not installed.
    """
    fixed = np.isfinite(latitude) & np.isfinite(longitude)
    x, y = np.full(latitude.size, np.nan), np.full(latitude.size, np.nan)
    if not fixed.any():
        return x, y
    try:
        from pyproj import Transformer
    except ModuleNotFoundError as missing:
        raise InputError(
            f"{place}: fixes of satellites are projected by the Python package {missing.name}: "
            'pip install "werrimbi_odom[gps]"'
        ) from missing
    known = altitude[fixed & np.isfinite(altitude)]
    level = float(known[0]) if known.size else 0.0
    first = int(np.flatnonzero(fixed)[0])
    origin = (float(latitude[first]), float(longitude[first]), level)
    plane = Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad "
        "+step +proj=cart +ellps=WGS84 "
        "+step +proj=topocentric +ellps=WGS84 +lat_0={!r} +lon_0={!r} +h_0={!r}".format(*origin)
    )
    height = np.full(latitude.size, level)  # a wheeled robot's path is measured on the floor
    x[fixed], y[fixed], _ = plane.transform(longitude[fixed], latitude[fixed], height[fixed])
    return x, y
