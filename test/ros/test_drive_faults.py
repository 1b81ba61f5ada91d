# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""drive_node over DDS, on a robot that we play: each fault stops it, within 0.1 m.

All of them, and how fast: `test_each_fault_stops_it_in_time`, which wants a machine of its own.
"""

from __future__ import annotations

import math
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from test.evidence import in_evidence

pytest.importorskip("rclpy")

from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.qos import QoSProfile
from rclpy.time import Time
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Trigger

from test.ros.beside import Beside, beside
from test.ros.conftest import Launched, launcher

VALUES = {
    "manoeuvre": "paper_out_and_back",
    "length": 1.5,
    "area_ahead": 1.9,
    "area_behind": 1.0,
    "area_left": 1.0,
    "area_right": 1.0,
    "max_vel_x": 0.5,
    "acc_lim_x": 2.0,
    "max_deviation": 2.0,
    "scan_topic": "scan",
    "imu_topic": "imu",
}
SPEED = 0.2
"""Over this the robot is under way [m/s]."""
STEP = 0.02
"""Between two odometry messages [s]."""
BRAKES = 3.0
"""[m/s^2]"""
OWN_TIMEOUT = 0.15
"""Without a command the base stops by itself after so long [s], as docs/driving.md asks for."""
BUSY = (
    "stopped: the odometry is silent",
    "stopped: the odometry comes",
    "stopped: the odometry jumped by 0.0",
)
"""What a machine that is busy with other things makes of us now and then: steps that it makes up
for come at once, and messages are lost. The jump that is tried is of 0.40 m."""


class PlayedRobot:
    """A robot on paper that obeys cmd_vel, and whose odometry, gyro and scan can be spoilt."""

    def __init__(self, client: Launched, folder: Path) -> None:
        self.client, self._folder = client, folder
        self.drive = self.driven()
        self.x = self.speed = 0.0
        self.wanted = 0.0
        self.zero_at = math.inf
        self.stuck: float | None = None
        self.own_timeout, self._obeyed = math.inf, 0.0
        self.odometry: Callable[[Odometry], Odometry | None] = lambda message: message
        self.gyro: float | None = 0.0
        self.nearest = 2.0
        self.clock = 0.0
        """Its own: it lives on with each odometry message, however busy the machine is [s]."""
        node = client.node
        deep = QoSProfile(depth=10)
        self._odometry = node.create_publisher(Odometry, "odom", deep)
        self._imu = node.create_publisher(Imu, "imu", deep)
        self._scan = node.create_publisher(LaserScan, "scan", deep)
        node.create_subscription(Twist, "cmd_vel", self._obey, deep)
        node.create_timer(STEP, self._step)

    def driven(self) -> Beside:
        """A drive_node that has begun."""
        return Beside(self._folder, self.client.environment, "drive_node", **VALUES)

    def _obey(self, message: Twist) -> None:
        self.wanted, self._obeyed = message.linear.x, self.clock
        if not self.wanted and math.isinf(self.zero_at):
            self.zero_at = self.clock

    def _step(self) -> None:
        self.clock += STEP
        if self.clock - self._obeyed > self.own_timeout and math.isinf(self.zero_at):
            self.wanted, self.zero_at = 0.0, self.clock
        wanted = self.wanted if self.stuck is None else self.stuck
        most = BRAKES * STEP
        self.speed += min(max(wanted - self.speed, -most), most)
        self.x += self.speed * STEP
        stamp = Time(nanoseconds=time.time_ns()).to_msg()
        message = Odometry()
        message.header.stamp, message.header.frame_id = stamp, "odom"
        message.pose.pose.position.x = self.x
        message.pose.pose.orientation.w = 1.0
        spoilt = self.odometry(message)
        if spoilt is not None:
            self._odometry.publish(spoilt)
        imu = Imu()
        if self.gyro is None:
            imu.angular_velocity_covariance[0] = -1.0  # it measures something else
        imu.header.stamp, imu.angular_velocity.z = stamp, self.gyro or 0.0
        self._imu.publish(imu)
        self._scan.publish(LaserScan(ranges=[math.inf, self.nearest], range_min=0.05))

    def state(self) -> str:
        """What drive_node last said of itself."""
        told = [each for each in self.client.diagnostics if each.name == "drive_node: drive"]
        return str(told[-1].message) if told else ""

    def commanders(self) -> int:
        """How many publish cmd_vel."""
        return int(self.client.node.count_publishers("cmd_vel"))

    def ask(self, service: str) -> Any:
        """Call a service of drive_node."""
        again = 2.0 if service == "check" else math.inf
        return self.client.call(Trigger, f"drive_node/{service}", Trigger.Request(), again)

    def anew(self) -> None:
        """From the origin, sound, and ready to start."""
        self.x = self.speed = self.wanted = self.gyro = 0.0
        self.nearest, self.stuck = 2.0, None
        self.odometry = lambda message: message
        self.client.until(lambda: self.ask("check").success, "robot that could start", 30.0)

    def under_way(self) -> None:
        """Anew, until it drives; anew too where a busy machine delayed us."""
        for _ in range(5):
            self.anew()
            self.client.diagnostics.clear()
            if not self.ask("start").success:
                continue
            self.client.until(
                lambda: self.speed > SPEED or self.state().startswith(BUSY),
                f"motion ({self.state()})",
                15.0,
            )
            if self.speed > SPEED:
                self.zero_at = math.inf
                return
        raise AssertionError(self.state())

    def stops(self, since: float, x: float, words: str) -> tuple[float, float]:
        """Until it stands, having said why: time to the first zero [s], way to standstill [m].

        Both by the robot's own clock. Where a busy machine was quicker to stop it: not numbers.
        """
        self.client.until(lambda: not math.isinf(self.zero_at), "zero on cmd_vel")
        self.client.until(
            lambda: words in self.state() or self.state().startswith((*BUSY, "done")), words
        )
        self.stuck = None
        self.client.until(lambda: not self.speed, "standstill")
        if words not in self.state():
            return math.nan, math.nan
        assert self.state().startswith("stopped: "), self.state()
        return self.zero_at - since, abs(self.x - x)

    def tried(self, fault: Callable[[PlayedRobot], None], words: str) -> tuple[float, float]:
        """Under way, a fault, and how it stops."""
        for _ in range(10):
            self.under_way()
            since, x = self.clock, self.x
            fault(self)
            took, way = self.stops(since, x, words)
            if not math.isnan(took):
                return took, way
        raise AssertionError(self.state())


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Iterator[PlayedRobot]:
    folder = tmp_path_factory.mktemp("drive")
    for launch_one in launcher(folder):
        client = launch_one()
        robot = PlayedRobot(client, folder)
        yield robot
        assert robot.drive.stop() == 0, robot.drive.said()
        assert "Traceback" not in robot.drive.said(), robot.drive.said()


def silent(robot: PlayedRobot) -> None:
    robot.odometry = lambda message: None


def back(robot: PlayedRobot) -> None:
    def spoil(message: Odometry) -> Odometry:
        message.header.stamp.sec -= 5
        return message

    robot.odometry = spoil


def delayed(robot: PlayedRobot) -> None:
    waiting: list[Odometry] = []

    def spoil(message: Odometry) -> Odometry | None:
        waiting.append(message)
        return waiting.pop(0) if len(waiting) > 16 else None

    robot.odometry = spoil


def jumping(robot: PlayedRobot) -> None:
    def spoil(message: Odometry) -> Odometry:
        message.pose.pose.position.y += 0.4
        return message

    robot.odometry = spoil


def no_number(robot: PlayedRobot) -> None:
    def spoil(message: Odometry) -> Odometry:
        message.pose.pose.position.y = math.nan
        return message

    robot.odometry = spoil


def slipping(robot: PlayedRobot) -> None:
    robot.gyro = 0.6


def something_near(robot: PlayedRobot) -> None:
    robot.nearest = 0.3


def something_too_near_to_measure(robot: PlayedRobot) -> None:
    robot.nearest = -math.inf  # REP 117


def without_gyro(robot: PlayedRobot) -> None:
    robot.gyro = None


def asked(robot: PlayedRobot) -> None:
    robot.ask("stop")


FAULTS: dict[Callable[[PlayedRobot], None], str] = {
    silent: "the odometry is silent for 0.1",
    back: "the odometry's stamps go back",
    delayed: "the odometry ",  # first it is silent, and then comes late
    jumping: "the odometry jumped by 0.40 m",
    no_number: "the odometry is no pose",
    slipping: "the wheels slip",
    something_near: "the scan sees something at 0.30 m",
    something_too_near_to_measure: "the scan sees something at 0.00 m",
    without_gyro: "no gyro comes",
    asked: "asked to stop",
}


@pytest.mark.parametrize(
    "fault", [silent, jumping, something_too_near_to_measure, without_gyro, asked]
)
def test_a_fault_stops_it_for_good(
    played: PlayedRobot, fault: Callable[[PlayedRobot], None]
) -> None:
    _, way = played.tried(fault, FAULTS[fault])
    assert way < 0.1
    played.client.rest(0.2)
    assert played.wanted == 0.0


@pytest.mark.evidence
def test_a_robot_that_does_not_obey_is_told_to_stop_at_the_border(played: PlayedRobot) -> None:
    played.under_way()
    played.stuck = 0.4
    played.client.until(lambda: played.x > 1.6, "way to the border")  # 1.9 less the radius
    took, way = played.stops(played.clock, 1.6, "it left the area")
    print(f"area left: {took:.3f} s, {way:.3f} m")
    assert took < 0.2
    assert way < 0.1


def test_another_on_cmd_vel_stops_it_and_keeps_it_from_starting(played: PlayedRobot) -> None:
    for _ in range(5):
        played.under_way()
        since, x = played.clock, played.x
        other = played.client.node.create_publisher(Twist, "cmd_vel", 10)
        try:
            _, way = played.stops(since, x, "stopped: ")
            if played.state().startswith(BUSY):
                continue
            assert "another publishes /cmd_vel too (" in played.state()
            assert way < 0.1
            for _ in range(50):  # a publisher is found before the name of its node
                answer = played.ask("start")
                assert not answer.success
                assert "another publishes /cmd_vel too (" in answer.message
                assert "UNKNOWN" not in answer.message
                if "(/client_" in answer.message:
                    return
                played.client.rest(0.1)
            raise AssertionError(answer.message)
        finally:
            played.client.node.destroy_publisher(other)
    raise AssertionError(played.state())


@pytest.mark.parametrize("end", [signal.SIGINT, in_evidence(signal.SIGTERM)])
def test_told_to_end_it_stops_the_robot_first_and_moves_nothing_when_it_is_back(
    played: PlayedRobot, end: int
) -> None:
    client, drive = played.client, played.drive
    played.under_way()
    x = played.x
    drive.process.send_signal(end)
    client.until(lambda: not math.isinf(played.zero_at), "zero on cmd_vel")
    client.until(lambda: not played.speed, "standstill")
    assert abs(played.x - x) < 0.1, drive.said()
    client.until(lambda: drive.process.poll() is not None, "end")
    assert drive.stop() == 0, drive.said()
    assert "told to end" in drive.said()
    client.diagnostics.clear()
    played.wanted = math.nan  # a command of any kind would be noticed
    played.stuck = 0.0
    played.drive = played.driven()
    client.until(lambda: played.state().startswith("waiting"), "node that is back")
    client.rest(1.0)
    assert math.isnan(played.wanted)


@pytest.mark.evidence
def test_killed_in_mid_drive_the_base_stops_and_a_successor_waits(played: PlayedRobot) -> None:
    """Nothing here can stop a robot whose driver was killed: the base's own timeout does."""
    times, ways = [], []
    for _ in range(5):
        played.under_way()
        since, x = played.clock, played.x
        played.own_timeout = OWN_TIMEOUT
        played.drive.process.kill()
        played.client.until(lambda: not math.isinf(played.zero_at), "end of the base's patience")
        played.client.until(lambda: not played.speed, "standstill")
        times.append(played.zero_at - since)
        ways.append(abs(played.x - x))
        played.own_timeout = math.inf
        played.client.diagnostics.clear()
        played.wanted = math.nan
        played.stuck = 0.0
        played.drive = played.driven()
        played.client.until(lambda: played.state().startswith("waiting"), "node that is back")
        played.client.rest(1.0)
        assert math.isnan(played.wanted)
    played.under_way()  # and can be asked again
    print(f"killed: {max(times):.3f} s, {max(ways):.3f} m")
    assert max(times) < 0.2
    assert max(ways) < 0.1


