# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Real node processes over real DDS, each in a ROS domain of its own.

`launch` starts the node as a user does and gives back a `Launched`, which is also a ROS client: it
publishes to the node and keeps whatever the node publishes.
"""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

rclpy = pytest.importorskip("rclpy", reason="the node's tests need ROS 2 (pip install .[ros])")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus  # noqa: E402
from geometry_msgs.msg import PoseWithCovarianceStamped  # noqa: E402
from nav_msgs.msg import Odometry  # noqa: E402
from rcl_interfaces.srv import SetParametersAtomically  # noqa: E402
from rclpy.context import Context  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.parameter import Parameter  # noqa: E402
from rclpy.qos import QoSProfile  # noqa: E402
from sensor_msgs.msg import JointState  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from visualization_msgs.msg import MarkerArray  # noqa: E402

from test.ros.beside import ended  # noqa: E402
from test.ros.messages import seconds_of, stamp_at, values_of  # noqa: E402
from werrimbi_odom.ros.domain import free_domain  # noqa: E402

ROOT = Path(__file__).parents[2]

DEEP = {"reliability": "reliable", "depth": 10_000}
"""Tests publish faster than any driver, and count what arrives."""

ROBOT: dict[str, Any] = {
    "wheel_separation": 0.35,
    "wheel_radius": 0.05,
    "left_ticks_per_revolution": 2000.0,
    "right_ticks_per_revolution": 1000.0,
    "position_unit": "ticks",
    "qos_overrides": {"/joint_states": {"subscription": DEEP}, "/odom": {"publisher": DEEP}},
}
"""The robot of most tests; unequal encoders, so that left and right are never mistaken."""


def environment(domain: int, log: Path) -> dict[str, str]:
    """For a node process; our checkout first, and nothing heard from other machines."""
    return os.environ | {
        "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")]),
        "PYTHONUNBUFFERED": "1",
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "ROS_LOG_DIR": str(log),
    }


def command(folder: Path, robot: dict[str, Any], *arguments: str) -> list[str]:
    """The command line that runs the node with a parameter file."""
    file = folder / "robot.yaml"
    file.write_text(json.dumps({"/**": {"ros__parameters": robot}}), encoding="utf-8")
    node = [sys.executable, "-m", "werrimbi_odom.ros.odom_node"]
    return [*node, "--ros-args", "--params-file", str(file), *arguments]


class Launched:
    """A node process, and a client in its domain; its parameter file and logs lie in `folder`."""

    def __init__(self, folder: Path, robot: dict[str, Any], *arguments: str) -> None:
        domain, self._lock = free_domain()
        self._errors = (folder / "stderr").open("w+", encoding="utf-8")
        # Tests share a node, so stamps and counters go on from one to the next.
        self.now = 100.0
        self.left = self.right = 0
        self.environment = environment(domain, folder)
        self.process = subprocess.Popen(
            command(folder, robot, *arguments), stderr=self._errors, env=self.environment
        )
        self.context = Context()
        rclpy.init(context=self.context, domain_id=domain)
        self.node = rclpy.create_node(f"client_{domain}", context=self.context)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self._publishers: dict[str, Any] = {}
        self._clients: dict[str, Any] = {}
        self.odometry: list[Odometry] = []
        self.diagnostics: list[DiagnosticStatus] = []
        self._read = 0  # of them, by the last `counts`
        self._listen(Odometry, "odom", self.odometry.append)
        self._listen(DiagnosticArray, "/diagnostics", lambda m: self.diagnostics.extend(m.status))

    def _listen(self, kind: type, topic: str, take: Callable[[Any], None]) -> None:
        self.node.create_subscription(kind, topic, take, QoSProfile(depth=10_000))

    def keep(self, kind: type, topic: str) -> list[Any]:
        """A list that fills with what is published on a topic from now on."""
        kept: list[Any] = []
        self._listen(kind, topic, kept.append)
        self.until(lambda: self.node.count_publishers(topic) > 0, f"a publisher on {topic}")
        return kept

    # ------------------------------------------------------------------ time

    def until(self, done: Callable[[], bool], what: str, seconds: float = 10.0) -> None:
        """Let messages flow until something has come about."""
        end = time.monotonic() + seconds
        while not done():
            assert self.process.poll() is None, f"the node ended: {self.stderr()}"
            assert time.monotonic() < end, f"no {what} within {seconds} s; {self.stderr()}"
            self.executor.spin_once(timeout_sec=0.05)

    def rest(self, seconds: float) -> None:
        """Let messages flow for a while."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.executor.spin_once(timeout_sec=max(0.0, end - time.monotonic()))

    def catch_up(self) -> None:
        """Take what was published while a test was busy with another node."""
        seen = -1
        while seen != len(self.diagnostics):
            seen = len(self.diagnostics)
            self.rest(0.02)

    # ------------------------------------------------------------------ to the node

    def publisher(self, kind: type, topic: str) -> Any:
        """A reliable publisher that the node has already found."""
        if topic not in self._publishers:
            publisher = self.node.create_publisher(kind, topic, QoSProfile(depth=10_000))
            self.until(lambda: publisher.get_subscription_count() > 0, f"subscriber of {topic}")
            self.rest(0.2)  # we have found the node; best effort also needs that it has found us
            self._publishers[topic] = publisher
        return self._publishers[topic]

    def send(self, kind: type, topic: str, message: Any) -> None:
        """Publish one message."""
        self.publisher(kind, topic).publish(message)

    def joints(self, positions: dict[str, float], stamp: float | None = None) -> None:
        """Publish a JointState, 20 ms after the last one if no stamp is given."""
        self.raw_joints(list(positions), list(positions.values()), stamp)

    def raw_joints(
        self, names: list[str], positions: list[float], stamp: float | None = None
    ) -> None:
        """Publish a JointState whose names and positions need not fit."""
        if stamp is None:
            self.now = round(self.now + 0.02, 6)
            stamp = self.now
        message = JointState(name=names, position=[float(position) for position in positions])
        message.header.stamp = stamp_at(stamp)
        self.send(JointState, "joint_states", message)

    def ticks(self, left: float, right: float, stamp: float | None = None) -> None:
        """Publish the counters of the two wheels."""
        self.left, self.right = left, right
        self.joints({"left_wheel_joint": left, "right_wheel_joint": right}, stamp)

    def step(self, left: float, right: float) -> None:
        """Publish the counters after so many more counts."""
        self.ticks(self.left + left, self.right + right)

    def drive(self, steps: list[tuple[float, float]]) -> Odometry:
        """Publish the readings of a drive; returns the odometry of the last."""
        for left, right in steps:
            self.step(left, right)
        return self.last()

    def begin(self, send: Callable[[], None] | None = None) -> Launched:
        """Send a robot at rest until both sides have found each other: the first odometry comes."""
        for _ in range(100):
            (send or (lambda: self.step(0, 0)))()
            self.rest(0.05)
            if self.odometry:
                return self
        raise AssertionError(f"no odometry; {self.stderr()}")

    def last(self) -> Odometry:
        """The odometry of the last stamp sent."""
        self.until(
            lambda: bool(self.odometry) and abs(seconds_of(self.odometry[-1]) - self.now) < 1e-6,
            f"odometry of {self.now}",
        )
        return self.odometry[-1]

    def call(self, kind: type, service: str, request: Any, again_after: float = math.inf) -> Any:
        """Call a service of a node; one that only tells something may be asked again [s].

        A node that has not yet found us answers nobody: its service is ready, the answer is lost.
        """
        if service not in self._clients:
            self._clients[service] = self.node.create_client(kind, service)
        self.until(self._clients[service].service_is_ready, f"service {service}")
        asked: list[tuple[float, Any]] = []

        def answered() -> bool:
            if not asked or time.monotonic() > asked[-1][0] + again_after:
                asked.append((time.monotonic(), self._clients[service].call_async(request)))
            return any(future.done() for _, future in asked)

        self.until(answered, f"answer of {service}")
        return next(future.result() for _, future in asked if future.done())

    def set_parameters(self, **values: Any) -> Any:
        """As `ros2 param set`, all or none; returns the result."""
        request = SetParametersAtomically.Request(
            parameters=[
                Parameter(name, value=value).to_parameter_msg() for name, value in values.items()
            ]
        )
        service = "odom_node/set_parameters_atomically"
        return self.call(SetParametersAtomically, service, request).result

    def reset(self) -> None:
        """Call ~/reset."""
        assert self.call(Trigger, "odom_node/reset", Trigger.Request()).success

    def set_pose(self, message: PoseWithCovarianceStamped) -> None:
        """Publish on set_pose, and give the node the time to take it."""
        self.send(PoseWithCovarianceStamped, "set_pose", message)
        self.rest(0.2)

    def pieces(self) -> list[Any]:
        """Keep what comes on ~/pieces."""
        return self.keep(MarkerArray, "odom_node/pieces")

    # ------------------------------------------------------------------ from the node

    def report(self) -> tuple[bytes, str, dict[str, str]]:
        """The next /diagnostics: level, words and values."""
        seen = len(self.diagnostics)
        self.until(lambda: len(self.diagnostics) > seen, "diagnostics")
        status = self.diagnostics[-1]
        return status.level, status.message, values_of(status)

    def counts(self) -> Counter[str]:
        """Counts on the last /diagnostics, or the first."""
        self.catch_up()
        if not self.diagnostics:
            self.report()
        self._read = len(self.diagnostics)
        told = values_of(self.diagnostics[-1])
        return Counter({key: int(value) for key, value in told.items() if value.isdigit()})

    def stand(self) -> None:
        """Publish the counters of a robot that does not move."""
        self.step(0, 0)

    def counted(
        self, before: Counter[str], send: Callable[[], None] | None = None, **expected: int
    ) -> tuple[bytes, str]:
        """Wait for the first /diagnostics since `before` that counts so much more; level and words.

        Its words are of what came since the one before it, and the next one no longer has them.
        `send` goes on publishing meanwhile, as a driver does: an input that ends is told as silent.
        Underscores stand for spaces and colons where a count has those in its name.
        """
        new: dict[str, int] = {}
        self.catch_up()
        end = time.monotonic() + 10.0
        while True:
            for status in self.diagnostics[self._read :]:
                new = {
                    key.replace(": ", "_").replace(" ", "_"): int(value) - before[key]
                    for key, value in values_of(status).items()
                    if value.isdigit()
                }
                if all(new.get(key) == count for key, count in expected.items()):
                    return status.level, status.message
            assert time.monotonic() < end, f"not {expected} but {new}; {self.stderr()}"
            if send is not None:
                send()
            self.rest(0.05)

    def stderr(self) -> str:
        """What the node has said."""
        self._errors.flush()
        return Path(self._errors.name).read_text(encoding="utf-8")

    # ------------------------------------------------------------------ its end

    def stop(self, with_signal: int = signal.SIGINT) -> int:
        """End the node as Ctrl-C or a launch file does; returns its exit code."""
        return ended(self.process, with_signal)

    def close(self) -> None:
        """End the node, and our part."""
        code = self.stop()
        errors = self.stderr()
        self.executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown(context=self.context)
        self._errors.close()
        self._lock.close()
        assert code == 0, f"the node ended with {code}: {errors}"
        assert "Traceback" not in errors, errors


