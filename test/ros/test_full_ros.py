# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What only a full ROS 2 has: `ros2 launch` reads our files, robot_localization takes our odometry.

    colcon build --packages-select werrimbi_odom && source install/setup.bash
    python3 -m pytest test/ros/test_full_ros.py

Skipped where there is none: ros2cli, launch and robot_localization have no wheel on PyPI.
"""

from __future__ import annotations

import math
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("rclpy")

from nav_msgs.msg import Odometry

from test.package.launching import launched

ROOT = Path(__file__).parents[2]
LAUNCH = sorted(path.name for path in (ROOT / "launch").glob("*.launch.xml"))


def installed(package: str) -> bool:
    """Whether ROS's own command knows a package."""
    if shutil.which("ros2") is None:
        return False
    words = ["ros2", "pkg", "prefix", package]
    return subprocess.run(words, capture_output=True, check=False).returncode == 0


@pytest.mark.skipif(not installed("werrimbi_odom"), reason="needs `ros2 launch`, and colcon build")
@pytest.mark.parametrize("name", LAUNCH)
def test_ros2_launch_reads_each_file_and_tells_its_arguments(name: str) -> None:
    words = ["ros2", "launch", "werrimbi_odom", name, "--show-args"]
    end = subprocess.run(words, capture_output=True, text=True, check=False, timeout=60)
    assert end.returncode == 0, end.stderr
    assert "'namespace'" in end.stdout


@pytest.mark.skipif(not installed("robot_localization"), reason="needs robot_localization")
def test_robot_localization_goes_where_the_odometry_goes(
    launch: Any, robot: dict[str, Any]
) -> None:
    """On the odometry alone the filter has nothing else to believe, nor a reason to be surer."""
    client = launch(robot)
    ekf = launched(ROOT, "odom_ekf.launch.xml")[-1]
    words = ["ros2", "run", ekf.package, ekf.executable, *ekf.arguments]
    process = subprocess.Popen(words, env=client.environment)
    try:
        filtered: list[Odometry] = []
        client.node.create_subscription(Odometry, "odometry/filtered", filtered.append, 100)
        left = right = 0.0
        for row in range(300):
            moving = row < 250  # 5 s in a curve, then 1 s at rest
            left, right = left + 12.0 * moving, right + 8.0 * moving
            client.ticks(left, right, stamp=time.time())
            client.rest(0.02)
    finally:
        process.terminate()
        process.wait(10.0)
    assert filtered, "robot_localization said nothing on odometry/filtered"
    there, here = filtered[-1].pose, client.odometry[-1].pose
    way = math.hypot(here.pose.position.x, here.pose.position.y)
    apart = math.hypot(
        there.pose.position.x - here.pose.position.x, there.pose.position.y - here.pose.position.y
    )
    assert way > 0.3
    assert apart < 0.05 * way
    for index in (0, 7, 35):  # x, y, yaw
        assert 0.2 < there.covariance[index] / here.covariance[index] < 5.0
