# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Effects over a recorded run: one pass, or several where effects depend on the resulting pose.

The quantities that an effect reads are recorded while it runs on the actual steps and values. An
effect that did not read the pose cannot depend on it. One that did is evaluated again with the
poses that result, until these converge.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.drive import Drive, Span
from werrimbi_odom.model.drive_of_run import QUANTITIES, DriveOfRun, Some
from werrimbi_odom.model.effect import after_stage
from werrimbi_odom.model.measured_poses import MeasuredPoses
from werrimbi_odom.model.motion import BodyMotion, Number, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pose import Floats, Pose
from werrimbi_odom.model.robot import Robot

PLACE = frozenset({"x", "y"})
POSE = PLACE | {"heading"}

_PASSES = 30
_SAME = 1e-11  # m, rad
_BLOCK = 256
_SETTLED = 1e-13  # m, rad


class AfterEffects(NamedTuple):
    """All steps of a run after the effects; arrays of shape (n,)."""

    travel: WheelTravel[Floats]
    motion: BodyMotion[Floats]


class WatchedDrive(DriveOfRun):
    """A `Drive` that records which quantities and extra channels are read, by name.

    Copies of it read their quantities through it, so those are recorded too.
    """

    __slots__ = ("asked",)
    asked: set[str]

    @classmethod
    def by(cls: type[Some], works: Mapping[str, Callable[[], Any]]) -> Some:
        """Create a drive from functions that compute its quantities, by name."""
        drive = super().by(works)
        object.__setattr__(drive, "asked", set())
        return drive

    def __init__(self, **quantities: Any) -> None:
        object.__setattr__(self, "asked", set())
        super().__init__(**quantities)

    def __getattribute__(self, name: str) -> Any:
        if name in _QUANTITIES:
            self.asked.add(name)
        value = object.__getattribute__(self, name)
        return _WatchedChannels(value, self.asked) if name == "channels" else value


_QUANTITIES = frozenset(QUANTITIES) - {"channels"}


class _WatchedChannels(Mapping[str, Span[Floats]]):
    def __init__(self, channels: Mapping[str, Span[Floats]], asked: set[str]) -> None:
        self._channels, self._asked = channels, asked

    def __getitem__(self, name: str) -> Span[Floats]:
        self._asked.add(name)
        return self._channels[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)


def watched(drive: Drive[Floats]) -> WatchedDrive:
    """Return the drive with recording of what is read."""
    seen = WatchedDrive.by({name: partial(getattr, drive, name) for name in QUANTITIES})
    object.__setattr__(seen, "channels", drive.channels)
    return seen


def after_effects(
    robot: Robot, raw: WheelTravel[Number], drive: Drive[Number]
) -> tuple[WheelTravel[Number], BodyMotion[Number]]:
    """Travel and motion after all effects, in their order."""
    travel = after_stage("wheels", robot.effects, raw, drive)
    motion = wheels_to_body(travel, robot.track)
    return travel, after_stage("body", robot.effects, motion, drive)


def driven(
    robot: Robot, raw: WheelTravel[Floats], drive: Drive[Floats], start: Pose
) -> AfterEffects:
    """Compute a whole run after the effects; the same as `driven_motion.Driving` step by step.

    `raw`: travel before the effects, shape (n,). `drive`: drive of the run
    (`driven_motion.features`). `start`: pose of the robot before the first step.
    """
    seen = watched(drive)
    first = AfterEffects(*after_effects(robot, raw, seen))
    if not seen.asked & POSE or raw.left.size == 0:
        return first
    # Few effects turn the robot depending on its heading, so a second pass with the heading of the
    # first is usually the solution.
    heading = np.cumsum(np.concatenate([[start.yaw], first.motion.turn[:-1]]))
    again = watched(drive.with_heading(heading, drive.heading.change))
    second = AfterEffects(*after_effects(robot, raw, again))
    if not again.asked & PLACE and np.array_equal(first.motion.turn, second.motion.turn):
        return second
    return _settled(robot, raw, drive, start)


