# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""compare_node beside odom_node, over DDS: wheels and a reference in, a verdict out."""

from __future__ import annotations

import json
import math
import signal
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest

pytest.importorskip("rclpy")

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import (
    PoseStamped,
    PoseWithCovarianceStamped,
    TransformStamped,
    Vector3Stamped,
)
from nav_msgs.msg import Odometry
from std_msgs.msg import Float64

from test.package.launching import launched as launched_by
from test.ros.messages import in_plane, seconds_of, stamp_at, turn, values_of
from test.white_noise_robot import WhiteNoiseRobot, drive, wandering
from werrimbi_odom.ros.compare_inputs import Clockwork, odometry_of, reference_reader
from werrimbi_odom.ros.compare_parameters import PARAMETERS

ROOT = Path(__file__).parents[2]
TRUE = WhiteNoiseRobot()
SIGMA_XY, SIGMA_YAW = 5e-4, 1e-3
DEEP = {"subscription": {"reliability": "reliable", "depth": 10_000}}
WINDOW = 20
AHEAD = 10.0  # of the drive [s], well within what compare_node remembers
COMMAND = [sys.executable, "-m", "werrimbi_odom.ros.compare_node"]


def robot_file(noise: float = 1.0) -> dict[str, Any]:
    """The true robot, with `noise` times the noise of its wheels."""
    return {
        "wheel_separation": TRUE.separation,
        "wheel_radius": TRUE.left_radius,
        "right_wheel_radius_multiplier": TRUE.right_radius / TRUE.left_radius,
        "left_ticks_per_revolution": TRUE.ticks_per_revolution,
        "right_ticks_per_revolution": TRUE.ticks_per_revolution,
        "left_wheel_noise": noise * TRUE.left_noise,
        "right_wheel_noise": noise * TRUE.right_noise,
        "position_unit": "ticks",
        "qos_overrides": {"/joint_states": DEEP, "/odom": {"publisher": DEEP["subscription"]}},
    }


class Comparing:
    """A compare_node process in the domain of a launched odom_node, and what it publishes."""

    def __init__(self, launched: Any, folder: Path, *arguments: str, **parameters: Any) -> None:
        self.launched = launched
        self.file = folder / "compare.yaml"
        values = {
            "qos_overrides": {"/odom": DEEP, "/reference": DEEP},
            "reference_sigma_xy": SIGMA_XY,
            "reference_sigma_yaw": SIGMA_YAW,
            "window": WINDOW,
            **parameters,
        }
        self.file.write_text(json.dumps({"compare_node": {"ros__parameters": values}}))
        self.process = subprocess.Popen(
            [*COMMAND, "--ros-args", "--params-file", str(self.file), *arguments],
            env=launched.environment,
            stderr=subprocess.PIPE,
            text=True,
        )

    def listen(self) -> Comparing:
        """Keep what it publishes from now on."""
        launched = self.launched
        self.errors = launched.keep(Vector3Stamped, "compare_node/error")
        self.poses = launched.keep(PoseWithCovarianceStamped, "compare_node/error_with_covariance")
        self.figures = {
            name: launched.keep(Float64, f"compare_node/{name}")
            for name in ("leg_nees", "nees", "nees_low", "nees_high", "coverage")
        }
        self.told: defaultdict[str, list[Any]] = defaultdict(list)
        self.said = self.told["honesty of the covariance"]
        launched._listen(DiagnosticArray, "/diagnostics", self._note)
        return self

    def _note(self, array: Any) -> None:
        for status in array.status:
            if status.name.startswith("compare_node: "):
                self.told[status.name.removeprefix("compare_node: ")].append(status)

    def reached(self, time: float) -> bool:
        """Whether an error has come of a later instant."""
        return bool(self.errors) and seconds_of(self.errors[-1]) > time

    def verdict(self) -> Any:
        """The next /diagnostics."""
        before = len(self.said)
        self.launched.until(lambda: len(self.said) > before, "diagnostics of compare_node")
        return self.said[-1]

    def last_verdict(self) -> Any:
        """The last one that came while there was something to compare."""
        return [s for s in self.said if s.level != DiagnosticStatus.STALE][-1]

    def stop(self) -> str:
        """End it as Ctrl-C does; returns what it said."""
        self.process.send_signal(signal.SIGINT)
        _, errors = self.process.communicate(timeout=10.0)
        assert self.process.returncode == 0, errors
        assert "Traceback" not in errors
        return errors


@pytest.fixture
def compare(tmp_path: Path) -> Iterator[Any]:
    started: list[Comparing] = []

    def start(launched: Any, *arguments: str, **parameters: Any) -> Comparing:
        started.append(Comparing(launched, tmp_path, *arguments, **parameters))
        # One that is not heard in time is ended too: it would live on in a domain that others get.
        return started[-1].listen()

    yield start
    for each in started:
        each.process.kill()


