# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Hours of driving watched by compare_node itself, faster than time.

    python -m test.ros.watched_hours engine|paper SEED HOURS [EFFECT=STRENGTH SETS_IN_AT_HOUR]

The robot is one in the engine on patrol, or one on paper whose wheels err with white noise, which
costs a third. Each message is handed to the node's own callbacks, so that hours take minutes: all
but DDS is as on a robot, and the odometry is what odom_node would publish. Simulated time stands
still for as long as a look of the node's takes. Prints each look, and what everything cost.
"""

from __future__ import annotations

import gc
import json
import math
import sys
import tempfile
import time as clock
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import rclpy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped
from rclpy.clock import ClockType
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from rclpy.time import Time
from sensor_msgs.msg import JointState

import werrimbi_odom as wo
from test.driving.in_engine import InEngine
from test.driving.test_watched_hours import TRUTH, patrol
from test.memory import resident
from test.ros.messages import stamp_at, turn, values_of
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.demo.node_processes import private_domain
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.run import Reference, Run, Ticks
from werrimbi_odom.model.pose import Floats, Pose, compose, inverse
from werrimbi_odom.ros.compare_node import CompareNode
from werrimbi_odom.ros.live_odometer import LiveOdometer
from werrimbi_odom.ros.odometry_messages import OdometryMessage
from werrimbi_odom.simulation import LiveRobot, hide, write_robot_file

BEGINS = 1_000_000
"""The first stamp [s]: zero means none."""
ALARMS = (DiagnosticStatus.WARN, DiagnosticStatus.ERROR)
"""STALE is none: to the node's own clock everything is silent while a look is waited for."""
RATES = (25, 10)
"""Messages a second of the wheels and of the reference."""
PERIOD = 1.0
"""Simulated seconds between two reports of the node, as on a robot."""


class Look(NamedTuple):
    """What stood on /diagnostics after a look, and what all cost until then."""

    hours: float
    """Of simulated time, standing included."""
    since: float
    """Minutes of driving since what is hidden set in; negative before."""
    verdict: str
    names: str
    words: str
    alarms: dict[str, int]
    """Of the other two statuses: how often each became a WARN so far."""
    resident: float
    """Of the process, with the engine in it [MB]."""
    odometry: float
    """CPU of odom_node's own work so far [ms in a second of simulated time]."""
    comparing: float
    """The same of compare_node's."""
    looking: float
    """The same of its looks."""


def patrols(seed: int, file: RobotFile, sets_in: float, hidden: str) -> Iterator[Run]:
    """Patrols of five minutes in the engine, on one clock; something sets in after so many [s]."""
    rng = np.random.default_rng(seed)
    live = LiveRobot(TRUTH, seed=seed)
    there, begun, counted = InEngine(live, file, *RATES), 0.0, np.zeros(2)
    sound = True
    while True:
        if sound and live.time >= sets_in:
            effect, _, strength = hidden.partition("=")
            odd = hide(effect, float(strength) if strength else None, seed=seed).peculiarity
            sound, begun = False, live.time
            counted = np.array(live.counters(live.time), dtype=float)
            live = LiveRobot(TRUTH, seed=seed + 1, hidden=[odd], start=live.pose)
            counted -= live.counters(0.0)
            there = InEngine(live, file, *RATES)
        run, driver = there.drive(patrol(rng))
        assert driver.state == "done", driver.words
        yield _later(run, begun, counted, Pose())


ON_PAPER = {"unequal_wheel_radii": "right_radius", "track_width": "separation"}
"""What can set in there: a size that becomes so many times as large."""


