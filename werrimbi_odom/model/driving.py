# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""From what the encoders say to what the robot does: travel passes through the effects it holds."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import Any, NamedTuple

import numpy as np

from werrimbi_odom.errors import InputError
from werrimbi_odom.model.drive import Drive, RawStep, Span
from werrimbi_odom.model.drive_memory import DriveMemory
from werrimbi_odom.model.drive_of_run import drive_of_run
from werrimbi_odom.model.effect import after_body_effects, after_wheel_effects
from werrimbi_odom.model.motion import (
    BodyMotion,
    Number,
    WheelTravel,
    displacement,
    wheels_to_body,
)
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

_BLOCK = 256
_SETTLED = 1e-13  # m, rad


class Driven(NamedTuple):
    """All steps of a run after the effects; arrays of shape (n,)."""

    travel: WheelTravel[Floats]
    motion: BodyMotion[Floats]


Channels = Mapping[str, float]
"""Extra measured channels at a message, by name."""


class DrivenStep(NamedTuple):
    """One step before any effect, and what effects may look at in it."""

    raw: WheelTravel[float]
    drive: Drive[float]


@dataclass(slots=True)
class Driving:
    """The effects of a robot in a live drive, a step at a time."""

    robot: Robot
    last: DrivenStep | None = field(default=None, init=False)
    """The latest step, where the robot has effects."""
    _memory: DriveMemory | None = field(init=False)
    _channels: dict[str, float] = field(default_factory=dict, init=False)

    def __post_init__(self) -> None:
        self._memory = DriveMemory(flicker_of(self.robot)) if acts(self.robot) else None

    def begin(self, left: float, right: float, channels: Channels | None = None) -> None:
        """Take the counters of the first message: wheels have angles from then on."""
        if self._memory is not None:
            self._memory.left_angle = left * _left_angle(self.robot)
            self._memory.right_angle = right * _right_angle(self.robot)
            self._channels.update(_measured(channels or {}))

    def retune(self, robot: Robot, left: float, right: float) -> None:
        """Go on with other values; all that effects remember stays.

        Parameters
        ----------
        left, right : float
            The counters of the last message, for an effect that is the first to act.
        """
        self.robot = robot
        if self._memory is None and acts(robot):
            self.__post_init__()
            self.begin(left, right)

    def step(
        self,
        duration: float,
        raw: WheelTravel[float],
        pose: Pose,
        channels: Channels | None = None,
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
        drive = self._memory.step(step, pose.yaw, self._spans(channels))
        if looks_at_pose(self.robot):
            drive = drive.with_place(pose.x, pose.y, displacement(motion, pose.yaw))
        self.last = DrivenStep(raw, drive)
        return after_effects(self.robot, raw, drive)

    def _spans(self, channels: Channels | None) -> Mapping[str, Span[float]] | None:
        """From the last message's values to this one's; what was not measured stays as it was."""
        if not channels and not self._channels:
            check_channels(self.robot, {})
            return None
        before = dict(self._channels)
        self._channels.update(_measured(channels or {}))
        check_channels(self.robot, self._channels)
        return {name: Span(before.get(name, now), now) for name, now in self._channels.items()}


def _measured(channels: Channels) -> dict[str, float]:
    return {name: value for name, value in channels.items() if math.isfinite(value)}


def check_channels(robot: Robot, channels: Mapping[str, object]) -> None:
    """Whether everything is measured that the robot's effects look at.

    Raises
    ------
    InputError
        When a channel is not; the message names it and the effect.
    """
    for applied in robot.effects:
        missing = [name for name in applied.effect.channels if name not in channels]
        if missing:
            known = f" (there are {', '.join(channels)})" if channels else ""
            raise InputError(
                f"effect {applied.name} needs the measured channel {', '.join(missing)}, a column "
                f"of ticks.csv, which is not there{known}; record it, or take {applied.name} out "
                "of the robot file's effects"
            )


def driven(
    robot: Robot,
    raw: WheelTravel[Floats],
    drive: Drive[Floats],
    yaw: float,
    place: tuple[float, float] = (0.0, 0.0),
) -> Driven:
    """A whole run after the effects, the same as `Driving` step by step.

    Parameters
    ----------
    raw : WheelTravel
        Before the effects, shape (n,).
    drive : Drive
        Of the run (`features`).
    yaw : float
        Heading before the first step [rad].
    place : (x, y)
        Of the robot before the first step [m].
    """
    if not acts(robot):
        return Driven(raw, wheels_to_body(raw, robot.track))
    start = Pose(*place, yaw)
    if looks_at_pose(robot):
        return settled(robot, raw, drive, start)
    _, motion = after_effects(robot, raw, drive)
    # An effect may look at the heading, and the heading contains the effects; but few turn the
    # robot by its heading, so a second pass with the heading of the first is mostly the answer.
    heading = np.cumsum(np.concatenate([[yaw], motion.turn[:-1]]))
    whole = Driven(*after_effects(robot, raw, drive.with_heading(heading, drive.heading.change)))
    if np.array_equal(whole.motion.turn, motion.turn):
        return whole
    return settled(robot, raw, drive, start)


def settled(robot: Robot, raw: WheelTravel[Floats], drive: Drive[Floats], start: Pose) -> Driven:
    """The same where motion depends on the pose that it leads to, some hundred steps at a time.

    In each pass the poses come from the last pass's motion. A step depends on those before it
    alone, so every pass settles at least one step more for good; a gentle dependence settles all
    of them in a few.
    """
    parts = []
    x, y, yaw = start
    unmoved = wheels_to_body(raw, robot.track)
    for first in range(0, raw.left.size, _BLOCK):
        steps = slice(first, first + _BLOCK)
        own, seen = WheelTravel(raw.left[steps], raw.right[steps]), rows_of(drive, steps)
        plain = BodyMotion(*(part[steps] for part in unmoved))
        motion, poses = plain, np.zeros((3, 0))
        for _ in range(own.left.size + 1):
            before = poses
            heading = yaw + np.concatenate([[0.0], np.cumsum(motion.turn)])
            dx, dy = displacement(motion, heading[:-1])
            poses = np.stack(
                [
                    x + np.concatenate([[0.0], np.cumsum(dx)]),
                    y + np.concatenate([[0.0], np.cumsum(dy)]),
                    heading,
                ]
            )
            if before.size and not np.max(np.abs(poses - before)) >= _SETTLED:
                break
            here = seen.with_heading(heading[:-1], plain.turn).with_place(
                poses[0, :-1], poses[1, :-1], displacement(plain, heading[:-1])
            )
            travel, motion = after_effects(robot, own, here)
        x, y, yaw = poses[:, -1].tolist()
        parts.append((travel, motion))
    return Driven(
        WheelTravel(
            *(np.concatenate(side) for side in zip(*(part[0] for part in parts), strict=True))
        ),
        BodyMotion(
            *(np.concatenate(part) for part in zip(*(part[1] for part in parts), strict=True))
        ),
    )


def rows_of(drive: Drive[Floats], steps: slice) -> Drive[Floats]:
    """Some steps of a drive."""

    def some(value: Any) -> Any:
        if isinstance(value, Span):
            return Span(value.start[steps], value.end[steps])
        if isinstance(value, np.ndarray):
            return value[steps]
        return {name: some(span) for name, span in value.items()}

    return Drive(*(some(getattr(drive, item.name)) for item in fields(drive)))


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
    channels : mapping, optional
        Extra measured channels at the start and end of each step.

    Raises
    ------
    InputError
        When an effect looks at a channel that was not measured.
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


def looks_at_pose(robot: Robot) -> bool:
    """Whether any of its effects depends on where the robot stands."""
    return any(applied.effect.pose for applied in robot.effects)


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
