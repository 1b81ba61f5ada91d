# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What launch files, RViz file, package.xml and the commands of docs/robot.md name is there."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ruamel.yaml import YAML

from test.command_line import ROOT
from test.package.launching import launched

FILES = sorted(path.name for path in (ROOT / "launch").glob("*"))
ASKED = {"compare.launch.xml": {"reference": "/vrpn/robot/pose"}}
PACKAGE_OF = {"tf2_ros": "tf2_ros_py"}  # whose Python module bears another package's name
ELSEWHERE = {("robot_localization", "ekf_node"), ("rviz2", "rviz2")}


@pytest.mark.parametrize("name", FILES)
def test_a_launch_file_starts_what_there_is_with_files_that_exist(name: str) -> None:
    processes = launched(ROOT, name, **ASKED.get(name, {}))
    assert processes
    entry_points = (ROOT / "setup.py").read_text(encoding="utf-8")
    for process in processes:
        if process.package == "werrimbi_odom":
            assert f'f"{process.executable} = {{PACKAGE}}.ros.' in entry_points
        else:
            assert (process.package, process.executable) in ELSEWHERE
        for argument in process.arguments:
            if argument.startswith(str(ROOT)):
                assert Path(argument).is_file(), argument


@pytest.mark.parametrize("name", FILES)
def test_a_launch_file_hands_its_arguments_on(name: str) -> None:
    """Namespace and simulated time reach each node that it starts."""
    given = {**ASKED.get(name, {}), "namespace": "robot1", "use_sim_time": "true"}
    for process in launched(ROOT, name, **given):
        assert "__ns:=/robot1" in process.arguments
        assert "use_sim_time:=true" in process.arguments


@pytest.mark.parametrize("name", FILES)
def test_every_argument_is_used(name: str) -> None:
    for argument in ElementTree.parse(ROOT / "launch" / name).getroot().iter("arg"):
        key = argument.attrib["name"]
        given = {**ASKED.get(name, {}), key: "sentinel"}
        words = " ".join(w for each in launched(ROOT, name, **given) for w in each.arguments)
        assert "sentinel" in words, key


def test_the_robot_file_reaches_both_launch_files_that_take_one() -> None:
    for name in ("odom.launch.xml", "odom_ekf.launch.xml"):
        first = launched(ROOT, name, robot_file="/tmp/mine.yaml")[0]
        assert first.arguments[first.arguments.index("--params-file") + 1] == "/tmp/mine.yaml"


def test_rviz_shows_path_pieces_and_ellipses_on_the_nodes_topics() -> None:
    file = YAML(typ="safe").load((ROOT / "rviz" / "odom.rviz").read_text(encoding="utf-8"))
    manager = file["Visualization Manager"]
    shown = {display["Class"].split("/")[1]: display for display in manager["Displays"]}
    assert manager["Global Options"]["Fixed Frame"] == "odom"
    assert shown["MarkerArray"]["Topic"]["Value"] == "/odom_node/pieces"
    kinds = {"line", "arc", "spin", "open"}
    assert set(shown["MarkerArray"]["Namespaces"]) == kinds | {f"{kind} ellipse" for kind in kinds}
    assert shown["Odometry"]["Topic"]["Value"] == "/odom"
    assert shown["Odometry"]["Covariance"]["Position"]["Scale"] == pytest.approx(2.4477)


@pytest.mark.parametrize("name", ["odom.rviz", "simulated.rviz"])
def test_rviz_in_a_namespace_looks_at_that_robot(name: str) -> None:
    """view.launch.xml takes every absolute name of the file to the namespace."""
    (view,) = launched(ROOT, "view.launch.xml", namespace="robot1")
    text = (ROOT / "rviz" / name).read_text(encoding="utf-8")
    topics = re.findall(r"Value: (/\S+)", text)
    assert topics
    for topic in topics:
        assert f"{topic}:={topic[1:]}" in view.arguments
    # Only what differs: the view of a simulated robot shows all that the other shows.
    shown = YAML(typ="safe").load(text)["Visualization Manager"]["Displays"]
    plain = YAML(typ="safe").load((ROOT / "rviz" / "odom.rviz").read_text(encoding="utf-8"))
    assert all(each in shown for each in plain["Visualization Manager"]["Displays"])


def test_every_message_package_that_the_nodes_import_is_a_dependency() -> None:
    stated = (ROOT / "package.xml").read_text(encoding="utf-8")
    imported = {
        found
        for path in (ROOT / "werrimbi_odom" / "ros").glob("*.py")
        for found in re.findall(
            r"^\s*(?:from|import) (\w+(?:_msgs|_srvs|_interfaces|_ros)|rclpy)",
            path.read_text(),
            re.M,
        )
    }
    assert imported >= {"rclpy", "nav_msgs", "tf2_ros", "std_msgs"}
    packages = {PACKAGE_OF.get(name, name) for name in imported}
    assert [name for name in packages if f"<exec_depend>{name}</exec_depend>" not in stated] == []


def test_every_source_file_says_whose_it_is_and_under_which_licence() -> None:
    """As ament_copyright would, which has no wheel."""
    folders = ("werrimbi_odom", "test", "benchmark", "launch")
    kinds = ("*.py", "*.xml")
    for path in (p for f in folders for kind in kinds for p in (ROOT / f).rglob(kind)):
        if path.name != "package.xml" and path.stat().st_size:
            begin = path.read_text(encoding="utf-8")[:300]
            assert "SPDX-License-Identifier: Apache-2.0" in begin, path


PAGE = (ROOT / "docs" / "robot.md").read_text(encoding="utf-8")
LAUNCHES = re.findall(r"^ros2 launch werrimbi_odom (\S+)(.*)$", PAGE, re.M)


@pytest.mark.parametrize(("name", "rest"), LAUNCHES)
def test_a_shown_launch_starts_nodes_with_its_arguments(name: str, rest: str) -> None:
    given = dict(word.split(":=") for word in rest.split())
    words = [word for process in launched(ROOT, name, **given) for word in process.arguments]
    for value in given.values():
        assert any(value in word for word in words), value


def test_every_launch_file_is_shown_with_all_its_arguments() -> None:
    assert {name for name, _ in LAUNCHES} == {path.name for path in (ROOT / "launch").iterdir()}
    for path in (ROOT / "launch").iterdir():
        row = next(line for line in PAGE.splitlines() if line.startswith(f"| `{path.name}` |"))
        stated = set(re.findall(r"`(\w+)`", row.split("|")[3]))
        assert stated == set(re.findall(r'<arg name="(\w+)"(?! value)', path.read_text()))


def test_shown_executables_are_installed() -> None:
    entry_points = (ROOT / "setup.py").read_text(encoding="utf-8")
    shown = re.findall(r"^ros2 run werrimbi_odom (\w+)", PAGE, re.M)
    assert shown
    for name in shown:
        assert f'f"{name} = ' in entry_points
