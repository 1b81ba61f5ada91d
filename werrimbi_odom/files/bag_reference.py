# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A reference from the messages of a bag: poses, transforms, or a gyro integrated to yaw."""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bag import Message, Topic, stamp_of, topic_in_words
from werrimbi_odom.files.robot_file import RobotFile
from werrimbi_odom.files.run import Reference
from werrimbi_odom.model.pose import Floats

NONE = "none"
"""Said instead of a topic: use no reference."""
NAN = math.nan
STATIC = "/tf_static"


class ReferenceSource(NamedTuple):
    """The topic that holds a run's reference."""

    topic: str
    kind: str
    child: str
    """Frame that the reference is about, among those of a transform topic; "" to find it."""


class _Row(NamedTuple):
    frames: tuple[str, str]
    """Parent and child."""
    values: tuple[float, float, float, float, float, float]
    """Stamp, x, y, yaw, and the two sigmas."""


def choose_reference(
    path: Path, topics: Sequence[Topic], wish: str | None
) -> ReferenceSource | None:
    """The topic that is wished for, or the only one there is; None where there is none.

    Parameters
    ----------
    wish : str, optional
        TOPIC, TOPIC:CHILD_FRAME, or `none`.

    Raises
    ------
    InputError
        When the wish is not there, or there are several; the message lists them.
    """
    candidates = [each for each in topics if each.kind in _ROWS and each.name != STATIC]
    listed = ", ".join(map(topic_in_words, candidates)) or "none"
    if wish == NONE:
        return None
    if wish is not None:
        name, _, child = wish.partition(":")
        name = "/" + name.strip("/")
        for each in topics:
            if each.name == name and each.kind in _ROWS:
                return ReferenceSource(name, each.kind, child)
        raise InputError(f"{path}: there is no reference in {name}; candidates are: {listed}")
    if len(candidates) > 1:
        raise InputError(
            f"{path}: choose with --reference-topic ({NONE} for no reference); "
            f"candidates are: {listed}"
        )
    return ReferenceSource(*candidates[0][:2], "") if candidates else None


def kinds_in_words() -> str:
    """Message types that can be a reference."""
    names = sorted(kind.rpartition("/")[2] for kind in _ROWS)
    return f"{', '.join(names[:-1])} or {names[-1]}"


class ReferenceCollector:
    """Takes messages, one at a time, and gives the reference at the end."""

    def __init__(self, path: Path, source: ReferenceSource, robot_file: RobotFile) -> None:
        self._place = f"{path}: {source.topic}"
        self._source = source
        self._base = str(robot_file.values["base_frame_id"])
        self._rows = _ROWS[source.kind]
        self._found: dict[tuple[str, str], array[float]] = {}

    def take(self, message: Message) -> None:
        """Take a message of the source's topic."""
        for row in self._rows(message):
            self._found.setdefault(row.frames, array("d")).extend(row.values)

    def reference(self) -> tuple[Reference, str]:
        """The reference, and in words the frames it is about.

        Raises
        ------
        InputError
            When nothing was measured, or several frames are there and none is named.
        """
        parent, child = self._frames()
        table = np.array(self._found[parent, child]).reshape(-1, 6)
        if self._source.kind == IMU:
            table[:, 3] = _integrated(table[:, 0], table[:, 3])
        time, x, y, yaw, sigma_xy, sigma_yaw = table.T.copy()
        if not (np.isfinite(yaw) | np.isfinite(x + y)).any():
            raise InputError(f"{self._place}: no message holds a finite pose")
        sigmas = (each if np.isfinite(each).any() else None for each in (sigma_xy, sigma_yaw))
        told = f"{parent} -> {child}" if parent and child else f"frame {parent or child}"
        return Reference(time, x, y, yaw, *sigmas), told

    def _frames(self) -> tuple[str, str]:
        wished = self._source.child
        pairs = [pair for pair in self._found if not wished or pair[1] == wished.strip("/")]
        if len(pairs) > 1:
            pairs = [pair for pair in pairs if pair[1] == self._base] or pairs
        if len(pairs) == 1:
            return pairs[0]
        listed = ", ".join(f"{parent} -> {child}" for parent, child in self._found) or "none"
        raise InputError(
            f"{self._place}: name the frame with --reference-topic "
            f"{self._source.topic}:CHILD_FRAME; it has: {listed}"
        )


