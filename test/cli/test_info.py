# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From a bag that nobody has seen to a robot file and the command that comes next, which works."""

from __future__ import annotations

import json
import math
import shlex
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.files.conftest import Messages
from test.inference.driven import run_of
from test.inference.test_held_or_carried import held
from test.model.drives import ROBOT
from werrimbi_odom.cli.main import main
from werrimbi_odom.files.controller_wheels import of_controller
from werrimbi_odom.files.first_robot import with_steps
from werrimbi_odom.files.stamps import _judged
from werrimbi_odom.files.urdf_wheels import of_urdf
from werrimbi_odom.report.info_words import _clock
from werrimbi_odom.simulation.lidar import Lidar

DAY = 1_700_000_000
JOINTS = ("drive_left_joint", "drive_right_joint")

WHEEL = """
  <joint name="{name}" type="continuous">
    <parent link="chassis"/><child link="{name}_link"/>
    <origin xyz="0.05 {y} 0.01" rpy="-1.5707963 0 0"/><axis xyz="0 0 1"/>
  </joint>
  <link name="{name}_link"><collision><geometry>
    <cylinder radius="{radius}" length="0.02"/>
  </geometry></collision></link>
"""
URDF = """<robot name="a_robot"><link name="base_footprint"/><link name="chassis"/>
  <joint name="up" type="fixed"><parent link="base_footprint"/><child link="chassis"/>
    <origin xyz="0 0 0.04" rpy="0 0 {yaw}"/></joint>
  <joint name="castor_joint" type="continuous"><parent link="chassis"/><child link="castor"/>
    <origin xyz="-0.2 0.01 0"/><axis xyz="0 1 0"/></joint><link name="castor"/>{wheels}</robot>"""


def urdf(yaw: float = 0.0) -> str:
    """Of the robot that is driven."""
    half, radius = 0.5 * ROBOT.wheel_separation, ROBOT.wheel_radius
    wheels = [
        WHEEL.format(name=name, y=y, radius=radius)
        for name, y in zip(JOINTS, (half, -half), strict=True)
    ]
    return URDF.format(wheels="".join(wheels), yaw=yaw)


def bag_of(folder: Path, *, described: bool = True, measured: bool = True) -> tuple[Path, float]:
    """A bag as people have it: joints, gyro, own odometry, poses of a tracker; begin of a hold."""
    ros, random = Messages(), np.random.default_rng(4)
    run, begin, _ = held(run_of(ROBOT, 1, 40), 20.0, 26.0)
    reference = run.reference
    assert reference is not None
    late = random.exponential(0.02, 10_000)
    entries = []

    def add(topic: str, seconds: float, message: object) -> None:
        stamp = DAY * 10**9 + round(seconds * 1e9)
        entries.append((topic, stamp + round(1e9 * late[len(entries)]), message))

    per_turn = ROBOT.left_ticks_per_revolution
    for time, *counts in zip(run.ticks.time, run.ticks.left, run.ticks.right, strict=True):
        stamp = DAY * 10**9 + round(time * 1e9)
        angles = [2.0 * math.pi * round(count) / per_turn for count in counts]
        add("/joint_states", time, ros.joints(stamp, JOINTS, angles))
        add("/odom", time, ros.odometry(stamp, 0.0, 0.0, 0.0))
    poses = zip(reference.time, reference.x, reference.y, reference.yaw, strict=True)
    rates = np.gradient(reference.yaw, reference.time)
    for rate, (time, *pose) in zip(rates, poses, strict=True):
        stamp = DAY * 10**9 + round(time * 1e9)
        if measured:
            add("/imu", time, ros.imu(stamp, rate))
            add("/vrpn/robot/pose", time, ros.pose(stamp, *pose))
    if described:
        text = ros.make("std_msgs/msg/String", urdf())
        add("/robot_description", 0.0, ("std_msgs/msg/String", text))
    entries.sort(key=lambda entry: entry[1])
    return ros.write(folder / "a bag", entries, "sqlite3"), begin


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float]:
    return bag_of(tmp_path_factory.mktemp("info"))


