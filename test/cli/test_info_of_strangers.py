# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""What `info` says of bags in which something is amiss, and where it leads."""

from __future__ import annotations

import json
import math
import shlex
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import werrimbi_odom as wo
from test.cli.commands import PLAIN, ROBOT_FILE, write_run
from test.command_line import Werrimbi
from test.files.conftest import Messages
from test.files.unseen import JOINTS, gyro, joints, poses, stamp_of, urdf
from test.inference.driven import run_of
from test.model.drives import ROBOT
from werrimbi_odom.files.run import Reference

SIZES = f"""odom_node:
  ros__parameters:
    wheel_separation: {ROBOT.wheel_separation}
    wheel_radius: {ROBOT.wheel_radius}
    left_ticks_per_revolution: {ROBOT.left_ticks_per_revolution}
    right_ticks_per_revolution: {ROBOT.right_ticks_per_revolution}
"""
NAMES = f"""
    left_wheel_names: [{JOINTS[0]}]
    right_wheel_names: [{JOINTS[1]}]
"""


def bag_of(folder: Path, *, moves: bool = True, frame: str = "map") -> Path:
    """Joints, a gyro, and poses in some frame."""
    ros, run, share = Messages(), run_of(ROBOT, 1, 40), float(moves)
    entries = [*joints(ros, run, share), *gyro(ros, run, share)]
    for _, stamp, (kind, pose) in poses(ros, run, share):
        pose.header.frame_id = frame
        entries.append(("/seen", stamp, (kind, pose)))
    return ros.write(folder / "bag", sorted(entries, key=lambda entry: entry[1]))


