# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Physical effects in the real node: as recorded, changed while it runs, learnt on the way."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Imu, JointState

from test.model.drives import Ticks, random_drive
from test.ros.messages import seconds_of, stamp_at, turn, yaw_of
from werrimbi_odom.cli.main import main
from werrimbi_odom.effects import find
from werrimbi_odom.model.robot import Robot
from werrimbi_odom.model.trajectory import Trajectory, trajectory

# Each stage, every kind of memory, and the wiring; the reference's must change nothing here.
COMPOSED: dict[str, Any] = {
    "effects": [
        "wheels_swapped",
        "eccentric_left_wheel",
        "right_missed_ticks",
        "left_backlash",
        "radius_drift",
        "encoder_skew",
        "turn_dependent_track",
        "longitudinal_slip",
        "castor_kick",
        "lateral_slip",
        "floor_slope",
        "reference_yaw_offset",
    ],
    "eccentric_left_wheel": {"amplitude": 0.0008, "phase": 0.4},
    "right_missed_ticks": {"fraction": 0.02, "above": 0.2},
    "left_backlash": {"travel": 0.003},
    "radius_drift": {"per_metre": 0.001},
    "encoder_skew": {"delay": 0.005},
    "turn_dependent_track": {"sharpness": 0.05, "sense": 0.02},
    "longitudinal_slip": {"coefficient": 0.02, "turning": 0.5},
    "castor_kick": {"angle": 0.02},
    "lateral_slip.creep": 0.01,  # as `-p lateral_slip.creep:=0.01` on the command line has it
    "reference_yaw_offset": {"angle": 0.3},
}
AMPLITUDE = 0.002


def drive(seconds: float, seed: int = 3) -> Ticks:
    """Counters of the robot of the tests that start anywhere, stamped at 20 Hz."""
    robot = Robot(0.35, 0.05, 2000.0, 1000.0)
    ticks = random_drive(seed, robot, rate=20.0, duration=seconds)
    return Ticks(np.round(ticks.time + 100.0, 6), ticks.left + 4321, ticks.right - 99)


def play(node: Any, ticks: Ticks) -> None:
    for time, left, right in zip(*(column.tolist() for column in ticks), strict=True):
        node.now = time
        node.ticks(left, right, time)


def poses(messages: list[Any]) -> np.ndarray:
    """Stamp, x, y, yaw of odometry."""
    each = ((message, message.pose.pose) for message in messages)
    return np.array([(seconds_of(m), p.position.x, p.position.y, yaw_of(p)) for m, p in each])


def found_each_other(node: Any) -> None:
    """Before the first reading, without sending one: the effects' memory begins with it."""
    node.publisher(JointState, "joint_states")
    node.until(lambda: node.node.count_publishers("odom") > 0, "publisher of odom")
    node.rest(0.5)


def test_live_is_what_werrimbi_odom_says_of_the_record(
    launch: Any, robot: dict[str, Any], tmp_path: Path
) -> None:
    node = launch(robot | COMPOSED)
    found_each_other(node)
    ticks = drive(40.0)
    play(node, ticks)
    node.last()
    live = poses(node.odometry)
    (tmp_path / "run").mkdir()
    rows = zip(*(column.tolist() for column in ticks), strict=True)
    text = "".join(f"{time!r},{left},{right}\n" for time, left, right in rows)
    (tmp_path / "run" / "ticks.csv").write_text("t_s,left_ticks,right_ticks\n" + text)
    file = tmp_path / "robot.yaml"
    file.write_text(json.dumps({"/**": {"ros__parameters": robot | COMPOSED}}))
    words = ["odom", "--robot", file, tmp_path / "run", "--out", tmp_path / "odom.csv"]
    assert main([str(word) for word in words]) == 0
    with (tmp_path / "odom.csv").open() as lines:
        recorded = np.array(
            [[float(cell) for cell in row[:4]] for row in list(csv.reader(lines))[1:]]
        )
    assert live.shape[0] == recorded.shape[0] - 1
    np.testing.assert_allclose(live[:, :3], recorded[1:, :3], rtol=0.0, atol=1e-9)
    turned = np.abs(np.exp(1j * live[:, 3]) - np.exp(1j * recorded[1:, 3]))
    assert turned.max() < 1e-9
    level, _, values = node.report()
    told = {key.removeprefix("effect "): words for key, words in values.items() if "effect " in key}
    assert list(told) == COMPOSED["effects"], "in order of application"
    assert told["eccentric_left_wheel"] == "amplitude 0.0008 m, phase 0.4 rad"
    assert told["wheels_swapped"] == "on"
    assert told["reference_yaw_offset"].endswith("of the measurement, so odometry does without it")
    assert level in (b"\x00", b"\x03")


