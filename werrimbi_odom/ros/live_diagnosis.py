# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Live diagnosis with compare_node: what is missing in the robot file in use.

Messages of the last minutes of driving are stored (`recent_messages`). From time to time a separate
process with low priority diagnoses them (`werrimbi_odom.api.live_diagnosis`), as the command line
would.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import String
from std_srvs.srv import Trigger

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.node_parameter import Value
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.text_files import place_of, replacing
from werrimbi_odom.model.motion import BodyMotion
from werrimbi_odom.ros import counter_inputs
from werrimbi_odom.ros.diagnostics import diagnostic, tell
from werrimbi_odom.ros.recent_messages import Kept
from werrimbi_odom.ros.topics import full_name

LOOKER = "werrimbi_odom.api.live_diagnosis"
"""Run as a process, never imported: the node loads neither scipy nor the diagnosis."""
LOOKS_BACK = 2.0
"""Length of the stored drive, in intervals between two diagnoses: a new effect fills the whole
drive at the second diagnosis after its onset."""


class NoWatching:
    """No robot file is given."""

    def odometry(self, time: float, twist: BodyMotion[float]) -> None:
        """Add time and twist of an odometry message."""

    def reference(self, message: Any) -> None:
        """Add a message of the reference."""

    def look(self) -> list[DiagnosticStatus]:
        """Called once a second: advance the diagnosis, and return its status."""
        return []

    def close(self) -> None:
        """Terminate a running diagnosis."""


