# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives as ordinary robots record them: held, carried, jittered, and true in between."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from rosbags.highlevel import AnyReader

import werrimbi_odom as wo
from test.evidence import in_evidence
from werrimbi_odom import simulation as sim
from werrimbi_odom.cli.main import main
from werrimbi_odom.files.read_run import read_run
from werrimbi_odom.files.robot_files.robot_file import read_robot_file
from werrimbi_odom.simulation.bag import EPOCH, write_bag
from werrimbi_odom.simulation.hidden.axle_and_reference import DriftingClock
from werrimbi_odom.simulation.hidden.knocks import ReferenceJump
from werrimbi_odom.simulation.recording import Happened

ROBOT = sim.TrueRobot()


@cache
def recorded() -> sim.Recording:
    return sim.record(ROBOT, sim.free(40.0, seed=3, yaw_rate=1.0), seed=4)


@cache
def seen() -> sim.FieldDrive:
    return sim.as_in_the_field(recorded(), ROBOT, seed=5, robot_seed=6)


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What was seen, as a bag: to be read alone."""
    return sim.write_field_bag(seen(), ROBOT, tmp_path_factory.mktemp("field") / "bag")


def stretch(name: str) -> tuple[float, float]:
    ((begin, end),) = seen().truth[name]  # type: ignore[misc]
    return begin - EPOCH, end - EPOCH


def within(table: np.ndarray, name: str, inset: float = 0.1) -> np.ndarray:
    begin, end = stretch(name)
    return np.asarray(table[(table[:, 0] > begin + inset) & (table[:, 0] < end - inset)])


def test_while_it_is_held_its_wheels_turn_and_it_does_not() -> None:
    wheels, imu = within(seen().wheels, "held"), within(seen().imu, "held")
    assert np.abs(wheels[-1, 2:] - wheels[0, 2:]).max() > 2.0
    bias = seen().truth["gyro"]["bias_rad_per_s"]  # type: ignore[index]
    assert imu[:, 2].mean() == pytest.approx(bias, abs=1.5e-3)


def test_its_wheels_touch_the_floor_after_a_hold_where_they_would_have_without() -> None:
    """By whole turns, or what goes with a wheel's angle (an oval tyre) would change its phase."""
    path, wheels = recorded().true_path, seen().wheels
    for angle, told in ((path.left_angle_rad, wheels[:, 2]), (path.right_angle_rad, wheels[:, 3])):
        turns = ((told[-1] - told[0]) - (angle[-1] - angle[0])) / (2.0 * np.pi)
        assert turns == pytest.approx(round(turns), abs=0.01)
        assert abs(round(turns)) >= 1


def test_while_it_is_carried_it_moves_and_its_wheels_do_not() -> None:
    wheels, imu = within(seen().wheels, "carried"), within(seen().imu, "carried")
    assert np.ptp(wheels[:, 2:], axis=0).max() < 5e-3
    assert abs(imu[1:, 2] @ np.diff(imu[:, 0])) > 0.4
    places = within(seen().localiser, "carried")
    assert np.hypot(*(places[-1, 2:4] - places[0, 2:4])) > 0.3


def test_elsewhere_wheels_and_gyro_turn_alike() -> None:
    """Up to the gyro's own scale and bias, which are fitted and come out as they were made."""
    imu, odometry, wheels = seen().imu, seen().odometry, seen().wheels
    by_wheels = np.gradient(np.interp(imu[:, 0], wheels[:, 0], odometry[:, 2]), imu[:, 0])
    still = np.convolve(by_wheels, np.ones(9) / 9.0, "same")
    gyro = np.convolve(imu[:, 2], np.ones(9) / 9.0, "same")
    free_of = np.ones(len(imu), dtype=bool)
    for name in ("held", "carried"):
        begin, end = stretch(name)
        free_of &= (imu[:, 0] < begin - 0.3) | (imu[:, 0] > end + 0.3)
    free_of[:10] = free_of[-10:] = False
    scale, bias = np.polyfit(still[free_of], gyro[free_of], 1)
    true = seen().truth["gyro"]
    assert scale == pytest.approx(true["scale"], abs=0.02)  # type: ignore[index]
    assert bias == pytest.approx(true["bias_rad_per_s"], abs=2e-3)  # type: ignore[index]


def test_stamps_scatter_and_stay_in_order() -> None:
    for table in (seen().wheels, seen().imu, seen().localiser):
        assert np.all(np.diff(table[:, 0]) > 0.0)
        assert np.all(np.diff(table[:, 1]) >= 0.0)
    assert 2e-3 < np.diff(seen().wheels[:, 0]).std() < 12e-3


def test_the_same_seeds_the_same_drive() -> None:
    again = sim.as_in_the_field(recorded(), ROBOT, seed=5, robot_seed=6)
    np.testing.assert_array_equal(again.imu, seen().imu)
    assert again.truth == seen().truth


