# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From what the encoders say to what the robot does: travel passes through the effects it holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from werrimbi_odom.model.drive import Drive, DriveMemory, RawStep, Span, drive_of_run
from werrimbi_odom.model.effect import after_body_effects, after_wheel_effects
from werrimbi_odom.model.motion import BodyMotion, Number, WheelTravel, wheels_to_body
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


class Driven(NamedTuple):
    """All steps of a run after the effects; arrays of shape (n,)."""

    travel: WheelTravel[Floats]
    motion: BodyMotion[Floats]


@dataclass(slots=True)
class Driving:
    """The effects of a robot in a live drive, a step at a time."""

    robot: Robot
    _memory: DriveMemory | None = field(init=False)

    def __post_init__(self) -> None:
        self._memory = DriveMemory(flicker_of(self.robot)) if acts(self.robot) else None

    def begin(self, left: float, right: float) -> None:
        """Take the counters of the first message: wheels have angles from then on."""
        if self._memory is not None:
            self._memory.left_angle = left * _left_angle(self.robot)
            self._memory.right_angle = right * _right_angle(self.robot)

    def step(
        self, duration: float, raw: WheelTravel[float], yaw: float
    ) -> tuple[WheelTravel[float], BodyMotion[float]]:
        """Travel and motion of one step that begins with heading `yaw` [rad]."""
        motion = wheels_to_body(raw, self.robot.track)
        if self._memory is None:
            return raw, motion
        step = RawStep(
            duration,
            raw.left,
            raw.right,
            motion.along,
            motion.turn,
            raw.left / self.robot.left_tick * _left_angle(self.robot),
            raw.right / self.robot.right_tick * _right_angle(self.robot),
        )
        return after_effects(self.robot, raw, self._memory.step(step, yaw))


def driven(robot: Robot, raw: WheelTravel[Floats], drive: Drive[Floats], yaw: float) -> Driven:
    """A whole run after the effects, the same as `Driving` step by step.

    Parameters
    ----------
    raw : WheelTravel
        Before the effects, shape (n,).
    drive : Drive
        Of the run (`features`).
    yaw : float
        Heading before the first step [rad].
    """
    if not acts(robot):
        return Driven(raw, wheels_to_body(raw, robot.track))
    _, motion = after_effects(robot, raw, drive)
    # An effect may look at the heading, and the heading contains the effects; but no effect's turn
    # depends on the heading, so a second pass with the heading of the first is the answer.
    heading = np.cumsum(np.concatenate([[yaw], motion.turn[:-1]]))
    own_turn = drive.heading.end - drive.heading.start
    return Driven(*after_effects(robot, raw, drive.with_heading(heading, own_turn)))


def features(
    robot: Robot,
    duration: Floats,
    raw: WheelTravel[Floats],
    first_counts: tuple[float, float],
    channels: Mapping[str, Span[Floats]] | None = None,
) -> Drive[Floats]:
    """What effects may look at in a run.

    Parameters
    ----------
    first_counts : (left, right)
        The counters at the first message.
    """
    motion = wheels_to_body(raw, robot.track)
    per_left, per_right = _left_angle(robot), _right_angle(robot)
    return drive_of_run(
        duration,
        raw.left,
        raw.right,
        motion.along,
        motion.turn,
        raw.left / robot.left_tick * per_left,
        raw.right / robot.right_tick * per_right,
        flicker=flicker_of(robot),
        first_angles=(first_counts[0] * per_left, first_counts[1] * per_right),
        channels=channels,
    )


def after_effects(
    robot: Robot, raw: WheelTravel[Number], drive: Drive[Number]
) -> tuple[WheelTravel[Number], BodyMotion[Number]]:
    """Travel and motion once all effects have acted, in their order."""
    travel = after_wheel_effects(robot.effects, raw, drive)
    motion = wheels_to_body(travel, robot.track)
    return travel, after_body_effects(robot.effects, motion, drive)


def acts(robot: Robot) -> bool:
    """Whether any of its effects acts on wheels or body."""
    return any(applied.effect.stage in ("wheels", "body") for applied in robot.effects)


def flicker_of(robot: Robot) -> float:
    """How far a wheel may go back without having reversed [m]: one count may flicker."""
    return 0.75 * (robot.left_tick + robot.right_tick)


def _left_angle(robot: Robot) -> float:
    return 2.0 * math.pi / robot.left_ticks_per_revolution


def _right_angle(robot: Robot) -> float:
    return 2.0 * math.pi / robot.right_ticks_per_revolution
