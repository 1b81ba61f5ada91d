# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A wheel driver in a process of its own: JointState at a steady rate, then what it sent to a file.

python feeder.py RATE SECONDS OUT.npy
"""

from __future__ import annotations

import sys
import time

import numpy as np
import rclpy
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

START = 1_000_000  # s: the stamp before the first


def counters(rate: float, seconds: float) -> np.ndarray:
    """Stamp [ns], left and right counts of a drive that curves, stops, turns and goes back."""
    time = np.arange(round(rate * seconds)) / rate
    speed = np.clip(2.0 * np.sin(0.7 * time), -1.0, 1.0) * 3000.0
    curve = 0.3 * np.sin(0.31 * time)
    left = np.cumsum(speed * (1.0 - curve)) / rate
    right = np.cumsum(speed * (1.0 + curve)) / rate / 2.0
    stamps = START * 10**9 + np.round(1e9 * time).astype(np.int64)
    return np.stack([stamps, np.rint(left).astype(np.int64), np.rint(right).astype(np.int64)])


def main(rate: float, seconds: float, out: str) -> None:
    """Publish it all."""
    rows = counters(rate, seconds)
    np.save(out, rows)
    rclpy.init()
    node = rclpy.create_node("feeder")
    publisher = node.create_publisher(JointState, "joint_states", QoSProfile(depth=100_000))
    message = JointState(name=["left_wheel_joint", "right_wheel_joint"])
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    time.sleep(0.3)
    begin = time.perf_counter()
    for row, (stamp, left, right) in enumerate(rows.T.tolist()):
        ahead = begin + row / rate - time.perf_counter()
        if ahead > 0.0:
            time.sleep(ahead)
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        message.position = [float(left), float(right)]
        publisher.publish(message)
    took = time.perf_counter() - begin
    print(f"{rows.shape[1] / took:.0f} messages a second", flush=True)
    sys.stdin.read()  # until we are told that everything has arrived
    node.destroy_node()
    rclpy.try_shutdown()


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]), sys.argv[3])