def test_only_one_that_drives_is_on_cmd_vel(played: PlayedRobot) -> None:
    """Before it was asked it disturbs nobody, and a second after it stopped neither."""
    client = played.client
    client.until(lambda: not played.commanders(), "end of earlier drives", 30.0)
    played.under_way()
    assert played.commanders() == 1
    played.ask("stop")
    client.until(lambda: not played.commanders(), "release of cmd_vel", 5.0)
    assert not played.speed


@pytest.mark.evidence
def test_of_two_that_are_asked_at_once_one_at_most_drives(
    played: PlayedRobot, tmp_path: Path
) -> None:
    """They have one name: one request starts both, ten times. One is refused, or both stop."""
    client, together, driven = played.client, [], 0
    client.until(lambda: not played.commanders(), "end of earlier drives", 30.0)
    with beside(tmp_path, client.environment, "drive_node", **VALUES) as second:
        client.until(lambda: "waits for" in second.said(), "a second", 30.0)
        for _ in range(10):
            played.anew()
            played.ask("start")
            end = played.clock + 3.0
            while played.clock < end:
                client.rest(STEP)
                if played.speed:
                    together.append(played.commanders())
            driven += bool(played.speed)
            played.ask("stop")
            client.until(lambda: not played.commanders(), "release of cmd_vel", 5.0)
    print(f"two asked at once, 10 times: one drove {driven} times; moved by {set(together)}")
    assert set(together) <= {1}


