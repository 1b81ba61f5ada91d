# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Node processes of a demo in a private ROS domain, and saving of figures."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import time as clock
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.report.save import save_page, save_png, save_simple_png
from werrimbi_odom.report.style import Figure


def private_domain(stack: ExitStack) -> None:
    """Use a ROS domain that no other robot, demo or test uses, until the stack is left."""
    from werrimbi_odom.ros.domain import free_domain

    domain, lock = free_domain()
    stack.enter_context(lock)
    os.environ["ROS_DOMAIN_ID"] = str(domain)
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    os.environ["ROS_LOG_DIR"] = stack.enter_context(tempfile.TemporaryDirectory())


def end(node: subprocess.Popen[bytes]) -> None:
    """End a node as by Ctrl-C."""
    node.send_signal(signal.SIGINT)
    try:
        node.wait(timeout=10.0)
    except subprocess.TimeoutExpired:
        node.kill()
        node.wait()


UNDER_WAY = 0.5
"""Time in which the last messages of an ended node may still arrive [s]."""
NOTHING: Mapping[str, object] = {}


class Stage:
    """Context manager that runs nodes and ends them on exit."""

    def __init__(self) -> None:
        import rclpy
        from diagnostic_msgs.msg import DiagnosticArray
        from geometry_msgs.msg import PoseStamped
        from nav_msgs.msg import Odometry
        from rclpy.qos import DurabilityPolicy, QoSProfile
        from std_msgs.msg import String

        self._stack = ExitStack()
        private_domain(self._stack)
        rclpy.init()
        self._stack.callback(rclpy.try_shutdown)
        self._rclpy = rclpy
        self._node = rclpy.create_node("demo")
        self._stack.callback(self._node.destroy_node)
        self._running: dict[str, subprocess.Popen[bytes]] = {}
        self._status: dict[str, str] = {}
        self.diagnoses: list[str] = []
        """Diagnoses of compare_node, as printed on the terminal."""
        self.odometry: list[Any] = []
        self.measured: list[Any] = []
        deep = QoSProfile(depth=1000)
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        listen = self._node.create_subscription
        listen(DiagnosticArray, "/diagnostics", self._note, deep)
        listen(String, "compare_node/diagnosis", lambda m: self.diagnoses.append(m.data), latched)
        listen(Odometry, "odom", lambda m: self.odometry.append(m), deep)
        listen(PoseStamped, "reference", lambda m: self.measured.append(m), deep)

    def __enter__(self) -> Stage:
        return self

    def __exit__(self, *_: object) -> None:
        for node in self._running.values():
            end(node)
        self._stack.close()

    def _note(self, array: Any) -> None:
        self._status.update({each.name: each.message for each in array.status})

    def start(
        self, name: str, values: Mapping[str, object] = NOTHING, *, params_file: Path | None = None
    ) -> None:
        """Start a node, on simulated time; only its errors are shown."""
        words = [sys.executable, "-m", f"werrimbi_odom.ros.{name}", "--ros-args", "--log-level"]
        words += ["error", *(["--params-file", str(params_file)] if params_file else [])]
        for key, value in {"use_sim_time": name != "simulated_robot", **values}.items():
            text = str(value).lower() if isinstance(value, bool) else str(value)
            words += ["-p", f"{key}:={text}"]
        self._running[name] = subprocess.Popen(words)

    def end(self, name: str) -> None:
        """End a node."""
        end(self._running.pop(name))

    def forget(self) -> None:
        """Discard all messages so far, including those in transit."""
        until = clock.monotonic() + UNDER_WAY
        while clock.monotonic() < until:
            self._rclpy.spin_once(self._node, timeout_sec=0.0)
        self._status.clear()
        self.diagnoses, self.odometry, self.measured = [], [], []

    def told(self, name: str) -> str:
        """Last message of a status on /diagnostics; "" before the first."""
        return self._status.get(name, "")

    def until(self, done: Callable[[], bool], what: str, seconds: float = 60.0) -> None:
        """Process messages until a condition is true.

        InputError if a node ended, or it takes too long.
        """
        until = clock.monotonic() + seconds
        while not done():
            if any(node.poll() is not None for node in self._running.values()):
                raise InputError("a node ended; its own words are above")
            if clock.monotonic() > until:
                raise InputError(f"no {what} within {seconds:.0f} s: is this machine very busy?")
            self._rclpy.spin_once(self._node, timeout_sec=0.05)

    def ask(self, service: str) -> Any:
        """Call a service without arguments."""
        from std_srvs.srv import Trigger

        client = self._node.create_client(Trigger, service)
        self.until(client.service_is_ready, f"service {service}")
        answer = client.call_async(Trigger.Request())
        self.until(answer.done, f"answer of {service}")
        self._node.destroy_client(client)
        return answer.result()


def save_and_tell(figure: Figure, path: Path) -> None:
    """Write `path`.html and `path`.png, and print their names."""
    page, picture = path.with_suffix(".html"), path.with_suffix(".png")
    save_page(figure, page)
    print(f"\npicture: {page} (interactive)")
    if save_png(figure, picture):
        print(f"         {picture}")
    elif save_simple_png(figure, picture):
        print(f"         {picture} (a plain one: the pages' own look needs Chrome or Chromium)")
    else:
        print("         (no PNG: it needs Chrome or Chromium, or matplotlib)")
