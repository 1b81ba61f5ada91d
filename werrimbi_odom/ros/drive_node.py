# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Drives a manoeuvre through cmd_vel, in closed loop on the odometry, within user-given limits.

    ros2 run werrimbi_odom drive_node --ros-args -p manoeuvre:=square -p area_radius:=4.0
    ros2 service call /drive_node/start std_srvs/srv/Trigger

All decisions are made by `werrimbi_odom.driving.driver.Driver`: when to move, and when to stop.
"""

from __future__ import annotations

import math
import sys
import time
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Point, Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from sensor_msgs.msg import Imu, LaserScan
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker

from werrimbi_odom.driving.driver import Driver
from werrimbi_odom.driving.limits import STILL, Command, OdometryReading
from werrimbi_odom.errors import InputError
from werrimbi_odom.model.pose import Pose
from werrimbi_odom.ros import drive_parameters, planar
from werrimbi_odom.ros.declared_parameters import declared
from werrimbi_odom.ros.diagnostics import diagnostic, diagnostics_publisher, tell
from werrimbi_odom.ros.drive_records import Records
from werrimbi_odom.ros.run_node import run
from werrimbi_odom.ros.topics import full_name, others_on, publisher, stamp_of, subscribe
from werrimbi_odom.ros.upright_gyro import UprightGyro

TICK = 0.02
"""Period of the timer [s]."""
HOLD = 1.0
"""Time for which zeros are repeated after a drive [s]; then `cmd_vel` is free for others."""
LEVELS = {
    "waiting": DiagnosticStatus.OK,
    "driving": DiagnosticStatus.OK,
    "done": DiagnosticStatus.OK,
    "stopped": DiagnosticStatus.WARN,
}


class DriveNode(Node):  # type: ignore[misc]
    """A `Driver` behind topics and services.

    It publishes on `cmd_vel` from the start of a drive to a second after its end. A node that waits
    disturbs nobody; a second one that is started is refused, or both see each other and stop in the
    second that a robot stands still before it drives. InputError if a parameter is invalid, or no
    area is given.
    """

    def __init__(self) -> None:
        super().__init__("drive_node")
        values = self._values = declared(self, drive_parameters.PARAMETERS)
        self._driver = Driver(
            drive_parameters.chosen_plan(values),
            drive_parameters.limits_of(values),
            drive_parameters.area_of(values),
            drive_parameters.watch_of(values),
        )
        self._records = Records(self, values)
        self._stamped = bool(values["use_stamped_vel"])
        self._frame = "odom"
        self._held_until = -math.inf
        self._told = self._driver.state
        self._shown_from: Pose | None = None
        self._topic = self.resolve_topic_name("cmd_vel")
        self._commands: Publisher | None = None
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self._path = publisher(self, Marker, "~/path", latched)
        self._diagnose = diagnostics_publisher(self)
        subscribe(self, Odometry, "odom", self._on_odometry)
        if values["scan_topic"]:
            subscribe(self, LaserScan, str(values["scan_topic"]), self._on_scan)
        if values["imu_topic"]:
            self._gyro = UprightGyro(str(values["imu_topic"]), self.get_logger())
            subscribe(self, Imu, str(values["imu_topic"]), self._on_imu)
        self.create_service(Trigger, "~/start", self._on_start)
        self.create_service(Trigger, "~/stop", self._on_stop)
        self.create_service(Trigger, "~/check", self._on_check)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(TICK, self._tick, clock=steady)
        self.create_timer(1.0, self._report, clock=steady)
        plan = self._driver.plan
        self.get_logger().info(
            f"{plan.name}: {plan.words}; {plan.duration(self._driver.limits):.0f} s. It waits for "
            f"{full_name(self)}/start, and shows the path on {full_name(self)}/path"
        )

    # ------------------------------------------------------------------------- subscriptions

    def _on_odometry(self, message: Any) -> None:
        driver, now = self._driver, time.monotonic()
        try:
            x, y = planar.place_of(message.pose.pose.position)
            yaw = planar.yaw_of(message.pose.pose.orientation, slack=1e-2)
        except InputError as error:
            self._stop(f"the odometry is no pose: {error.args[0]}")
            return
        self._frame = message.header.frame_id
        stamp = _seconds(message.header.stamp)
        age = 1e-9 * self.get_clock().now().nanoseconds - stamp
        self._send(driver.odometry(OdometryReading(stamp, age, Pose(x, y, yaw)), now))
        self._after()

    def _on_scan(self, message: Any) -> None:
        least = message.range_min
        # Below the least range nothing is measured, but for -inf: too near to be (REP 117).
        seen = (each for each in message.ranges if each >= least or each == -math.inf)
        nearest = max(min(seen, default=math.inf), 0.0)
        self._send(self._driver.scan(nearest, time.monotonic()))
        self._after()

    def _on_imu(self, message: Any) -> None:
        try:
            rate = self._gyro.rate(message)
        except InputError:
            return  # as if no gyro came
        stamp = _seconds(stamp_of(message, self.get_clock()))
        self._send(self._driver.gyro(stamp, rate, time.monotonic()))
        self._after()

    def _tick(self) -> None:
        """Check time and other publishers; repeat zeros after a drive."""
        driver, now = self._driver, time.monotonic()
        if driver.state == "driving":
            others = self._others()
            if others:
                driver.stop(others)
                self._send(STILL)
            else:
                self._send(driver.tick(now))
            self._after()
        if driver.state != "driving" and self._commands is not None:
            if now < self._held_until:
                self._send(STILL)
            else:
                self.destroy_publisher(self._commands)
                self._commands = None
        self._records.look()
        self._show(again=False)

    # ------------------------------------------------------------------------- services

    def _on_start(self, _: Any, response: Any) -> Any:
        asked = time.monotonic()
        wrong = self._others() or self._driver.refusal(asked)
        if wrong:
            response.success, response.message = False, f"it does not start: {wrong}"
            self.get_logger().warning(response.message)
            return response
        self._show(again=True)
        if self._values["dry_run"]:
            response.success = True
            response.message = f"it could start; nothing moves (dry_run). {self._words()}"
            return response
        try:
            self._records.begin(self._driver.plan.name)
            now = time.monotonic()
            self._driver.start(now, busy=now - asked)
            kind = TwistStamped if self._stamped else Twist
            self._commands = self._commands or publisher(self, kind, "cmd_vel", 10)
        except InputError as error:
            self._records.close()
            response.success, response.message = False, f"it does not start: {error}"
            return response
        response.success, response.message = True, f"it drives. {self._words()}"
        self.get_logger().info(response.message)
        self._told = "driving"
        self._report()
        return response

    def _on_stop(self, _: Any, response: Any) -> Any:
        was_driving = self._driver.state == "driving"
        self._stop("asked to stop")
        response.success = True
        response.message = "it stops" if was_driving else "it was not driving"
        return response

    def _on_check(self, _: Any, response: Any) -> Any:
        wrong = self._others() or self._driver.refusal(time.monotonic())
        self._show(again=True)
        response.success = not wrong
        response.message = wrong or f"it could start. {self._words()}"
        return response

    def _stop(self, why: str) -> None:
        """Send zeros at once."""
        was_driving = self._driver.state == "driving"
        self._driver.stop(why)
        if was_driving:
            self._send(STILL)
        self._after()

    def farewell(self) -> None:
        """Stop the robot before the node ends."""
        if self._driver.state == "driving":
            self._stop("told to end (Ctrl-C)")
            until = time.monotonic() + 0.3
            while time.monotonic() < until:
                self._send(STILL)
                time.sleep(TICK)
        self._records.close()

    def _others(self) -> str:
        """Who else commands the robot, in words; "" if nobody does."""
        return others_on(self, self._topic, own=self._commands is not None)

    # ------------------------------------------------------------------------- publications

    def _send(self, command: Command | None) -> None:
        if command is None or self._commands is None:
            return
        twist = Twist()
        twist.linear.x, twist.angular.z = command
        if self._stamped:
            message = TwistStamped(twist=twist)
            message.header.stamp = self.get_clock().now().to_msg()
            message.header.frame_id = "base_link"
            self._commands.publish(message)
        else:
            self._commands.publish(twist)

    def _after(self) -> None:
        """Report the end of a drive, once."""
        driver = self._driver
        if driver.state == self._told:
            return
        self._told = driver.state
        if driver.state not in ("done", "stopped"):
            return
        self._held_until = time.monotonic() + HOLD
        self._records.ending()
        done = driver.state == "done"
        words = driver.words if done else f"stopped: {driver.words}"
        tell(self.get_logger(), f"{words}. Next: {self._records.next_command()}", fine=done)
        self._report()

    def _words(self) -> str:
        driver = self._driver
        least = driver.plan.duration(driver.limits)
        return f"{driver.plan.name} takes {least:.0f} s; {self._records.words()}"

    def _show(self, *, again: bool) -> None:
        """Publish the path, if the robot moved since it was last shown."""
        driver = self._driver
        if driver.last is None or driver.state == "driving":
            return
        here, seen = driver.last.pose, self._shown_from
        if seen is not None and not again:
            moved = math.hypot(here.x - seen.x, here.y - seen.y)
            if moved < 0.02 and abs(math.remainder(here.yaw - seen.yaw, 2.0 * math.pi)) < 0.02:
                return
        self._shown_from = here
        marker = Marker(type=Marker.LINE_STRIP, action=Marker.ADD, ns="path")
        marker.header.frame_id = self._frame
        marker.pose.orientation.w = 1.0
        marker.scale.x = 0.02
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = 0.84, 0.37, 0.0, 1.0
        marker.points = [Point(x=point.x, y=point.y) for point in driver.shown()]
        self._path.publish(marker)

    def _report(self) -> None:
        driver = self._driver
        name, words = f"{full_name(self)}: drive", f"{driver.state}: {driver.words}"
        told = {
            "manoeuvre": driver.plan.name,
            "progress": driver.progress,
            "speed": f"{driver.command.speed:.3f} m/s",
            "yaw rate": f"{driver.command.yaw_rate:.3f} rad/s",
        }
        status = diagnostic(LEVELS[driver.state], name, words, told, of="base")
        self._diagnose(status)


def _seconds(stamp: Stamp) -> float:
    return float(stamp.sec) + 1e-9 * float(stamp.nanosec)


def main(args: list[str] | None = None) -> int:
    """Run the node until it is stopped; return the exit code."""
    return run(DriveNode, "drive_node", args, farewell=DriveNode.farewell)


if __name__ == "__main__":
    sys.exit(main())
