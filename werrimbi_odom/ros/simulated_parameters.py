# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of simulated_robot."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.robot_files.node_parameter import NodeParameter
from werrimbi_odom.ros.declared_parameters import above_zero, table, within

if TYPE_CHECKING:
    from werrimbi_odom.simulation import Hidden, LiveRobot, TrueRobot

# fmt: off
PARAMETERS: tuple[NodeParameter, ...] = (
    NodeParameter("hide", "",
        "Effect to hide in the robot, `EFFECT` or `EFFECT=STRENGTH` as for `werrimbi simulate "
        "--hide` (`werrimbi simulate --list`); several with commas; `random` takes any; `none`."),
    NodeParameter("seed", 1,
        "Of all that is random: noises, wheel angles, counters, the gyro, what `hide` leaves open.",
        minimum=0, maximum=2**31),
    NodeParameter("real_time_factor", 1.0,
        "Simulated seconds in a second. Other than 1: with `publish_clock`, and `use_sim_time` for "
        "all other nodes.", above=0.0, maximum=20.0),
    NodeParameter("publish_clock", False,
        "Publish simulated time on /clock, and stamp with it; else stamps are the time of day."),
    NodeParameter("use_stamped_vel", False,
        "Take geometry_msgs/TwistStamped on `cmd_vel`, else Twist."),
    above_zero("cmd_vel_timeout", 0.5, "s", 10.0,
        "The robot stops when no command has come for so long."),
    above_zero("joint_states_rate", 50.0, "Hz", 200.0, "Messages a second on `joint_states`."),
    above_zero("imu_rate", 100.0, "Hz", 200.0, "The same on `imu`."),
    above_zero("reference_rate", 20.0, "Hz", 200.0, "The same on `reference`."),
    within("reference_sigma_xy", 0.001, "m", 0.0, 10.0,
        "Noise of the reference: standard deviation of x and of y."),
    within("reference_sigma_yaw", 0.002, "rad", 0.0, 1.0, "The same of its heading."),
    NodeParameter("room", "none",
        "What a lidar sees and publishes on `scan`, with walls that the robot drives through; the "
        "robot begins in the middle.", choices=("none", "living_room", "arena")),
    NodeParameter("enable_tf", False,
        "Broadcast world -> odom (where the robot began), world -> base_link_true (the truth) and "
        "base_link -> base_scan (the lidar's place) on /tf; needs tf2_ros."),
    NodeParameter("robot_file", "",
        "New file to write: the robot as its maker believes it to be, for odom_node."),
)
# fmt: on


def robot_of(values: Mapping[str, Any]) -> tuple[LiveRobot, list[Hidden], TrueRobot]:
    """The simulated robot, its hidden effects, and the nominal robot.

    InputError if the effect to hide is unknown, or mujoco is not installed.
    """
    try:
        from werrimbi_odom import simulation
        from werrimbi_odom.simulation import rooms
    except ModuleNotFoundError as missing:
        if (missing.name or "").startswith("werrimbi_odom"):
            raise
        raise InputError(
            f"the physics engine is not installed ({missing.name} is missing): "
            "pip install mujoco rosbags, or pip install 'werrimbi_odom[simulation]'"
        ) from missing
    seed = int(values["seed"])
    wishes = [
        wish.strip() for wish in str(values["hide"]).split(",") if wish.strip() not in ("", "none")
    ]
    try:
        hidden = simulation.wished(wishes, seed=seed)
    except simulation.WishError as error:
        raise InputError(f"hide: {error} (all: werrimbi simulate --list)") from error
    robot = simulation.TrueRobot(left_wheel_noise=4.0e-4, right_wheel_noise=5.8e-4)
    believed = robot
    for each in hidden:
        believed = each.peculiarity.written(believed)
    reference = simulation.ReferenceSensor(
        sigma_xy=float(values["reference_sigma_xy"]), sigma_yaw=float(values["reference_sigma_yaw"])
    )
    try:
        live = simulation.LiveRobot(
            robot,
            seed=seed,
            reference=reference,
            hidden=[each.peculiarity for each in hidden],
            room=None if values["room"] == "none" else getattr(rooms, str(values["room"]))(),
        )
    except (simulation.UnstableError, ValueError) as error:
        raise InputError(f"no such robot can be built: {str(error).splitlines()[0]}") from error
    return live, hidden, believed


def write_believed(robot: TrueRobot, path: Path) -> None:
    """Write the nominal robot file; InputError if the file exists, or cannot be written."""
    from werrimbi_odom.simulation import write_robot_file

    if path.exists():
        raise InputError(f"robot_file: {path} is there already; name a new one")
    try:
        write_robot_file(robot, path)
    except OSError as error:
        raise InputError(f"robot_file: {path} cannot be written: {error.strerror}") from error


if __name__ == "__main__":
    print(table(PARAMETERS), end="")
