# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Robot files that are right: read, written again with their comments, read by ROS's own means."""

from __future__ import annotations

import os
import re
import stat
from pathlib import Path

import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from test.command_line import ROOT
from test.robot_file import BARE
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value
from werrimbi_odom.files.robot_files.parameters import PARAMETERS, on_both_sides
from werrimbi_odom.files.robot_files.robot_file import RobotFile, read_robot_file
from werrimbi_odom.files.robot_files.robot_file_rewrite import write_robot_file

COMMENTED = """\
# The robot in the cellar.

odom_node:
    ros__parameters:
        # ruler
        wheel_separation: 0.35              # m, nominal
        wheel_radius: 5e-2                  # m

        # encoders, see the label
        left_ticks_per_revolution: 2000     # counted twice
        right_ticks_per_revolution: 2000.0
        right_wheel_noise: 0.00058
        left_wheel_names:
          - front_left   # steel
          - rear_left    # rubber
        # right side
        right_wheel_names: [front_right, 'rear_right']   # both rubber
        enable_odom_tf: yes
# the end
"""


@pytest.fixture
def commented(tmp_path: Path) -> RobotFile:
    path = tmp_path / "robot.yaml"
    path.write_text(COMMENTED)
    return read_robot_file(path)


def test_values_are_complete_and_typed(commented: RobotFile) -> None:
    assert set(commented.values) == {item.name for item in PARAMETERS}
    assert commented.values["wheel_radius"] == 0.05
    assert type(commented.values["left_ticks_per_revolution"]) is float
    assert commented.values["left_wheel_names"] == ("front_left", "rear_left")
    assert commented.values["enable_odom_tf"] is True, "ROS reads YAML 1.1, where yes is true"
    assert commented.values["gap_duration"] == 1.0
    assert "gap_duration" not in commented.given
    assert commented.given[:2] == ("wheel_separation", "wheel_radius")


def test_what_it_describes(commented: RobotFile) -> None:
    assert commented.robot.track == 0.35
    assert commented.robot.left_ticks_per_revolution == 2000.0
    assert commented.tolerance.path == 0.003
    assert commented.limits.gap_duration == 1.0
    assert commented.node == "odom_node"


@pytest.mark.parametrize("node", ["/**", "/odom_node", "left_robot_odometry", "/ns/odom"])
def test_any_node_name(tmp_path: Path, node: str) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(BARE.replace("odom_node", node))
    assert read_robot_file(path).node == node


