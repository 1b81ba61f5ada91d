# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A number of a robot file is the same number to ROS's own reader and to the command line's."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

pytest.importorskip("rclpy")

from test.robot_file import BARE
from test.ros.messages import read_by_ros
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.ros.domain import free_domain

NUMBERS = st.one_of(
    st.floats(1e-3, 1e3).map(repr),
    st.integers(1, 1000).map(str),
    st.builds(
        "{}{}{}".format,
        st.sampled_from(["", "+", "0", "0x", "0o", "0b"]),
        st.text("0123456789_.", min_size=1, max_size=5),
        st.sampled_from(["", "e1", "E1", "_"]),
    ),
)
START = BARE.removesuffix("2000.0\n")


@settings(max_examples=100, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(NUMBERS)
@example("0100")
@example("0x1F")
@example("1e3")
def test_a_number_is_the_same_to_both(tmp_path: Path, number: str) -> None:
    file = tmp_path / "robot.yaml"
    file.write_text(f"{START}{number}\n")
    try:
        to_command_line = read_robot_file(file).values["right_ticks_per_revolution"]
    except InputError:
        return
    assert to_ros(file) == to_command_line


def to_ros(file: Path) -> object:
    """What ROS's reader hands to a node."""
    domain, lock = free_domain()
    with lock:
        _, given = read_by_ros("odom_node", ["--ros-args", "--params-file", str(file)], domain)
    return given["right_ticks_per_revolution"]
