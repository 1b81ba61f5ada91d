# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheels as people have recorded them: drivers' own messages, speeds, odometry alone, ROS 1."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.model.trajectory import trajectory

MS = 10**6
WHEELS = ["left_wheel_joint", "right_wheel_joint"]
DRIVERS = {
    "turtlebot3_msgs/msg/SensorState": ("left_encoder", "right_encoder"),
    "kobuki_ros_interfaces/msg/SensorState": ("left_encoder", "right_encoder"),
    "kobuki_msgs/msg/SensorState": ("left_encoder", "right_encoder"),
    "irobot_create_msgs/msg/WheelTicks": ("ticks_left", "ticks_right"),
}


@pytest.mark.parametrize("plugin", ["mcap", "sqlite3", "ros1"])
@pytest.mark.parametrize("kind", DRIVERS)
def test_counters_of_drivers(tmp_path: Path, ros: Any, robot: Any, kind: str, plugin: str) -> None:
    left, right = DRIVERS[kind]
    entries = [
        (
            "/sensors",
            n * 50 * MS + 9,
            ros.of_driver(kind, n * 50 * MS, **{left: 7 + 30 * n, right: 9 + 40 * n}),
        )
        for n in range(1, 4)
    ]
    if plugin == "ros1":
        bag = ros.write_ros1(tmp_path / "run.bag", entries)
    else:
        bag = ros.write(tmp_path / "bag", entries, plugin)
    run = read_run(bag, robot())
    assert run.ticks.time.tolist() == [0.05, 0.1, 0.15], "stamps, not times of receipt"
    assert run.ticks.left.tolist() == [37, 67, 97]
    assert run.ticks.right.tolist() == [49, 89, 129]
    assert run.ticks.left.dtype == np.int64


@pytest.mark.parametrize("wish", [None, "sensors", "/sensors"])
def test_a_topic_that_was_recorded_without_its_slash(
    tmp_path: Path, ros: Any, robot: Any, wish: str | None
) -> None:
    """As by `rosbag record sensors`."""
    kind = "kobuki_msgs/msg/SensorState"
    entries = [
        ("sensors", n * MS, ros.of_driver(kind, n * MS, left_encoder=n, right_encoder=2 * n))
        for n in range(1, 4)
    ]
    bag = ros.write_ros1(tmp_path / "run.bag", entries)
    assert read_run(bag, robot(), ticks_topic=wish).ticks.right.tolist() == [2, 4, 6]


def test_a_bag_without_definitions(tmp_path: Path, ros: Any, robot: Any) -> None:
    """As a sqlite3 bag of ROS 2 Humble: the types come from our own list."""
    import sqlite3

    kind = "turtlebot3_msgs/msg/SensorState"
    entries = [
        ("/sensor_state", n * MS, ros.of_driver(kind, n * MS, left_encoder=n, right_encoder=n))
        for n in range(1, 4)
    ]
    bag = ros.write(tmp_path / "bag", entries, "sqlite3")
    with sqlite3.connect(next(bag.glob("*.db3"))) as database:
        database.execute("DELETE FROM message_definitions")
    assert read_run(bag, robot()).ticks.left.tolist() == [1, 2, 3]


def _joints_of_ros2_control(ros: Any, nanoseconds: int, left: float, right: float) -> Any:
    kind, names = "control_msgs/msg/DynamicJointState", ["castor_joint", *WHEELS]
    values = [
        ros.make("control_msgs/msg/InterfaceValue", ["velocity", "position"], np.array(both))
        for both in ([0.0, 3.0], [0.5, left], [0.5, right])
    ]
    return kind, ros.make(kind, ros.header(nanoseconds), names, values)


