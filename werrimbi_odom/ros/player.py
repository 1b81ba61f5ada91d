# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Plays recorded ticks to a running `odom_node` over DDS, and collects its output."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
import rclpy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState
from visualization_msgs.msg import Marker, MarkerArray

from werrimbi_odom.ros.topics import stamp_at

Floats = NDArray[np.float64]

IN_FLIGHT = 8
"""Messages sent ahead of the node's answers: enough to keep it busy, fewer than its queue holds."""
PATIENCE = 0.5
"""Time without an answer after which the player continues [s] (the node rejected a message)."""


@dataclass
class Answers:
    """Output of the node while the ticks were played; lists of n values."""

    time: list[float] = field(default_factory=list)
    x: list[float] = field(default_factory=list)
    y: list[float] = field(default_factory=list)
    yaw: list[float] = field(default_factory=list)
    covariance: list[Floats] = field(default_factory=list)
    """Covariances of (x, y, yaw), each of shape (3, 3)."""
    piece_kinds: dict[tuple[str, int], None] = field(default_factory=dict)
    """(kind, number) of every piece whose marker was received."""

    def counts_by_kind(self) -> dict[str, int]:
        """Number of lines, arcs and spins in the node's output."""
        kinds = [kind for kind, _ in self.piece_kinds]
        return {kind: kinds.count(kind) for kind in ("line", "arc", "spin")}


class Player(Node):  # type: ignore[misc]
    """Publishes `joint_states`; subscribes to `odom` and `pieces`; all in one namespace."""

    def __init__(self, namespace: str) -> None:
        super().__init__("werrimbi_player", namespace=namespace)
        deep = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)
        self.answers = Answers()
        self.offset = 0.0
        self._ticks = self.create_publisher(JointState, "joint_states", deep)
        self._pose = self.create_publisher(PoseWithCovarianceStamped, "set_pose", 10)
        self.create_subscription(Odometry, "odom", self._on_odometry, deep)
        self.create_subscription(MarkerArray, "pieces", self._on_pieces, deep)

    def wait_for_node(self, seconds: float, alive: Callable[[], bool]) -> bool:
        """Wait until the node subscribes to ticks and poses; False if it does not start."""
        until = clock.monotonic() + seconds
        while clock.monotonic() < until and alive():
            if self._ticks.get_subscription_count() and self._pose.get_subscription_count():
                return True
            rclpy.spin_once(self, timeout_sec=0.05)
        return False

    def play(
        self,
        time: Floats,
        left: Floats,
        right: Floats,
        *,
        left_names: Sequence[str],
        right_names: Sequence[str],
        start: tuple[float, float, float],
        frame: str,
    ) -> Answers:
        """Set the start pose, then send every row as fast as the node answers.

        Stamps [s] and cumulative counts as recorded, shape (n,); all wheels of a side get the same
        count. The start is x, y [m] and yaw [rad] in `frame`.
        """
        # A stamp of zero means "no stamp" in ROS, so a record that begins at zero is shifted.
        self.offset = max(0.0, 2.0 - float(time[0]))
        names = [*left_names, *right_names]

        def tick(stamp: float, left_count: float, right_count: float) -> None:
            message = JointState()
            message.header.stamp = stamp_at(stamp + self.offset)
            message.name = names
            message.position = [left_count] * len(left_names) + [right_count] * len(right_names)
            self._ticks.publish(message)

        first = float(time[0]), float(left[0]), float(right[0])
        self._shake_hands(tick, *first)
        self._set_pose(start, frame, first[0] + self.offset)
        last_answer, answered = clock.monotonic(), 0
        base = 0  # messages without an answer: rejected ones
        for row, (stamp, left_count, right_count) in enumerate(
            zip(time.tolist(), left.tolist(), right.tolist(), strict=True)
        ):
            tick(stamp, left_count, right_count)
            rclpy.spin_once(self, timeout_sec=0.0)
            while row - base - len(self.answers.time) > IN_FLIGHT:
                rclpy.spin_once(self, timeout_sec=0.01)
                if len(self.answers.time) > answered:
                    answered, last_answer = len(self.answers.time), clock.monotonic()
                elif clock.monotonic() - last_answer > PATIENCE:
                    base, last_answer = row - answered, clock.monotonic()
        self._listen_out()
        return self.answers

    def _shake_hands(
        self, tick: Callable[[float, float, float], None], stamp: float, left: float, right: float
    ) -> None:
        """Send the first reading repeatedly, with increasing stamps, until the node answers.

        Only an answer shows that DDS has connected both ways. The robot does not move meanwhile.
        """
        for attempt in range(2000):
            tick(stamp - 0.9 + 4e-4 * attempt, left, right)
            rclpy.spin_once(self, timeout_sec=0.01)
            if self.answers.time:
                break
        until = clock.monotonic() + 0.2
        while clock.monotonic() < until:  # messages in flight
            rclpy.spin_once(self, timeout_sec=0.02)
        self.answers = Answers()

    def _set_pose(self, start: tuple[float, float, float], frame: str, stamp: float) -> None:
        message = PoseWithCovarianceStamped()
        message.header.frame_id = frame
        message.header.stamp = stamp_at(stamp)
        x, y, yaw = start
        message.pose.pose.position.x, message.pose.pose.position.y = x, y
        message.pose.pose.orientation.z = math.sin(0.5 * yaw)
        message.pose.pose.orientation.w = math.cos(0.5 * yaw)
        self._pose.publish(message)
        # The pose must be set before the first ticks, and the node does not confirm it.
        until = clock.monotonic() + 0.3
        while clock.monotonic() < until:
            rclpy.spin_once(self, timeout_sec=0.05)

    def _listen_out(self) -> None:
        """Receive until nothing new has arrived for a while."""
        quiet_since, heard = clock.monotonic(), -1
        while clock.monotonic() - quiet_since < PATIENCE + 0.5:
            rclpy.spin_once(self, timeout_sec=0.05)
            now = len(self.answers.time) + len(self.answers.piece_kinds)
            if now != heard:
                quiet_since, heard = clock.monotonic(), now

    def _on_odometry(self, message: Odometry) -> None:
        answers, pose = self.answers, message.pose.pose
        stamp = message.header.stamp.sec + 1e-9 * message.header.stamp.nanosec
        answers.time.append(stamp - self.offset)
        answers.x.append(pose.position.x)
        answers.y.append(pose.position.y)
        answers.yaw.append(2.0 * math.atan2(pose.orientation.z, pose.orientation.w))
        block = np.asarray(message.pose.covariance).reshape(6, 6)[np.ix_([0, 1, 5], [0, 1, 5])]
        answers.covariance.append(block)

    def _on_pieces(self, message: MarkerArray) -> None:
        for marker in message.markers:
            if marker.ns in ("line", "arc", "spin") and marker.action == Marker.ADD:
                self.answers.piece_kinds[(marker.ns, marker.id)] = None
