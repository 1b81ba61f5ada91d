# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""A short synthetic drive with all kinds of motion, for testing the laws."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace
from functools import cache, cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.drive import Drive, RawStep, Span
from werrimbi_odom.model.drive_memory import DriveMemory
from werrimbi_odom.model.drive_of_run import drive_of_run
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement, wheels_to_body
from werrimbi_odom.model.pose import Floats, Pose

TRACK, RADIUS, FLICKER = 0.35, 0.05, 2.5e-4
FIRST_ANGLES = (0.3, -1.1)

# Targets of speed [m/s] and yaw rate [rad/s] in sequence: lines, arcs and spins to both sides, slow
# and fast, backwards, rests.
_TARGETS = (
    (0.0, 0.0), (0.4, 0.0), (0.7, 0.0), (0.5, 1.2), (0.2, -0.8), (0.0, 0.0), (-0.4, 0.0),
    (-0.3, 0.6), (0.3, 0.2), (0.6, -1.5), (0.0, 1.5), (0.0, -2.0), (0.0, 0.0), (-0.5, -0.5),
    (0.1, 0.0), (0.8, 0.05), (0.8, 2.0), (0.175, -1.0), (0.0, 0.0), (0.5, 0.0), (0.0, 0.0),
)  # fmt: skip


class Moment(NamedTuple):
    """One step in floats, as in the node."""

    travel: WheelTravel[float]
    motion: BodyMotion[float]
    drive: Drive[float]


@dataclass(frozen=True)
class Rehearsal:
    """Wheel travel and duration of each step; arrays of shape (n,)."""

    duration: Floats
    left: Floats
    right: Floats
    channels: tuple[str, ...] = ()
    knots: Floats = field(default_factory=lambda: np.zeros(1))
    """Times at which the channels were measured [s]; linear in between."""
    message: NDArray[np.intp] | None = None
    """Index of the message that each step belongs to, if messages are split."""

    @classmethod
    @cache
    def of(cls, channels: tuple[str, ...] = ()) -> Rehearsal:
        """The drive, with synthetic values in the channels of an effect."""
        random = np.random.default_rng(1)
        each = 30
        share = np.arange(1, each + 1) / each
        ramp = np.minimum(1.0, 2.0 * share)[:, None]  # half of the time to reach it, half to stay
        targets = np.array(_TARGETS)
        speeds = np.concatenate(
            [before + ramp * (after - before) for before, after in pairwise(targets)]
        )
        duration = random.uniform(0.01, 0.05, len(speeds))
        along, turn = (speeds * duration[:, None]).T
        half = 0.5 * TRACK * turn
        knots = np.concatenate([[0.0], np.cumsum(duration)])
        return cls(duration, along - half, along + half, channels, knots)

    @property
    def travel(self) -> WheelTravel[Floats]:
        """Wheel travel of all steps."""
        return WheelTravel(self.left, self.right)

    @property
    def motion(self) -> BodyMotion[Floats]:
        """Body motion of all steps, with some sideways creep, as by other effects."""
        motion = wheels_to_body(self.travel, TRACK)
        return motion._replace(sideways=0.01 * motion.along)

    @property
    def drive(self) -> Drive[Floats]:
        """All steps at once."""
        motion = self.motion
        drive = drive_of_run(
            self.duration,
            self.left,
            self.right,
            motion.along,
            motion.turn,
            self.left / RADIUS,
            self.right / RADIUS,
            flicker=FLICKER,
            track=TRACK,
            first_angles=FIRST_ANGLES,
            channels=self.measured,
            message=self.message,
        )
        x, y = self._places()
        moved = displacement(motion, drive.heading.start)
        return drive.with_place(x, y, moved)

    def _places(self) -> tuple[Floats, Floats]:
        """Start positions of the steps [m]."""
        motion = self.motion
        heading = np.cumsum(motion.turn) - motion.turn
        dx, dy = displacement(motion, heading)
        return np.cumsum(dx) - dx, np.cumsum(dy) - dy

    @cached_property
    def steps(self) -> tuple[Moment, ...]:
        """Step by step, with the causal memory of the node."""
        memory = DriveMemory(FLICKER, TRACK, *FIRST_ANGLES)
        motion, heading, found = self.motion, 0.0, []
        measured, (x, y) = self.measured, self._places()
        for i, (duration, left, right) in enumerate(
            zip(self.duration.tolist(), self.left.tolist(), self.right.tolist(), strict=True)
        ):
            one = BodyMotion(*(float(part[i]) for part in motion))
            raw = RawStep(duration, left, right, one.along, one.turn, left / RADIUS, right / RADIUS)
            now = {name: Span(float(s.start[i]), float(s.end[i])) for name, s in measured.items()}
            pose = Pose(float(x[i]), float(y[i]), heading)
            seen = memory.step(raw, pose, now).with_place(*pose[:2], displacement(one, heading))
            found.append(Moment(WheelTravel(left, right), one, seen))
            heading += one.turn
        return tuple(found)

    def split(self, shares: tuple[float, ...]) -> Rehearsal:
        """The same drive with each step split, as by a pose between two messages."""
        parts = np.array(shares)
        return replace(
            self,
            duration=np.outer(self.duration, parts).ravel(),
            left=np.outer(self.left, parts).ravel(),
            right=np.outer(self.right, parts).ravel(),
            message=np.repeat(np.arange(self.duration.size), parts.size),
        )

    @property
    def measured(self) -> dict[str, Span[Floats]]:
        """Channels at the start and end of each step."""
        time = np.concatenate([[0.0], np.cumsum(self.duration)])
        found = {}
        for number, name in enumerate(self.channels):
            values = np.interp(time, self.knots, 3.0 + number + 2.0 * np.sin(0.7 * self.knots))
            found[name] = Span(values[:-1], values[1:])
        return found


def rows(drive: Drive[Floats], index: Any) -> Drive[Floats]:
    """Selected rows of a drive."""
    return _each(drive, lambda values: values[index])


def sealed(drive: Drive[Floats]) -> Drive[Floats]:
    """A read-only copy of a drive."""
    return _each(drive, seal)


def seal(values: Floats) -> Floats:
    """A read-only copy of an array."""
    copy = values.copy()
    copy.setflags(write=False)
    return copy


def _each(drive: Drive[Floats], change: Any) -> Drive[Floats]:
    def changed(value: Any) -> Any:
        if isinstance(value, Span):
            return Span(change(value.start), change(value.end))
        if isinstance(value, np.ndarray):
            return change(value)
        return {name: changed(span) for name, span in value.items()}

    return replace(
        drive, **{item.name: changed(getattr(drive, item.name)) for item in fields(drive)}
    )