def wanderings(seed: int, file: RobotFile, sets_in: float, hidden: str) -> Iterator[Run]:
    """The same of a robot on paper, by quarters of an hour."""
    rng = np.random.default_rng(seed)
    believed = file.robot
    robot = WhiteNoiseRobot(
        believed.track, 0.05, 0.05, believed.left_wheel_noise, believed.right_wheel_noise
    )
    begun, counted, there = 0.0, np.zeros(2), Pose()
    sound = True
    while True:
        if sound and begun >= sets_in - 1.0:
            effect, _, strength = hidden.partition("=")
            size = ON_PAPER[effect]
            robot = replace(robot, **{size: getattr(robot, size) * float(strength)})
            sound = False
        left = sets_in - begun
        speeds = wandering(rng, left if 1.0 < left < 900.0 else 900.0, RATES[0])
        every = RATES[0] // RATES[1]
        run = drive(robot, speeds, rng, sigma_xy=0.0, sigma_yaw=0.0, every=every, hertz=RATES[0])
        ticks, exact = run.ticks, run.reference
        assert exact is not None
        counted -= ticks.left[0], ticks.right[0]
        origin = compose(there, inverse(Pose(exact.x[0], exact.y[0], exact.yaw[0])))
        run = _later(run, begun, counted, origin)
        assert run.reference is not None
        x, y, yaw = run.reference.x, run.reference.y, run.reference.yaw
        there = Pose(float(x[-1]), float(y[-1]), float(yaw[-1]))
        begun = float(run.ticks.time[-1])
        counted = np.array([run.ticks.left[-1], run.ticks.right[-1]])
        noise = (sigma * rng.standard_normal(x.size) for sigma in (0.001, 0.001, 0.002))
        x, y, yaw = (one + other for one, other in zip((x, y, yaw), noise, strict=True))
        keep = slice(0, -1)  # the last reading is the next one's first
        yield replace(
            run,
            ticks=Ticks(run.ticks.time[keep], run.ticks.left[keep], run.ticks.right[keep]),
            reference=Reference(run.reference.time[keep], x[keep], y[keep], yaw[keep]),
        )


def _later(run: Run, begun: float, counted: Floats, origin: Pose) -> Run:
    """The same drive at another time, with other counts, from another place."""
    ticks, reference = run.ticks, run.reference
    assert reference is not None
    cos, sin = math.cos(origin.yaw), math.sin(origin.yaw)
    return replace(
        run,
        ticks=Ticks(ticks.time + begun, ticks.left + counted[0], ticks.right + counted[1]),
        reference=Reference(
            reference.time + begun,
            origin.x + cos * reference.x - sin * reference.y,
            origin.y + sin * reference.x + cos * reference.y,
            origin.yaw + reference.yaw,
        ),
    )


@dataclass
class Costs:
    """CPU so far [s]."""

    odometry: float = 0.0
    comparing: float = 0.0


class Watched:
    """compare_node, fed message by message, on a robot file that is both nodes'."""

    def __init__(self, folder: Path, robot: Path) -> None:
        self._stack = ExitStack()
        private_domain(self._stack)
        given = folder / "compare.yaml"
        values = {
            "robot_file": str(robot),
            "new_robot_file": str(folder / "better.yaml"),
            "reference_sigma_xy": 0.001,
            "reference_sigma_yaw": 0.002,
            "use_sim_time": True,
        }
        given.write_text(json.dumps({"compare_node": {"ros__parameters": values}}))
        rclpy.init(args=["--ros-args", "--log-level", "fatal", "--params-file", str(given)])
        self._stack.callback(rclpy.try_shutdown)
        self.node = CompareNode()
        self._stack.callback(self.node.destroy_node)
        self._take = {each.topic_name: each.callback for each in self.node.subscriptions}
        listener = rclpy.create_node("listener")
        self._stack.callback(listener.destroy_node)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(listener)
        self._arrays: list[Any] = []
        deep = QoSProfile(depth=1000)
        listener.create_subscription(DiagnosticArray, "/diagnostics", self._arrays.append, deep)
        file = read_robot_file(robot)
        self._tick = 2.0 * math.pi / float(file.values["left_ticks_per_revolution"])  # type: ignore[arg-type]
        self._tracker = LiveOdometer(file.robot, file.tolerance, file.limits)
        self._message = OdometryMessage("odom", "base_link")
        self.costs = Costs()
        self.status: dict[str, Any] = {}
        self.alarms: Counter[str] = Counter()
        while not listener.count_publishers("/diagnostics"):
            clock.sleep(0.05)
        clock.sleep(0.5)

    def __enter__(self) -> Watched:
        return self

    def __exit__(self, *_: object) -> None:
        self._executor.shutdown()
        self._stack.close()

    def drive(self, run: Run) -> Iterator[float]:
        """Hand over a drive's messages in the order of their stamps; its time after each second."""
        reference = run.reference
        assert reference is not None
        columns = (reference.time, reference.x, reference.y, reference.yaw)
        poses = list(zip(*(each.tolist() for each in columns), strict=True))
        due, ticks = 0, run.ticks
        told = math.floor(ticks.time[0] / PERIOD)
        for time, left, right in zip(
            ticks.time.tolist(), ticks.left.tolist(), ticks.right.tolist(), strict=True
        ):
            self._wheels(time, left, right)
            while due < len(poses) and poses[due][0] <= time:
                self._pose(*poses[due])
                due += 1
            if time // PERIOD > told:
                told = time // PERIOD
                self._report()
                yield time

    def _wheels(self, time: float, left: float, right: float) -> None:
        stamp = stamp_at(BEGINS + time)
        began = clock.process_time()
        estimate = self._tracker.take(stamp, left, right)
        odometry = None if estimate is None else self._message.filled(stamp, estimate)
        self.costs.odometry += clock.process_time() - began
        joints = JointState(
            name=["left_wheel_joint", "right_wheel_joint"],
            position=[left * self._tick, right * self._tick],
            velocity=[0.0, 0.0],  # without any, rclpy serializes some bytes too many
            effort=[0.0, 0.0],
        )
        joints.header.stamp = stamp
        data = serialize_message(joints)
        now = Time(nanoseconds=round(1e9 * (BEGINS + time)), clock_type=ClockType.ROS_TIME)
        self.node.get_clock().set_ros_time_override(now)
        began = clock.process_time()
        self._take["/joint_states"](data)
        if odometry is not None:
            self._take["/odom"](odometry)
        self.costs.comparing += clock.process_time() - began

    def _pose(self, time: float, x: float, y: float, yaw: float) -> None:
        message = PoseStamped()
        message.header.stamp, message.header.frame_id = stamp_at(BEGINS + time), "world"
        message.pose.position.x, message.pose.position.y = x, y
        turn(message.pose, yaw)
        began = clock.process_time()
        self._take["/reference"](message)
        self.costs.comparing += clock.process_time() - began

    def _report(self) -> None:
        """The node's own second: what it says, and a look to its end if one is due."""
        began = clock.process_time()
        self.node._report()
        self.costs.comparing += clock.process_time() - began
        self._listen()
        while self.told("what is missing", "looking") == "True":
            clock.sleep(0.2)
            self.node._report()
            self._listen()

    def _listen(self) -> None:
        end = clock.monotonic() + 10.0
        while not self._arrays:
            assert clock.monotonic() < end, "no /diagnostics"
            self._executor.spin_once(timeout_sec=1.0)
        for status in self._arrays.pop().status:
            name = status.name.removeprefix("compare_node: ")
            before = self.status.get(name)
            if status.level in ALARMS and (before is None or before.level not in ALARMS):
                self.alarms[name] += 1
            self.status[name] = status
        self._arrays.clear()

    def told(self, name: str, key: str) -> str:
        """A value of a status."""
        return values_of(self.status[name])[key]


