# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Odometry against a reference, live: the error, and whether the covariance is consistent with it.

    ros2 run werrimbi_odom compare_node --ros-args -r reference:=/vrpn/robot/pose

`CompareNode._compare` processes a reference pose; everything else is set-up and reporting.
"""

from __future__ import annotations

import math
import sys
from collections import Counter, deque
from functools import partial
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseWithCovarianceStamped, Vector3Stamped
from nav_msgs.msg import Odometry
from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from std_msgs.msg import Float64

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.covariance import PoseCovariance
from werrimbi_odom.ros import compare_parameters
from werrimbi_odom.ros.compare_inputs import (
    REFERENCE_TYPES,
    Clockwork,
    odometry_of,
    reference_reader,
)
from werrimbi_odom.ros.compare_legs import Both, LegCutter, LegError, Window
from werrimbi_odom.ros.compare_motion import Motion
from werrimbi_odom.ros.compare_track import OdometryTrack, TimedPose
from werrimbi_odom.ros.declared_parameters import declared
from werrimbi_odom.ros.diagnostics import diagnostic, diagnostics_publisher, tell
from werrimbi_odom.ros.live_diagnosis import watching_of
from werrimbi_odom.ros.run_node import run
from werrimbi_odom.ros.topics import Company, full_name, publisher, subscribe

WAITING = 1_000
"""Largest number of reference poses that wait for odometry."""
SILENT = 2.0
"""Time without a message after which a topic counts as silent [s]."""
PERIOD = 1.0
"""Period of /diagnostics [s]."""


class CompareNode(Node):  # type: ignore[misc]
    """Compares `odom` with `reference`, leg by leg.

    InputError if a parameter or a QoS override is invalid.
    """

    def __init__(self) -> None:
        super().__init__("compare_node")
        values = declared(self, compare_parameters.PARAMETERS)
        sigmas = (values["reference_sigma_xy"], values["reference_sigma_yaw"])
        xy, yaw = (float(sigma) ** 2 for sigma in sigmas)  # type: ignore[arg-type]
        kind = str(values["reference_type"])
        self._read = reference_reader(kind, PoseCovariance(xy, 0.0, 0.0, xy, 0.0, yaw))
        self._clockwork = Clockwork()
        self._track = OdometryTrack()
        self._cutter = LegCutter(float(values["leg"]))  # type: ignore[arg-type]
        self._window = Window(int(values["window"]))  # type: ignore[arg-type]
        self._motion = Motion()
        self._waiting: deque[TimedPose] = deque()
        self._base_frame = ""
        self._counts: Counter[str] = Counter()
        self._told: set[str] = set()
        self._heard = {"odom": -math.inf, "reference": -math.inf}
        self._latest = math.nan
        self._compared_at = -math.inf
        self._counts_before: Counter[str] = Counter()
        self._level = DiagnosticStatus.OK
        self._moved_well = True
        self._steady = Clock(clock_type=ClockType.STEADY_TIME)
        self._error = publisher(self, Vector3Stamped, "~/error")
        self._pose = publisher(self, PoseWithCovarianceStamped, "~/error_with_covariance")
        self._leg_nees, self._nees, self._low, self._high, self._coverage = (
            publisher(self, Float64, f"~/{name}")
            for name in ("leg_nees", "nees", "nees_low", "nees_high", "coverage")
        )
        self._diagnose = diagnostics_publisher(self)
        listen = partial(subscribe, self, overridable=True)
        listen(Odometry, "odom", self._on_odometry)
        listen(REFERENCE_TYPES[kind], "reference", self._on_reference)
        self._watching = watching_of(self, values, REFERENCE_TYPES[kind], listen)
        self.create_timer(PERIOD, self._report, clock=self._steady)
        topics = tuple(self.resolve_topic_name(name) for name in self._heard)
        self._company = Company(self, topics)
        self.get_logger().info(
            f"{topics[0]} against {kind} on {topics[1]}, legs of {values['leg']} m"
        )

    # ------------------------------------------------------------------------- messages

    def _on_odometry(self, message: Any) -> None:
        self._hear("odom")
        try:
            reading, twist = odometry_of(message, self._clockwork)
        except InputError as error:
            self._refuse("odom", *error.args)
            return
        self._base_frame = message.child_frame_id
        self._watching.odometry(reading.time, twist)
        happened = self._track.add(reading, twist)
        self._counts["old odometry" if happened == "old" else "odometry taken"] += 1
        if happened in ("set", "back"):
            self._counts["poses set" if happened == "set" else "clock jumps"] += 1
            self._cutter.restart()
            self._motion.restart()
        if happened == "back":
            self._forget_waiting()
        while self._waiting and self._waiting[0].time <= self._track.newest:
            self._compare(self._waiting.popleft())

    def _on_reference(self, message: Any) -> None:
        self._hear("reference")
        try:
            reading = self._read(message, self._clockwork)
        except InputError as error:
            self._refuse("reference", *error.args)
            return
        if math.isfinite(self._latest) and reading.time <= self._latest:
            if reading.time > self._latest - 1.0:
                self._counts["old references"] += 1
                return
            self._forget_waiting()  # its clock was set back
            self._cutter.restart()
            self._motion.restart()
        self._latest = reading.time
        self._watching.reference(message)
        if reading.time <= self._track.newest:
            self._compare(reading)
            return
        self._waiting.append(reading)
        if len(self._waiting) > WAITING:
            self._waiting.popleft()
            self._counts["without odometry"] += 1

    def _compare(self, reference: TimedPose) -> None:
        """Process a reference pose: odometry at its instant, then motion, leg and window."""
        odometry = self._track.at(reference.time)
        if odometry is None:
            self._counts["without odometry"] += 1
            return
        self._counts["compared"] += 1
        self._compared_at = self._now()
        both = Both(odometry, reference)
        self._motion.take(both)
        leg, ends = self._cutter.take(both)
        if leg is None:
            return
        self._publish_error(leg)
        if ends:
            self._window.take(leg.deviation, leg.grows)
            self._publish_statistics(leg)

    def _forget_waiting(self) -> None:
        self._counts["without odometry"] += len(self._waiting)
        self._waiting.clear()

    # ------------------------------------------------------------------------- publications

    def _publish_error(self, leg: LegError) -> None:
        x, y, yaw = leg.error.tolist()
        error, pose = Vector3Stamped(), PoseWithCovarianceStamped()
        error.header.stamp = self._clockwork.stamp(leg.time)
        error.header.frame_id = self._base_frame
        error.vector.x, error.vector.y, error.vector.z = x, y, yaw
        self._error.publish(error)
        if not self._pose.get_subscription_count():
            return
        pose.header = error.header
        place, turn = pose.pose.pose.position, pose.pose.pose.orientation
        place.x, place.y = x, y
        turn.z, turn.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)
        covariance = pose.pose.covariance.reshape(6, 6)
        for row, entries in zip((0, 1, 5), leg.covariance, strict=True):
            covariance[row, [0, 1, 5]] = entries
        self._pose.publish(pose)

    def _publish_statistics(self, leg: LegError) -> None:
        window = self._window
        if not leg.grows:
            return
        low, high = window.bounds()
        self._leg_nees.publish(Float64(data=leg.deviation / 3.0))
        self._nees.publish(Float64(data=window.nees))
        self._low.publish(Float64(data=low))
        self._high.publish(Float64(data=high))
        self._coverage.publish(Float64(data=window.coverage))

    def _report(self) -> None:
        level, words = self._verdict()
        if level != self._level:
            self._level = level
            tell(self.get_logger(), words, fine=level == DiagnosticStatus.OK)
        window = self._window
        low, high = window.bounds()
        told = {
            "legs": window.count,
            "NEES": f"{window.nees:.3f}",
            "NEES low": f"{low:.3f}",
            "NEES high": f"{high:.3f}",
            "coverage": f"{window.coverage:.3f}",
            **self._counts,
            "waiting": len(self._waiting),
        }
        name = f"{full_name(self)}: honesty of the covariance"
        status = diagnostic(level, name, words, told)
        self._diagnose(status, self._motion_status(), *self._watching.look())

    def _motion_status(self) -> DiagnosticStatus:
        fine, words = self._motion.status()
        if fine != self._moved_well:
            self._moved_well = fine
            tell(self.get_logger(), words, fine=fine)
        level = DiagnosticStatus.OK if fine else DiagnosticStatus.WARN
        name = f"{full_name(self)}: wheels and reference"
        return diagnostic(level, name, words, {"state": self._motion.state})

    def _verdict(self) -> tuple[bytes, str]:
        """Level and message of the comparison, unless other publishers make it meaningless."""
        level, words = self._verdict_on_messages()
        wrong = self._company.look()
        if wrong and level == DiagnosticStatus.OK:
            level = DiagnosticStatus.WARN
        return level, "; ".join([words, *wrong])

    def _verdict_on_messages(self) -> tuple[bytes, str]:
        now = self._now()
        before = f"; before, {self._window.verdict()[1]}" if self._window.count else ""
        new = self._counts - self._counts_before
        self._counts_before = Counter(self._counts)
        silent = [name for name, at in self._heard.items() if now - at > SILENT]
        if silent:
            topics = " and ".join(self.resolve_topic_name(name) for name in silent)
            return DiagnosticStatus.STALE, f"nothing to compare: {topics} silent{before}"
        if min(self._heard.values()) - self._compared_at > SILENT:  # disjoint stamps
            apart = self._latest - self._track.newest
            if not math.isfinite(apart):  # of one of both no message was ever taken
                new = self._counts
            refused = ", ".join(f"{key} ({n})" for key, n in new.items() if " refused: " in key)
            if refused:
                return DiagnosticStatus.ERROR, f"nothing to compare: {refused}{before}"
            return DiagnosticStatus.WARN, (
                "no stamp of the reference falls between two of the odometry; its last is "
                f"{apart:+.1f} s from the odometry's: are both on one clock (use_sim_time)?{before}"
            )
        honest, words = self._window.verdict()
        return DiagnosticStatus.OK if honest else DiagnosticStatus.WARN, words

    # ------------------------------------------------------------------------- set-up

    def destroy_node(self) -> None:
        """End the node and its diagnosis process."""
        self._watching.close()
        super().destroy_node()

    def _hear(self, topic: str) -> None:
        self._heard[topic] = self._now()

    def _now(self) -> float:
        return 1e-9 * float(self._steady.now().nanoseconds)

    def _refuse(self, topic: str, cause: str, detail: str) -> None:
        key = f"{topic} refused: {cause}"
        if key not in self._told:
            self._told.add(key)
            self.get_logger().warning(f"{key}: {detail} (from now on only counted on /diagnostics)")
        self._counts[key] += 1


def main(args: list[str] | None = None) -> int:
    """Run the node until it is stopped; return the exit code."""
    return run(CompareNode, "compare_node", args)


if __name__ == "__main__":
    sys.exit(main())