def test_other_nodes_may_stand_beside_ours(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text("ekf:\n  ros__parameters:\n    frequency: 30.0\n" + BARE)
    assert read_robot_file(path).node == "odom_node"


def test_what_every_node_understands_is_let_through(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    more = "    use_sim_time: true\n    qos_overrides./odom.publisher.depth: 10\n    effects: []\n"
    path.write_text(BARE + more)
    assert len(read_robot_file(path).given) == 4


def test_sizes_in_millimetres_are_doubted(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(COMMENTED.replace("0.35  ", "350.0").replace("5e-2", "50.0"))
    assert read_robot_file(path).remarks == (
        "wheel_separation is 350 m: is it in millimetres?",
        "wheel_radius is 50 m: is it in millimetres?",
    )


def test_line_ends_of_windows_and_a_byte_order_mark(tmp_path: Path) -> None:
    path = tmp_path / "robot.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + BARE.replace("\n", "\r\n").encode())
    assert read_robot_file(path).robot.wheel_radius == 0.05


def test_the_shipped_file_gives_every_parameter_its_default() -> None:
    shipped = read_robot_file(ROOT / "config" / "robot.yaml")
    assert set(shipped.given) == {item.name for item in PARAMETERS}
    for item in PARAMETERS:
        if item.default is not None:
            assert shipped.values[item.name] == item.default, item.name


def test_a_change_touches_its_own_lines_alone(commented: RobotFile, tmp_path: Path) -> None:
    out = tmp_path / "new.yaml"
    changes: dict[str, Value] = {
        "wheel_radius": 1e-5,
        "wheel_separation_multiplier": 1.02,
        "left_wheel_names": ("a", "b"),
        "gap_duration": 2.0,
    }
    written = write_robot_file(commented, changes, out)
    expected = COMMENTED.replace("5e-2                  # m", "1.0e-05               # m")
    expected = expected.replace("# m\n\n", "# m\n        wheel_separation_multiplier: 1.02\n\n")
    expected = expected.replace("2000     # counted", "2000.0   # counted")
    expected = expected.replace("- front_left   # steel", "- a")
    expected = expected.replace("- rear_left    # rubber", "- b    # rubber")
    noise = "        right_wheel_noise: 0.00058\n"
    expected = expected.replace(noise, noise + "        gap_duration: 2.0\n")
    assert _single_spaced(out.read_text()) == _single_spaced(expected)
    assert written.text == out.read_text()
    assert read_robot_file(out).values == {**commented.values, **changes}


def _single_spaced(text: str) -> list[str]:
    return [re.sub(r"(?<=\S) +", " ", line) for line in text.splitlines()]


def test_nothing_changed_is_the_same_text(tmp_path: Path) -> None:
    source = read_robot_file(ROOT / "config" / "robot.yaml")
    write_robot_file(source, {"wheel_radius": 0.05}, tmp_path / "same.yaml")
    assert (tmp_path / "same.yaml").read_text() == source.text


def test_an_added_value_stands_above_the_comment_of_what_follows(tmp_path: Path) -> None:
    path, out = tmp_path / "robot.yaml", tmp_path / "new.yaml"
    path.write_text(BARE + "\n# footer\n")
    write_robot_file(read_robot_file(path), {"encoder_bits": 16}, out)
    assert out.read_text() == BARE + "    encoder_bits: 16\n\n# footer\n"


def test_other_nodes_are_kept(tmp_path: Path) -> None:
    path, out = tmp_path / "robot.yaml", tmp_path / "new.yaml"
    other = "ekf:\n  ros__parameters:\n    frequency: 30.0  # Hz\n"
    path.write_text(other + BARE)
    write_robot_file(read_robot_file(path), {"wheel_radius": 0.06}, out)
    assert out.read_text() == other + BARE.replace("0.05", "0.06")


def test_an_existing_file_is_safe_without_force(commented: RobotFile, tmp_path: Path) -> None:
    out = tmp_path / "new.yaml"
    out.write_text("precious")
    with pytest.raises(InputError, match=r"new\.yaml exists; --force"):
        write_robot_file(commented, {}, out)
    assert out.read_text() == "precious"
    write_robot_file(commented, {"wheel_radius": 0.06}, out, force=True)
    assert read_robot_file(out).values["wheel_radius"] == 0.06


def test_in_place_with_force_keeps_mode_and_link(commented: RobotFile, tmp_path: Path) -> None:
    commented.path.chmod(0o640)
    link = tmp_path / "link.yaml"
    link.symlink_to(commented.path)
    write_robot_file(commented, {"wheel_radius": 0.06}, link, force=True)
    assert link.is_symlink()
    assert stat.S_IMODE(commented.path.stat().st_mode) == 0o640
    assert read_robot_file(commented.path).values["wheel_radius"] == 0.06


@pytest.mark.parametrize(
    ("changes", "out", "words"),
    [
        ({"wheel_radius": -1.0}, "new.yaml", "wheel_radius must be a number greater than 0"),
        ({"wheel_radius": 1e22}, "new.yaml", "wheel_radius times left_wheel_radius_multiplier"),
        ({"wheel_radus": 1.0}, "new.yaml", "the nearest known one is wheel_radius"),
        ({}, "nowhere/new.yaml", "No such file or directory"),
        ({}, ".", "is a folder"),
    ],
)
def test_a_failed_write_leaves_nothing(
    commented: RobotFile, tmp_path: Path, changes: dict[str, Value], out: str, words: str
) -> None:
    before = sorted(os.listdir(tmp_path))
    with pytest.raises(InputError, match=re.escape(words)):
        write_robot_file(commented, changes, tmp_path / out, force=True)
    assert sorted(os.listdir(tmp_path)) == before


def test_written_files_are_read_by_yaml_1_1(commented: RobotFile, tmp_path: Path) -> None:
    """ROS reads YAML 1.1: there 1e-05 is a text and yes is a truth value."""
    out = tmp_path / "new.yaml"
    changes: dict[str, Value] = {
        "left_wheel_noise": 1e-5,
        "piece_path_tolerance": 1e22,
        "odom_frame_id": "yes",
        "base_frame_id": "12",
        "left_wheel_names": ("no", "a b", "null", "3.5", "c"),
    }
    written = write_robot_file(commented, changes, out)
    yaml_1_1 = YAML(typ="safe", pure=True)
    yaml_1_1.version = (1, 1)
    block = yaml_1_1.load(out.read_text())["odom_node"]["ros__parameters"]
    for name in written.given:
        value = written.values[name]
        assert block[name] == (list(value) if isinstance(value, tuple) else value), name
        assert isinstance(block[name], list if isinstance(value, tuple) else type(value)), name


def test_written_files_are_read_by_a_real_node(
    commented: RobotFile, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rclpy = pytest.importorskip("rclpy", reason="rclpy is not installed")
    out = tmp_path / "new.yaml"
    written = write_robot_file(commented, {"wheel_radius": 1e-5, "odom_frame_id": "yes"}, out)
    monkeypatch.setenv("ROS_LOG_DIR", str(tmp_path))
    context = rclpy.Context()
    rclpy.init(args=["--ros-args", "--params-file", str(out)], context=context)
    try:
        node = rclpy.create_node(
            "odom_node", context=context, automatically_declare_parameters_from_overrides=True
        )
        found = {name: node.get_parameter(name).value for name in written.given}
        node.destroy_node()
    finally:
        context.try_shutdown()
    for name in written.given:
        value = written.values[name]
        assert found[name] == (list(value) if isinstance(value, tuple) else value), name
        assert type(found[name]) is (list if isinstance(value, tuple) else type(value)), name


# What a robot can have together; the others may be anything.
SIZES = {
    **{item.name: (1e-2, 1e2) for item in PARAMETERS if "wheel_" in item.name},
    **{item.name: (1.0, 1e9) for item in PARAMETERS if "_per_revolution" in item.name},
    **{item.name: (0.0, 1e3) for item in PARAMETERS if "_noise" in item.name},
}


def _values(item: NodeParameter) -> st.SearchStrategy[Value]:
    if item.choices:
        return st.sampled_from(item.choices)
    if item.kind == "integer":
        assert item.minimum is not None
        assert item.maximum is not None
        whole = st.integers(int(item.minimum), int(item.maximum))
        return whole.filter(lambda bits: bits != 1) if item.name == "encoder_bits" else whole
    if item.kind == "float" and item.name in SIZES:
        return st.floats(*SIZES[item.name])
    if item.kind == "float":
        low = item.minimum if item.minimum is not None else item.above
        return st.floats(low, 1e300, exclude_min=item.above is not None)
    if item.kind == "boolean":
        return st.booleans()
    texts = st.text(st.characters(codec="utf-8", exclude_categories=["C", "Zl", "Zp"]), min_size=1)
    return texts if item.kind == "string" else st.lists(texts, min_size=1, max_size=4).map(tuple)


CHANGES = st.fixed_dictionaries({}, optional={item.name: _values(item) for item in PARAMETERS})


@pytest.mark.parametrize(
    "names", [("front_left",), ("other", "front_left"), ("x", "0", "y", "0"), ("rear_left",)]
)
def test_the_comment_beside_the_last_wheel_stays_when_that_wheel_goes(
    commented: RobotFile, tmp_path: Path, names: tuple[str, ...]
) -> None:
    out = tmp_path / "new.yaml"
    first = write_robot_file(commented, {"left_wheel_names": names}, out)
    assert read_robot_file(out).values["left_wheel_names"] == names
    again = names[-2:-1] or ("other",)
    write_robot_file(first, {"left_wheel_names": again}, out, force=True)
    assert read_robot_file(out).values["left_wheel_names"] == again
    assert "# rubber" in out.read_text()


def test_a_brace_in_a_name_is_quoted_in_a_list(commented: RobotFile, tmp_path: Path) -> None:
    out = tmp_path / "new.yaml"
    write_robot_file(commented, {"right_wheel_names": ("A{", "b}")}, out)
    assert read_robot_file(out).values["right_wheel_names"] == ("A{", "b}")


@settings(
    max_examples=30,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(changes=CHANGES, again=CHANGES)
def test_any_change_is_read_back_and_every_comment_stays(
    commented: RobotFile, tmp_path: Path, changes: dict[str, Value], again: dict[str, Value]
) -> None:
    for change in (changes, {**changes, **again}):
        assume(not on_both_sides({**commented.values, **change}))  # refused, as the node does
    out = tmp_path / "new.yaml"
    first = write_robot_file(commented, changes, out, force=True)
    second = write_robot_file(first, again, out, force=True)
    assert second.values == {**commented.values, **changes, **again}
    assert read_robot_file(out).values == second.values
    text = out.read_text(encoding="utf-8")
    block_lists = {"left_wheel_names"} & {*changes, *again}
    for comment in re.findall(r"# .*", COMMENTED):
        assert comment in text or (block_lists and comment == "# steel"), comment
    order = [name for name in second.given if name in commented.given]
    assert order == list(commented.given)