def looks(
    kind: str, seed: int, hours: float, hidden: str, sets_in: float, folder: Path
) -> Iterator[Look]:
    """Each look at so many hours; what is hidden sets in at an hour."""
    robot = folder / "robot.yaml"
    write_robot_file(TRUTH, robot)
    runs = {"engine": patrols, "paper": wanderings}[kind]
    with Watched(folder, robot) as watched:
        seen, driven_at = "0", math.nan
        for run in runs(seed, wo.read_robot(robot), 3600.0 * sets_in, hidden):
            for time in watched.drive(run):
                driven = float(watched.told("what is missing", "driven").removesuffix(" min"))
                if math.isnan(driven_at) and time >= 3600.0 * sets_in:
                    driven_at = driven
                count = watched.told("what is missing", "looks")
                if count != seen:
                    seen = count
                    yield look(watched, time, driven - driven_at)
            if time > 3600.0 * hours:
                return


def look(watched: Watched, time: float, since: float) -> Look:
    """What stands now."""
    gc.collect()
    costs, milli = watched.costs, 1e3 / time
    looking = float(watched.told("what is missing", "CPU of all looks").removesuffix(" s"))
    status = watched.status["what is missing"]
    return Look(
        round(time / 3600.0, 3),
        round(since, 1),
        watched.told("what is missing", "verdict"),
        watched.told("what is missing", "effect"),
        status.message.partition("/compare_node/")[0].strip(),
        dict(watched.alarms),
        round(1e-6 * resident(), 1),
        round(milli * costs.odometry, 2),
        round(milli * costs.comparing, 2),
        round(milli * looking, 2),
    )


def main() -> None:
    """Watch, and print."""
    kind, seed, hours = sys.argv[1], int(sys.argv[2]), float(sys.argv[3])
    hidden, sets_in = (sys.argv[4], float(sys.argv[5])) if len(sys.argv) > 4 else ("", math.inf)
    with tempfile.TemporaryDirectory() as folder:
        for each in looks(kind, seed, hours, hidden, sets_in, Path(folder)):
            print(*each, sep="; ", flush=True)


if __name__ == "__main__":
    main()
