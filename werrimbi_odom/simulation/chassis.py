# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot's body in MJCF (MuJoCo's XML), with contact settings that make wheels roll accurately.

Reasons for the settings (measured; the figures are in docs/simulation.md):

- Wheels are spheres: one contact point each, vertically below the centre at any tilt of the body.
- The skid has no friction, so only the wheels determine the motion.
- Wheels and skid touch the floor alone (`conaffinity`): spheres larger than half the base overlap.
- MuJoCo's contacts are springs. A wheel penetrates the floor by a few micrometres, and its contact
  acts at half of this depth, so the rolling radius is short by half the penetration.
- Friction removes slip with a time constant of TIME_CONSTANT * IMPEDANCE / 2, as an acceleration
  that leaves out the rotation of the contact frame. In a curve the wheels therefore creep outwards
  by this time, less half a step, times speed times yaw rate. A longer time constant (the default is
  0.02 s) makes that 9 ms instead of 0.45.
- The integrator is `Euler`: with `implicitfast` the wheels' angles lead the body by milliseconds of
  travel while the motors exert torque.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .robot import TrueRobot

STEP = 1e-3
"""Time step of the integrator [s]."""

TIME_CONSTANT = 2e-3
"""Time constant of contacts [s]: two steps, the shortest that MuJoCo treats as stable."""

IMPEDANCE = 0.95
"""Impedance of contacts, constant over depth so that depth is proportional to load."""

IMPRATIO = 100
"""Ratio of frictional to normal impedance; high, so that loaded wheels do not creep."""

SKID_BEHIND = 0.16
"""Distance from the axle back to the skid [m]."""

MOTOR_DAMPING = 5.0
"""Proportional gain of the speed controller [N m s/rad]."""

MOTOR_STIFFNESS = 50.0
"""Integral gain of the speed controller [N m/rad]; it removes lasting errors of the wheel angle."""

ROTOR = 0.01
"""Inertia of a motor reflected through the gear to its wheel [kg m^2].

With less, the speed controller is too fast for the integrator's step when a wheel leaves the floor,
and the simulation becomes unstable.
"""

BEARING_DRAG = 0.5
"""Friction torque of a wheel with play [N m]; with less, the robot coasts through the play."""


STOP_TIME_CONSTANT = 0.01
"""Time constant of the stops of a wheel's play [s]; with harder stops the rotor's impact makes the
wheel lose its grip."""


@dataclass(frozen=True)
class WheelPlan:
    """Parameters of one wheel."""

    side: str
    """"left" or "right"."""
    y: float
    """Position of its hub along the axle from the middle of the body, left positive [m]."""
    radius: float
    """Rolling radius [m]."""
    offset: float = 0.0
    """Distance of the wheel's centre from its axle [m]; not zero for an eccentric wheel."""
    phase: float = 0.0
    """Angle of the wheel [rad] at which its centre is straight ahead of its axle."""
    ovality: float = 0.0
    """(largest - smallest radius) / (2 radius); the wheel is an ellipsoid."""
    play: float = 0.0
    """Backlash between the encoder's shaft and the wheel [rad]."""


@dataclass(frozen=True)
class Chassis:
    """Parameters of the body in the engine."""

    left: WheelPlan
    right: WheelPlan
    mass: float
    """Total mass [kg]."""
    axle_yaw: float = 0.0
    """Rotation of the axle relative to the body, anticlockwise [rad]."""

    @property
    def height(self) -> float:
        """Height of the axle above the floor [m]."""
        return (self.left.radius + self.right.radius) / 2

    @property
    def wheels(self) -> tuple[WheelPlan, WheelPlan]:
        """Left and right wheel."""
        return self.left, self.right

    @property
    def giving(self) -> WheelPlan | None:
        """The wheel with lateral compliance: one that is not round, if any.

        The contact of such a wheel moves ahead of and behind its axle. Two rigid wheels with
        contacts off the axle's line cannot both roll while the robot turns: one of them slides, and
        then loses its longitudinal grip too. Real tyres deflect laterally by a little in each turn.
        Here this wheel moves laterally without resistance (the engine resets it after every
        period), and the other one holds the robot laterally.
        """
        return next((wheel for wheel in self.wheels if wheel.offset or wheel.ovality), None)


def chassis_of(robot: TrueRobot) -> Chassis:
    """The chassis of a robot without peculiarities."""
    half = robot.wheel_separation / 2
    return Chassis(
        left=WheelPlan("left", half, robot.left_wheel_radius),
        right=WheelPlan("right", -half, robot.right_wheel_radius),
        mass=robot.mass,
    )