def recorded(seed: int, seconds: float = 50.0) -> Any:
    """A drive of the true robot."""
    random = np.random.default_rng(seed)
    return drive(
        TRUE, wandering(random, seconds), random, sigma_xy=SIGMA_XY, sigma_yaw=SIGMA_YAW, every=5
    )


def pose_stamped(time: float, x: float, y: float, yaw: float) -> PoseStamped:
    message = PoseStamped()
    message.header.stamp = stamp_at(1000.0 + time)
    message.pose.position.x, message.pose.position.y = x, y
    turn(message.pose, yaw)
    return message


def paced(launched: Any, caught_up: Callable[[], bool]) -> None:
    """Wait for a node that is behind; what waits for the next message would wait for ever."""
    end = time.monotonic() + 5.0
    while not caught_up() and time.monotonic() < end:
        launched.rest(0.05)


def play(launched: Any, run: Any, compare: Comparing) -> None:
    """Wheels and reference as they come; returns when all of it has been compared."""
    topics = [f"/compare_node/{name}" for name in (*compare.figures, "error")]
    launched.until(lambda: all(map(launched.node.count_publishers, topics)), "compare_node", 60.0)
    compare.verdict()  # it is heard, so nothing that it says is lost
    reference = list(
        zip(
            *(getattr(run.reference, name).tolist() for name in ("time", "x", "y", "yaw")),
            strict=True,
        )
    )
    launched.publisher(PoseStamped, "reference")
    row, waited = 0, run.ticks.time[0]
    for at, left, right in zip(
        *map(np.ndarray.tolist, (run.ticks.time, run.ticks.left, run.ticks.right)), strict=True
    ):
        if at > waited + AHEAD:  # a sample that DDS sends again may come seconds later
            waited = at
            paced(launched, partial(compare.reached, 999.0 + at))
        launched.ticks(left, right, 1000.0 + at)
        while row < len(reference) and reference[row][0] <= at:
            launched.send(PoseStamped, "reference", pose_stamped(*reference[row]))
            row += 1
        launched.executor.spin_once(timeout_sec=0.0)
    end = run.ticks.time[-1] + 1000.0
    launched.until(
        lambda: bool(launched.odometry) and abs(seconds_of(launched.odometry[-1]) - end) < 1e-6,
        "the last odometry",
        60.0,
    )
    launched.until(partial(compare.reached, end - 0.5), "its error", 60.0)
    compare.verdict()


@pytest.mark.evidence
def test_an_honest_covariance_is_said_to_be_so(launch: Any, compare: Any) -> None:
    launched = launch(robot_file())
    comparing = compare(launched)
    play(launched, recorded(1), comparing)
    status = comparing.last_verdict()
    assert status.level == DiagnosticStatus.OK
    assert status.message.startswith("the covariance is honest: NEES ")
    figures = {name: [m.data for m in kept] for name, kept in comparing.figures.items()}
    assert len(figures["nees"]) >= WINDOW
    assert figures["nees_low"][-1] < figures["nees"][-1] < figures["nees_high"][-1]
    assert figures["nees"][-1] == pytest.approx(np.mean(figures["leg_nees"][-WINDOW:]))
    assert figures["coverage"][-1] >= 0.8
    told = values_of(comparing.verdict())
    assert float(told["NEES"]) == pytest.approx(figures["nees"][-1], abs=1e-3)
    assert "refused" not in " ".join(told)
    # The error itself, in the robot's frame, with the covariance promised for it.
    last, pose = comparing.errors[-1], comparing.poses[-1]
    assert last.header.frame_id == "base_link"
    assert math.hypot(last.vector.x, last.vector.y) < 0.05
    assert pose.pose.pose.position.x == last.vector.x
    block = in_plane(pose.pose.covariance)
    assert (np.linalg.eigvalsh(block) > 0.0).all()
    assert (block == block.T).all() or np.allclose(block, block.T, rtol=1e-9)
    comparing.stop()


def test_a_covariance_a_third_of_the_true_sigma_is_said_to_be_too_small(
    launch: Any, compare: Any
) -> None:
    launched = launch(robot_file(noise=1.0 / 3.0))
    comparing = compare(launched)
    play(launched, recorded(1), comparing)
    status = comparing.last_verdict()
    assert status.level == DiagnosticStatus.WARN
    assert status.message.startswith("the covariance is too small, the errors are larger")
    figures = {name: kept[-1].data for name, kept in comparing.figures.items() if kept}
    assert figures["nees"] > figures["nees_high"]  # which legs are there depends on the machine
    assert figures["coverage"] < 0.9
    assert "the covariance is too small" in comparing.stop()


