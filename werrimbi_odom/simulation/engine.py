# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The physics engine: takes commands, returns the true path and the wheel angles."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from .chassis import IMPEDANCE, SKID_BEHIND, STEP, TIME_CONSTANT, Chassis, shaft_joint, to_mjcf

Floats = NDArray[np.float64]

PERIOD = 5e-3
"""Period of the speed controller and of the recorded true path [s]."""

CURVE_CREEP = TIME_CONSTANT * IMPEDANCE / 2 - STEP / 2
"""Outward creep of the engine's wheels per speed times yaw rate [s]; measured: 0.451 ms."""


# By default MuJoCo writes its warnings to a file in the current folder. `Engine.check` reads them
# from the data instead.
mujoco.set_mju_user_warning(lambda message: None)


TIPPED = 0.2
"""Tilt of the body [rad] above which its wheels no longer roll as the floor is.

A robot that stands on its wheels and skid tilts by 2e-5 in the hardest drive of a session, and one
whose radii change, by what they change over the distance to the skid. An axle at 0.2 m under a body
that is made for 0.05 m went head over heels: its wheels counted a metre that was not driven.
"""


class UnstableError(RuntimeError):
    """The simulation became unstable: the requested robot is beyond the engine."""


class AxlePose(NamedTuple):
    """Pose of the axle's midpoint on the floor: x, y [m], yaw [rad]; the yaw counts full turns."""

    x: float
    y: float
    yaw: float


class Stride(NamedTuple):
    """Motion of the robot in one period of the controller.

    Time at its end and duration [s], rolled distance of each wheel [m], pose at its end.
    """

    time: float
    period: float
    left: float
    right: float
    pose: AxlePose


class Shift(NamedTuple):
    """A small motion without wheel rotation: along, sideways (left positive) [m], turn [rad]."""

    along: float
    sideways: float
    turn: float


Shifter = Callable[[Stride], Shift]
"""Returns the motion of the robot in addition to rolling; may have a state."""


@dataclass(frozen=True)
class TruePath:
    """Ground truth without measurement noise; arrays of shape (n,), one row per PERIOD."""

    t_s: Floats
    """Time since the start of the simulation [s]."""
    x_m: Floats
    y_m: Floats
    yaw_rad: Floats
    """Pose of the axle's midpoint in the world; the yaw counts full turns."""
    left_angle_rad: Floats
    right_angle_rad: Floats
    """Angles of the encoder shafts relative to the body, positive forwards."""


class Engine:
    """A robot on MuJoCo's floor, ready to drive. The only mutable state of the engine."""

    def __init__(self, chassis: Chassis, start: AxlePose, angles: tuple[float, float]) -> None:
        self._model = mujoco.MjModel.from_xml_string(to_mjcf(chassis))
        self._data = mujoco.MjData(self._model)
        # Views of the engine's memory: a new look-up in each step would cost as much as the step.
        self._q, self._v, self._speeds = self._data.qpos, self._data.qvel, self._data.ctrl
        self._x, self._y, self._yaw = (self._place(name) for name in ("x", "y", "yaw"))
        self._z, self._pitch, self._roll = (self._place(name) for name in ("z", "pitch", "roll"))
        self._wheels = [self._place(wheel.side) for wheel in chassis.wheels]
        self._shafts = [self._place(shaft_joint(wheel)) for wheel in chassis.wheels]
        giving = chassis.giving
        self._gives = [self._place(f"{giving.side}_give")] if giving else []
        self._radii = {wheel.side: wheel.radius for wheel in chassis.wheels}
        self._hubs = {wheel.side: wheel.y for wheel in chassis.wheels}
        self._data.qpos[self._wheels] = angles
        self._data.qpos[self._shafts] = angles
        self._data.act[:] = angles
        self._settle()
        self._data.qpos[[self._x, self._y, self._yaw]] = start
        self._data.qvel[:] = 0.0
        self._tilt = 0.0  # the largest so far [rad]

    def _place(self, joint: str) -> int:
        return int(self._model.joint(joint).qposadr[0])

    def _settle(self) -> None:
        """Let the robot settle into its contacts, and add half the penetration to the radii."""
        self._run(500)
        sunk = dict.fromkeys(self._radii, 0.0)
        for contact in self._data.contact:
            for geom in contact.geom:
                name = self._model.geom(geom).name
                if name in sunk:
                    sunk[name] = -float(contact.dist)
        for side, depth in sunk.items():
            self._grow(side, depth / 2)
        self._run(500)

    def _grow(self, side: str, by: float) -> None:
        geom = self._model.geom(side)
        geom.size[:] += by
        geom.rbound[:] += by  # otherwise the engine would not look for contacts that far out

    def _run(self, steps: int) -> None:
        mujoco.mj_step(self._model, self._data, steps)

    @property
    def pose(self) -> AxlePose:
        """Pose of the axle's midpoint in the world."""
        q = self._q
        return AxlePose(float(q[self._x]), float(q[self._y]), float(q[self._yaw]))

    @property
    def wheel_angles(self) -> tuple[float, float]:
        """Angles of the wheels, left and right [rad]."""
        left, right = self._wheels
        return float(self._q[left]), float(self._q[right])

    @property
    def shaft_angles(self) -> tuple[float, float]:
        """Angles of the encoder shafts, left and right [rad]; without play equal to the wheels'."""
        left, right = self._shafts
        return float(self._q[left]), float(self._q[right])

    def radius(self, side: str) -> float:
        """Present rolling radius of a wheel [m]."""
        return self._radii[side]

    def set_radius(self, side: str, radius: float) -> None:
        """Change the rolling radius of a wheel to `radius` [m].

        Its hub rises by as much, and the other tyre and the skid stay on the floor; wheels roll as
        the body tilts. Contacts are micrometres deep: a tyre that shrank under a hub at rest would
        lose the floor, and slip until the hub has fallen as far.
        """
        by = radius - self._radii[side]
        self._grow(side, by)
        self._radii[side] = radius
        own, other = self._hubs[side], next(y for at, y in self._hubs.items() if at != side)
        roll = by / (own - other)
        rise = -roll * other
        pitch = -rise / SKID_BEHIND
        self._q[[self._z, self._pitch, self._roll]] += (rise, pitch, roll)
        self.move([Shift(radius * pitch, 0.0, 0.0)])

    def advance(self, left_speed: float, right_speed: float) -> None:
        """Hold the commanded motor speeds [rad/s] for one PERIOD."""
        self._speeds[:] = (left_speed, left_speed, right_speed, right_speed)
        self._run(round(PERIOD / STEP))
        for give in self._gives:
            self._q[give] = 0.0
        pitch, roll = float(self._q[self._pitch]), float(self._q[self._roll])
        self._tilt = max(self._tilt, abs(pitch), abs(roll))

    def check(self) -> None:
        """Raise UnstableError if the engine has warned so far, or the robot has tipped over."""
        if self._tilt > TIPPED:
            raise UnstableError(
                f"the robot tipped by {math.degrees(self._tilt):.0f}°: it starts or brakes too "
                "hard for the height of its axle; drive it with less acceleration"
            )
        if any(warning.number for warning in self._data.warning):
            raise UnstableError("the physics engine became unstable; is the robot buildable?")

    def move(self, shifts: Iterable[Shift]) -> None:
        """Apply shifts to the whole robot on the floor, in this order, and rotate its velocity too.

        The floor is uniform, so contacts and forces do not change.
        """
        q, v = self._q, self._v
        x, y, yaw = self.pose
        vx, vy = float(v[self._x]), float(v[self._y])
        for along, sideways, turn in shifts:
            middle = yaw + turn / 2
            cos, sin = math.cos(middle), math.sin(middle)
            x, y, yaw = (
                x + (cos * along - sin * sideways),
                y + (sin * along + cos * sideways),
                yaw + turn,
            )
            cos, sin = math.cos(turn), math.sin(turn)
            vx, vy = cos * vx - sin * vy, sin * vx + cos * vy
        q[self._x], q[self._y], q[self._yaw] = x, y, yaw
        v[self._x], v[self._y] = vx, vy


