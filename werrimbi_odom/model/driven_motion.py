# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From encoder increments to motion of the robot, through the effects of its model."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.drive import Drive, RawStep, Span
from werrimbi_odom.model.drive_memory import DriveMemory
from werrimbi_odom.model.drive_of_run import DriveOfRun, drive_of_run
from werrimbi_odom.model.effects_over_run import after_effects
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, wheels_to_body
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

Channels = Mapping[str, float]
"""Extra measured channels at a message, by name."""


class DrivenStep(NamedTuple):
    """One step before any effect, and what effects may read in it."""

    raw: WheelTravel[float]
    drive: Drive[float]


@dataclass(slots=True)
class Driving:
    """The effects of a robot during a live drive, one step at a time."""

    robot: Robot
    last: DrivenStep | None = field(default=None, init=False)
    """The latest step; None for a robot without effects."""
    _memory: DriveMemory | None = field(init=False)
    _channels: dict[str, float] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        if acts(self.robot):
            self._memory = DriveMemory(flicker_of(self.robot), self.robot.track)
        else:
            self._memory = None

    def begin(self, left: float, right: float, channels: Channels | None = None) -> None:
        """Set the counters of the first message, which define the wheels' angles."""
        if self._memory is not None:
            self._memory.left_angle = left * _left_angle(self.robot)
            self._memory.right_angle = right * _right_angle(self.robot)
            self._channels.update(_measured(channels or {}))

    def retune(self, robot: Robot, left: float, right: float) -> None:
        """Change the parameter values; the state of the effects is kept.

        `left`, `right`: counters of the last message, needed where no effect acted before.
        """
        self.robot = robot
        if self._memory is not None:
            self._memory.track = robot.track
        elif acts(robot):
            self.__post_init__()
            self.begin(left, right)

    def step(
        self, duration: float, raw: WheelTravel[float], pose: Pose, channels: Channels | None = None
    ) -> tuple[WheelTravel[float], BodyMotion[float]]:
        """Travel and motion of one step that begins at `pose`."""
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
        drive = self._memory.step(step, pose, self._spans(channels))
        self.last = DrivenStep(raw, drive)
        return after_effects(self.robot, raw, drive)

    def check(self, channels: Channels | None = None) -> None:
        """Check that the next step has all that effects read; InputError before anything changes.

        Channels without a value keep the last.
        """
        if self._memory is not None:
            check_channels(self.robot, self._channels | _measured(channels or {}))

    def _spans(self, channels: Channels | None) -> Mapping[str, Span[float]] | None:
        """From the last message's values to this one's; channels without a value keep the last."""
        if not channels and not self._channels:
            return None
        before = dict(self._channels)
        self._channels.update(_measured(channels or {}))
        return {name: Span(before.get(name, now), now) for name, now in self._channels.items()}


def _measured(channels: Channels) -> dict[str, float]:
    return {name: value for name, value in channels.items() if math.isfinite(value)}


def check_channels(robot: Robot, channels: Mapping[str, object]) -> None:
    """Check that every channel that the robot's effects read is measured.

    InputError if one is not; the message names it and the effect.
    """
    for applied in robot.effects:
        missing = applied.effect.lacks(channels)
        if missing:
            known = f" (there are {', '.join(channels)})" if channels else ""
            raise InputError(
                f"effect {applied.name} needs the measured channel {', '.join(missing)}, a column "
                f"of ticks.csv, which is not there{known}; record it, or take {applied.name} out "
                "of the robot file's effects"
            )


def features(
    robot: Robot,
    duration: Floats,
    raw: WheelTravel[Floats],
    first_counts: tuple[float, float],
    channels: Mapping[str, Span[Floats]] | None,
    message: NDArray[np.intp] | None = None,
    rims: WheelTravel[Floats] | None = None,
) -> DriveOfRun:
    """Compute what effects may read in a run.

    `first_counts`: counters at the first message. `channels`: extra measured channels at the start
    and end of each step. `message`, `rims`: as for `drive_of_run`. InputError if an effect reads a
    channel that was not measured.
    """
    check_channels(robot, channels or {})
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
        track=robot.track,
        first_angles=(first_counts[0] * per_left, first_counts[1] * per_right),
        channels=channels,
        message=message,
        rims=rims,
    )


def acts(robot: Robot) -> bool:
    """Whether any of the robot's effects acts on wheels or body."""
    return any(applied.effect.stage in ("wheels", "body") for applied in robot.effects)


def flicker_of(robot: Robot) -> float:
    """Largest backward travel of a wheel that is no reversal [m]: one count may flicker."""
    return 0.75 * (robot.left_tick + robot.right_tick)


def _left_angle(robot: Robot) -> float:
    return 2.0 * math.pi / robot.left_ticks_per_revolution


def _right_angle(robot: Robot) -> float:
    return 2.0 * math.pi / robot.right_ticks_per_revolution
