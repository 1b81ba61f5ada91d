# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Parameters of simulated_robot, declared once."""

from __future__ import annotations

from werrimbi_odom.files.parameters import Parameter
from werrimbi_odom.ros.declaring import table

PARAMETERS: tuple[Parameter, ...] = (
    Parameter(
        "hide",
        "string",
        "",
        "",
        "Effect to hide in the robot, `EFFECT` or `EFFECT=STRENGTH` as for `werrimbi simulate "
        "--hide` (`werrimbi simulate --list`); several with commas; `random` takes any; `none`.",
        may_be_empty=True,
    ),
    Parameter(
        "seed",
        "integer",
        1,
        "",
        "Of all that is random: noises, wheel angles, counters, the gyro, what `hide` leaves open.",
        minimum=0,
        maximum=2**31,
    ),
    Parameter(
        "real_time_factor",
        "float",
        1.0,
        "",
        "Simulated seconds in a second. Other than 1: with `publish_clock`, and `use_sim_time` for "
        "all other nodes.",
        above=0.0,
        maximum=20.0,
    ),
    Parameter(
        "publish_clock",
        "boolean",
        False,
        "",
        "Publish simulated time on /clock, and stamp with it; else stamps are the time of day.",
    ),
    Parameter(
        "use_stamped_vel",
        "boolean",
        False,
        "",
        "Take geometry_msgs/TwistStamped on `cmd_vel`, else Twist.",
    ),
    Parameter(
        "cmd_vel_timeout",
        "float",
        0.5,
        "s",
        "The robot stops when no command has come for so long.",
        above=0.0,
        maximum=10.0,
    ),
    Parameter(
        "joint_states_rate",
        "float",
        50.0,
        "Hz",
        "Messages a second on `joint_states`.",
        above=0.0,
        maximum=200.0,
    ),
    Parameter("imu_rate", "float", 100.0, "Hz", "The same on `imu`.", above=0.0, maximum=200.0),
    Parameter(
        "reference_rate",
        "float",
        20.0,
        "Hz",
        "The same on `reference`.",
        above=0.0,
        maximum=200.0,
    ),
    Parameter(
        "reference_sigma_xy",
        "float",
        0.001,
        "m",
        "Noise of the reference: standard deviation of x and of y.",
        minimum=0.0,
        maximum=10.0,
    ),
    Parameter(
        "reference_sigma_yaw",
        "float",
        0.002,
        "rad",
        "The same of its heading.",
        minimum=0.0,
        maximum=1.0,
    ),
    Parameter(
        "enable_tf",
        "boolean",
        False,
        "",
        "Broadcast world -> odom (where the robot began) and world -> base_link_true (the truth) "
        "on /tf; needs tf2_ros.",
    ),
    Parameter(
        "robot_file",
        "string",
        "",
        "",
        "New file to write: the robot as its maker believes it to be, for odom_node.",
        may_be_empty=True,
    ),
)

if __name__ == "__main__":
    print(table(PARAMETERS), end="")