Launch = Callable[..., Launched]


def launcher(folder: Path) -> Iterator[Launch]:
    """A function that starts nodes, all of which are ended (and end well) after the yield."""
    launched: list[Launched] = []

    def launch(robot: dict[str, Any] | None = None, *arguments: str) -> Launched:
        own = folder / str(len(launched))
        own.mkdir()
        launched.append(Launched(own, ROBOT if robot is None else robot, *arguments))
        return launched[-1]

    yield launch
    for node in launched:
        node.close()


@pytest.fixture
def launch(tmp_path: Path) -> Iterator[Launch]:
    yield from launcher(tmp_path)


@pytest.fixture(scope="module")
def node(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Launched]:
    """One node of the robot above, shared by the tests of a file, that has begun."""
    for launch_one in launcher(tmp_path_factory.mktemp("node")):
        yield launch_one().begin()


@pytest.fixture
def robot() -> dict[str, Any]:
    """Parameters of the node that `launch` and `node` start unless told otherwise."""
    return dict(ROBOT)


@pytest.fixture
def start_node(tmp_path: Path) -> Iterator[Callable[..., subprocess.Popen[str]]]:
    """Start a bare node process, with no client."""
    domain, lock = free_domain()
    started: list[subprocess.Popen[str]] = []

    def start(robot: dict[str, Any], *arguments: str) -> subprocess.Popen[str]:
        process = subprocess.Popen(
            command(tmp_path, robot, *arguments),
            stderr=subprocess.PIPE,
            text=True,
            env=environment(domain, tmp_path),
        )
        started.append(process)
        return process

    yield start
    for process in started:
        process.kill()
    lock.close()


@pytest.fixture
def run_node(
    start_node: Callable[..., subprocess.Popen[str]],
) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run a bare node process to its end."""

    def run(robot: dict[str, Any], *arguments: str) -> subprocess.CompletedProcess[str]:
        process = start_node(robot, *arguments)
        _, errors = process.communicate(timeout=20.0)
        return subprocess.CompletedProcess(process.args, process.returncode, "", errors)

    return run
