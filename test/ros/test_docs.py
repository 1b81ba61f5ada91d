# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""docs/node.md and config/robot.yaml say what the code does."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("rclpy")

from test.package.launching import launched
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter
from werrimbi_odom.files.robot_files.parameters import PARAMETERS
from werrimbi_odom.ros import compare_parameters, drive_parameters
from werrimbi_odom.ros.declared_parameters import NONE, told
from werrimbi_odom.ros.odom_parameters import CHANGEABLE

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "node.md").read_text(encoding="utf-8")


def between(first: str, last: str) -> str:
    return PAGE.partition(f"<!-- {first} -->\n")[2].partition(f"<!-- {last} -->")[0]


def test_the_table_of_parameters_is_what_the_command_prints() -> None:
    command = [sys.executable, "docs/make_parameter_table.py"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert between("parameters", "end of parameters") == printed
    assert printed.count("\n") == 2 + len(PARAMETERS)


def test_what_may_change_at_run_time_is_listed() -> None:
    listed = between("changeable", "end of changeable").strip().rstrip(".").replace("\n", " ")
    assert listed.split(", ") == [f"`{p.name}`" for p in PARAMETERS if p.name in CHANGEABLE]
    assert len(CHANGEABLE) == len(listed.split(", "))


@pytest.mark.parametrize(
    ("node", "module"),
    [("simulated_robot", "simulated_parameters"), ("drive_node", "drive_parameters")],
)
def test_the_tables_of_the_driving_page_are_what_the_commands_print(node: str, module: str) -> None:
    command = [sys.executable, "-m", f"werrimbi_odom.ros.{module}"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout
    page = (ROOT / "docs" / "driving.md").read_text(encoding="utf-8")
    kept = page.partition(f"<!-- {node} -->\n")[2].partition(f"<!-- end of {node} -->")[0]
    assert kept == printed


@pytest.mark.parametrize(
    ("name", "parameters", "own"),
    [
        ("drive.launch.xml", drive_parameters.PARAMETERS, {"record": "drives"}),
        ("compare.launch.xml", compare_parameters.PARAMETERS, {}),
    ],
    ids=["drive", "compare"],
)
def test_a_launch_file_takes_every_parameter_of_its_node(
    name: str, parameters: tuple[NodeParameter, ...], own: dict[str, str]
) -> None:
    """One that it lacks would be ignored without a word: a scan that is to stop the robot, say."""
    asked = {"reference": "pose"} if "compare" in name else {}
    for item in parameters:
        (process,) = launched(ROOT, name, **asked)
        default = own.get(item.name, told(item.default) if item.default != "" else NONE)
        assert f"{item.name}:={default}" in process.arguments
        (process,) = launched(ROOT, name, **asked, **{item.name: "sentinel"})
        assert f"{item.name}:=sentinel" in process.arguments
