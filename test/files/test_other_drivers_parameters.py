# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameter files of other drivers: read where the names are the same, else told all at once."""

from __future__ import annotations

from pathlib import Path

import pytest

from test.evidence import in_evidence
from werrimbi_odom.api.odom import odometry
from werrimbi_odom.effects import find
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_descriptions.controller_wheels import of_controller
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.files.robot_files.robot_file_rewrite import write_robot_file
from werrimbi_odom.ros.odom_parameters import settings_of

RECORDINGS = Path(__file__).parents[2] / "werrimbi_odom" / "recordings"
TICKS_PER_REVOLUTION = ("left_ticks_per_revolution", "right_ticks_per_revolution")
CONTROLLERS = """\
controller_manager:
  ros__parameters:
    update_rate: 50  # Hz
    joint_state_broadcaster:
      type: joint_state_broadcaster/JointStateBroadcaster
    diffbot_base_controller:
      type: diff_drive_controller/DiffDriveController

diffbot_base_controller:
  ros__parameters:
    left_wheel_names: ["left_wheel_joint"]
    right_wheel_names: ["right_wheel_joint"]
    wheel_separation: 0.10
    #wheels_per_side: 1  # actually 2, but both are controlled by 1 signal
    wheels_per_side: 1
    wheel_radius: 0.015
    wheel_separation_multiplier: 1.0
    left_wheel_radius_multiplier: 1.0
    right_wheel_radius_multiplier: 1.0
    publish_rate: 50.0
    odom_frame_id: odom
    base_frame_id: base_link
    pose_covariance_diagonal : [0.001, 0.001, 0.001, 0.001, 0.001, 0.01]
    twist_covariance_diagonal: [0.001, 0.001, 0.001, 0.001, 0.001, 0.01]
    open_loop: true
    enable_odom_tf: true
    cmd_vel_timeout: 0.5
    use_stamped_vel: true
    linear.x.has_velocity_limits: true
    linear.x.max_velocity: 1.0
    angular:
      z:
        max_velocity: 1.0
"""
TICKS = "    left_ticks_per_revolution: 2000.0\n    right_ticks_per_revolution: 2000.0\n"
TURTLEBOT = """\
turtlebot3_node:
  ros__parameters:
    opencr:
      id: 200
    wheels:
      separation: 0.160
      radius: 0.033
diff_drive_controller:
  ros__parameters:
    odometry:
      publish_tf: true
"""
NEWER_TURTLEBOT = """\
/**:
  turtlebot3_node:
    ros__parameters:
      enable_stamped_cmd_vel: true
      opencr:
        id: 200
      wheels:
        separation: 0.160
        radius: 0.033
/**:
  diff_drive_controller:
    ros__parameters:
      odometry:
        publish_tf: true
"""
"""One key twice, and nodes below it: ROS reads both nodes."""

OWN = """\
odom_node:
  ros__parameters:
    wheel_separation: 0.35
    wheel_radius: 0.05
"""
"""A file of ours that says no more than a ruler does."""


def refused(path: Path, text: str) -> str:
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_robot_file(path)
    return str(error.value).removeprefix(str(path))


def test_a_controllers_file_is_read_and_it_is_said_what_is_not_needed(tmp_path: Path) -> None:
    path = tmp_path / "controllers.yaml"
    path.write_text(CONTROLLERS + TICKS)
    found = read_robot_file(path)
    assert found.node == "diffbot_base_controller"
    assert found.robot.wheel_separation == 0.1
    (remark,) = found.remarks
    assert remark.startswith("of diff_drive_controller; not needed here: wheels_per_side, publish_")
    assert "linear.x.max_velocity, angular" in remark
    out = tmp_path / "new.yaml"
    written = write_robot_file(found, {"wheel_separation_multiplier": 1.01}, out)
    assert written.robot.track == pytest.approx(0.101)
    assert "publish_rate: 50.0" in out.read_text()


def test_parameters_of_older_controllers_are_not_needed_either(tmp_path: Path) -> None:
    """As in Clearpath's file of an A200."""
    older = ("preserve_turning_radius", "publish_cmd", "publish_wheel_data")
    path = tmp_path / "control.yaml"
    path.write_text(CONTROLLERS + TICKS + "".join(f"    {name}: true\n" for name in older))
    (remark,) = read_robot_file(path).remarks
    assert ", ".join(older) in remark


