# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The engine's robot, odom_node and drive_node over DDS: round a square, recorded, and back."""

from __future__ import annotations

import json
import math
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")
pytest.importorskip("mujoco", reason="needs mujoco (pip install werrimbi_odom[all])")

from geometry_msgs.msg import PoseStamped, TransformStamped, TwistStamped
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Imu, JointState, LaserScan
from std_srvs.srv import Trigger

import werrimbi_odom as wo
from test.ros.beside import beside, stand_in_for_tf2_ros
from werrimbi_odom.errors import InputError
from werrimbi_odom.inference import rules
from werrimbi_odom.ros.simulated_parameters import PARAMETERS, robot_of

ROBOT = {
    "wheel_separation": 0.35,
    "wheel_radius": 0.05,
    "left_ticks_per_revolution": 2000.0,
    "right_ticks_per_revolution": 2000.0,
}
PATIENT = {"odom_timeout": 1.0, "max_deviation": 0.5}
"""On a machine that does other things beside."""


def drive_state(client: Any) -> str:
    told = [each.message for each in client.diagnostics if each.name == "drive_node: drive"]
    return str(told[-1]) if told else ""


def driven_round(client: Any) -> None:
    """Ask drive_node to start, and wait for the end."""

    def ask(service: str) -> Any:
        return client.call(Trigger, f"drive_node/{service}", Trigger.Request(), again_after=2.0)

    client.until(lambda: ask("check").success, "robot that could start", 30.0)
    answer = ask("start")
    assert answer.success or "driving already" in answer.message, answer.message
    client.until(lambda: drive_state(client).startswith(("done", "stopped")), "end", 200.0)
    assert drive_state(client).startswith("done"), drive_state(client)


def test_a_square_ends_where_it_began_and_its_recording_can_be_read(
    launch: Any, tmp_path: Path
) -> None:
    client = launch(ROBOT)
    about = {"manoeuvre": "umbmark_ccw", "length": 0.3, "area_radius": 1.2, "record": tmp_path}
    pace = {"max_vel_x": 0.4, "max_vel_theta": 1.6, "acc_lim_x": 1.0, "acc_lim_theta": 8.0}
    file = tmp_path / "robot.yaml"
    with (
        beside(
            tmp_path,
            client.environment,
            "simulated_robot",
            robot_file=file,
            imu_rate=20.0,
            reference_rate=10.0,
        ),
        beside(tmp_path, client.environment, "drive_node", **about, **pace, **PATIENT) as drive,
    ):
        measured = client.keep(PoseStamped, "reference")
        driven_round(client)
        client.rest(0.8)
        place = client.odometry[-1].pose.pose.position
        true = measured[-1].pose.position
        assert "Next: werrimbi diagnose" in drive.said()
    # A move ends late where this machine pauses, and never goes back: as closed as UMBmark asks.
    assert math.hypot(place.x, place.y) < rules.LAP_TOLERANCE * 0.3
    assert math.hypot(true.x - place.x, true.y - place.y) < 0.02
    assert max(abs(each.pose.position.y) for each in measured) > 0.25  # it was there
    robot = wo.read_robot(file)
    (bag,) = (path for path in tmp_path.iterdir() if path.name.startswith("umbmark_ccw_"))
    run = wo.read_run(bag, robot, ticks_topic="/joint_states", reference_topic="/reference")
    path = wo.odometry(robot, run.ticks.time, run.ticks.left, run.ticks.right)
    gone = (path.x[-1] - path.x[0], path.y[-1] - path.y[0])
    assert math.dist(gone, (place.x, place.y)) < 0.005
    live = [each.pose.pose.position.y for each in client.odometry]
    assert np.ptp(path.y) == pytest.approx(np.ptp(live), abs=0.005)
    assert run.reference is not None
    there = [each.pose.position.y for each in measured]
    assert np.ptp(run.reference.y) == pytest.approx(np.ptp(there), abs=0.005)


@pytest.mark.evidence
def test_the_round_is_closed_without_a_hand(launch: Any, tmp_path: Path) -> None:
    """What is hidden in the robot that drives is found in what drive_node recorded.

    Squares, whose turns are all alike, do not tell a base from a track that goes with the turning:
    the manoeuvre that is proposed does, and drive_node drives it.
    """
    client = launch(ROBOT)
    about = {"area_radius": 3.0, "max_vel_x": 0.5, "max_vel_theta": 1.6, "record": tmp_path}
    file, answer = tmp_path / "robot.yaml", tmp_path / "answer.json"
    stamped = {"use_stamped_vel": True}
    hidden = {"hide": "track_width=1.03", "robot_file": file, "cmd_vel_timeout": 0.2}
    topics = {"ticks_topic": "/joint_states", "reference_topic": "/reference"}

    def driven(**what: Any) -> Path:
        before = set(tmp_path.iterdir())
        drive = about | what | PATIENT | stamped
        with beside(tmp_path, client.environment, "drive_node", **drive):
            driven_round(client)
            client.rest(0.8)
        (bag,) = (each for each in set(tmp_path.iterdir()) - before if each.is_dir())
        return bag

    with beside(tmp_path, client.environment, "simulated_robot", **hidden, **stamped):
        squares = driven(manoeuvre="umbmark", length=1.0)
        found = wo.diagnose(wo.read_robot(file), [squares], **topics).to_dict()
        assert found["effect"] == "track_width"
        assert found["rivals"] == ["track_width", "turn_dependent_track"]
        answer.write_text(json.dumps(found))
        then = driven(diagnosis=answer, size=0.5)
    found = wo.diagnose(wo.read_robot(file), [squares, then], **topics).to_dict()
    assert (found["verdict"], found["effect"]) == ("named", "track_width")
    multiplier = found["found"][0]["parameters"]["multiplier"]
    assert abs(multiplier["value"] - 1.03) < 3.0 * multiplier["std"] + 0.002


