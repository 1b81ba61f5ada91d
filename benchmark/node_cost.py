# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""CPU time a message: `odom_node`, the same tick by tick, and an empty relay, in one run.

The relay takes a JointState and publishes an Odometry with nothing computed; it is what rclpy and
DDS cost. "Tick by tick" is the same node with pieces of one message each, so that it does at every
message what is otherwise done at the end of a piece. All run at the same time, each in a process
of its own, and are fed in turn, second by second, so that they do not wait for each other and
whatever else the machine does weighs on all alike.

What a process takes without any message (a timer, discovery) is measured first and taken off.

    python benchmark/node_cost.py [--rate HZ ...] [--seconds S]
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

ROOT = Path(__file__).resolve().parents[1]
DOMAIN = 101
ROBOT = {
    "wheel_separation": 0.35,
    "wheel_radius": 0.05,
    "left_ticks_per_revolution": 2000.0,
    "right_ticks_per_revolution": 2000.0,
    "gap_duration": 60.0,  # a node that waits for its turn is not silent, and logs nothing
}

NODES = {
    "odom_node": [],
    "tick_by_tick": ["piece_path_tolerance:=1.0e-12", "piece_heading_tolerance:=1.0e-12"],
}
"""Parameters of each node, beside those of the robot."""


_MEET = 60.0
"""For all nodes to begin and to be found [s]."""

_IDLE = 5.0
"""Without messages [s]."""


def relay() -> None:
    """The empty relay, as a ROS tutorial would write it."""
    rclpy.init()
    node = Node("relay")
    publisher = node.create_publisher(Odometry, "relayed", QoSProfile(depth=100))
    odometry = Odometry()

    def arrived(message: JointState) -> None:
        odometry.header.stamp = message.header.stamp
        publisher.publish(odometry)

    # As deep as the node's, so that both answer the same messages.
    deep = QoSProfile(depth=100, reliability=ReliabilityPolicy.BEST_EFFORT)
    node.create_subscription(JointState, "relayed/joint_states", arrived, deep)
    with contextlib.suppress(KeyboardInterrupt):
        rclpy.spin(node)