@pytest.mark.parametrize("text", [CONTROLLERS, in_evidence(TURTLEBOT), NEWER_TURTLEBOT, OWN])
def test_without_ticks_positions_in_radians_are_read_and_counts_refused(
    tmp_path: Path, text: str
) -> None:
    """The same path as with the encoder's ticks, but for the size of a count."""
    path = tmp_path / "robot.yaml"
    path.write_text(text)
    alone = read_robot_file(path)
    joints = write_robot_file(
        alone,
        {"left_wheel_names": ("left_wheel_joint",), "right_wheel_names": ("right_wheel_joint",)},
        tmp_path / "joints.yaml",
    )
    assert any("positions must come in radians" in remark for remark in joints.remarks)
    bag = RECORDINGS / "square_bag"
    both = [joints]
    both.append(write_robot_file(
        joints, dict.fromkeys(TICKS_PER_REVOLUTION, 2000.0), tmp_path / "with_ticks.yaml"
    ))  # fmt: skip
    ends = []
    for robot in both:
        ticks = read_run(bag, robot).ticks
        found = odometry(robot, ticks.time, ticks.left, ticks.right)
        ends.append((found.x[-1], found.y[-1], found.yaw[-1]))
    assert ends[0] == pytest.approx(ends[1], abs=1e-3)
    with pytest.raises(InputError, match=r"ticks\.csv holds counts, and .* does not say how many"):
        read_run(RECORDINGS / "square", joints)


def test_the_node_reads_it_too() -> None:
    given = {"wheel_separation": 0.1, "wheel_radius": 0.015, "publish_rate": 50.0}
    values = settings_of({**given, "linear.x.max_velocity": 1.0, "open_loop": True}).values
    assert values["wheel_separation"] == 0.1


def test_turtlebots_file_is_read(tmp_path: Path) -> None:
    path = tmp_path / "burger.yaml"
    path.write_text(TURTLEBOT)
    found = read_robot_file(path)
    assert (found.robot.wheel_separation, found.robot.wheel_radius) == (0.16, 0.033)
    assert found.remarks[:2] == (
        "of TurtleBot3's driver; not needed here: opencr",
        "wheels is of TurtleBot3's driver; read as wheel_separation 0.16 and wheel_radius 0.033",
    )
    written = write_robot_file(found, {"wheel_separation": 0.162}, tmp_path / "new.yaml")
    assert written.robot.wheel_separation == 0.162
    assert "separation: 0.160" in (tmp_path / "new.yaml").read_text(), "its own block stays"
    assert refused(path, TURTLEBOT.replace("0.033", "-1.0")).startswith(", line 5: wheel_radius")


def test_a_key_in_two_parts_is_one_as_to_ros(tmp_path: Path) -> None:
    path = tmp_path / "burger.yaml"
    path.write_text(NEWER_TURTLEBOT)
    found = read_robot_file(path)
    assert (found.robot.wheel_separation, found.robot.wheel_radius) == (0.16, 0.033)
    assert found.place == ("/**", "turtlebot3_node")
    assert found.remarks[0] == "/** is there twice; its parts are read as one"
    assert of_controller(path).separation == 0.16
    halves = OWN.replace("    wheel_radius: 0.05\n", "") + "odom_node:\n  ros__parameters:\n"
    path.write_text(halves + "    wheel_radius: 0.05\n" + TICKS)
    written = write_robot_file(read_robot_file(path), {"wheel_radius": 0.06}, tmp_path / "new.yaml")
    assert (written.robot.wheel_separation, written.robot.wheel_radius) == (0.35, 0.06)
    assert "duplicate key" in refused(path, halves + "    wheel_separation: 0.4\n" + TICKS)


@pytest.mark.parametrize("text", [CONTROLLERS + TICKS, TURTLEBOT, NEWER_TURTLEBOT])
def test_an_effect_is_added_and_all_that_is_not_ours_stays(tmp_path: Path, text: str) -> None:
    path = tmp_path / "robot.yaml"
    path.write_text(text)
    slip = find("lateral_slip").using(creep=0.002)
    new = write_robot_file(read_robot_file(path), {}, tmp_path / "new.yaml", effects=[slip])
    assert new.effects == (slip,)
    gone = [line for line in text.splitlines() if line not in new.text.splitlines()]
    assert gone == []


def test_everything_wrong_is_said_at_once(tmp_path: Path) -> None:
    said = refused(
        tmp_path / "robot.yaml",
        "odom_node:\n  ros__parameters:\n    wheel_separation: -1\n    wheel_radus: 0.05\n"
        "    publish_speed: 1\n    effects: [my_own]\n    my_own: {size: 1.0}\n" + TICKS,
    )
    assert said == (
        ", line 3: wheel_separation must be a number greater than 0 (m), not -1; "
        "line 4: unknown parameter wheel_radus; the nearest known one is wheel_radius; "
        "line 5: unknown parameter publish_speed (docs/node.md lists all); "
        "line 6: unknown effect my_own (all: werrimbi explain; one of your own: give its file "
        "with --effects FILE, or pip install its package); "
        "odom_node must also give wheel_radius (m)"
    )
