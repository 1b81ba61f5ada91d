# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A thousand messages a second: none lost, every tick in the pose; in a minute, no memory eaten."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from test.memory import resident
from test.ros.messages import in_plane, seconds_of, yaw_of
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import trajectory

RATE = 1000.0


def test_four_seconds(launch: Callable[..., Any], robot: dict[str, Any], tmp_path: Path) -> None:
    soak(launch(robot), tmp_path, 4.0)


@pytest.mark.evidence
def test_a_minute(launch: Callable[..., Any], robot: dict[str, Any], tmp_path: Path) -> None:
    memory = soak(launch(robot), tmp_path, 60.0)
    # The pieces kept for RViz and the queues of DDS fill up in the first ten to twenty seconds.
    # After that nothing grows: of 30,000 messages not twenty bytes each are kept.
    assert memory[-1] - memory[len(memory) // 2] < 0.5e6


def soak(node: Any, folder: Path, seconds: float) -> list[int]:
    """Resident memory each second [bytes]; asserts what holds over any time."""
    out = folder / "sent.npy"
    script = Path(__file__).with_name("feeder.py")
    feeder = subprocess.Popen(
        [sys.executable, str(script), str(RATE), str(seconds), str(out)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=node.environment,
    )
    try:
        received, last, memory, cpu = listened(node, round(RATE * seconds))
        rate = feeder.stdout.readline().strip()
    finally:
        feeder.communicate("", timeout=10.0)
    stamps, left, right = np.load(out)
    model = trajectory(Robot(0.35, 0.05, 2000.0, 1000.0), 1e-9 * (stamps - stamps[0]), left, right)
    counts = node.counts()
    first, middle, end = (memory[place] / 1e6 for place in (0, len(memory) // 2, -1))
    print(
        f"\n{stamps.size} messages sent at {rate}; {counts['messages']} arrived, "
        f"{counts['lost by DDS']} lost by DDS; {received} odometry messages received; "
        f"{cpu / stamps.size * 1e6:.0f} us of CPU a message; resident memory {first:.1f} MB after "
        f"a second, {middle:.1f} MB half way, {end:.1f} MB at the end"
    )
    assert counts["messages"] + counts["lost by DDS"] == stamps.size
    assert counts["published"] == counts["messages"] - 1
    # This test's own listener may be starved on a busy machine, which says nothing of the node.
    assert 0 < received <= counts["published"]
    position = last.pose.pose.position
    assert position.x == pytest.approx(model.x[-1], abs=1e-9)
    assert position.y == pytest.approx(model.y[-1], abs=1e-9)
    turned = math.remainder(yaw_of(last.pose.pose) - model.yaw[-1], 2.0 * math.pi)
    assert turned == pytest.approx(0.0, abs=1e-9)
    covariance = in_plane(last.pose.covariance)
    np.testing.assert_allclose(covariance, model.covariance.matrix()[-1], rtol=1e-8)
    return memory


def listened(node: Any, expected: int) -> tuple[int, Any, list[int], float]:
    """Odometry messages until the last, that one, resident memory each second, CPU time [s]."""
    last_stamp = 1_000_000 + (expected - 1) / RATE
    received, last, memory = 0, None, []
    node.until(lambda: bool(node.odometry), "odometry")
    begin = cpu_time(node.process.pid)
    while last is None or abs(seconds_of(last) - last_stamp) > 1e-6:
        seen = len(node.diagnostics)
        node.until(
            lambda seen=seen: len(node.diagnostics) > seen or arrived(node, last_stamp), "report"
        )
        memory.append(resident(node.process.pid))
        if node.odometry:
            last = node.odometry[-1]
        received += len(node.odometry)
        node.odometry.clear()
    node.report()
    node.report()
    return received, last, memory, cpu_time(node.process.pid) - begin


def arrived(node: Any, last_stamp: float) -> bool:
    return bool(node.odometry) and abs(seconds_of(node.odometry[-1]) - last_stamp) < 1e-6


def cpu_time(process: int) -> float:
    """User and system time [s]."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(") ")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