def to_mjcf(chassis: Chassis) -> str:
    """The chassis as MJCF.

    The body has three slide and three hinge joints instead of a free joint, so that the yaw is one
    coordinate that counts full turns, and a shift on the floor is an addition.
    """
    height = chassis.height
    wheel_mass = 0.03 * chassis.mass
    hull_mass = chassis.mass - 2 * wheel_mass
    skid = 0.02
    left, right = (
        _wheel(wheel, height, wheel_mass, gives=wheel is chassis.giving) for wheel in chassis.wheels
    )
    return f"""
<mujoco>
  <option timestep="{STEP}" integrator="Euler" cone="elliptic" impratio="{IMPRATIO}"/>
  <default>
    <geom solref="{TIME_CONSTANT} 1" solimp="{IMPEDANCE} {IMPEDANCE} 0.001"/>
  </default>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 1" condim="3" friction="1.5 0 0"/>
    <body name="body" pos="0 0 {height}">
      <joint name="x" type="slide" axis="1 0 0"/>
      <joint name="y" type="slide" axis="0 1 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <joint name="yaw" type="hinge" axis="0 0 1"/>
      <joint name="pitch" type="hinge" axis="0 1 0"/>
      <joint name="roll" type="hinge" axis="1 0 0"/>
      <geom name="hull" type="box" size="0.15 0.1 0.02" pos="-0.04 0 0" mass="{hull_mass}"
            contype="0" conaffinity="0"/>
      <geom name="skid" type="sphere" size="{skid}" pos="{-SKID_BEHIND} 0 {skid - height}"
            mass="0.001" condim="1" friction="0 0 0" priority="1" conaffinity="0"/>
      <body name="axle" euler="0 0 {math.degrees(chassis.axle_yaw)}">
        {left}{right}
      </body>
    </body>
  </worldbody>
  <tendon>{"".join(_play(wheel) for wheel in chassis.wheels if wheel.play)}
  </tendon>
  <actuator>{"".join(_motor(wheel) for wheel in chassis.wheels)}
  </actuator>
</mujoco>"""


def shaft_joint(plan: WheelPlan) -> str:
    """Name of the joint that the motor drives and the encoder reads."""
    return f"{plan.side}_shaft" if plan.play else plan.side


def _wheel(plan: WheelPlan, height: float, mass: float, *, gives: bool) -> str:
    # Hubs at the height of their own radius keep the body level if the radii differ.
    hub = f"0 {plan.y} {plan.radius - height}"
    ahead, up = plan.offset * math.cos(plan.phase), plan.offset * math.sin(plan.phase)
    if plan.ovality:
        long, short = plan.radius * (1 + plan.ovality), plan.radius * (1 - plan.ovality)
        shape = f'type="ellipsoid" size="{long} {plan.radius} {short}"'
    else:
        shape = f'type="sphere" size="{plan.radius}"'
    give = (
        f'''
          <joint name="{plan.side}_give" type="slide" axis="0 1 0" damping="1"/>'''
        if gives
        else ""
    )
    rotor = 0.001 if plan.play else ROTOR  # with play, the shaft carries the motor's inertia
    drag = f'frictionloss="{BEARING_DRAG}"' if plan.play else ""
    body = f"""
        <body name="{plan.side}" pos="{hub}">{give}
          <joint name="{plan.side}" type="hinge" axis="0 1 0" armature="{rotor}" {drag}/>
          <geom name="{plan.side}" {shape} pos="{ahead} 0 {up}" mass="{mass}"
                condim="3" friction="1.5 0 0" conaffinity="0"/>
        </body>"""
    if plan.play:
        body += f"""
        <body name="{plan.side}_shaft" pos="{hub}">
          <joint name="{plan.side}_shaft" type="hinge" axis="0 1 0" armature="{ROTOR}"/>
          <inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/>
        </body>"""
    return body


def _play(plan: WheelPlan) -> str:
    """Backlash: shaft and wheel turn freely relative to each other between two stops."""
    return f"""
    <fixed name="{plan.side}_play" limited="true" range="{-plan.play / 2} {plan.play / 2}"
           solreflimit="{STOP_TIME_CONSTANT} 1" solimplimit="{IMPEDANCE} {IMPEDANCE} 0.001">
      <joint joint="{plan.side}" coef="1"/>
      <joint joint="{plan.side}_shaft" coef="-1"/>
    </fixed>"""


def _motor(plan: WheelPlan) -> str:
    joint = shaft_joint(plan)
    return f"""
    <velocity name="{plan.side}_speed" joint="{joint}" kv="{MOTOR_DAMPING}"/>
    <intvelocity name="{plan.side}_travel" joint="{joint}" kp="{MOTOR_STIFFNESS}"
                 actrange="-1e9 1e9"/>"""