def _yaw(q: Any) -> float:
    """Heading of a quaternion; NaN where it is none."""
    squared = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w
    if not 0.5 < squared < 2.0:  # not a rotation: (0, 0, 0, 0) says that nothing was measured
        return NAN
    return math.atan2(2.0 * (q.w * q.z + q.x * q.y), squared - 2.0 * (q.y * q.y + q.z * q.z))


def planar(point: Any, orientation: Any) -> tuple[float, float, float]:
    """Pose on the floor; NaN where a part of it is not finite."""
    x, y = float(point.x), float(point.y)
    if not (math.isfinite(x) and math.isfinite(y)):
        x = y = NAN
    return x, y, _yaw(orientation)


def _of_pose(message: Message) -> Iterator[_Row]:
    pose, frame = message.content.pose, message.content.header.frame_id
    measured = planar(pose.position, pose.orientation)
    yield _Row((frame.strip("/"), ""), (stamp_of(message), *measured, NAN, NAN))


def _of_odometry(message: Message) -> Iterator[_Row]:
    """Its covariance is left alone: it grows along the way, and says nothing of a single pose."""
    content = message.content
    frames = (content.header.frame_id.strip("/"), content.child_frame_id.strip("/"))
    measured = planar(content.pose.pose.position, content.pose.pose.orientation)
    yield _Row(frames, (stamp_of(message), *measured, NAN, NAN))


def _of_pose_with_covariance(message: Message) -> Iterator[_Row]:
    stamped = message.content.pose
    measured = planar(stamped.pose.position, stamped.pose.orientation)
    xx, yy, yawyaw = (float(stamped.covariance[place]) for place in (0, 7, 35))
    sigmas = _deviation(0.5 * (xx + yy)), _deviation(yawyaw)
    frame = message.content.header.frame_id.strip("/")
    yield _Row((frame, ""), (stamp_of(message), *measured, *sigmas))


def _deviation(variance: float) -> float:
    """Zero is how a publisher says that it does not know."""
    return math.sqrt(variance) if 0.0 < variance < math.inf else NAN


def _of_transform(message: Message) -> Iterator[_Row]:
    yield _transform(message, message.content)


def _of_transforms(message: Message) -> Iterator[_Row]:
    for content in message.content.transforms:
        yield _transform(message, content)


def _transform(message: Message, content: Any) -> _Row:
    frames = (content.header.frame_id.strip("/"), content.child_frame_id.strip("/"))
    measured = planar(content.transform.translation, content.transform.rotation)
    return _Row(frames, (stamp_of(message, content), *measured, NAN, NAN))


def _of_imu(message: Message) -> Iterator[_Row]:
    """The yaw rate stands in the yaw's place until all are there to be integrated."""
    rate = float(message.content.angular_velocity.z)
    unknown = float(message.content.angular_velocity_covariance[0]) == -1.0
    if not unknown and math.isfinite(rate):
        frame = message.content.header.frame_id.strip("/")
        yield _Row(("", frame), (stamp_of(message), NAN, NAN, rate, NAN, NAN))


def _integrated(time: Floats, rate: Floats) -> Floats:
    """Yaw from a yaw rate, by trapezia; stamps that do not go forward add nothing."""
    latest = np.maximum.accumulate(time)
    turns = 0.5 * (rate[1:] + rate[:-1]) * np.diff(latest)
    return np.concatenate([[0.0], np.cumsum(turns)])


IMU = "sensor_msgs/msg/Imu"
_ROWS: dict[str, Callable[[Message], Iterator[_Row]]] = {
    "nav_msgs/msg/Odometry": _of_odometry,
    "geometry_msgs/msg/PoseStamped": _of_pose,
    "geometry_msgs/msg/PoseWithCovarianceStamped": _of_pose_with_covariance,
    "geometry_msgs/msg/TransformStamped": _of_transform,
    "tf2_msgs/msg/TFMessage": _of_transforms,
    IMU: _of_imu,
}
