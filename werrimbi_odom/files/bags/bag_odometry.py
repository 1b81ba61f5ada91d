# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Wheel travel reconstructed from odometry, for drivers that publish nothing else."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.errors import InputError
from werrimbi_odom.files.bags.bag import BagMessage, stamp_of
from werrimbi_odom.files.bags.bag_reference import planar
from werrimbi_odom.files.bags.bag_wheels import Wheels
from werrimbi_odom.files.bags.frames import frame
from werrimbi_odom.files.bags.own_odometry import ODOMETRY
from werrimbi_odom.files.bags.ways_of_speeds import ways_of
from werrimbi_odom.files.robot_files.robot_file import RobotFile
from werrimbi_odom.files.run import WORKED_OUT, Ticks
from werrimbi_odom.model.pose import Floats

_WINDOW = 0.5
"""Time of a step of the path that is asked whether it goes sideways [s]: far above rounding."""
_FEWEST = 10
"""Fewest such steps."""
_SLOW = 0.1
"""Share of the usual speed below which the robot does not go anywhere."""
_ASIDE = 0.3
"""Sideways part of a step that goes sideways: 17 degrees. Made of two wheels it is zero."""
_OFTEN = 0.1
"""Share of such steps; where the poses are set back to an origin there is one."""
_OTHER_HEADING = 1.65
"""Most that a driver's heading of a step is off from its middle, in turns of that step, and a tenth
more: half where it takes that of the step's begin or end; 1.5 with the Neato's, which adds the turn
to the wrong side as well."""
_ORIGIN = 1e-6
"""Place [m] and heading [rad] up to which a pose is the origin."""
_LEAPS = 10.0
"""Length of a step to the origin over a usual one, from which on it was no driving."""
SET_BACK = (
    "{:.1f} s after its first message the odometry was set back to its origin: the robot is taken "
    "to have stood in that step"
)
REPEATED = (
    "{} of {} messages repeat the one before to the last digit, while their twist says that the "
    "robot moves: they are old, and left out"
)
FROM_TWIST = "its poses never change, so its twist was integrated"


class OdometryTurnedBack:
    """Collects odometry, and computes the wheel counts that would produce it."""

    def __init__(self, path: Path, source: Wheels, robot_file: RobotFile) -> None:
        self._place = f"{path}: {source.name}"
        self._robot = robot_file.robot
        self._frames = () if source.kind == ODOMETRY else tuple(source.name.split(":")[1:])
        self._time = array("d")
        self._poses = array("d")
        self._twists = array("d")

    def take(self, message: BagMessage) -> None:
        """Add a message."""
        if self._frames:
            for each in self._transforms(message.content):
                self._time.append(stamp_of(message, each))
                self._poses.extend(planar(each.transform.translation, each.transform.rotation))
                self._twists.extend((0.0, 0.0))
            return
        content = message.content
        self._time.append(stamp_of(message))
        self._poses.extend(planar(content.pose.pose.position, content.pose.pose.orientation))
        twist = content.twist.twist
        self._twists.extend((float(twist.linear.x), float(twist.angular.z)))

    def _repeated(self, *columns: Floats) -> NDArray[np.bool_]:
        """Messages that were sent once more, shape (n,), of pose, speed and turn rate.

        A driver that publishes more often than it reads its wheels sends them, or one that hangs:
        the robot would stand, and go twice as far in the next step.
        """
        again = np.all(np.diff(columns, axis=1) == 0.0, axis=0)
        *_, speed, rate = columns
        rolled = np.abs(speed) + 0.5 * self._robot.wheel_separation * np.abs(rate)
        return np.append(False, again & (rolled[1:] > _SLOW * np.quantile(rolled, 0.9)))

    def _refuse_sideways(self, time: Floats, x: Floats, y: Floats, yaw: Floats) -> None:
        """Raise if the robot goes sideways, which two wheels on an axle cannot."""
        back = int(np.count_nonzero(np.diff(time) < 0.0))
        order = np.argsort(time, kind="stable")
        time, (steps, turns) = time[order], _chords(x[order], y[order], yaw[order])
        steps = _along_own_heading(steps, turns)
        place = np.append(0.0, np.cumsum(steps))
        later = np.searchsorted(time, time + _WINDOW)
        begin = np.flatnonzero(later < time.size)
        way, turned = (
            each[later[begin]] - each[begin] for each in (place, np.append(0.0, np.cumsum(turns)))
        )
        if way.size < _FEWEST:
            return
        # A frame ahead of the axle goes sideways as the robot turns: by as much for each radian.
        lever = float(way.imag @ turned) / float(turned @ turned) if turned.any() else 0.0
        aside = np.abs(way.imag - lever * turned)
        # Of a robot that only spins, the wheels roll, and its way is what rounding makes of none.
        rolled = np.abs(way) + 0.5 * self._robot.wheel_separation * np.abs(turned)
        moves = rolled > _SLOW * np.quantile(rolled, 0.9)
        share = float(np.mean(aside[moves] > _ASIDE * rolled[moves])) if moves.any() else 0.0
        if share > _OFTEN:
            two = ", or two nodes publish poses of their own on one topic"
            two = f"{two} (its stamps go back {back} times)" if back else ""
            raise InputError(
                f"{self._place}: by its odometry the robot goes sideways to its heading for "
                f"{100 * share:.0f} % of the time. Mecanum and omni wheels do so, and no model "
                "here is for them. On any other robot the odometry is given of a frame whose x "
                f"axis does not point ahead{two}"
            )

    def _transforms(self, content: Any) -> Iterator[Any]:
        for each in content.transforms:
            if (frame(each.header.frame_id), frame(each.child_frame_id)) == self._frames:
                yield each

    def ticks(self) -> tuple[Ticks, list[str]]:
        """Counts of both wheels, from zero, and the method in words."""
        time = np.array(self._time)
        x, y, yaw = np.array(self._poses).reshape(-1, 3).T
        speed, rate = np.array(self._twists).reshape(-1, 2).T
        words = [WORKED_OUT["odometry"]]
        if not np.isfinite(x + y + yaw).any():
            raise InputError(f"{self._place}: no message holds a finite pose")
        if not (np.ptp(x[np.isfinite(x)]) or np.ptp(y[np.isfinite(y)])) and np.any(speed):
            ways, how = ways_of(time, np.column_stack([speed, rate]))
            along, turned = ways.T
            words += [FROM_TWIST, *how]
        else:
            repeated = self._repeated(x, y, yaw, speed, rate)
            count = int(repeated.sum())
            words += [REPEATED.format(count, time.size)] if count else []
            whole = np.isfinite(x + y + yaw) & ~repeated
            time = time[whole]
            self._refuse_sideways(time, x[whole], y[whole], yaw[whole])
            poses = x[whole], y[whole], yaw[whole]
            back = _set_back(*poses)
            words += [SET_BACK.format(time[row + 1] - time[0]) for row in np.flatnonzero(back)]
            along, turned = _driven(*poses, back)
        robot = self._robot
        half = 0.5 * robot.wheel_separation * turned
        left, right = (
            (along + sign * half) * (per_turn / (2.0 * np.pi * robot.wheel_radius))
            for sign, per_turn in (
                (-1.0, robot.left_ticks_per_revolution),
                (1.0, robot.right_ticks_per_revolution),
            )
        )
        return Ticks(time, left, right), words