def test_a_parameter_of_an_effect_may_change_on_the_way(launch: Any, robot: dict[str, Any]) -> None:
    names = ["lateral_slip", "eccentric_left_wheel", "left_tread_bump"]
    held = {"effects": names, "eccentric_left_wheel.amplitude": AMPLITUDE}
    node = launch(robot | held)
    found_each_other(node)
    assert "eccentric_left_wheel: not applied while the phase is unknown" in node.stderr()
    assert "left_tread_bump: not applied while its place is unknown" in node.stderr()
    ticks = drive(10.0)
    first, second = Ticks(*(c[:100] for c in ticks)), Ticks(*(c[100:] for c in ticks))
    play(node, first)
    node.last()
    assert "phase unknown" in node.report()[2]["effect eccentric_left_wheel"]
    for wrong, reason in (
        ({"lateral_slip.creep": 5.0}, "lateral_slip.creep"),
        ({"eccentric_left_wheel.phase": "late"}, "eccentric_left_wheel.phase must be a number"),
        ({"effects": ["lateral_slip"]}, "read-only parameter: effects"),
    ):
        result = node.set_parameters(**wrong)
        assert not result.successful
        assert reason in result.reason
    assert node.set_parameters(**{"lateral_slip.creep": 0.05}).successful
    assert node.set_parameters(**{"eccentric_left_wheel.phase": 1}).successful
    play(node, second)
    node.last()
    wheel = find("eccentric_left_wheel")
    slip = find("lateral_slip")
    plain = model_path(ticks, wheel.using(amplitude=AMPLITUDE), slip.using())
    changed = model_path(ticks, wheel.using(amplitude=AMPLITUDE, phase=1.0), slip.using(creep=0.05))
    live = poses(node.odometry)
    np.testing.assert_allclose(live[:99, 1], plain.x[1:100], rtol=0.0, atol=1e-9)
    turns = np.diff(live[99:, 3])
    np.testing.assert_allclose(
        np.exp(1j * turns), np.exp(1j * np.diff(changed.yaw[100:])), atol=1e-9
    )
    assert node.report()[2]["effect eccentric_left_wheel"] == "amplitude 0.002 m, phase 1 rad"


def model_path(ticks: Ticks, *effects: Any) -> Trajectory:
    return trajectory(Robot(0.35, 0.05, 2000.0, 1000.0, effects=effects), *ticks)


@pytest.mark.parametrize("kind", ["imu", in_evidence("pose_stamped")])
def test_the_phase_of_a_wheel_is_learnt_from_a_topic(
    launch: Any, robot: dict[str, Any], kind: str
) -> None:
    held = {
        "effects": ["eccentric_left_wheel"],
        "eccentric_left_wheel": {"amplitude": AMPLITUDE},
        "learn_from_topic": "heading",
        "learn_from_type": kind,
    }
    node = launch(robot | held)
    found_each_other(node)
    message_type = Imu if kind == "imu" else PoseStamped
    node.publisher(message_type, "heading")
    ticks = drive(60.0)
    wheel = find("eccentric_left_wheel")
    true = model_path(ticks, wheel.using(amplitude=AMPLITUDE, phase=2.0))
    chance = np.random.default_rng(0)
    rates = np.append(np.diff(true.yaw) * 20.0, 0.0) + 0.02
    for row, (time, left, right) in enumerate(zip(*(c.tolist() for c in ticks), strict=True)):
        node.now = time
        node.ticks(left, right, time)
        if kind == "imu":
            message = Imu()
            message.angular_velocity.z = rates[row] + chance.normal(0.0, 0.003)
            time += 0.025  # the mean rate of the next step
        else:
            message = PoseStamped()
            turn(message.pose, true.yaw[row] + chance.normal(0.0, 0.001))
        message.header.stamp = stamp_at(time)
        node.send(message_type, "heading", message)
        if row % 40 == 39:  # less than the node keeps, however busy the machine
            node.last()
    node.last()
    words = "learnt from heading: eccentric_left_wheel.phase is "
    node.until(lambda: words in node.stderr(), "phase")
    found, deviation = (
        float(word.strip(",")) for word in node.stderr().rpartition(words)[2].split()[0:6:5]
    )
    assert deviation < 0.3
    assert abs(math.remainder(found - 2.0, 2.0 * math.pi)) < 4.0 * deviation + 0.01
    node.report()
    told = node.report()[2]["effect eccentric_left_wheel"]
    assert "phase learnt from heading, to 0." in told
    running = float(told.partition(", phase ")[2].split()[0])
    assert abs(math.remainder(running - 2.0, 2.0 * math.pi)) < 4.0 * deviation + 0.01


def test_an_imu_without_a_gyro_is_refused(launch: Any, robot: dict[str, Any]) -> None:
    held = {"effects": ["eccentric_left_wheel"], "eccentric_left_wheel": {"amplitude": AMPLITUDE}}
    node = launch(robot | held | {"learn_from_topic": "imu"})
    found_each_other(node)
    message = Imu()
    message.angular_velocity_covariance[0] = -1.0
    node.send(Imu, "imu", message)
    node.until(
        lambda: "not learnt from: no angular velocity: the Imu measures none" in node.stderr(),
        "refusal",
    )