def test_joints_of_ros2_control_are_read_as_joint_states(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """As `joint_state_broadcaster` sends them beside its joint states, which come first."""
    entries = [
        ("/dynamic_joint_states", n * MS, _joints_of_ros2_control(ros, n * MS, 0.1 * n, 0.2 * n))
        for n in range(1, 4)
    ]
    alone = read_run(ros.write(tmp_path / "alone", entries), robot())
    assert alone.ticks.right == pytest.approx(2000.0 / (2.0 * math.pi) * np.array([0.2, 0.4, 0.6]))
    both = [("/joint_states", n * MS, ros.joints(n * MS, WHEELS, [n, n])) for n in range(1, 4)]
    beside = read_run(ros.write(tmp_path / "both", entries + both), robot())
    assert beside.ticks.right == pytest.approx(2000.0 / (2.0 * math.pi) * np.array([1, 2, 3]))


def test_a_leo_rover_by_its_firmware_alone(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Four wheels and a gyro in messages of its own, whose definitions the bag does not hold."""
    import sqlite3

    wheels, imu, none = "leo_msgs/msg/WheelStates", "leo_msgs/msg/Imu", np.zeros(4, np.float32)
    entries = []
    for n in range(1, 40):
        stamp = ros.header(n * 50 * MS).stamp
        angles = np.array([n, n, 2 * n, 2 * n], dtype=np.float32)
        rate = (0.0, 0.0, 0.5)
        states = ros.make(wheels, stamp, angles, none, none, none)
        turning = ros.make(imu, stamp, 30.0, *rate, 0.0, 0.0, 9.8)
        entries.append(("/firmware/wheel_states", n * 50 * MS + 9, (wheels, states)))
        entries.append(("/firmware/imu", n * 50 * MS + 9, (imu, turning)))
    bag = ros.write(tmp_path / "bag", entries, "sqlite3")
    with sqlite3.connect(next(bag.glob("*.db3"))) as database:
        database.execute("DELETE FROM message_definitions")
    sides = {
        "left": "[wheel_FL_joint, wheel_RL_joint]",
        "right": "[wheel_FR_joint, wheel_RR_joint]",
    }
    leo = robot(*(f"{side}_wheel_names: {names}" for side, names in sides.items()))
    run = read_run(bag, leo)
    assert run.ticks.time[:2].tolist() == [0.05, 0.1], "stamps, not times of receipt"
    per_radian = 1000.0 / (2.0 * math.pi)
    assert np.ptp(run.ticks.left) == pytest.approx(38 * per_radian)
    assert np.ptp(run.ticks.right) == pytest.approx(2 * 38 * 2 * per_radian)
    assert run.reference is not None
    assert np.ptp(run.reference.yaw) == pytest.approx(0.5 * 38 * 0.05)


def test_a_kobuki_counts_with_16_bits(tmp_path: Path, ros: Any, robot: Any) -> None:
    kind = "kobuki_ros_interfaces/msg/SensorState"
    counts = [65400, 65500, 64, 164]
    entries = [
        ("/s", n * MS, ros.of_driver(kind, n * MS, left_encoder=count, right_encoder=count))
        for n, count in enumerate(counts, start=1)
    ]
    bag = ros.write(tmp_path / "bag", entries)
    run = read_run(bag, robot())
    assert np.diff(run.ticks.left).tolist() == [100, 100, 100]
    assert read_run(bag, robot("encoder_bits: 16")).ticks.left.tolist() == counts, "as they are"


def joints(ros: Any, n: int, angles: list[float], speeds: list[float]) -> Any:
    kind, message = ros.joints(n * 100 * MS, WHEELS, angles)
    message.velocity = np.array(speeds)
    return ("/joint_states", n * 100 * MS, (kind, message))


def test_speeds_alone_are_integrated_and_said_so(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Speeds of 2 t rad/s for a second are one radian: trapezia are exact for it."""
    entries = [joints(ros, n, [], [0.2 * n, -0.2 * n]) for n in range(11)]
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.ticks.left[-1] == pytest.approx(1000 / (2 * math.pi))
    assert run.ticks.right[-1] == pytest.approx(-2000 / (2 * math.pi))
    assert any("only speeds: they are integrated" in note for note in run.notes)


def test_angles_that_never_change_are_none(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [joints(ros, n, [0.0, 0.0], [1.0, 1.0]) for n in range(11)]
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.ticks.left[-1] == pytest.approx(1000 / (2 * math.pi))
    assert run.wheels_from == "velocities", "compare and info say that they are integrated"
    entries = [joints(ros, n, [0.1 * n, 0.1 * n], [9.0, 9.0]) for n in range(11)]
    run = read_run(ros.write(tmp_path / "other", entries), robot())
    assert run.ticks.left[-1] == pytest.approx(1000 / (2 * math.pi)), "angles are what was counted"
    entries = [joints(ros, n, [0.5, 0.5], [0.0, 0.0]) for n in range(3)]
    run = read_run(ros.write(tmp_path / "still", entries), robot())
    assert not any("speeds" in note for note in run.notes), "a robot that stands has angles"


def test_angles_that_are_no_numbers_are_none(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A joint_state_broadcaster writes NaN for an interface that the hardware does not have."""
    for name, angle in (("none", math.nan), ("later", 0.0)):
        entries = [joints(ros, n, [angle if n else math.nan] * 2, [1.0, 1.0]) for n in range(11)]
        run = read_run(ros.write(tmp_path / name, entries), robot())
        assert run.ticks.left[-1] == pytest.approx(1000 / (2 * math.pi))
        assert any("only speeds: they are integrated" in note for note in run.notes)


def test_wheels_in_messages_of_their_own(tmp_path: Path, ros: Any, robot: Any) -> None:
    """Each motor has a node: both joints are there, and the nearest name was the other wheel."""
    entries = [
        ("/joint_states", n * MS, ros.joints(n * MS, [WHEELS[n % 2]], [0.1 * n])) for n in range(8)
    ]
    bag = ros.write(tmp_path / "bag", entries)
    with pytest.raises(InputError, match="joint_states: no message holds left_wheel_joint, right"):
        read_run(bag, robot())


def test_angles_that_begin_anew_at_each_turn(tmp_path: Path, ros: Any, robot: Any) -> None:
    true = 0.5 * np.arange(40)
    for name, wrapped in (
        ("around zero", np.angle(np.exp(1j * true))),
        ("from zero", true % (2 * math.pi)),
    ):
        entries = [joints(ros, n, [a, -a], []) for n, a in enumerate(wrapped)]
        run = read_run(ros.write(tmp_path / name, entries), robot())
        np.testing.assert_allclose(run.ticks.left, true * 1000 / (2 * math.pi), atol=1e-9)
        assert any("unwrapped" in note for note in run.notes)


def test_odometry_alone_is_turned_back(tmp_path: Path, ros: Any, robot: Any) -> None:
    """What the file makes of the wheels is where the odometry was; a calibration changes that."""
    file = robot()
    turns = np.cumsum(np.random.default_rng(3).normal(0.0, 30.0, (60, 2)), axis=0)
    path = trajectory(file.robot, 0.1 * np.arange(60), turns[:, 0], turns[:, 1])
    entries = [
        ("/odom", n * 100 * MS, ros.odometry(n * 100 * MS, 3 + x, y - 2, yaw))
        for n, (x, y, yaw) in enumerate(zip(path.x, path.y, path.yaw, strict=True))
    ]
    bag = ros.write(tmp_path / "bag", entries)
    run = read_run(bag, file)
    np.testing.assert_allclose(run.ticks.left, turns[:, 0] - turns[0, 0], atol=1e-6)
    np.testing.assert_allclose(run.ticks.right, turns[:, 1] - turns[0, 1], atol=1e-6)
    assert any("wheel_separation of the robot file" in note for note in run.notes)
    assert run.reference is None, "it is no measurement of itself"
    calibrated = read_run(bag, robot("wheel_separation_multiplier: 1.1"))
    np.testing.assert_allclose(calibrated.ticks.left, run.ticks.left)


def test_odometry_on_tf_alone_is_turned_back(tmp_path: Path, ros: Any, robot: Any) -> None:
    """As in bags for a SLAM: scans and transforms. Other transforms come on the same topic."""
    file = robot()
    turns = np.cumsum(np.random.default_rng(3).normal(0.0, 30.0, (60, 2)), axis=0)
    path = trajectory(file.robot, 0.1 * np.arange(60), turns[:, 0], turns[:, 1])
    entries = []
    for n, (x, y, yaw) in enumerate(zip(path.x, path.y, path.yaw, strict=True), start=1):
        at = n * 100 * MS
        moved = ros.transform(at, ("odom", "base_footprint"), 3 + x, y - 2, yaw)
        corrected = ros.transform(at, ("map", "odom"), 1e-3 * n, 0.0, 0.0)
        entries.append(("/tf", at, ros.transforms(corrected, moved)))
    bag = ros.write(tmp_path / "bag", entries)
    run = read_run(bag, file)
    np.testing.assert_allclose(run.ticks.left, turns[:, 0] - turns[0, 0], atol=1e-6)
    np.testing.assert_allclose(run.ticks.right, turns[:, 1] - turns[0, 1], atol=1e-6)
    assert run.reference is not None, "map -> odom measures"
    wished = read_run(bag, file, ticks_topic="/tf:odom:base_footprint", reference_topic="none")
    np.testing.assert_array_equal(wished.ticks.left, run.ticks.left)


def test_odometry_that_is_set_back_to_its_origin_is_no_way(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """A driver's reset in mid-drive, at (2, 1) and 0.5 rad: it was told as a counter that leapt."""
    poses = [(0.04 * n, 0.02 * n, 0.01 * n) for n in range(51)]
    poses += [(0.04 * n, 0.0, 0.0) for n in range(50)]
    entries = [
        ("/odom", n * 100 * MS, ros.odometry(n * 100 * MS, *at)) for n, at in enumerate(poses)
    ]
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    before, after = run.ticks.left[50], run.ticks.left[51]
    assert after == before
    assert run.ticks.left[-1] > before
    assert any("5.1 s after its first message the odometry was set back" in n for n in run.notes)
    home = [(0.04 * abs(50 - n), 0.0, 0.0) for n in range(100)]  # it drives home, and on
    entries = [
        ("/odom", n * 100 * MS, ros.odometry(n * 100 * MS, *at)) for n, at in enumerate(home)
    ]
    run = read_run(ros.write(tmp_path / "home", entries), robot())
    assert not any("set back" in note for note in run.notes)


def test_messages_that_were_sent_once_more_are_no_stop(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """A driver that reads its wheels at 10 Hz, publishes at 20, and once hangs for a second."""
    entries = []
    for n in range(200):
        read = 40 if 40 < n // 2 < 50 else n // 2
        kind, message = ros.odometry(n * 50 * MS, 0.05 * read, 0.0, 0.0)
        message.twist.twist.linear.x = 0.5
        entries.append(("/odom", n * 50 * MS, (kind, message)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.ticks.time.size == 91
    assert (np.diff(run.ticks.left) > 0.0).all()
    assert any(note.startswith("109 of 200 messages repeat the one before") for note in run.notes)


def sideways(ros: Any, ahead: float, aside: float) -> list[Any]:
    """Odometry of 10 s, 0.3 m/s ahead and then as fast to the left, for so many seconds each."""
    entries = []
    for n in range(100):
        x, y = 0.03 * min(n, 10 * ahead), 0.03 * min(max(n - 10 * ahead, 0.0), 10 * aside)
        entries.append(("/odom", n * 100 * MS, ros.odometry(n * 100 * MS, x, y, 0.0)))
    return entries


def test_odometry_that_goes_sideways_is_of_no_two_wheels(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    bag = ros.write(tmp_path / "mecanum", sideways(ros, 6.0, 4.0))
    with pytest.raises(InputError, match=r"sideways to its heading for \d+ % of the time. Mecanum"):
        read_run(bag, robot())
    mixed = sideways(ros, 9.9, 0.0)
    for n in np.random.default_rng(1).choice(98, 49, replace=False):  # origin, clock: another
        kind, message = ros.odometry(int(n) * 100 * MS + 140 * MS, 0.03 * n + 0.1, -0.2, 0.0)
        mixed.append(("/odom", int(n) * 100 * MS + 1, (kind, message)))
    mixed.sort(key=lambda entry: entry[1])
    with pytest.raises(InputError, match=r"two nodes publish .* stamps go back \d+ times"):
        read_run(ros.write(tmp_path / "two", mixed), robot())
    run = read_run(ros.write(tmp_path / "reset", sideways(ros, 9.8, 0.2)), robot())
    assert run.ticks.right[-1] > 0.0, "once set elsewhere, it is no mecanum robot"


@pytest.mark.parametrize("off", [-1.5, -0.5])
def test_a_driver_that_steps_along_another_heading_does_not_go_sideways(
    tmp_path: Path, ros: Any, robot: Any, off: float
) -> None:
    """The Neato's adds the turn of a step to the wrong side; over a poor radio steps are long."""
    turns = 0.5 * np.sin(0.3 * np.arange(60.0))
    yaw = np.cumsum(turns)
    steps = np.where(np.arange(60) < 40, 0.1, -0.1)
    path = np.cumsum(steps * np.exp(1j * (yaw - 0.5 * turns + off * turns)))
    entries = [
        ("/odom", n * 300 * MS, ros.odometry(n * 300 * MS, z.real, z.imag, angle))
        for n, (z, angle) in enumerate(zip(path, yaw, strict=True), start=1)
    ]
    ticks = read_run(ros.write(tmp_path / "neato", entries), robot()).ticks
    wheels = robot().robot
    driven = 0.5 * (ticks.left[-1] * wheels.left_tick + ticks.right[-1] * wheels.right_tick)
    assert driven == pytest.approx(1.9, rel=0.03)


def test_a_robot_that_only_spins_does_not_go_sideways(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A TurtleBot3 that turned by 2750 degrees and went 81 mm, by rounding as much sideways."""
    random = np.random.default_rng(1)
    x, y = np.cumsum(random.normal(0.0, 2e-5, (2, 400)), axis=1)
    entries = [
        ("/odom", n * 50 * 10**6, ros.odometry(n * 50 * 10**6, *pose))
        for n, pose in enumerate(zip(x, y, 0.03 * np.arange(400.0), strict=True), start=1)
    ]
    run = read_run(ros.write(tmp_path / "spins", entries), robot())
    assert run.ticks.right[-1] > run.ticks.left[-1]


@pytest.mark.parametrize(("rear", "refused"), [(-1.0, True), (0.0, True), (0.9, False)])
def test_wheels_of_a_side_that_do_not_turn_alike(
    tmp_path: Path, ros: Any, robot: Any, rear: float, refused: bool
) -> None:
    """Mecanum wheels on the way sideways, or one that is stuck; skidding ones differ by little."""
    names = ["fl", "rl", "fr", "rr"]
    entries = [
        ("/joint_states", n * 100 * MS, ros.joints(n * 100 * MS, names, [a, rear * a, a, a]))
        for n, a in enumerate(0.7 * np.arange(60.0))
    ]
    bag = ros.write(tmp_path / "bag", entries)
    file = robot("left_wheel_names: [fl, rl]", "right_wheel_names: [fr, rr]")
    if refused:
        with pytest.raises(
            InputError, match="fl and rl, wheels of the left side, do not turn alik"
        ):
            read_run(bag, file)
        file = robot("left_wheel_names: [fl]", "right_wheel_names: [fr]")
    run = read_run(bag, file)
    assert run.ticks.left[-1] == pytest.approx(
        0.5 * (2.0 if refused else 1.9) * 0.7 * 59e3 / 2 / math.pi
    )


def test_wheels_of_a_side_are_compared_where_the_clock_is_set(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    """A robot of four wheels without a battery for its clock: 25 GB were asked for."""
    names = ["fl", "rl", "fr", "rr"]
    entries = []
    for n in range(100):
        stamp = (100 * 1000 + 100 * n + (1_700_000_000_000 if n > 50 else 0)) * MS
        entries.append(
            ("/joint_states", (n + 1) * 100 * MS, ros.joints(stamp, names, [0.7 * n] * 4))
        )
    file = robot("left_wheel_names: [fl, rl]", "right_wheel_names: [fr, rr]")
    assert read_run(ros.write(tmp_path / "bag", entries), file).ticks.rows == 100


@pytest.mark.parametrize("every", [1, 3, 10])
def test_two_nodes_that_publish_the_wheels(
    tmp_path: Path, ros: Any, robot: Any, every: int
) -> None:
    """A joint_state_publisher's zeros beside the driver's angles: 6034 m in a minute."""
    entries = []
    for n in range(300):
        at = (1 + 20 * n) * MS
        entries.append(("/joint_states", at, ros.joints(at, WHEELS, [0.1 * n, 0.12 * n])))
        if n % every == 0:
            entries.append(("/joint_states", at + MS, ros.joints(at + MS, WHEELS, [0.0, 0.0])))
    with pytest.raises(InputError, match=r"left_wheel_joint jumps to and fro .* two nodes publish"):
        read_run(ros.write(tmp_path / "bag", entries), robot())


@pytest.mark.parametrize("faults", [0, 5])
def test_a_robot_that_rocks_or_whose_counter_errs_has_one_node(
    tmp_path: Path, ros: Any, robot: Any, faults: int
) -> None:
    """Read seldom, a wheel that is rocked is elsewhere in each message."""
    angles = 6.0 * np.sin(2.0 * np.arange(400))
    angles[50 : 50 + 50 * faults : 50] += 1000.0
    entries = [
        ("/joint_states", n * 100 * MS, ros.joints(n * 100 * MS, WHEELS, [each, each]))
        for n, each in enumerate(angles, start=1)
    ]
    assert read_run(ros.write(tmp_path / "bag", entries), robot()).ticks.rows == 400


def test_angles_are_not_read_as_counts(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = [
        ("/joint_states", n * MS, ros.joints(n * MS, WHEELS, [0.31 * n, 0.3 * n]))
        for n in range(1, 30)
    ]
    with pytest.raises(InputError, match="no whole numbers, and so no counts; angles are read wit"):
        read_run(ros.write(tmp_path / "bag", entries), robot("position_unit: ticks"))


def test_odometry_whose_poses_stay_at_zero(tmp_path: Path, ros: Any, robot: Any) -> None:
    entries = []
    for n in range(11):
        kind, message = ros.odometry(n * 100 * MS, 0.0, 0.0, 0.0)
        message.twist.twist.linear.x = 0.3
        entries.append(("/odom", n * 100 * MS, (kind, message)))
    run = read_run(ros.write(tmp_path / "bag", entries), robot())
    assert run.ticks.left[-1] == pytest.approx(0.3 * 1000 / (2 * math.pi * 0.1))


def test_wheels_come_before_odometry_and_two_robots_are_asked_about(
    tmp_path: Path, ros: Any, robot: Any
) -> None:
    entries = [
        ("/a/joint_states", 1, ros.joints(1, WHEELS, [0.0, 0.0])),
        ("/a/odom", 2, ros.odometry(2, 0.0, 0.0, 0.0)),
        ("/arm/joint_states", 3, ros.joints(3, ["elbow"], [0.0])),
    ]
    assert (
        read_run(ros.write(tmp_path / "one", entries), robot())
        .notes[0]
        .startswith("ticks from /a/joint_states")
    )
    entries.append(("/b/joint_states", 4, ros.joints(4, WHEELS, [0.0, 0.0])))
    with pytest.raises(InputError, match=r"choose with --ticks-topic; candidates are /a/joint_st"):
        read_run(ros.write(tmp_path / "two", entries), robot())


def test_a_type_that_nobody_knows(tmp_path: Path, ros: Any, robot: Any) -> None:
    """A message of a type that lies about itself is named with its topic, not as a traceback."""
    entries = [("/ticks", 1, ros.counts(1, 2)), ("/pose", 2, ros.pose(2, 0.0, 0.0, 0.0))]
    bag = ros.write(tmp_path / "bag", entries, "sqlite3")
    import sqlite3

    with sqlite3.connect(next(bag.glob("*.db3"))) as database:
        database.execute("UPDATE messages SET data = X'00010000' WHERE topic_id = 2")
    with pytest.raises(InputError, match=r"/pose \(geometry_msgs/msg/PoseStamped\)"):
        read_run(bag, robot(), reference_topic="/pose")
