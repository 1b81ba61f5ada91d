# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A robot in the physics engine as a ROS node: commands in, sensor data out.

    ros2 run werrimbi_odom simulated_robot --ros-args -p hide:=castor_kick

`SimulatedRobot._advance` advances the simulation; everything else is set-up and reporting.
"""

from __future__ import annotations

import math
import sys
import time as clock
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from builtin_interfaces.msg import Time as Stamp
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from geometry_msgs.msg import PoseStamped, TransformStamped, Twist, TwistStamped
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rosgraph_msgs.msg import Clock as ClockMessage
from sensor_msgs.msg import Imu, JointState, LaserScan
from std_srvs.srv import Trigger

from werrimbi_odom.errors import InputError
from werrimbi_odom.ros import simulated_parameters
from werrimbi_odom.ros.declared_parameters import declared
from werrimbi_odom.ros.diagnostics import diagnostic
from werrimbi_odom.ros.run_node import run
from werrimbi_odom.ros.topics import full_name, publisher, stamp_at, subscribe, transform_sender

if TYPE_CHECKING:
    from werrimbi_odom.simulation import AxlePose

TICK = 0.01
"""Period of the timer, wall time [s]."""
BEHIND = 0.5
"""Largest delay that the simulation catches up, wall time [s]; beyond, it stays late."""
CLOCK_RATE = 100.0
"""Messages on /clock per simulated second."""
BEGINS = 1.0
"""Simulated time on /clock at the start [s]; a stamp of zero means "no stamp"."""


class SimulatedRobot(Node):  # type: ignore[misc]
    """A simulated robot driven by `cmd_vel`.

    InputError if a parameter is invalid, or mujoco is not installed.
    """

    def __init__(self) -> None:
        super().__init__("simulated_robot")
        values = declared(self, simulated_parameters.PARAMETERS)
        self._factor = float(values["real_time_factor"])  # type: ignore[arg-type]
        self._publishes_clock = bool(values["publish_clock"])
        if self._factor != 1.0 and not self._publishes_clock:
            raise InputError(
                f"real_time_factor {self._factor:g} needs publish_clock: true (and use_sim_time: "
                "true for all other nodes): without it they would take time to go as on the wall"
            )
        self._timeout = float(values["cmd_vel_timeout"])  # type: ignore[arg-type]
        self._robot, self._hidden, self._believed = simulated_parameters.robot_of(values)
        if values["robot_file"]:
            simulated_parameters.write_believed(self._believed, Path(str(values["robot_file"])))
        self._tick = 2.0 * math.pi / self._believed.left_ticks_per_revolution
        self._dues = [
            _Due(float(values[f"{name}_rate"]), lag, publish)  # type: ignore[arg-type]
            for name, lag, publish in (
                ("joint_states", self._robot.counters_lag, self._publish_joints),
                ("imu", 0.0, self._publish_imu),
                ("reference", self._robot.reference_lag, self._publish_reference),
            )
        ]
        if values["room"] != "none":
            turn = 1.0 / self._robot.lidar.rate_hz
            self._dues.append(_Due(self._robot.lidar.rate_hz, turn, self._publish_scan))
            self._scan = publisher(self, LaserScan, "scan")
        if self._publishes_clock:
            self._dues.insert(0, _Due(CLOCK_RATE, 0.0, self._publish_clock))
        self._joints = publisher(self, JointState, "joint_states")
        self._imu = publisher(self, Imu, "imu")
        self._reference = publisher(self, PoseStamped, "reference")
        if self._publishes_clock:
            self._clock_out = publisher(self, ClockMessage, "/clock")
        self._diagnostics = publisher(self, DiagnosticArray, "/diagnostics")
        self._send = transform_sender(self, "enable_tf") if values["enable_tf"] else None
        stamped = bool(values["use_stamped_vel"])
        take = (lambda message: self._command(message.twist)) if stamped else self._command
        subscribe(self, TwistStamped if stamped else Twist, "cmd_vel", take)
        self.create_service(Trigger, "~/truth", self._tell)
        self._commanded = -math.inf
        self._asked = (0.0, 0.0)
        self._late = 0.0
        self._epoch = BEGINS if self._publishes_clock else clock.time()
        self._began = clock.monotonic()
        self._reported = (self._began, 0.0)
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(TICK, self._advance, clock=steady)
        self.create_timer(1.0, self._report, clock=steady)
        kind = "TwistStamped" if stamped else "Twist"
        self.get_logger().info(
            f"a robot in the physics engine: {kind} on {self.resolve_topic_name('cmd_vel')} drives "
            "it; joint_states, imu and reference come out; ~/truth tells what is hidden in it"
        )

    # ------------------------------------------------------------------------- time

    def _advance(self) -> None:
        """Advance the simulation to the present wall time, and publish sensor data on the way."""
        from werrimbi_odom.simulation import UnstableError
        from werrimbi_odom.simulation.engine import PERIOD

        robot = self._robot
        behind = (clock.monotonic() - self._began) - robot.time / self._factor
        if behind > BEHIND:
            self._began += behind - BEHIND
            self._late += behind - BEHIND
            if not self._publishes_clock:
                self._epoch += behind - BEHIND
            behind = BEHIND
        for _ in range(int(behind * self._factor / PERIOD)):
            if robot.time - self._commanded > self._timeout:
                self._asked = (0.0, 0.0)
            robot.command(*self._asked)
            try:
                robot.advance()
            except UnstableError as error:
                raise InputError(str(error)) from error
            for due in self._dues:
                due.look(robot.time)

    def _command(self, twist: Any) -> None:
        speed, yaw_rate = float(twist.linear.x), float(twist.angular.z)
        if not (math.isfinite(speed) and math.isfinite(yaw_rate)):
            self.get_logger().warning("a command that is no number: the robot stops")
            speed = yaw_rate = 0.0
        self._asked = speed, yaw_rate
        self._commanded = self._robot.time

    # ------------------------------------------------------------------------- publications

    def _publish_clock(self, time: float, _: float) -> None:
        self._clock_out.publish(ClockMessage(clock=self._stamp(time)))

    def _publish_joints(self, time: float, _: float) -> None:
        counts = self._robot.counters(time)
        wheels = zip(self._believed.joints, counts, strict=True)
        angles = {name: count * self._tick for names, count in wheels for name in names}
        message = JointState(name=list(angles), position=list(angles.values()))
        message.header.stamp = self._stamp(time)
        self._joints.publish(message)

    def _publish_imu(self, time: float, since: float) -> None:
        message = Imu()
        message.header.stamp = self._stamp(time)
        message.header.frame_id = "imu_link"
        message.orientation_covariance[0] = -1.0  # no orientation
        message.angular_velocity.z = self._robot.gyro(since, time)
        message.linear_acceleration.z = 9.81
        self._imu.publish(message)

    def _publish_reference(self, time: float, _: float) -> None:
        pose = self._robot.reference(time)
        message = PoseStamped()
        message.header.stamp = self._stamp(time)
        message.header.frame_id = "world"
        place, turn = message.pose.position, message.pose.orientation
        place.x, place.y = pose.x, pose.y
        turn.z, turn.w = math.sin(0.5 * pose.yaw), math.cos(0.5 * pose.yaw)
        self._reference.publish(message)
        if self._send is not None:
            self._send(self._transform("odom", (0.0, 0.0, 0.0)))
            self._send(self._transform("base_link_true", self._robot.pose))
            self._send(self._transform("base_scan", self._robot.lidar.mount, "base_link"))

    def _publish_scan(self, time: float, _: float) -> None:
        """Publish one sweep, stamped with the time of its first beam."""
        lidar = self._robot.lidar
        message = LaserScan(
            angle_max=lidar.increment * (lidar.beams - 1),
            angle_increment=lidar.increment,
            time_increment=lidar.beam_interval,
            scan_time=1.0 / lidar.rate_hz,
            range_min=lidar.nearest,
            range_max=lidar.farthest,
            ranges=self._robot.sweep(time).tolist(),
        )
        message.header.stamp = self._stamp(time)
        message.header.frame_id = "base_scan"
        self._scan.publish(message)

    def _transform(
        self, child: str, pose: AxlePose | tuple[float, float, float], parent: str = "world"
    ) -> TransformStamped:
        message = TransformStamped(child_frame_id=child)
        message.header.stamp = self._stamp(self._robot.time)
        message.header.frame_id = parent
        moved, turn = message.transform.translation, message.transform.rotation
        moved.x, moved.y, yaw = pose
        turn.z, turn.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)
        return message

    def _tell(self, _: Any, response: Any) -> Any:
        response.success = True
        response.message = "; ".join(
            f"{each.entry.name} = {each.strength:g}"
            f"{'' if each.entry.unit == '1' else ' ' + each.entry.unit}: {each.entry.says}"
            for each in self._hidden
        )
        response.message = response.message or "nothing is hidden"
        return response

    def _report(self) -> None:
        now, time = clock.monotonic(), self._robot.time
        pace = (time - self._reported[1]) / (now - self._reported[0])
        self._reported = now, time
        slow = pace < 0.9 * self._factor
        words = f"{pace:.2f} simulated seconds in a second"
        if slow:
            words += f", not {self._factor:g}: this machine is too slow"
        told = {
            "time": f"{time:.3f} s",
            "time lost": f"{self._late:.3f} s",
            "speed asked": f"{self._asked[0]:.3f} m/s",
            "yaw rate asked": f"{self._asked[1]:.3f} rad/s",
        }
        level = DiagnosticStatus.WARN if slow else DiagnosticStatus.OK
        name = f"{full_name(self)}: simulation"
        status = diagnostic(level, name, words, told, of="physics engine")
        array = DiagnosticArray(status=[status])
        array.header.stamp = self._stamp(time)
        self._diagnostics.publish(array)

    def _stamp(self, time: float) -> Stamp:
        return stamp_at(self._epoch + time)


class _Due:
    """A sensor that publishes at its own rate [Hz], as soon as its data are available.

    These lag behind their stamp [s]. `publish` gets that time, and the time before it.
    """

    def __init__(self, rate: float, lag: float, publish: Callable[[float, float], None]) -> None:
        self._rate, self._lag, self._publish = rate, lag, publish
        self._count = 0

    def look(self, now: float) -> None:
        """Publish if it is due."""
        time = (self._count + 1) / self._rate
        if time + self._lag <= now + 1e-9:
            self._publish(time, self._count / self._rate)
            self._count += 1


def main(args: list[str] | None = None) -> int:
    """Run the node until it is stopped; return the exit code."""
    return run(SimulatedRobot, "simulated_robot", args)


if __name__ == "__main__":
    sys.exit(main())