def test_the_bag_holds_what_was_seen(bag: Path) -> None:
    found: dict[str, list[object]] = {}
    with AnyReader([bag]) as reader:
        for connection, _, data in reader.messages():
            message = reader.deserialize(data, connection.msgtype)
            found.setdefault(connection.topic, []).append(message)
    own = {"/joint_states", "/imu", "/odom", "/tf", "/robot_description"}
    assert set(found) == own | {"/scan", "/tf_static"}
    assert len(found["/scan"]) == len(seen().scans.time)
    assert len(found["/joint_states"]) == len(seen().wheels)
    root = ElementTree.fromstring(found["/robot_description"][0].data)  # type: ignore[attr-defined]
    origins = [joint.find("origin").attrib["xyz"] for joint in root.iter("joint")]  # type: ignore[union-attr]
    ys = sorted(float(each.split()[1]) for each in origins)
    assert ys == pytest.approx([-0.175, 0.175])
    radii = {float(each.attrib["radius"]) for each in root.iter("cylinder")}
    assert radii == {0.05}
    # map -> odom after odom -> base_link is where the localiser thinks that the robot is.
    parts = [message.transforms[0] for message in found["/tf"]]  # type: ignore[attr-defined]
    frames = {(part.header.frame_id, part.child_frame_id) for part in parts}
    assert frames == {("map", "odom"), ("odom", "base_link")}


@pytest.mark.evidence
def test_its_scans_tell_by_their_receipt_that_their_clock_is_that_of_the_wheels(
    tmp_path: Path,
) -> None:
    """Their times of receipt have a way of their own, as those of any recorder.

    Ten seconds of them: a path by scans is much work, and they say it of so few.
    """
    drive, rows = seen(), slice(0, 100)
    scans = replace(
        drive.scans,
        time=drive.scans.time[rows],
        ranges=drive.scans.ranges[rows],
        truth=drive.scans.truth[rows],
    )
    some = replace(drive, scans=scans, scans_received=drive.scans_received[rows])
    folder = sim.write_field_bag(some, ROBOT, tmp_path / "bag")
    file = read_robot_file(sim.write_robot_file(ROBOT, tmp_path / "robot.yaml"))
    reference = read_run(
        folder, file, ticks_topic="/joint_states", reference_topic="/scan"
    ).reference
    assert reference is not None
    assert reference.one_rate


def test_the_positions_of_the_localiser_are_proposed_with_the_headings_of_the_gyro(
    bag: Path, tmp_path: Path
) -> None:
    """By the localiser alone a castor of usual size is nothing that these drives could show."""
    found = wo.info(bag, out=tmp_path / "robot.yaml")
    words = " ".join(found.summary().split())
    assert "(map -> odom comes from a sensor or a localiser). Its positions are taken." in words
    assert "Its headings are taken: they wander less." in words
    assert "Stamps of /imu: " in words
    both = "--ticks-topic /joint_states --reference-topic /tf:map:base_link --reference-topic /imu"
    assert both in found.to_dict()["next"]
    taken = [each["topic"] for each in found.to_dict()["runs"][0]["references"] if each["taken"]]
    assert taken == ["/tf:map:base_link", "/imu"]
    alone = wo.info(bag, reference_topic="/tf:map:base_link").summary()
    assert "It is taken." in " ".join(alone.split())


@pytest.mark.parametrize("factor", [*(in_evidence(each) for each in (0.0, 57.3)), -1.0])
def test_a_gyro_that_contradicts_the_localiser_is_not_proposed(
    tmp_path: Path, factor: float
) -> None:
    """Dead, turned over, or in degrees a second."""
    spoilt = replace(seen(), imu=seen().imu * [1.0, 1.0, factor])
    folder = sim.write_field_bag(spoilt, ROBOT, tmp_path / "bag")
    found = wo.info(folder, out=tmp_path / "robot.yaml").to_dict()
    assert "--reference-topic /tf:map:base_link " in found["next"]
    assert "/imu" not in found["next"]


def test_a_localiser_is_read_as_a_chain_of_transforms(bag: Path, tmp_path: Path) -> None:
    from werrimbi_odom.files.robot_files.robot_file import read_robot_file
    from werrimbi_odom.simulation import write_robot_file

    robot = write_robot_file(ROBOT, tmp_path / "robot.yaml")
    out = tmp_path / "odom.csv"
    assert main(["odom", "--robot", str(robot), str(bag), "--reference-topic",
                 "/tf:map:base_link", "--out", str(out)]) == 0  # fmt: skip
    assert read_robot_file(robot).robot.wheel_separation == 0.35
    first = np.loadtxt(out, delimiter=",", skiprows=1)[0]
    true = recorded().true_path
    assert np.hypot(first[1] - true.x_m[0], first[2] - true.y_m[0]) < 0.2