def test_three_commands_from_a_bag_to_the_verdict(
    recording: tuple[Path, float],
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bag, _ = recording
    monkeypatch.chdir(tmp_path)
    assert main(["info", str(bag)]) == 0
    words = " ".join(capsys.readouterr().out.split())
    assert "Wheels: /joint_states, angles of the wheels at 20 Hz" in words
    assert "Reference /vrpn/robot/pose: poses at 5 Hz" in words
    assert "No reference: /odom" in words
    assert "believe the headers" in words
    assert "was held for" in words
    assert "the wheels turned and the robot did not: held, or against a wall. Left out." in words
    commands = [words.rpartition("Next: a first robot file. ")[2]]
    for verb in ("info", "compare"):
        said = shlex.split(commands[-1])
        assert said[:2] == ["werrimbi", verb]
        assert main([*said[1:], "--json", f"{verb}.json"]) == 0, commands[-1]
        printed = capsys.readouterr().out
        commands.append(next((line for line in printed.splitlines() if "    werri" in line), ""))
    robot = wo.read_robot(tmp_path / "robot.yaml")
    assert robot.robot.wheel_separation == pytest.approx(ROBOT.wheel_separation, abs=1e-5)
    assert robot.robot.wheel_radius == pytest.approx(ROBOT.wheel_radius, abs=1e-6)
    assert robot.robot.left_ticks_per_revolution == ROBOT.left_ticks_per_revolution
    found = json.loads(Path("info.json").read_text())
    compared = json.loads(Path("compare.json").read_text())
    (run,) = found["runs"]
    assert run["left_out"] == compared["left_out"]
    assert [each["topic"] for each in run["references"] if each["taken"]] == ["/vrpn/robot/pose"]
    assert run["stamps"]["/joint_states"]["rate"] == pytest.approx(20.0, rel=0.01)
    assert run["stamps"]["/joint_states"]["jitter"] < 1e-4
    spans = dict.fromkeys(("stood", "drove", "held"), 0.0)
    for span in run["spans"]:
        spans[span["what"]] += span["to_s"] - span["from_s"]
    assert spans["held"] == pytest.approx(5.0, abs=1.5)
    assert compared["legs"]["count"] > 20


def test_from_python_it_is_the_same(recording: tuple[Path, float], tmp_path: Path) -> None:
    bag, begin = recording
    result = wo.info(bag, out=tmp_path / "robot.yaml")
    found = result.to_dict()
    (stretch,) = found["runs"][0]["left_out"]
    assert stretch["why"] == "held"
    assert stretch["from_s"] - DAY == pytest.approx(begin, abs=0.5)
    assert found["robot"] == str(tmp_path / "robot.yaml")
    assert found["next"].startswith("werrimbi compare --robot")
    assert "The" not in repr(result)
    assert str(bag) in result.summary()


def test_without_sizes_it_says_what_to_measure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag, _ = bag_of(tmp_path, described=False)
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "measure the wheels' radius and the distance between them" in printed
    assert " m and turned" not in printed
    assert main(["info", str(bag), "--out", str(tmp_path / "new.yaml")]) == 2
    told = capsys.readouterr()
    assert "/robot_description" in told.err
    assert " ".join(told.out.split()) == printed  # what it holds is told all the same
    parameters = tmp_path / "controllers.yaml"
    parameters.write_text(
        "controller_manager:\n  ros__parameters:\n    update_rate: 50\n"
        "diff_drive_controller:\n  ros__parameters:\n"
        f"    left_wheel_names: [{JOINTS[0]}]\n    right_wheel_names: [{JOINTS[1]}]\n"
        f"    wheel_separation: {ROBOT.wheel_separation}\n    wheel_radius: {ROBOT.wheel_radius}\n"
        "    left_wheel_radius_multiplier: 1.01\n    linear.x.max_velocity: 1.0\n"
    )
    capsys.readouterr()
    assert main(["info", str(bag), "--robot", str(parameters)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert f"--robot {parameters} --out robot.yaml" in printed, "else it has no sizes to write"
    out = tmp_path / "new.yaml"
    words = ["info", str(bag), "--robot", str(parameters), "--out", str(out)]
    assert main(words) == 0
    robot = wo.read_robot(out).robot
    assert robot.left_wheel_radius_multiplier == 1.01
    assert robot.left_ticks_per_revolution == ROBOT.left_ticks_per_revolution
    assert main(words) == 2  # it is not overwritten


def test_a_robot_file_with_a_mistake_is_not_taken_for_a_controllers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag, _ = bag_of(tmp_path)
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(
        "odom_node:\n  ros__parameters:\n    wheel_separation: 0.4\n    wheel_radius: 0.1\n"
        "    ticks_per_revolution: 1000.0\n"
    )
    assert main(["info", str(bag), "--robot", str(wrong)]) == 2
    assert "unknown parameter ticks_per_revolution" in capsys.readouterr().err


def test_without_a_reference_it_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag, _ = bag_of(tmp_path, measured=False)
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "Nothing that is read in the bag measures the robot but its own wheels" in printed
    assert "Record again with something that measures the robot" in printed


def one_drive(*spaces: str, wheels_late: int = 0) -> list[tuple[str, int, object]]:
    """Poses and wheels that roll ahead for 30 s, of as many robots as there are namespaces."""
    ros = Messages()
    entries: list[tuple[str, int, object]] = []
    for number in range(300):
        at = DAY * 10**9 + number * 10**8
        for space in spaces:
            wheels = ros.joints(at + wheels_late * 10**9, JOINTS, [0.1 * number] * 2)
            entries.append((f"{space}/joint_states", at, wheels))
            entries.append((f"{space}/pose", at, ros.pose(at, 0.005 * number, 0.0, 0.0)))
    return entries


def test_of_two_robots_each_is_judged_by_its_own_reference(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = Messages().write(tmp_path / "two", one_drive("/one", "/two"))
    for mine, other in (("one", "two"), ("two", "one")):
        assert main(["info", str(bag), "--ticks-topic", f"/{mine}/joint_states"]) == 0
        printed = " ".join(capsys.readouterr().out.split())
        assert f"Wheels: /{mine}/joint_states" in printed
        assert f"not looked at, but may tell of wheels: /{other}/joint_states" in printed.lower()
        assert f"Reference /{mine}/pose: poses at 10 Hz" in printed
        assert printed.count("It is taken") == 1
        assert printed.index(f"/{mine}/pose: poses") < printed.index("It is taken")


def test_clocks_apart_are_told_with_both_spans_and_put_on_the_recorders(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The robot's computer began at another date; one recorder received it all by one clock."""
    bag = Messages().write(tmp_path / "apart", one_drive("", wheels_late=5 - DAY))
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "the reference's stamps are 1.7e+09 s later than those of the wheels" in printed
    assert f"and reference ({DAY} to {DAY + 29.9:.14g}) are of two clocks" in printed
    assert "In 29.9 s the robot drove for 29.9 s" in printed
    assert "cannot be used" not in printed


def test_poses_that_repeat_are_left_out_as_where_drives_are_judged(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A tracker's last pose, sent on for 2 s at a time, is not a robot that somebody holds."""
    entries = one_drive("")
    poses = [each for each in entries if each[0] == "/pose"]
    ros = Messages()
    for number, (topic, at, _) in enumerate(poses):
        seen = 20 * (number // 20) if 100 <= number < 200 else number
        entries[entries.index(poses[number])] = (topic, at, ros.pose(at, 0.005 * seen, 0.0, 0.0))
    bag = ros.write(tmp_path / "sticks", entries)
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "reference poses repeat the one before to the last digit" in printed
    assert "held, or against a wall" not in printed


def test_an_array_of_floats_is_told_with_how_it_is_read(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ros = Messages()
    entries = [("/wheel_ticks", n * 10**8, ros.floats(10.0 * n, 10.0 * n)) for n in range(1, 100)]
    bag = ros.write(tmp_path / "floats", entries)
    assert main(["info", str(bag)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "if its two values count both wheels, --ticks-topic /wheel_ticks reads them" in printed
    assert main(["info", str(bag), "--ticks-topic", "/wheel_ticks"]) == 0
    assert "Wheels: /wheel_ticks, counters at 10 Hz" in capsys.readouterr().out


def test_a_run_folder_is_looked_at_too(capsys: pytest.CaptureFixture[str]) -> None:
    square = Path(wo.__file__).parent / "recordings" / "square"
    assert main(["info", str(square), "--robot", str(square / "robot.yaml")]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "Reference: reference.csv, poses." in printed
    assert "werrimbi compare --robot" in printed


def test_the_bias_of_a_gyro_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    counts = [100.0 * max(0.0, 0.1 * n - 3.0) for n in range(90)]
    rows = [f"{0.1 * n},{each:.0f},{each:.0f}" for n, each in enumerate(counts)]
    (tmp_path / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + "\n".join(rows))
    turned = [f"{0.1 * n},,,{-0.002 * n}" for n in range(90)]
    (tmp_path / "reference.csv").write_text("t_s,x_m,y_m,yaw_rad\n" + "\n".join(turned))
    robot = Path(wo.__file__).parent / "recordings" / "square" / "robot.yaml"
    assert main(["info", str(tmp_path), "--robot", str(robot)]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "Its headings turn by -1.1°/s while the wheels stand: a gyro's bias" in printed


@pytest.mark.parametrize("yaw", [0.0, 0.3])
def test_sizes_of_a_urdf(yaw: float) -> None:
    found = of_urdf(urdf(yaw), JOINTS)
    if yaw:  # a chassis that is mounted askew: its wheels do not roll along the robot's axis
        assert found.separation == pytest.approx(ROBOT.wheel_separation * math.cos(yaw), rel=1e-3)
        return
    assert (found.separation, found.radius) == (ROBOT.wheel_separation, ROBOT.wheel_radius)
    assert (found.left, found.right) == ((JOINTS[0],), (JOINTS[1],))
    assert not of_urdf(urdf(), ["arm_joint"]).has_sizes


@pytest.mark.parametrize(
    "text", ["", "<robot", "<robot/>", "<!DOCTYPE x [<!ENTITY a 'b'>]><robot/>"]
)
def test_what_is_no_urdf_says_nothing(text: str) -> None:
    assert not of_urdf(text).has_sizes


def test_stamps_of_a_simulation_are_of_another_clock() -> None:
    """Received in 2025, stamped from zero, by a clock that goes a little slower."""
    stamped = np.arange(0.0, 60.0, 0.05)
    words = _clock("/joint_states", _judged(stamped, 1.7e9 + 1.02 * stamped))
    assert "another clock" in words
    assert "e+09" not in words
    assert "late" not in words


@pytest.mark.parametrize(("uneven", "believed"), [(1.02, True), (1.5, False)])
def test_headers_are_believed_where_receipt_is_no_evener(uneven: float, believed: bool) -> None:
    random = np.random.default_rng(1)
    received = 0.2 * np.arange(500.0) + random.normal(0.0, 0.02, 500)
    stamped = 0.2 * np.arange(500.0) + uneven * (received - 0.2 * np.arange(500.0))
    assert ("believe the headers" in _clock("/odom", _judged(stamped, received))) is believed


def test_a_negative_multiplier_of_a_controller_is_a_reversed_wheel(tmp_path: Path) -> None:
    """So diff_drive_controller takes it; a robot file says it with an effect."""
    parameters = tmp_path / "controllers.yaml"
    parameters.write_text(
        "diff_drive_controller:\n  ros__parameters:\n    wheel_separation: 1.9\n"
        "    wheel_radius: 0.3\n    left_wheel_radius_multiplier: 1.01\n"
        "    right_wheel_radius_multiplier: -1.0\n"
    )
    out = tmp_path / "robot.yaml"
    out.write_text(of_controller(parameters).text("first"))
    robot = wo.read_robot(out).robot
    assert [each.name for each in robot.effects] == ["right_wheel_reversed"]
    assert robot.left_wheel_radius_multiplier == 1.01
    assert robot.right_wheel_radius_multiplier == 1.0


def test_a_file_without_wheels_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "other.yaml"
    path.write_text("amcl:\n  ros__parameters:\n    max_particles: 2000\n")
    with pytest.raises(wo.InputError, match="wheel_separation and wheel_radius"):
        of_controller(path)


@pytest.mark.parametrize("ticks", [512, 4096, 20000])
def test_steps_of_the_angles_tell_the_counts_of_a_turn(ticks: int) -> None:
    counts = np.cumsum(np.random.default_rng(1).integers(3, 60, 400))
    first = of_urdf(urdf())
    found = with_steps(first, [2.0 * math.pi * counts / ticks] * 2)
    assert found.ticks == ticks
    smooth = np.cumsum(np.random.default_rng(1).uniform(0.01, 0.1, 400))
    assert with_steps(first, [smooth, smooth]).ticks is None


def test_without_sizes_nothing_is_claimed_of_base_and_radii(tmp_path: Path) -> None:
    """A drive without a turn; by a size that nobody gave it would be any number of turns."""
    ros = Messages()
    entries = []
    for n in range(600):
        stamp = (DAY * 10 + n) * 10**8
        entries.append(("/joint_states", stamp, ros.joints(stamp, JOINTS, [0.2 * n, -0.2 * n])))
        entries.append(("/pose", stamp, ros.pose(stamp, 0.01 * n, 0.0, 0.0)))
    said = " ".join(wo.info(ros.write(tmp_path / "bag", entries)).summary().split())
    assert "show the base" not in said
    assert "show the ratio" not in said
    assert "Whether it can show base and radii is said once --robot gives their sizes." in said


def test_the_speeds_of_a_simulator_are_no_counts() -> None:
    """Without inertia a robot holds three speeds, and turns the same in each message."""
    steps = np.repeat([0.0, 0.135191, 0.0, 0.045064, 0.228225, 0.0], [80, 90, 30, 20, 60, 70])
    angles = np.cumsum(steps)
    assert with_steps(of_urdf(urdf()), [angles, angles]).ticks is None


def test_coarse_counts_at_one_speed_are_counts() -> None:
    """Twenty counts a turn: none or one in a message, as it comes."""
    counts = np.floor(np.arange(0.0, 100.0, 0.3))
    found = with_steps(of_urdf(urdf()), [2.0 * math.pi * counts / 20.0] * 2)
    assert found.ticks == 20.0


def in_a_hall(folder: Path, *scans: str, gyro: bool = True) -> Path:
    """A bag with a gyro, or none, and lidars that see nothing."""
    ros, lidar = Messages(), Lidar()
    run = run_of(ROBOT, 1, 40)
    assert run.reference is not None
    entries = []
    for time, *counts in zip(run.ticks.time, run.ticks.left, run.ticks.right, strict=True):
        angles = [2.0 * math.pi * count / ROBOT.left_ticks_per_revolution for count in counts]
        stamp = round(1e9 * (DAY + time))
        entries.append(("/joint_states", stamp, ros.joints(stamp, JOINTS, angles)))
    rates = np.gradient(np.unwrap(run.reference.yaw), run.reference.time)
    for time, rate in zip(run.reference.time, rates, strict=True):
        stamp = round(1e9 * (DAY + time))
        entries += [("/imu", stamp, ros.imu(stamp, rate))] if gyro else []
        nothing = np.full(lidar.beams, np.inf)
        entries += [(scan, stamp, ros.scan(stamp, lidar, nothing)) for scan in scans]
    return ros.write(folder, sorted(entries, key=lambda entry: entry[1]))


def test_where_the_scans_are_of_no_use_the_gyro_is_the_next(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the middle of a hall a lidar sees nothing; the command that is printed works."""
    bag = in_a_hall(tmp_path / "hall", "/scan")
    assert main(["info", str(bag), "--reference-topic", "/scan"]) == 0
    printed = capsys.readouterr().out
    assert "By /scan nothing can be judged" in " ".join(printed.split())
    assert main(shlex.split(printed.splitlines()[-1].strip())[1:]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "its yaw rate is integrated). It is taken." in said
    assert "It can show what happens at reversals" in said


def test_what_cannot_be_judged_either_does_not_lead_back(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The folder is called as a ROS 1 bag's file is: `ros2 bag record -o hall.bag`."""
    bag = in_a_hall(tmp_path / "hall.bag", "/scan", "/stable_scan", gyro=False)
    assert main(["info", str(bag)]) == 0
    printed = capsys.readouterr().out
    assert "By /scan nothing can be judged" in " ".join(printed.split())
    assert main(shlex.split(printed.splitlines()[-1].strip())[1:]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == "Nothing of it can be judged."


def test_a_cloud_of_points_is_told_with_what_makes_a_reference_of_it(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    ros, kind = Messages(), "sensor_msgs/msg/PointCloud2"
    none = np.zeros(0, dtype=np.uint8)
    cloud = (kind, ros.make(kind, ros.header(1), 1, 0, [], False, 16, 0, none, True))
    wheels = [("/joint_states", n, ros.joints(n, JOINTS, [0.1 * n] * 2)) for n in (1, 2, 3)]
    bag = ros.write(tmp_path / "cloud", [*wheels, ("/velodyne_points", 4, cloud)])
    assert main(["info", str(bag)]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "No reference as it is: /velodyne_points, clouds of points" in told
    assert "pointcloud_to_laserscan makes them of it" in told