def test_the_wheels_have_the_names_of_its_robot_file(launch: Any, tmp_path: Path) -> None:
    """Four of a robot that skids."""
    client, file = launch(ROBOT), tmp_path / "robot.yaml"
    hidden = {"hide": "skid_steer", "robot_file": file}
    with beside(tmp_path, client.environment, "simulated_robot", **hidden):
        heard = client.keep(JointState, "joint_states")
        client.until(lambda: bool(heard), "joint states", 30.0)
    values = wo.read_robot(file).values
    assert heard[0].name == [*values["left_wheel_names"], *values["right_wheel_names"]]  # type: ignore[misc]
    assert len(heard[0].position) == 4


@pytest.mark.evidence
def test_time_goes_as_fast_as_asked_and_silence_stops_the_robot(
    launch: Any, tmp_path: Path
) -> None:
    client = launch(ROBOT | {"use_sim_time": True})
    fast = {"real_time_factor": 4.0, "publish_clock": True, "use_stamped_vel": True}
    with beside(tmp_path, client.environment, "simulated_robot", **fast):
        clock, gyro = client.keep(Clock, "/clock"), client.keep(Imu, "imu")
        client.begin(lambda: None)
        begun, wall = seconds(clock[-1].clock), time.monotonic()
        client.rest(3.0)
        pace = (seconds(clock[-1].clock) - begun) / (time.monotonic() - wall)
        assert pace == pytest.approx(4.0, rel=0.1)
        command = TwistStamped()
        command.twist.linear.x = 0.4
        client.send(TwistStamped, "cmd_vel", command)
        client.rest(1.0)
        assert client.odometry[-1].twist.twist.linear.x == pytest.approx(0.0, abs=0.01)
        way = client.odometry[-1].pose.pose.position.x
        assert 0.1 < way < 0.3  # half a second of it, and what it takes to start and to brake
        assert len(gyro) > 4.0 * 3.0 * 80.0


@pytest.mark.evidence
def test_the_truth_goes_out_on_tf(
    launch: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With a stand-in for tf2_ros, which has no wheel."""
    stand_in_for_tf2_ros(tmp_path, monkeypatch)
    client = launch(ROBOT)
    with beside(tmp_path, client.environment, "simulated_robot", enable_tf=True, room="arena"):
        sent = client.keep(TransformStamped, "sent")
        scans = client.keep(LaserScan, "scan")
        client.until(lambda: len(sent) > 10 and len(scans) > 2, "transforms and scans")
    assert max(each for each in scans[-1].ranges if each < 8.0) < 2.0
    assert {each.header.frame_id for each in sent} == {"world", "base_link"}
    assert {each.child_frame_id for each in sent} == {"odom", "base_link_true", "base_scan"}


def seconds(stamp: Any) -> float:
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"hide": "castor_kik"}, "hide: .*castor_kick"),
        ({"hide": "castor_kick=much"}, "hide: the strength 'much' of castor_kick is not a number"),
        ({"hide": "wheel_radius_scale=-1"}, "hide: the strength of wheel_radius_scale cannot be"),
    ],
)
def test_what_cannot_be_hidden_is_told(given: dict[str, Any], says: str) -> None:
    values = {each.name: each.default for each in PARAMETERS} | given
    with pytest.raises(InputError, match=says):
        robot_of(values)


def test_several_effects_can_be_hidden() -> None:
    values = {each.name: each.default for each in PARAMETERS}
    hide = "castor_kick=0.02, wheel_radius_scale=0.5"
    _, hidden, believed = robot_of(values | {"hide": hide})
    assert [each.entry.name for each in hidden] == ["castor_kick", "wheel_radius_scale"]
    assert believed.nominal.wheel_radius == pytest.approx(0.1)  # its maker took the diameter


@pytest.mark.parametrize(
    ("node", "words", "says"),
    [
        in_evidence(
            "simulated_robot",
            ["-p", "real_time_factor:=2.0"],
            "real_time_factor 2 needs publish_clock: true",
        ),
        in_evidence(
            "simulated_robot", ["-p", "seeds:=2"], "unknown parameter seeds: did you mean seed?"
        ),
        (
            "simulated_robot",
            [],
            "the physics engine is not installed (mujoco is missing): pip install mujoco",
        ),
        (
            "drive_node",
            ["-p", "area_radius:=4.0", "-p", "scan_topic:=front scan", "-p", "record:=none"],
            "'front scan' is not the name of a topic: topic name must not contain characters",
        ),
        (
            "drive_node",
            ["-p", "area_radius:=4.0", "-p", "record_topics:=[odom, /a//b]"],
            "'/a//b' is not the name of a topic: topic name must not contain repeated '/'",
        ),
        (
            "drive_node",
            ["-p", "diagnosis:=none", "-p", "scan_topic:=none"],
            "no area is given in which the robot may move: give area_radius, or",
        ),
    ],
    ids=["faster", "misspelt", "no mujoco", "no topic", "none to record", "no area"],
)
def test_what_a_node_cannot_start_with_is_told_in_a_line(
    node: str, words: list[str], says: str
) -> None:
    without = "" if words else "sys.modules['mujoco'] = None;"
    code = f"import sys; {without} from werrimbi_odom.ros.{node} import main; "
    run = subprocess.run(
        [sys.executable, "-c", f"{code} sys.exit(main({['--ros-args', *words]}))"],
        capture_output=True,
        text=True,
        check=False,
        cwd=Path(__file__).parents[2],
    )
    assert run.returncode == 2
    assert says in run.stderr
    assert "Traceback" not in run.stderr