def main() -> None:
    """Measure, and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--rate", type=int, nargs="+", default=[1000, 100], help="messages a second, in turn"
    )
    parser.add_argument("--seconds", type=int, default=15, help="of each node's feeding")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "robot.yaml"
        file.write_text(json.dumps({"/**": {"ros__parameters": ROBOT}}), encoding="utf-8")
        os.environ |= {
            "ROS_DOMAIN_ID": str(DOMAIN),
            "ROS_LOG_DIR": folder,
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
        }
        processes = {}
        for name, extra in NODES.items():
            remap = ["-r", f"odom:={name}", "-r", f"__node:={name}"]
            remap += ["-r", f"joint_states:={name}/joint_states"]
            given = [word for each in extra for word in ("-p", each)]
            command = [sys.executable, "-m", "werrimbi_odom.ros.odom_node", "--ros-args"]
            command += ["--params-file", str(file), *remap, *given]
            processes[name] = subprocess.Popen(command)
        processes["relayed"] = subprocess.Popen([sys.executable, __file__, "--relay"])
        try:
            report(processes, arguments.rate, arguments.seconds)
        finally:
            for process in processes.values():
                process.send_signal(signal.SIGINT)
            for process in processes.values():
                try:
                    process.wait(10.0)
                except subprocess.TimeoutExpired:
                    process.kill()


def report(
    processes: dict[str, subprocess.Popen[bytes]], rates: Sequence[int], seconds: int
) -> None:
    """Feed them in turn, and print what a message cost each."""
    rclpy.init()
    node = Node("feeder")
    publishers = {
        name: node.create_publisher(JointState, f"{name}/joint_states", QoSProfile(depth=1000))
        for name in processes
    }
    heard = dict.fromkeys(processes, 0)

    def listener(topic: str) -> None:
        def arrived(_: Odometry) -> None:
            heard[topic] += 1

        node.create_subscription(Odometry, topic, arrived, QoSProfile(depth=1000))

    for topic in heard:
        listener(topic)
    end = time.perf_counter() + _MEET
    while any(each.get_subscription_count() == 0 for each in publishers.values()):
        if time.perf_counter() > end or any(item.poll() is not None for item in processes.values()):
            sys.exit(f"not all nodes listened within {_MEET:.0f} s; is the machine very busy?")
        rclpy.spin_once(node, timeout_sec=0.05)
    for publisher in publishers.values():
        feed(node, publisher, rates[0])
        drain(node, 0.3)
    before = {name: cpu_time(process.pid) for name, process in processes.items()}
    drain(node, _IDLE)
    idle = {
        name: (cpu_time(process.pid) - before[name]) / _IDLE for name, process in processes.items()
    }
    told = ", ".join(f"{name} {1e3 * each:.1f} ms" for name, each in idle.items())
    print(f"without messages, CPU a second: {told}")
    for rate in rates:
        heard.update(dict.fromkeys(processes, 0))
        spent = dict.fromkeys(processes, 0.0)
        for _ in range(seconds):
            for name, publisher in publishers.items():
                begun, before_it = time.perf_counter(), cpu_time(processes[name].pid)
                feed(node, publisher, rate)
                drain(node, 0.3)
                lasted = time.perf_counter() - begun
                spent[name] += cpu_time(processes[name].pid) - before_it - idle[name] * lasted
        tell(rate, rate * seconds, heard, spent)
    rclpy.try_shutdown()


def tell(rate: int, count: int, heard: dict[str, int], spent: dict[str, float]) -> None:
    """Print what a message cost each, and what of it is ours."""
    cost = {name: 1e6 * each / max(heard[name], 1) for name, each in spent.items()}
    print(f"{count} JointState messages at {rate} Hz to each, a second at a time in turn")
    print(f"{'':14} answered  CPU a message  over the relay")
    for name, each in cost.items():
        over = each - cost["relayed"]
        print(f"{name:14} {heard[name]:8}  {each:10.0f} us  {over:+10.0f} us")
    if min(heard.values()) < 0.99 * count:
        print(
            "not all was answered, so these costs are not of the same work: the machine is busy, "
            "or --rate too high"
        )
        return
    ours = cost["odom_node"] - cost["relayed"]
    print(f"ours: {ours:.0f} us, {ours / cost['relayed']:.0%} of what rclpy and DDS cost")


def drain(node: Node, seconds: float) -> None:
    """Listen until all answers have come."""
    end = time.perf_counter() + seconds
    while time.perf_counter() < end:
        rclpy.spin_once(node, timeout_sec=0.05)


_row = 0


def feed(node: Node, publisher: rclpy.publisher.Publisher, rate: int) -> None:
    """Publish a drive along arcs for a second, at a steady rate."""
    global _row
    message = JointState(name=["left_wheel_joint", "right_wheel_joint"])
    begin = time.perf_counter()
    for due in range(rate):
        while time.perf_counter() < begin + due / rate:
            rclpy.spin_once(node, timeout_sec=0.0)
        _row += 1
        stamp = 10**9 + round(1e9 * _row / rate)
        message.header.stamp.sec, message.header.stamp.nanosec = divmod(stamp, 10**9)
        bend = 0.2 if _row // 1000 % 2 else -0.1
        message.position = [6.0 * _row / rate, 6.0 * _row / rate * (1.0 + bend)]
        publisher.publish(message)


def cpu_time(process: int) -> float:
    """Time on a processor, of all threads of a process [s]."""
    threads = Path(f"/proc/{process}/task").glob("*/schedstat")
    return 1e-9 * sum(int(thread.read_text().split()[0]) for thread in threads)


if __name__ == "__main__":
    if "--relay" in sys.argv:
        relay()
    else:
        main()
