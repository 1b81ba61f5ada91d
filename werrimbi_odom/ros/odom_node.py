# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The main node: counters in, odometry with its covariance out.

    odom_node --ros-args --params-file robot.yaml

`OdomNode._take` processes a message; everything else is set-up and reporting.
"""

from __future__ import annotations

import sys
from functools import partial
from typing import Any

from builtin_interfaces.msg import Time as Stamp
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.parameters import doubtful_sizes
from werrimbi_odom.ros import counter_inputs, odom_parameters
from werrimbi_odom.ros.diagnostics import diagnostics_publisher, status_of, tell
from werrimbi_odom.ros.input_health import OF_POSE, Health
from werrimbi_odom.ros.live_odometer import Finished, LiveOdometer
from werrimbi_odom.ros.markers import PieceTrail
from werrimbi_odom.ros.odometry_messages import OdometryMessage, pose_from
from werrimbi_odom.ros.phase_learning import learning_of, status_of_effects
from werrimbi_odom.ros.run_node import run
from werrimbi_odom.ros.slip import slip_of
from werrimbi_odom.ros.topics import Company, full_name, publisher, subscribe, transform_sender

STATUS_PERIOD = 0.2
"""Period of ~/status [s]."""
DIAGNOSTICS_EVERY = 5
"""Number of ~/status messages per message on /diagnostics."""


class OdomNode(Node):  # type: ignore[misc]
    """Wheel odometry as a ROS 2 node.

    InputError if a parameter is missing, unknown or invalid; the message names all of them.
    """

    def __init__(self) -> None:
        super().__init__("odom_node")
        self._settings = odom_parameters.declared(self)
        values, robot, limits = self._settings.values, self._settings.robot, self._settings.limits
        self._changeable = odom_parameters.changeable(self._settings.effects)
        self._frame = str(values["odom_frame_id"])
        self._topics = tuple(map(self.resolve_topic_name, counter_inputs.kind_of(values)[1]))
        self._tracker = LiveOdometer(robot, self._settings.tolerance, limits)
        self._message = OdometryMessage(self._frame, str(values["base_frame_id"]))
        self._trail = PieceTrail(self._frame, robot.track)
        self._health = Health(self.get_logger(), self._topics, limits.gap_duration)
        self._company = Company(self, self._topics)
        self._foreign = 0
        self._viewers = 0
        self._rounds = 0
        self._level = DiagnosticStatus.OK
        self._odometry = publisher(self, Odometry, "odom", 100, overridable=True)
        self._pieces = publisher(self, MarkerArray, "~/pieces", 100)
        self._status = publisher(self, DiagnosticStatus, "~/status", 10)
        self._diagnose = diagnostics_publisher(self)
        self._send_transform = (
            transform_sender(self, "enable_odom_tf") if values["enable_odom_tf"] else None
        )
        wiring = counter_inputs.InputOptions(self, values, self._take, self._health)
        self._learning = learning_of(wiring, robot)
        self._slip = slip_of(wiring, robot)
        self._input = counter_inputs.subscribed(wiring)
        subscribe(
            self, PoseWithCovarianceStamped, "set_pose", self._on_set_pose, qos=QoSProfile(depth=10)
        )
        self.create_service(Trigger, "~/reset", self._on_reset)
        self.add_pre_set_parameters_callback(partial(odom_parameters.with_floats, self._changeable))
        self.add_on_set_parameters_callback(
            lambda changed: odom_parameters.judged(self._changeable, self._settings, changed)
        )
        self.add_post_set_parameters_callback(self._on_parameters_set)
        # The steady clock: /diagnostics must continue when simulated time stands still.
        steady = Clock(clock_type=ClockType.STEADY_TIME)
        self.create_timer(STATUS_PERIOD, self._report, clock=steady)
        self._say_hello()

    # ------------------------------------------------------------------------- readings

    def _take(self, stamp: Stamp, left: float, right: float) -> None:
        """Process a message, from two counters to odometry."""
        try:
            estimate = self._tracker.take(stamp, left, right)
        except InputError as error:
            self._health.refuse(*error.args)
            return
        if estimate is None:
            return
        missed = self._slip.missed(self._tracker)
        odometry = self._message.filled(stamp, estimate, missed)
        self._odometry.publish(odometry)
        self._health.published += 1
        if self._send_transform is not None:
            self._send_transform(self._message.transform())
        self._keep(self._tracker.finished_by(estimate))
        self._learning.after(self._tracker)
        if missed.heading:
            self._keep(self._tracker.grow(missed))

    def _keep(self, finished: Finished | None) -> None:
        """Add a piece to the trail for RViz; without a viewer, nothing is published."""
        if finished is None:
            return
        shown = self._trail.add(self._tracker.stamp, *finished, shown=self._viewers > 0)
        if shown is not None:
            self._pieces.publish(shown)

    # ------------------------------------------------------------------------- requests

    def _on_set_pose(self, message: PoseWithCovarianceStamped) -> None:
        try:
            pose, covariance = pose_from(message, self._frame)
        except InputError as error:
            cause, detail = error.args
            self._health.refuse(cause, detail, OF_POSE)
            return
        self._keep(self._tracker.set_pose(pose, covariance))

    def _on_reset(self, _: Any, response: Any) -> Any:
        self._tracker.reset()
        self._trail.clear()
        self._show_all_pieces()
        response.success = True
        response.message = "pose and distance set to zero, pieces cleared"
        return response

    def _on_parameters_set(self, changed: list[Any]) -> None:
        changes = odom_parameters.changes_of(self._changeable, changed)
        if not changes:
            return
        settings = self._settings = self._settings.after(changes)
        robot, limits = settings.robot, settings.limits
        self._health.silent_after = limits.gap_duration
        self._keep(self._tracker.retune(robot, settings.tolerance, limits))
        self._learning.retune(robot, tuple(changes))
        self._slip.retune(robot)
        self._trail.track = robot.track
        self.get_logger().info(
            "from here on: " + ", ".join(f"{name} {value}" for name, value in changes.items())
        )

    # ------------------------------------------------------------------------- reports

    def _report(self) -> None:
        self._rounds += 1
        learnt = self._learning.news()
        if learnt:
            self.set_parameters([Parameter(name, value=value) for name, value in learnt.items()])
        due = self._rounds % DIAGNOSTICS_EVERY == 0
        self._greet_viewers()
        if self._tracker.started:
            if self._status.get_subscription_count():
                self._publish_status()
            if self._viewers and due:
                self._show_open_piece()
        if due:
            self._publish_diagnostics()

    def _greet_viewers(self) -> None:
        """Publish all pieces when a new viewer subscribes, whatever its QoS."""
        viewers = self._pieces.get_subscription_count()
        if viewers > self._viewers:
            self._show_all_pieces()
        self._viewers = viewers

    def _show_all_pieces(self) -> None:
        self._pieces.publish(self._trail.everything(self._tracker.stamp))

    def _show_open_piece(self) -> None:
        tracker, odometer = self._tracker, self._tracker.odometer
        self._pieces.publish(
            self._trail.unfinished(tracker.stamp, odometer.piece, odometer.covariance())
        )

    def _publish_status(self) -> None:
        self._status.publish(status_of(f"{full_name(self)}: estimate", self._tracker))

    def _publish_diagnostics(self) -> None:
        name = f"{full_name(self)}: wheel encoders"
        effects = status_of_effects(self._settings.effects, self._learning) | self._slip.status()
        # Another driver on the topic may be that of an arm, with other joints.
        wrong = self._company.look(others_welcome=self._health.foreign > self._foreign)
        wrong += [*self._learning.wrong(), *self._slip.wrong()]
        self._foreign = self._health.foreign
        crowded = self._company.crowded
        tally, counts = self._tracker.odometer.tally, self._input.tally()
        status = self._health.report(name, tally, counts, effects, crowded, wrong)
        if status.level != self._level:
            self._level = status.level
            tell(self.get_logger(), status.message, fine=status.level == DiagnosticStatus.OK)
        self._diagnose(status)

    # ------------------------------------------------------------------------- set-up

    def _say_hello(self) -> None:
        log, values = self.get_logger(), self._settings.values
        for words in doubtful_sizes(values):
            log.warning(words)
        for name in odom_parameters.leftover_qos_overrides(self):
            log.warning(f"{name} is not used: there is no such topic or policy")
        if odom_parameters.has_virtual_ticks(values):
            log.info(
                "no ticks_per_revolution: wheel angles are taken as exact to a microradian. Give "
                "left_ and right_ticks_per_revolution where you know them: then quantisation "
                "belongs to the covariance, and a count that flickers is no motion"
            )
        for name, words in status_of_effects(self._settings.effects, self._learning).items():
            log.info(f"{name}: {words}")
        log.info(
            f"{values['input_type']} on {' and '.join(self._topics)}, odometry on "
            f"{self._odometry.topic_name} from {self._frame} to {values['base_frame_id']}"
        )


def main(args: list[str] | None = None) -> int:
    """Run the node until it is stopped; return the exit code."""
    return run(OdomNode, "odom_node", args)


if __name__ == "__main__":
    sys.exit(main())