def _settled(
    robot: Robot, raw: WheelTravel[Floats], drive: Drive[Floats], start: Pose
) -> AfterEffects:
    """Fixed-point iteration where motion depends on the resulting pose, in blocks of steps.

    Each pass uses the poses from the previous pass's motion. A step depends only on earlier ones,
    so every pass settles at least one more step; a weak dependence settles all of them in a few.
    """
    parts = []
    x, y, yaw = start
    unmoved = wheels_to_body(raw, robot.track)
    for first in range(0, raw.left.size, _BLOCK):
        steps = slice(first, first + _BLOCK)
        own, seen = WheelTravel(raw.left[steps], raw.right[steps]), _rows_of(drive, steps)
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
    return AfterEffects(
        WheelTravel(
            *(np.concatenate(side) for side in zip(*(part[0] for part in parts), strict=True))
        ),
        BodyMotion(
            *(np.concatenate(part) for part in zip(*(part[1] for part in parts), strict=True))
        ),
    )


Rows = slice | NDArray[np.intp]


def _rows_of(drive: Drive[Floats], steps: Rows) -> Drive[Floats]:
    """Slice of some steps of a drive."""

    def some(value: Any) -> Any:
        if isinstance(value, Span):
            return Span(value.start[steps], value.end[steps])
        if isinstance(value, np.ndarray):
            return value[steps]
        return {name: some(span) for name, span in value.items()}

    def of(name: str) -> Any:
        return some(getattr(drive, name))

    return DriveOfRun.by({name: partial(of, name) for name in QUANTITIES})


def driven_from_measured(
    robot: Robot,
    raw: WheelTravel[Floats],
    drive: Drive[Floats],
    measured: Callable[[], MeasuredPoses],
) -> AfterEffects:
    """As `driven`, where poses are `measured` at times, so that errors do not accumulate.

    A pass evaluates only the steps whose poses the last one moved. After the first two these are
    few: those up to the next measured pose from where the pose changes what an effect does.
    """
    seen = watched(drive)
    found = AfterEffects(*after_effects(robot, raw, seen))
    if not seen.asked & POSE:
        return found
    plain, whole = wheels_to_body(raw, robot.track), measured()
    if not seen.asked & PLACE:
        found, seen = _settled_at(robot, raw, drive, found, plain, whole, placed=False)
    if seen.asked & PLACE:
        start = AfterEffects(raw, plain)
        found, _ = _settled_at(robot, raw, drive, start, plain, whole, placed=True)
    return found


def _settled_at(
    robot: Robot,
    raw: WheelTravel[Floats],
    drive: Drive[Floats],
    start: AfterEffects,
    plain: BodyMotion[Floats],
    measured: MeasuredPoses,
    *,
    placed: bool,
) -> tuple[AfterEffects, WatchedDrive]:
    """Fixed-point iteration from the motion `start`; also what the effects looked at.

    `plain`: motion without effects. `placed`: whether positions are given as well as headings.
    """
    travel = WheelTravel(*map(np.array, start.travel))
    motion = BodyMotion(*map(np.array, start.motion))
    every = np.arange(raw.left.size)
    steps: Rows = slice(None)  # whose poses may move
    poses = np.full((3 if placed else 1, every.size), np.inf)  # at which they were evaluated
    for _ in range(_PASSES):
        own = BodyMotion(*(part[steps] for part in motion))
        heading = measured.headings(own.turn)
        now = np.stack([heading, *(measured.places(own, heading) if placed else ())])
        moved = (np.abs(now - poses) > _SAME).any(axis=0)
        if not moved.any():
            break
        some: Rows = slice(None) if moved.all() else np.flatnonzero(moved)
        rows = steps if moved.all() else every[steps][some]
        poses[:, some] = now[:, some]
        here = _rows_of(drive, rows)
        here = here.with_heading(heading[some], here.heading.change)
        if placed:
            way = displacement(BodyMotion(*(part[rows] for part in plain)), heading[some])
            here = here.with_place(now[1, some], now[2, some], way)
        seen = watched(here)
        after = after_effects(robot, WheelTravel(raw.left[rows], raw.right[rows]), seen)
        for whole, part in zip((*travel, *motion), (*after[0], *after[1]), strict=True):
            whole[rows] = part
        if not moved.all():
            reached = measured.reached_from(moved, placed)
            steps, poses, measured = every[steps][reached], poses[:, reached], measured.of(reached)
    return AfterEffects(travel, motion), seen