def test_its_launch_file_hands_it_topics_and_the_kind_of_reference(
    launch: Any, compare: Any
) -> None:
    launched = launch(robot_file())
    (process,) = launched_by(
        ROOT,
        "compare.launch.xml",
        reference="/vrpn/robot/pose",
        reference_type="transform_stamped",
        odom="/wheels",
    )
    comparing = compare(launched, *process.arguments)
    assert comparing.verdict().message == (
        "nothing to compare: /wheels and /vrpn/robot/pose silent"
    )
    (heard,) = launched.node.get_subscriptions_info_by_topic("/vrpn/robot/pose")
    assert heard.topic_type == "geometry_msgs/msg/TransformStamped"
    comparing.stop()


def test_silence_and_clocks_that_do_not_meet_are_said(launch: Any, compare: Any) -> None:
    launched = launch(robot_file())
    comparing = compare(launched)
    status = comparing.verdict()
    assert status.level == DiagnosticStatus.STALE
    assert status.message == "nothing to compare: /odom and /reference silent"
    for row in range(30):
        launched.ticks(10.0 * row, 10.0 * row, 1000.0 + 0.02 * row)
        launched.send(PoseStamped, "reference", pose_stamped(500.0 + 0.02 * row, 0.0, 0.0, 0.0))
        launched.rest(0.05)
    status = comparing.verdict()
    assert status.level == DiagnosticStatus.WARN
    assert "are both on one clock" in status.message
    assert "+500.0 s" in status.message
    bad = pose_stamped(600.0, math.nan, 0.0, 0.0)
    launched.send(PoseStamped, "reference", bad)
    unturned = pose_stamped(601.0, 0.0, 0.0, 0.0)
    unturned.pose.orientation.w = 0.0
    launched.send(PoseStamped, "reference", unturned)
    refused = {
        f"reference refused: {why}" for why in ("pose not finite", "orientation not a rotation")
    }

    def counted() -> dict[str, str]:
        return values_of(comparing.said[-1])

    launched.until(lambda: refused <= counted().keys(), "what was refused")
    assert {counted()[each] for each in refused} == {"1"}
    comparing.stop()


def test_what_is_given_wrongly_is_refused_in_one_line(launch: Any) -> None:
    launched = launch(robot_file())
    for wrong, said in (
        ({"windw": 30}, "unknown parameter windw: did you mean window?"),
        ({"reference_sigma_xy": 1e200}, "reference_sigma_xy must be a number of at most 1e+06"),
        ({"leg": -1.0}, "leg must be a number greater than 0 (m), not -1.0"),
        ({"reference_type": "laser"}, "reference_type must be one of pose_stamped, "),
    ):
        file = Path(launched.environment["ROS_LOG_DIR"]) / "wrong.yaml"
        file.write_text(json.dumps({"/**": {"ros__parameters": {**robot_file(), **wrong}}}))
        run = subprocess.run(
            [*COMMAND, "--ros-args", "--params-file", str(file)],
            env=launched.environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=30.0,
        )
        assert run.returncode == 2
        assert said in run.stderr
        assert "Traceback" not in run.stderr


# ------------------------------------------------------------------ kinds of reference


def test_all_kinds_of_reference_are_read_alike() -> None:
    pose = pose_stamped(2.5, 1.0, -2.0, 0.7)
    with_covariance, odometry, transform = (
        PoseWithCovarianceStamped(),
        Odometry(),
        TransformStamped(),
    )
    for message in (with_covariance, odometry):
        message.header = pose.header
        message.pose.pose = pose.pose
        message.pose.covariance[0] = message.pose.covariance[7] = 4e-6
        message.pose.covariance[35] = 9e-6
    transform.header = pose.header
    transform.transform.translation.x, transform.transform.translation.y = 1.0, -2.0
    transform.transform.rotation = pose.pose.orientation
    usual = odometry_of(odometry, Clockwork())[0].covariance
    for kind, message in (
        ("pose_stamped", pose),
        ("pose_with_covariance_stamped", with_covariance),
        ("odometry", odometry),
        ("transform_stamped", transform),
    ):
        reading = reference_reader(kind, usual)(message, Clockwork())
        assert reading.pose == pytest.approx((1.0, -2.0, 0.7))
        assert reading.covariance == pytest.approx((4e-6, 0.0, 0.0, 4e-6, 0.0, 9e-6))
    with_covariance.pose.covariance[:] = 0.0
    unstated = reference_reader("pose_with_covariance_stamped", usual)(with_covariance, Clockwork())
    assert unstated.covariance == usual


def test_the_docs_list_every_parameter() -> None:
    command = [sys.executable, "-m", "werrimbi_odom.ros.compare_parameters"]
    printed = subprocess.run(command, capture_output=True, text=True, check=True, cwd=ROOT).stdout
    assert printed in (ROOT / "docs" / "robot.md").read_text(encoding="utf-8")
    assert printed.count("\n") == 2 + len(PARAMETERS)
