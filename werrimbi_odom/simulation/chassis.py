# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The robot's body as MuJoCo's XML, with the contact settings that make wheels roll truly.

Why these settings (measured; the figures are in docs/simulation.md):

- Wheels are spheres: one contact point each, straight below the centre, wherever the body leans.
- The skid is frictionless, so only the wheels decide where the robot goes.
- MuJoCo's contacts are springs that give way. A wheel sinks in by some micrometres; its contact
  acts halfway down: the rolling radius is short by half the penetration.
- Friction removes slip with a time constant of TIME_CONSTANT * IMPEDANCE / 2, as an acceleration
  that leaves out the turning of the contact itself. So in a curve the wheels creep outwards by
  that time, less half a step, times speed times yaw rate. A longer time constant (the default is
  0.02 s) makes that 9 ms instead of 0.45.
- `Euler`, because with `implicitfast` the wheels' angles lead the body by milliseconds of travel
  whenever the motors work.
"""

from __future__ import annotations

from dataclasses import dataclass

from .robot import TrueRobot

STEP = 1e-3
"""Of the integrator [s]."""

TIME_CONSTANT = 2e-3
"""Of the contacts [s]; two steps is the shortest that MuJoCo holds to be stable."""

IMPEDANCE = 0.95
"""Of the contacts, the same at every depth, so that the depth is proportional to the load."""

IMPRATIO = 100
"""How much stiffer friction is than the normal direction: loaded wheels must not creep."""

SKID_BEHIND = 0.16
"""From the axle back to the skid [m]."""

MOTOR_DAMPING = 1.0
"""Torque of the speed controller for an error of speed [N m s/rad]."""

MOTOR_STIFFNESS = 4.0
"""Its integral part: torque for an error of the angle [N m/rad]; no travel is lost for good."""


@dataclass(frozen=True)
class WheelPlan:
    """One wheel: "left" or "right", its hub's `y` from the body's middle [m], its radius [m]."""

    side: str
    y: float
    radius: float


@dataclass(frozen=True)
class Chassis:
    """All that shapes the body in the engine.

    Parameters
    ----------
    left, right : WheelPlan
    mass : float
        Of everything [kg].
    """

    left: WheelPlan
    right: WheelPlan
    mass: float

    @property
    def height(self) -> float:
        """Of the axle above the floor [m]."""
        return (self.left.radius + self.right.radius) / 2


def chassis_of(robot: TrueRobot) -> Chassis:
    """The body of a robot without peculiarities."""
    half = robot.wheel_separation / 2
    return Chassis(
        left=WheelPlan("left", half, robot.left_wheel_radius),
        right=WheelPlan("right", -half, robot.right_wheel_radius),
        mass=robot.mass,
    )


def to_mjcf(chassis: Chassis) -> str:
    """The model for MuJoCo.

    The body stands on three slides and three hinges instead of a free joint: then the yaw is a
    coordinate that counts full turns, and a shift of the floor plan is an addition.
    """
    height = chassis.height
    wheel_mass = 0.03 * chassis.mass
    hull_mass = chassis.mass - 2 * wheel_mass
    skid = 0.02
    wheels = "".join(_wheel(plan, height, wheel_mass) for plan in (chassis.left, chassis.right))
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
            mass="0.001" condim="1" friction="0 0 0" priority="1"/>{wheels}
    </body>
  </worldbody>
  <actuator>
    <velocity name="left_speed" joint="left" kv="{MOTOR_DAMPING}"/>
    <velocity name="right_speed" joint="right" kv="{MOTOR_DAMPING}"/>
    <intvelocity name="left_travel" joint="left" kp="{MOTOR_STIFFNESS}" actrange="-1e9 1e9"/>
    <intvelocity name="right_travel" joint="right" kp="{MOTOR_STIFFNESS}" actrange="-1e9 1e9"/>
  </actuator>
</mujoco>"""


def _wheel(plan: WheelPlan, height: float, mass: float) -> str:
    # Hubs at the height of their own radius keep the body level when the radii differ.
    return f"""
      <body name="{plan.side}" pos="0 {plan.y} {plan.radius - height}">
        <joint name="{plan.side}" type="hinge" axis="0 1 0" armature="0.001"/>
        <geom name="{plan.side}" type="sphere" size="{plan.radius}" mass="{mass}"
              condim="3" friction="1.5 0 0"/>
      </body>"""
