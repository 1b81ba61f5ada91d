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

import math
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

MOTOR_DAMPING = 5.0
"""Torque of the speed controller for an error of speed [N m s/rad]."""

MOTOR_STIFFNESS = 50.0
"""Its integral part: torque for an error of the angle [N m/rad]; no travel is lost for good."""

ROTOR = 0.01
"""Inertia of a motor as its wheel feels it through the gear [kg m^2].

With less, the speed controller's torque would outrun a step of the integrator on a wheel that
hops off the floor, and the simulation explode.
"""

BEARING_DRAG = 0.5
"""Torque that brakes a wheel with play [N m]: less, and the robot coasts through the play."""


STOP_TIME_CONSTANT = 0.01
"""Of the stops of a wheel's play [s]; harder ones let the rotor's impact tear the wheel loose."""


@dataclass(frozen=True)
class WheelPlan:
    """One wheel.

    Parameters
    ----------
    side : str
        "left" or "right".
    y : float
        Of its hub along the axle from the body's middle, left positive [m].
    radius : float
        Rolling radius [m].
    offset : float
        From the axle to the wheel's centre [m]; not zero: an eccentric wheel.
    phase : float
        Angle of the wheel [rad] at which its centre is straight ahead of the axle.
    ovality : float
        (largest - smallest radius) / (2 radius); the wheel is an ellipsoid.
    play : float
        Free angle between the encoder's shaft and the wheel [rad].
    """

    side: str
    y: float
    radius: float
    offset: float = 0.0
    phase: float = 0.0
    ovality: float = 0.0
    play: float = 0.0


@dataclass(frozen=True)
class Chassis:
    """All that shapes the body in the engine.

    Parameters
    ----------
    left, right : WheelPlan
    mass : float
        Of everything [kg].
    axle_yaw : float
        How far the axle is turned against the body, anticlockwise [rad].
    """

    left: WheelPlan
    right: WheelPlan
    mass: float
    axle_yaw: float = 0.0

    @property
    def height(self) -> float:
        """Of the axle above the floor [m]."""
        return (self.left.radius + self.right.radius) / 2

    @property
    def wheels(self) -> tuple[WheelPlan, WheelPlan]:
        """Left and right."""
        return self.left, self.right

    @property
    def giving(self) -> WheelPlan | None:
        """The wheel whose tyre gives way sideways: one that is not round, if any.

        The contact of such a wheel wanders ahead of and behind its axle. Two rigid wheels whose
        contacts are not in line with the axle cannot both roll while the robot turns: they would
        fight, one of them slide, and a sliding wheel loses its grip along as well. Real tyres give
        way sideways by a little in each turn; here this wheel gives way freely (the engine sets it
        back to its place after every period) and the other one keeps the robot's line.
        """
        return next((wheel for wheel in self.wheels if wheel.offset or wheel.ovality), None)


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
            mass="0.001" condim="1" friction="0 0 0" priority="1"/>
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
    """Name of the joint that the motor drives and the encoder watches."""
    return f"{plan.side}_shaft" if plan.play else plan.side


def _wheel(plan: WheelPlan, height: float, mass: float, *, gives: bool) -> str:
    # Hubs at the height of their own radius keep the body level when the radii differ.
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
    rotor = 0.001 if plan.play else ROTOR  # with play, it is the shaft that feels the motor
    drag = f'frictionloss="{BEARING_DRAG}"' if plan.play else ""
    body = f"""
        <body name="{plan.side}" pos="{hub}">{give}
          <joint name="{plan.side}" type="hinge" axis="0 1 0" armature="{rotor}" {drag}/>
          <geom name="{plan.side}" {shape} pos="{ahead} 0 {up}" mass="{mass}"
                condim="3" friction="1.5 0 0"/>
        </body>"""
    if plan.play:
        body += f"""
        <body name="{plan.side}_shaft" pos="{hub}">
          <joint name="{plan.side}_shaft" type="hinge" axis="0 1 0" armature="{ROTOR}"/>
          <inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/>
        </body>"""
    return body


def _play(plan: WheelPlan) -> str:
    """Shaft and wheel turn freely against each other between two stops."""
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
