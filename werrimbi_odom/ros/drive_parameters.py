# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of drive_node."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from werrimbi_odom.driving.limits import Area, Limits, Watch
from werrimbi_odom.driving.manoeuvres import NAMES, plan_of, proposed
from werrimbi_odom.driving.plan import ManoeuvrePlan
from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter, Value
from werrimbi_odom.ros.declared_parameters import above_zero, table, within

FASTEST = 5.0
"""Upper limit of all speeds [m/s], [rad/s]."""


def _length(name: str, says: str) -> NodeParameter:
    return NodeParameter(name, 0.0, says, unit="m", minimum=0.0, maximum=1000.0)


# fmt: off
PARAMETERS: tuple[NodeParameter, ...] = (
    NodeParameter("manoeuvre", "square", "What to drive.", choices=NAMES),
    NodeParameter("diagnosis", "",
        "File of `werrimbi diagnose --json`: drive what it proposes, in place of `manoeuvre`."),
    above_zero("size", 1.0, "m", 100.0,
        "Size of the manoeuvres that `diagnose` proposes: a square has sides of twice this. 1 "
        "suits wheels 35 cm apart."),
    _length("length", "Side of UMBmark's squares, way of `paper_out_and_back`; 0: 4 m, and 10 m."),
    NodeParameter("repetitions", 1, "How often to drive it in one go.", minimum=1, maximum=1000),
    above_zero("max_vel_x", 0.3, "m/s", FASTEST, "Fastest command."),
    above_zero("max_vel_theta", 1.0, "rad/s", FASTEST, "Fastest turn."),
    above_zero("acc_lim_x", 0.5, "m/s^2", FASTEST,
        "Hardest change of the speed; a stop is a zero at once."),
    above_zero("acc_lim_theta", 1.5, "rad/s^2", 4.0 * FASTEST,
        "Hardest change of the rate of turning."),
    _length("area_radius", "The robot stays within this of its first start; 0: not given."),
    _length("area_ahead", "Or within a rectangle: this far ahead of its first start,"),
    _length("area_behind", "behind it,"),
    _length("area_left", "to its left,"),
    _length("area_right", "and to its right. Of a rectangle all four must be given."),
    above_zero("robot_radius", 0.3, "m", 100.0,
        "Of the circle about the middle of the axle that holds all of the robot."),
    NodeParameter("dry_run", False, "`~/start` checks all and shows the path, and moves nothing."),
    NodeParameter("use_stamped_vel", False,
        "Publish geometry_msgs/TwistStamped on `cmd_vel`, else Twist."),
    within("odom_timeout", 0.15, "s", 0.02, 2.0,
        "Stop when the odometry is silent for so long, or comes so much later than before."),
    above_zero("max_deviation", 0.15, "m", 2.0,
        "Stop when the robot is so far from where it should be by now."),
    NodeParameter("scan_topic", "", "A sensor_msgs/LaserScan that stops the robot; empty: none."),
    above_zero("scan_min_distance", 0.5, "m", 100.0,
        "Stop when the scan sees something nearer to the scanner."),
    NodeParameter("imu_topic", "",
        "A sensor_msgs/Imu (not upside down) whose turn rate stops the robot when its wheels slip; "
        "empty: none."),
    above_zero("max_slip", 0.06, "rad", 3.0,
        "Stop when turns of the wheels and of the gyro differ by so much within 0.2 s."),
    NodeParameter("record", "",
        "Folder in which each drive is recorded as a rosbag2 (MCAP; needs rosbags); empty: none."),
    NodeParameter("record_topics",
        ("joint_states", "odom", "imu", "reference", "scan", "/tf", "/tf_static"),
        "What is recorded, of it what there is."),
    NodeParameter("robot_file", "",
        "Robot file, for the command that is told at the end; nothing is read from it."),
)
# fmt: on


def limits_of(values: Mapping[str, Value]) -> Limits:
    """Limits of speed and acceleration."""
    names = ("max_vel_x", "max_vel_theta", "acc_lim_x", "acc_lim_theta")
    return Limits(*(_number(values, name) for name in names))


def area_of(values: Mapping[str, Value]) -> Area:
    """Area in which the robot must stay.

    InputError if no area is given, or not all sides of a rectangle.
    """
    sides = {name: _number(values, f"area_{name}") for name in ("ahead", "behind", "left", "right")}
    radius = _number(values, "area_radius")
    missing = [f"area_{name}" for name, value in sides.items() if not value]
    if len(missing) == 4 and not radius:
        raise InputError(
            "no area is given in which the robot may move: give area_radius, or area_ahead, "
            "area_behind, area_left and area_right [m], measured from where it stands"
        )
    if 0 < len(missing) < 4:
        raise InputError(f"{', '.join(missing)} must be given too, with the other sides [m]")
    if len(missing) == 4:
        sides = {}
    return Area(**sides, radius=radius or math.inf, robot_radius=_number(values, "robot_radius"))


def watch_of(values: Mapping[str, Value]) -> Watch:
    """Conditions that stop the robot."""
    return Watch(
        odom_timeout=_number(values, "odom_timeout"),
        deviation=_number(values, "max_deviation"),
        scan_min_distance=_number(values, "scan_min_distance") if values["scan_topic"] else 0.0,
        slip=_number(values, "max_slip") if values["imu_topic"] else 0.0,
    )


def chosen_plan(values: Mapping[str, Value]) -> ManoeuvrePlan:
    """Manoeuvre to drive; InputError if the diagnosis file is not usable."""
    size = _number(values, "size")
    if values["diagnosis"]:
        return proposed(Path(str(values["diagnosis"])), limits_of(values), size=size)
    return plan_of(
        str(values["manoeuvre"]),
        size=size,
        length=_number(values, "length"),
        repetitions=int(_number(values, "repetitions")),
    )


def _number(values: Mapping[str, Value], name: str) -> float:
    return float(values[name])  # type: ignore[arg-type]


if __name__ == "__main__":
    print(table(PARAMETERS), end="")