class Watching(NoWatching):
    """Diagnoses repeatedly, with the parameters of compare_node and a reference of type `kind`.

    `subscribe` is the method of the node that subscribes. InputError if the robot file is invalid,
    or the new one would overwrite it.
    """

    def __init__(
        self, node: Node, values: Mapping[str, Value], kind: type, subscribe: Callable[..., None]
    ) -> None:
        self._node = node
        self._robot = Path(str(values["robot_file"])).absolute()
        robot = read_robot_file(self._robot).values
        named = str(values["new_robot_file"])
        self._new = Path(named or self._robot.with_name(f"{self._robot.stem}_better.yaml"))
        if place_of(self._new) == place_of(self._robot):
            raise InputError(f"new_robot_file: {self._new} is the robot file in use; name another")
        of_wheels, names = counter_inputs.kind_of(robot)
        wheels = [node.resolve_topic_name(name) for name in names]
        reference = node.resolve_topic_name("reference")
        self._reference = len(wheels)
        kind_of = str(values["reference_kind"])
        self._asked = {
            "robot": str(self._robot),
            "topics": {"ticks_topic": ",".join(wheels), "reference_topic": reference},
            "options": {} if kind_of == "auto" else {"reference_kind": kind_of},
        }
        self._every = 60.0 * float(values["diagnose_every"])  # type: ignore[arg-type]
        topics = [*((topic, _named(of_wheels)) for topic in wheels), (reference, _named(kind))]
        self._kept = Kept(topics, LOOKS_BACK * self._every)
        self._looked_at = 0.0
        self._looks = 0
        self._used = 0.0
        self._looking: subprocess.Popen[bytes] | None = None
        self._folder = Path()
        self._found: dict[str, Any] = {}
        self._better = ""
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._words = node.create_publisher(String, "~/diagnosis", latched)
        node.create_service(Trigger, "~/write_robot_file", self._on_write)
        for number, topic in enumerate(wheels):
            subscribe(of_wheels, topic, partial(self._take, number), raw=True)

    # ------------------------------------------------------------------------- messages

    def odometry(self, time: float, twist: BodyMotion[float]) -> None:
        """Add time and twist of an odometry message."""
        self._kept.motion(self._now(), time, twist.along, twist.turn)

    def reference(self, message: Any) -> None:
        """Add a message of the reference."""
        self._take(self._reference, serialize_message(message))

    def _take(self, topic: int, data: bytes) -> None:
        self._kept.take(topic, self._now(), data)

    def _now(self) -> int:
        """Reception time [ns]."""
        return int(self._node.get_clock().now().nanoseconds)

    # ------------------------------------------------------------------------- diagnosis

    def look(self) -> list[DiagnosticStatus]:
        """Called once a second: advance the diagnosis, and return its status."""
        if self._looking is not None:
            if self._looking.poll() is not None:
                self._end()
        elif self._kept.driven - self._looked_at >= self._every:
            self._looked_at = self._kept.driven
            try:
                self._begin()
            except OSError as error:  # no room for its files
                self._found = {"trouble": f"the diagnosis cannot begin: {error}"}
                self._better = ""
                tell(self._node.get_logger(), self._found["trouble"], fine=False)
        return [self._status()]

    def _begin(self) -> None:
        self._folder = Path(tempfile.mkdtemp(prefix="werrimbi_odom_"))
        try:
            self._ask()
        except OSError:
            shutil.rmtree(self._folder, ignore_errors=True)
            raise

    def _ask(self) -> None:
        """Write the messages, and start the process that looks at them."""
        self._kept.write(self._folder / "messages")
        (self._folder / "asked.json").write_text(json.dumps(self._asked), encoding="utf-8")
        self._looking = subprocess.Popen(
            [sys.executable, "-m", LOOKER, str(self._folder)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=(self._folder / "said").open("wb"),
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
        )

    def _end(self) -> None:
        """Read the result, and report it if it is new."""
        before, better = self._found.get("headline"), self._folder / "better.yaml"
        try:
            self._found = json.loads((self._folder / "found.json").read_text(encoding="utf-8"))
            self._better = better.read_text(encoding="utf-8") if better.exists() else ""
        except (OSError, ValueError):
            said, last = self._folder / "said", "its files were deleted"
            with contextlib.suppress(OSError):  # as by what tidies up /tmp
                lines = said.read_text(encoding="utf-8", errors="replace").strip().splitlines()
                last = lines[-1] if lines else "it was ended"
            self._found, self._better = {"error": f"the diagnosis failed: {last}"}, ""
        self._looks += 1
        self._used += float(self._found.get("cpu_s", 0.0))
        self.close()
        self._words.publish(String(data=self._found.get("words") or self._found["error"]))
        level, words = self._verdict()
        if self._found.get("headline") != before:
            tell(self._node.get_logger(), words, fine=level == DiagnosticStatus.OK)

    def _verdict(self) -> tuple[bytes, str]:
        found = self._found
        if not found:
            return DiagnosticStatus.OK, "not enough was driven yet"
        if "trouble" in found:
            return DiagnosticStatus.WARN, found["trouble"]
        if "error" in found:
            return DiagnosticStatus.OK, f"these drives tell nothing: {found['error']}"
        words = found["headline"]
        if found["added"]:
            service = f"{self._node.get_fully_qualified_name()}/write_robot_file"
            words += f" {service} writes {self._new} with it."
        fine = found["verdict"] == "none" and not found["changes"]
        return DiagnosticStatus.OK if fine else DiagnosticStatus.WARN, words

    def _status(self) -> DiagnosticStatus:
        kept, found = self._kept, self._found
        level, words = self._verdict()
        move = found.get("next_manoeuvre") or {}
        told = {
            "verdict": found.get("verdict", ""),
            "effect": found.get("effect") or ", ".join(found.get("rivals", ())),
            "next manoeuvre": move.get("name", ""),
            "looks": self._looks,
            "looking": self._looking is not None,
            "driven": f"{kept.driven / 60.0:.1f} min",
            "driven since the last look": f"{(kept.driven - self._looked_at) / 60.0:.1f} min",
            "CPU of all looks": f"{self._used:.1f} s",
        }
        return diagnostic(level, f"{full_name(self._node)}: what is missing", words, told)

    def close(self) -> None:
        """Terminate a running diagnosis, and delete its files."""
        if self._looking is None:
            return
        self._looking.kill()
        self._looking.wait()
        self._looking = None
        shutil.rmtree(self._folder, ignore_errors=True)

    # ------------------------------------------------------------------------- services

    def _on_write(self, _: Any, response: Any) -> Any:
        response.success, response.message = False, self._unwritable()
        if response.message:
            return response
        try:
            with replacing(self._new) as file:
                file.write(self._better)
        except InputError as error:
            response.message = str(error)
            return response
        names = ", ".join(self._found["added"])
        response.success = True
        response.message = (
            f"{self._new} is {self._robot} with {names}; the one in use is as it was. "
            "Restart odom_node and compare_node with the new one to use it"
        )
        return response

    def _unwritable(self) -> str:
        """Reason why there is no new robot file to write; "" if there is one."""
        if self._better:
            there = f"{self._new} is there already: move it, or start with another new_robot_file"
            return there if self._new.exists() else ""
        why = self._found.get("refused") or self._verdict()[1]
        return f"there is nothing to write: {why}"


def _named(kind: type) -> str:
    """Message type in the notation of bags."""
    return f"{kind.__module__.split('.')[0]}/msg/{kind.__name__}"


def watching_of(
    node: Node, values: Mapping[str, Value], kind: type, subscribe: Callable[..., None]
) -> NoWatching:
    """Create what the parameters request."""
    if not values["robot_file"]:
        return NoWatching()
    return Watching(node, values, kind, subscribe)
