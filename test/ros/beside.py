# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Further node processes beside a `Launched`, in its domain."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest


def arguments(values: dict[str, Any]) -> list[str]:
    """Parameters on a command line of ROS."""
    words = ["--ros-args"]
    for name, value in values.items():
        if value != "":  # which no command line of ROS can say
            text = str(value).lower() if isinstance(value, bool) else str(value)
            words += ["-p", f"{name}:={text}"]
    return words


def ended(process: subprocess.Popen[Any], with_signal: int = signal.SIGINT) -> int:
    """End a process as Ctrl-C or a launch file does; returns its exit code."""
    if process.poll() is None:
        process.send_signal(with_signal)
    try:
        return process.wait(10.0)
    finally:
        process.kill()


def stand_in_for_tf2_ros(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """For nodes started after this: tf2_ros, which has no wheel; publishes what it is to send."""
    (folder / "tf2_ros.py").write_text(
        "from geometry_msgs.msg import TransformStamped\n"
        "class TransformBroadcaster:\n"
        "    def __init__(self, node):\n"
        "        self.publisher = node.create_publisher(TransformStamped, 'sent', 10)\n"
        "    def sendTransform(self, transform):\n"
        "        self.publisher.publish(transform)\n",
        encoding="utf-8",
    )
    monkeypatch.setenv("PYTHONPATH", str(folder))


class Beside:
    """A node process in the environment of a `Launched`; what it says goes into `folder`."""

    def __init__(self, folder: Path, environment: dict[str, str], node: str, **values: Any) -> None:
        self._file = folder / f"{node}_{len(list(folder.iterdir()))}.stderr"
        words = [sys.executable, "-m", f"werrimbi_odom.ros.{node}", *arguments(values)]
        with self._file.open("w", encoding="utf-8") as errors:
            self.process = subprocess.Popen(words, stderr=errors, env=environment)

    def said(self) -> str:
        """All that it has said."""
        return self._file.read_text(encoding="utf-8")

    def stop(self, with_signal: int = signal.SIGINT) -> int:
        """End it; returns its exit code."""
        return ended(self.process, with_signal)


@contextmanager
def beside(folder: Path, environment: dict[str, str], node: str, **values: Any) -> Iterator[Beside]:
    """A node that is ended at the end, and ends well."""
    one = Beside(folder, environment, node, **values)
    try:
        yield one
    finally:
        code = one.stop()
    assert code in (0, -signal.SIGKILL), one.said()
    assert "Traceback" not in one.said(), one.said()