def _chords(x: Floats, y: Floats, yaw: Floats) -> tuple[NDArray[np.complex128], Floats]:
    """Step from each pose to the next, ahead and to the left of the mean heading, and turn."""
    turns: NDArray[np.float64] = np.angle(np.exp(1j * np.diff(yaw)))
    steps = (np.diff(x) + 1j * np.diff(y)) * np.exp(-1j * (yaw[:-1] + 0.5 * turns))
    return steps, turns


def _along_own_heading(steps: NDArray[np.complex128], turns: Floats) -> NDArray[np.complex128]:
    """Steps of a driver that goes along another heading than the middle one, set right.

    Where messages are lost the turn of a step is large, and so is how far it seems to go sideways.
    """
    if not steps.size:
        return steps
    ahead = np.angle(np.where(steps.real < 0.0, -steps, steps))
    goes, turning = (
        size > _SLOW * np.quantile(size, 0.9) for size in (np.abs(steps), np.abs(turns))
    )
    large = goes & turning
    off = float(np.median(ahead[large] / turns[large])) if large.any() else 0.0
    return steps * np.exp(-1j * off * turns) if abs(off) < _OTHER_HEADING else steps


def _set_back(x: Floats, y: Floats, yaw: Floats) -> NDArray[np.bool_]:
    """Steps in which the odometry was set back to its origin, (n - 1,).

    A robot that drives home passes its origin by less than a step, and not to the last digit.
    """
    place = np.hypot(x, y)
    home = (place < _ORIGIN) & (np.abs(yaw) < _ORIGIN)
    moved = np.abs(_chords(x, y, yaw)[0])
    usual = np.median(moved[moved > 0.0]) if moved.any() else 0.0
    return np.asarray(home[1:] & ~home[:-1] & (moved > np.maximum(_LEAPS * usual, _ORIGIN)))


def _driven(x: Floats, y: Floats, yaw: Floats, back: NDArray[np.bool_]) -> tuple[Floats, Floats]:
    """Cumulative path of the axle's midpoint, backwards negative, and turn at each pose.

    Between two poses the robot drove an arc; its length follows from chord and turn. Where its
    odometry was set back, nothing is known of the way in that step.
    """
    steps, turns = _chords(x, y, yaw)
    steps[back], turns[back] = 0.0, 0.0
    chord = np.abs(steps) * np.where(steps.real < 0.0, -1.0, 1.0)
    arc = chord / np.sinc(0.5 * turns / np.pi)
    return tuple(np.concatenate([[0.0], np.cumsum(part)]) for part in (arc, turns))  # type: ignore[return-value]