Reshaper = Callable[[Engine, Stride], None]
"""Changes the robot while it drives, after each PERIOD; may have a state."""

Row = tuple[float, float, float, float, float, float]
"""Row of a TruePath: time, x, y, yaw, and the angles of both shafts."""


class DrivenRobot:
    """A robot driven period by period, with its shifters and reshapers; arguments as in `drive`."""

    def __init__(
        self,
        chassis: Chassis,
        start: AxlePose,
        angles: tuple[float, float],
        shifters: Sequence[Shifter] = (),
        reshapers: Sequence[Reshaper] = (),
    ) -> None:
        self._engine = Engine(chassis, start, angles)
        self._shifters, self._reshapers = tuple(shifters), tuple(reshapers)
        self._pose, self._wheels = self._engine.pose, self._engine.wheel_angles
        self._periods = 0
        self.row: Row = (0.0, *self._pose, *self._engine.shaft_angles)
        """The current row of the true path."""

    def advance(self, left_speed: float, right_speed: float) -> Row:
        """Hold the motor speeds [rad/s] for one PERIOD; return the next row of the path."""
        engine, before, wheels = self._engine, self._pose, self._wheels
        self._periods += 1
        engine.advance(left_speed, right_speed)
        now, turned = engine.pose, engine.wheel_angles
        stride = Stride(
            time=self._periods * PERIOD,
            period=PERIOD,
            left=(turned[0] - wheels[0]) * engine.radius("left"),
            right=(turned[1] - wheels[1]) * engine.radius("right"),
            pose=now,
        )
        speed = (stride.left + stride.right) / 2 / PERIOD
        creep = Shift(0.0, CURVE_CREEP * speed * (now.yaw - before.yaw), 0.0)
        engine.move((creep, *(shifter(stride) for shifter in self._shifters)))
        for reshape in self._reshapers:
            reshape(engine, stride)
        self._pose, self._wheels = engine.pose, turned
        self.row = (stride.time, *self._pose, *engine.shaft_angles)
        return self.row

    def check(self) -> None:
        """Raise UnstableError if the engine has warned so far, or the robot has tipped over."""
        self._engine.check()


def drive(
    chassis: Chassis,
    wheel_speeds: Floats,
    *,
    start: AxlePose,
    angles: tuple[float, float],
    shifters: Sequence[Shifter] = (),
    reshapers: Sequence[Reshaper] = (),
) -> TruePath:
    """Drive a robot with given motor speeds; return a path of n + 1 rows.

    `wheel_speeds` are the commanded mean speeds of the left and right motor in each PERIOD [rad/s],
    shape (n, 2); `angles` those of the encoder shafts at the start, left and right [rad]. Shifters
    (which all get the same stride) and reshapers are applied after each PERIOD.
    """
    robot = DrivenRobot(chassis, start, angles, shifters, reshapers)
    rows = np.empty((len(wheel_speeds) + 1, 6))
    rows[0] = robot.row
    for i, (left_speed, right_speed) in enumerate(wheel_speeds, start=1):
        rows[i] = robot.advance(left_speed, right_speed)
    robot.check()
    return TruePath(*np.ascontiguousarray(rows.T))