def test_what_is_made_in_records_is_hidden_too() -> None:
    """Counts that are lost at speed, and stamps of gyro and localiser that are late."""
    odd = [sim.hide("left_missed_ticks", 0.05, seed=1).peculiarity]
    odd.append(sim.hide("reference_delay", 0.1, seed=1).peculiarity)
    drive = sim.as_in_the_field(recorded(), ROBOT, seed=5, robot_seed=6, hidden=odd)
    lost = seen().wheels[-1, 2:] - drive.wheels[-1, 2:]
    assert lost[0] > 1.0
    assert lost[1] == 0.0
    # What was seen at t is stamped 0.1 s later: five samples of the gyro, one of the localiser.
    for now, late, rows in ((seen().imu, drive.imu, 5), (seen().localiser, drive.localiser, 1)):
        apart = [np.abs(np.sin(now[:-k, -1] - late[k:, -1])).mean() for k in range(1, 10)]
        assert 1 + int(np.argmin(apart)) == rows


def test_what_is_made_in_the_record_of_a_reference_shows_in_the_localiser() -> None:
    """Jumps, at the places and times that the truth tells, and a clock that gains."""
    odd = [ReferenceJump(0.5, stays=True, every=25.0), DriftingClock(5e-3, unset=0.0)]
    drive = sim.as_in_the_field(recorded(), ROBOT, seed=5, robot_seed=6, hidden=odd)
    gained = (drive.localiser - seen().localiser)[:, 0]
    assert gained[-1] == pytest.approx(5e-3 * seen().localiser[-1, 0], rel=0.25)
    apart = drive.localiser[:, 2:4] - seen().localiser[:, 2:4]
    (jump, *_) = drive.happened
    at = seen().localiser[:, 0] - (jump.t_s - EPOCH)
    np.testing.assert_allclose(apart[at < -0.2], 0.0, atol=1e-9)
    first = apart[at > 0.2][0]
    np.testing.assert_allclose(first, [jump.along_m, jump.sideways_m], atol=1e-9)
    np.testing.assert_array_equal(drive.wheels, seen().wheels)


def test_a_counter_that_keeps_its_zero_tells_the_angle_of_its_wheel() -> None:
    keeping = replace(ROBOT, counters_keep_zero=True)
    drive = sim.as_in_the_field(recorded(), keeping, seed=5, robot_seed=6)
    np.testing.assert_allclose(drive.imu, seen().imu)
    first = recorded().true_path.left_angle_rad[0], recorded().true_path.right_angle_rad[0]
    np.testing.assert_allclose(drive.wheels[0, 2:], first, atol=0.01)


def test_a_bag_names_the_wheels_as_the_robot_file_does(tmp_path: Path) -> None:
    four = replace(ROBOT, wheels_a_side=2)
    robot = wo.read_robot(sim.write_robot_file(four, tmp_path / "robot.yaml"))
    bag = write_bag(recorded(), four, tmp_path / "bag")
    run = wo.read_run(bag, robot, ticks_topic="/joint_states", reference_topic="/reference")
    travel = np.ptp(recorded().left_ticks) * robot.robot.left_tick
    assert np.ptp(run.ticks.left) * robot.robot.left_tick == pytest.approx(travel, rel=1e-6)


def test_events_have_the_time_of_the_bag() -> None:
    """Later than in the drive itself by what was inserted before them: holding and carrying."""
    path = recorded().true_path
    pushed = tuple(Happened("push", t, 0.0, 0.02, 0.0) for t in (0.5, 0.5 * path.t_s[-1], 39.5))
    told = replace(recorded(), happened=pushed)
    drive = sim.as_in_the_field(told, ROBOT, seed=5, robot_seed=6)
    for before, after in zip(pushed, drive.happened, strict=True):
        time = after.t_s - EPOCH
        late = sum(end - begin for begin, end in map(stretch, ("held", "carried")) if begin < time)
        assert time == pytest.approx(before.t_s + late, abs=2e-3)
    assert drive.happened[-1].t_s - EPOCH == pytest.approx(39.5 + 9.0, abs=2e-3)


def test_a_lidar_that_is_not_where_its_transform_says() -> None:
    """What the transform makes of its pose is a base that is beside the robot's, and late."""
    odd = [sim.hide("reference_lever_arm", 0.05, seed=1).peculiarity]
    odd.append(sim.hide("reference_yaw_offset", 0.3, seed=1).peculiarity)
    odd.append(sim.hide("reference_delay", 0.1, seed=1).peculiarity)
    drive = sim.as_in_the_field(recorded(), ROBOT, seed=5, robot_seed=6, hidden=odd)
    np.testing.assert_allclose(drive.scans.time - seen().scans.time, 0.1)
    believed = [pose_of(each.scans.truth, drive.lidar.mount) for each in (seen(), drive)]
    apart = believed[1][0] - believed[0][0]
    assert np.abs(apart) == pytest.approx(0.05)
    turned = believed[1][1] - believed[0][1]
    assert np.abs(turned) == pytest.approx(0.3)


def pose_of(lidar: np.ndarray, mount: sim.AxlePose) -> tuple[np.ndarray, np.ndarray]:
    """Of the base, by poses (n, 3) of its lidar: place and heading."""
    yaw = lidar[:, 2] - mount.yaw
    return lidar[:, 0] + 1j * lidar[:, 1] - (mount.x + 1j * mount.y) * np.exp(1j * yaw), yaw