def test_other_names_of_joints_are_no_fault_of_the_reference(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """No other reference mends that; the lines that are told, written into the file, do."""
    bag, robot = bag_of(tmp_path), tmp_path / "robot.yaml"
    robot.write_text(SIZES)
    told = werrimbi("info", bag, "--robot", robot).words
    assert "no joint left_wheel_joint" in told
    assert "nothing can be judged" not in told
    for line in NAMES.split("\n"):
        assert line.strip() in told
    robot.write_text(SIZES + NAMES)
    told = werrimbi("info", bag, "--robot", robot).words
    assert "Next: werrimbi compare" in told


@pytest.mark.parametrize(
    ("header", "receipt", "told"),
    [
        (0, 0, "either clock will do (intervals vary by ± 0 ms)"),
        (0, 9, "believe the headers, whose intervals vary by ± 0 ms against"),
        (9, 0, "the headers are used, though their intervals vary by"),
    ],
)
def test_of_two_clocks_the_evener_is_to_be_believed_if_either_is(
    header: int, receipt: int, told: str, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    ros, run, late = (
        Messages(),
        run_of(ROBOT, 1, 20),
        np.random.default_rng(3).integers(2, size=999),
    )
    entries = [
        (
            topic,
            stamp + int(1e6 * receipt * late[row]),
            ros.joints(stamp + int(1e6 * header * late[row]), JOINTS, message.position),
        )
        for row, (topic, stamp, (_, message)) in enumerate(joints(ros, run))
    ]
    assert told in werrimbi("info", ros.write(tmp_path / "bag", entries)).words


def test_poses_as_text_are_told_with_how_they_become_a_reference(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """A tracker whose node sends lines of text: to record again was all the advice."""
    ros, kind = Messages(), "std_msgs/msg/String"
    entries = [
        each
        for topic, stamp, message in joints(ros, run_of(ROBOT, 1, 20))
        for each in (
            (topic, stamp, message),
            ("/get/vicon_pose", stamp, (kind, ros.make(kind, "robot 3380.4 2546.9 -0.027"))),
            ("/motor_status", stamp, ros.counts(0, 0, 0)),
        )
    ]
    told = werrimbi("info", ros.write(tmp_path / "bag", entries)).words
    assert "By name /get/vicon_pose (std_msgs/msg/String) may: written as rows of t_s" in told
    assert "motor_status" not in told.partition("may: written")[0]
    assert "By name" not in werrimbi("info", bag_of(tmp_path / "other")).words


def test_of_odometry_the_drivers_sizes_are_asked_for(tmp_path: Path, werrimbi: Werrimbi) -> None:
    """It is turned back by them, whatever a ruler says."""
    ros, run = Messages(), run_of(ROBOT, 1, 20)
    own = [
        ("/odom", stamp_of(0.1 * n), ros.odometry(stamp_of(0.1 * n), 0.02 * n, 0.0, 0.0))
        for n in range(200)
    ]
    entries = sorted([*own, *gyro(ros, run)], key=lambda entry: entry[1])
    told = werrimbi("info", ros.write(tmp_path / "bag", entries)).words
    assert "that its driver works with into a robot file" in told
    assert "measure the wheels' radius" not in told


@pytest.mark.parametrize("sizes", [False, True])
def test_a_robot_that_stood_shows_nothing(sizes: bool, tmp_path: Path, werrimbi: Werrimbi) -> None:
    bag, robot = bag_of(tmp_path, moves=False), tmp_path / "robot.yaml"
    robot.write_text(SIZES + NAMES)
    told = werrimbi("info", bag, *(["--robot", robot] if sizes else [])).words
    assert "It cannot show anything: the robot hardly moved." in told
    assert "It can show" not in told
    assert told.endswith("Record again while the robot drives.")


@pytest.mark.evidence
def test_a_filter_s_poses_as_wheels_have_no_counts_and_no_radius_of_the_file(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """They cancel: what is turned back by the file's sizes does not depend on them."""
    ros, run = Messages(), run_of(PLAIN, 1, 60)
    entries = list(poses(ros, run))
    larger = replace(PLAIN, wheel_radius=1.6 * PLAIN.wheel_radius)
    fused = wo.odometry(larger, run.ticks.time, run.ticks.left, run.ticks.right)
    for time, *pose in zip(run.ticks.time, fused.x, fused.y, fused.yaw, strict=True):
        at = stamp_of(time)
        entries.append(("/odometry/filtered", at, ros.odometry(at, *pose)))
    bag = ros.write(tmp_path / "bag", sorted(entries, key=lambda each: each[1]))
    robot = tmp_path / "robot.yaml"
    robot.write_text(ROBOT_FILE)
    option = ("--ticks-topic", "/odometry/filtered")
    said = werrimbi("info", bag).words
    assert f"{' '.join(option)} takes a filter's poses in their stead" in said
    assert "a filter's poses, turned back" in werrimbi("info", bag, *option).words
    told = werrimbi("diagnose", bag, "--robot", robot, *option)
    assert "turned back from poses of odometry" in told.err
    assert "is 1/1.6 times what its odometry was made with" in told.words
    for untrue in ("what the robot file says", "counts by these drives", "ticks_per_revolution"):
        assert untrue not in told.words


def test_what_compare_refuses_info_does_not_offer(tmp_path: Path, werrimbi: Werrimbi) -> None:
    """Poses that are the wheels' own, under a name that says nothing."""
    ros, run = Messages(), run_of(ROBOT, 1, 40)
    entries, robot = [], tmp_path / "robot.yaml"
    robot.write_text(SIZES + NAMES)
    x = y = yaw = 0.0
    last = np.zeros(2)
    for time, *counts in zip(run.ticks.time, run.ticks.left, run.ticks.right, strict=True):
        stamp = stamp_of(time)
        counts = [n + 0.4 * math.sin(n) for n in counts]  # angles that are no whole counts
        angles = [2.0 * math.pi * n / ROBOT.left_ticks_per_revolution for n in counts]
        left, right = np.array(angles) * ROBOT.wheel_radius - last
        last += (left, right)
        way, turn = 0.5 * (left + right), (right - left) / ROBOT.wheel_separation
        x += way * math.cos(yaw + 0.5 * turn)
        y += way * math.sin(yaw + 0.5 * turn)
        yaw += turn
        entries.append(("/joint_states", stamp, ros.joints(stamp, JOINTS, angles)))
        entries.append(("/where", stamp, ros.pose(stamp, x, y, yaw)))
    bag = ros.write(tmp_path / "bag", entries)
    told = werrimbi("info", bag, "--robot", robot).words
    assert "it was made from the same" in told
    assert "werrimbi compare" not in told


def test_what_is_seen_from_the_robot_is_not_taken_for_where_it_is(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    bag = bag_of(tmp_path, frame="base_link")
    told = werrimbi("info", bag, "--json", tmp_path / "found.json").words
    assert "its yaw rate is integrated). It is taken." in told
    assert "Reference /seen: poses at 5 Hz (poses in base_link, a frame on the robot" in told
    (run,) = json.loads((tmp_path / "found.json").read_text())["runs"]
    assert [each["topic"] for each in run["references"]] == ["/imu", "/seen"]
    robot = tmp_path / "robot.yaml"
    robot.write_text(SIZES + NAMES)
    told = werrimbi("info", bag, "--robot", robot).words
    werrimbi(*shlex.split(told.rpartition("Next: ")[2])[1:])


def test_drives_whose_topics_have_other_names_have_commands_of_their_own(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """The first one's topics were printed for all, and are not there in the others."""
    ros, run = Messages(), run_of(ROBOT, 1, 40)
    bags = []
    for name, before in (("a", ""), ("b", "/base"), ("c", "")):
        sent = [
            (f"{before}{topic}", *rest) for topic, *rest in (*joints(ros, run), *gyro(ros, run))
        ]
        bags.append(ros.write(tmp_path / name, sorted(sent, key=lambda entry: entry[1])))
    robot = tmp_path / "robot.yaml"
    robot.write_text(SIZES + NAMES)
    told = werrimbi("info", *bags, "--robot", robot).words
    assert f"The topics of {bags[1]} have other names: info of it alone prints its" in told
    command = shlex.split(told.rpartition("Next: ")[2])
    assert command[-2:] == [str(bags[0]), str(bags[2])]
    werrimbi(*command[1:])


def test_the_description_of_a_robot_in_a_namespace_is_found(
    tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """The other robot's comes first in the bag; only the wheels' own has the right sizes."""
    ros, run = Messages(), run_of(ROBOT, 1, 20)
    entries = [(f"/two{name}", stamp, sent) for name, stamp, sent in joints(ros, run)]
    own = ros.make("std_msgs/msg/String", urdf())
    other = ros.make("std_msgs/msg/String", urdf().replace('radius="', 'radius="9'))
    for space, text in (("/one", other), ("/two", own)):
        entries.append((f"{space}/robot_description", stamp_of(0.0), ("std_msgs/msg/String", text)))
    bag = ros.write(tmp_path / "bag", sorted(entries, key=lambda entry: entry[1]))
    werrimbi("info", bag, "--out", tmp_path / "robot.yaml")
    robot = wo.read_robot(tmp_path / "robot.yaml").robot
    assert robot.wheel_radius == pytest.approx(ROBOT.wheel_radius, abs=1e-6)


@pytest.mark.parametrize("until", [5.0, 60.0])
def test_what_drives_can_show_is_of_what_the_reference_measured(
    until: float, tmp_path: Path, werrimbi: Werrimbi
) -> None:
    """A tracker that lost the robot after a few seconds shows no base, however far it drove on."""
    run = run_of(ROBOT, 1, 60)
    assert run.reference is not None
    kept = run.reference.time <= until
    columns = (getattr(run.reference, name)[kept] for name in ("time", "x", "y", "yaw"))
    write_run(tmp_path / "run", replace(run, reference=Reference(*columns)))
    (tmp_path / "robot.yaml").write_text(SIZES)
    told = werrimbi("info", tmp_path / "run", "--robot", tmp_path / "robot.yaml").words
    assert ("It can show the base" in told) == (until == 60.0)
    lost = "It cannot show the base: too little turning while the reference measured it."
    assert (lost in told) == ("The reference measured" in told) == (until == 5.0)
    few = "Too little was driven to judge by: it makes"
    why = "By legs of 0.25 m, because of a metre or a quarter turn these drives have only"
    assert (few if until == 5.0 else why) in told
    assert "--leg 0.25" in told