@pytest.mark.evidence
def test_a_second_that_is_asked_while_one_drives_is_refused(
    played: PlayedRobot, tmp_path: Path
) -> None:
    """It is asked from its first breath on, five times."""
    client, most, refused = played.client, [], 0
    for _ in range(20):
        played.under_way()
        with beside(tmp_path, client.environment, "drive_node", **VALUES) as second:
            client.until(lambda: "waits for" in second.said(), "a second", 30.0)
            end = played.clock + 8.0
            while "it does not start" not in second.said() and played.clock < end:
                played.ask("start")
                client.rest(STEP)
                most.append(played.commanders())
            if not played.state().startswith(BUSY):
                assert "it does not start: " in second.said(), second.said()
                assert played.state().startswith("driving"), played.state()
                refused += 1
        played.ask("stop")
        if refused == 5:
            break
    print(f"a second asked, {refused} times: at most {max(most)} on cmd_vel")
    assert max(most) == 1
    assert refused == 5


@pytest.mark.evidence
@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.__name__)
def test_each_fault_stops_it_in_time(
    played: PlayedRobot, fault: Callable[[PlayedRobot], None]
) -> None:
    """From the fault to the first zero on cmd_vel; ten times."""
    times, ways = [], []
    for _ in range(10):
        took, way = played.tried(fault, FAULTS[fault])
        times.append(took)
        ways.append(way)
    print(f"{fault.__name__}: {max(times):.3f} s, {max(ways):.3f} m")
    assert max(times) < 0.2
    assert max(ways) < 0.1
