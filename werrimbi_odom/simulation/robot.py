# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The true robot, its nominal parameters, and the robot file that its user would have."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path


@dataclass(frozen=True)
class Nominal:
    """Nominal parameters: those of the robot file and of the robot's own controller."""

    wheel_separation: float = 0.35
    """Distance between the wheels' contact points [m]."""
    wheel_radius: float = 0.05
    """Radius of both wheels [m]."""


@dataclass(frozen=True)
class TrueRobot:
    """True parameters of a differential-drive robot on two spherical wheels and a skid.

    By default they are equal to the nominal ones, and the wheels have no noise.
    """

    wheel_separation: float = 0.35
    """True distance between the contact points, B [m]."""
    left_wheel_radius: float = 0.05
    right_wheel_radius: float = 0.05
    """True rolling radii [m]: one revolution moves the hub by exactly 2 pi times this."""
    left_ticks_per_revolution: float = 2000.0
    right_ticks_per_revolution: float = 2000.0
    """Counts of each encoder per revolution of its wheel."""
    left_wheel_noise: float = 0.0
    right_wheel_noise: float = 0.0
    """k_L, k_R [m^0.5]: over a path of length s the travel of each wheel has a Gaussian error of
    variance k^2 |s|, white along the path and independent between wheels (Chong and Kleeman 1997,
    section 4). Zero for none."""
    counters_keep_zero: bool = False
    """True: counter zero is always at the same wheel angle (absolute encoder). False: counters have
    random start values, as after a real robot is switched on."""
    mass: float = 10.0
    """Total mass [kg]."""
    wheels_a_side: int = 1
    """Number of wheels per side in the robot file: 1 or 2."""
    nominal: Nominal = field(default_factory=Nominal)
    """Parameters of the controller and of the robot file."""

    @property
    def joints(self) -> tuple[list[str], list[str]]:
        """Names of the joints of the left and of the right wheels, as in the robot file."""
        places = [""] if self.wheels_a_side == 1 else ["front_", "rear_"]
        left, right = ([f"{at}{side}_wheel_joint" for at in places] for side in ("left", "right"))
        return left, right


_TEMPLATE = """\
# The robot as its maker believes it to be. The node and the command line read this same file:
#   odom_node --ros-args --params-file robot.yaml
#   werrimbi odom --robot robot.yaml RUN --out odom.csv
odom_node:
  ros__parameters:
    wheel_separation: {wheel_separation:<17} # m, between the wheels' contact points
    wheel_radius: {wheel_radius:<21} # m
    wheel_separation_multiplier: 1.0    # calibration of the base; 1: as measured with the ruler
    left_wheel_radius_multiplier: 1.0   # calibration of the left wheel
    right_wheel_radius_multiplier: 1.0  # calibration of the right wheel
    left_ticks_per_revolution: {left_ticks_per_revolution:<8} # counts in one turn of the wheel
    right_ticks_per_revolution: {right_ticks_per_revolution}
    encoder_bits: 0                     # the counters do not wrap
    left_wheel_noise: {left_wheel_noise:<17} # k_L, m^0.5: a wheel errs by k * sqrt(path)
    right_wheel_noise: {right_wheel_noise:<16} # k_R
    odom_frame_id: odom
    base_frame_id: base_link
    enable_odom_tf: false               # true where no filter (EKF) publishes odom -> base_link
    input_type: joint_state             # wheel angles in radians on joint_states
    left_wheel_names: [{left_wheel_names}]
    right_wheel_names: [{right_wheel_names}]
"""


def write_robot_file(robot: TrueRobot, path: str | Path) -> Path:
    """Write the nominal parameters of `robot` and its noise, without its true geometry.

    Returns the YAML file; its folder must exist.
    """
    path = Path(path)
    text = _TEMPLATE.format(
        wheel_separation=_real(robot.nominal.wheel_separation),
        wheel_radius=_real(robot.nominal.wheel_radius),
        left_ticks_per_revolution=_real(robot.left_ticks_per_revolution),
        right_ticks_per_revolution=_real(robot.right_ticks_per_revolution),
        left_wheel_noise=_real(robot.left_wheel_noise),
        right_wheel_noise=_real(robot.right_wheel_noise),
        left_wheel_names=", ".join(robot.joints[0]),
        right_wheel_names=", ".join(robot.joints[1]),
    )
    path.write_text(text, encoding="utf-8")
    return path


def _real(value: float) -> str:
    """Digits that every YAML reader takes for a float: with a point, also before an exponent."""
    digits = repr(float(value))
    return digits if "." in digits else digits.replace("e", ".0e")
