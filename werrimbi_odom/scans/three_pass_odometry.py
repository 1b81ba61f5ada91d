# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Scans in, poses out: three passes side by side, and cuts where the lidar was lost.

The first pass deskews a scan by the lidar's own last motion, and so leans a little to it. The
second deskews it by the smoothed path of the first, some scans before and after it, on a map of its
own, and the third by that of the second: what is left of any guess is then gone. (Poses of two
passes are still a little ahead of the truth where the robot turns; a fourth changes nothing.) Each
follows the one before by some scans, so that neither scans nor maps are kept: memory does not grow
with the drive.
"""

from __future__ import annotations

from array import array
from collections import Counter, deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.limits import (
    FEWEST_POSES,
    LONGEST_HOLE,
    ORDER_MOST,
    ORDER_TURNING,
)
from werrimbi_odom.scans.pose_noise import common_noise, usual_about
from werrimbi_odom.scans.scan_odometry import Flag, ScanTracker, motion_between, moved
from werrimbi_odom.scans.sweep import Sweep, SweepMotion, deskewed, own_course

AROUND = 2
"""Scans before and after one, that its course in later passes is fitted to: five poses, which a
cubic fits with one to spare. A parabola is too smooth where turning begins or ends (4 rad/s^2: NEES
of steps 2.1 in place of 1.2, in a simulated drive); by three poses alone the noise of the two
neighbours is felt (of a calm drive 1.1 in place of 1.0)."""
USUAL = 0.1
"""Time of a turn until two scans are known [s]."""
INTERVALS = 15
"""Scans whose median tells how long a turn takes."""
_COLUMNS = 16
"""Numbers of each pose: time, pose, covariance, walk, piece."""


@dataclass(frozen=True, eq=False)
class ScanPath:
    """Poses of a lidar; n of them, on pieces whose frames have nothing to do with each other."""

    time: Floats
    """Of the middle of each sweep, shape (n,) [s]."""
    poses: Floats
    """x, y [m] and yaw [rad], shape (n, 3)."""
    covariances: Floats
    """Of each pose, given the map; axes of the piece, shape (n, 3, 3)."""
    walked: Floats
    """Variances of position, an axis, and heading that the map has walked by then, from the start
    of the piece on, shape (n, 2) [m², rad²]."""
    piece: NDArray[np.intp]
    """Number of the unbroken piece, shape (n,)."""
    common: tuple[float, float]
    """What no match can see, and `covariances` have: a factor on the variances of positions, 1 if
    there is none, and a standard deviation of the heading [rad]."""
    scans: int
    """All that were given, those with one stamp counted once."""
    flags: dict[Flag, int]
    """How many matches were none, by reason."""

    @property
    def cuts(self) -> list[tuple[float, float]]:
        """From the last pose of a piece to the first of the next [s]."""
        at = np.flatnonzero(np.diff(self.piece))
        return [(float(self.time[row]), float(self.time[row + 1])) for row in at]


class _Seen(NamedTuple):
    """A scan as a pass has it."""

    sweep: Sweep
    pose: Floats
    clock: float
    """Even, however its stamps jitter [s]."""


class ScanMatcher:
    """Takes scans in the order of time, and gives the path at the end."""

    def __init__(self) -> None:
        self._intervals: deque[float] = deque(maxlen=INTERVALS)
        self._last: Sweep | None = None
        self._first = ScanTracker(np.zeros(3))
        self._motion, self._clock = np.zeros(3), 0.0
        self._begun, self._scans = False, 0
        self._flags: Counter[Flag] = Counter()
        self._second, self._third = _PassAgain(self._flags), _PassAgain(self._flags)
        self._found = array("d")
        self.scatter: dict[float, float] = {}
        """By the time of the first scans in which the lidar turned: how far their echoes lie from
        the walls [m]."""

    def take(self, sweep: Sweep) -> None:
        """Take a scan; one that is not later than the last is none."""
        if self._last is not None:
            interval = sweep.time - self._last.time
            if interval <= 0.0:
                return  # a message that came twice
            if interval > LONGEST_HOLE:
                self._cut()
            else:
                self._intervals.append(interval)
        self._scans += 1
        usual = float(np.median(self._intervals)) if self._intervals else USUAL
        turns = 1 if self._last is None else max(round((sweep.time - self._last.time) / usual), 1)
        self._last = sweep
        self._clock += turns * usual
        turns += self._first.failed
        before = self._first.pose
        points = deskewed(sweep, own_course(self._motion, usual))
        motion = turns * self._motion
        flag = self._first.take(points, sweep.reach, motion, turns * usual)
        if flag:
            self._flags[flag] += 1
            if self._first.lost:
                self._cut()
            return
        if self._begun:
            self._motion = motion_between(before, self._first.pose) / turns
        self._begun = True
        self._again(self._second.take(_Seen(sweep, self._first.pose, self._clock)))

    def headings(self, most: int) -> Floats:
        """Time [s], heading [rad] and piece of the last poses so far, at most so many, (n, 3)."""
        table = np.array(self._found[-_COLUMNS * most :]).reshape(-1, _COLUMNS)
        return np.asarray(table[:, [0, 3, 15]])

    def path(self) -> ScanPath:
        """The path of all scans that were taken; the last call of all."""
        self._cut()
        table = np.array(self._found).reshape(-1, _COLUMNS)
        piece = table[:, 15].astype(np.intp)
        kept = np.bincount(piece, minlength=1)[piece] >= FEWEST_POSES
        poses = table[kept, 1:4]
        covariances = usual_about(table[kept, 4:13].reshape(-1, 3, 3), piece[kept])
        wider, turned = common_noise(poses, covariances, piece[kept])
        scale = np.sqrt([wider, wider, 1.0])
        return ScanPath(
            table[kept, 0],
            poses,
            covariances * np.outer(scale, scale) + np.diag([0.0, 0.0, turned**2]),
            table[kept, 13:15],
            piece[kept],
            (wider, turned),
            self._scans,
            dict(self._flags),
        )

    def _cut(self) -> None:
        """End the piece: what comes next has a map and a frame of its own."""
        self._again(self._second.rest())
        self._keep(self._third.rest())
        self._first = ScanTracker(self._first.pose)
        self._motion, self._begun = np.zeros(3), False

    def _again(self, matched: Iterable[_Seen]) -> None:
        for seen in matched:
            self._keep(self._third.take(seen))

    def _keep(self, matched: Iterable[_Seen]) -> None:
        last = self._third
        for seen in matched:
            if abs(last.turning) > ORDER_TURNING and len(self.scatter) < ORDER_MOST:
                self.scatter[seen.sweep.time] = last.tracker.scatter
            self._found.append(seen.sweep.time)
            self._found.extend(seen.pose)
            self._found.extend(last.tracker.covariance.ravel())
            self._found.extend(last.tracker.walk)
            self._found.append(last.piece)


class _PassAgain:
    """A pass over scans as the one before has them, on a map of its own."""

    def __init__(self, flags: Counter[Flag]) -> None:
        """Count reasons of matches that fail in `flags`."""
        self.tracker = ScanTracker(np.zeros(3))
        self.piece = 0
        self.turning = 0.0
        """Yaw rate in the last scan [rad/s]."""
        self._seen: deque[_Seen] = deque(maxlen=2 * AROUND + 1)
        self._done = 0  # scans at the front of `_seen` that this pass has
        self._flags = flags

    def take(self, seen: _Seen) -> Iterator[_Seen]:
        """Take a scan; what is matched then, one by one."""
        if len(self._seen) == self._seen.maxlen:
            self._done -= 1
        self._seen.append(seen)
        if len(self._seen) - self._done > AROUND:
            yield from self._match()

    def rest(self) -> Iterator[_Seen]:
        """What is left to match; then a new piece begins."""
        while self._done < len(self._seen):
            yield from self._match()
        self._seen.clear()
        self._done = 0
        self._renew()

    def _renew(self) -> None:
        # Beside the last pose: one that is the same to the last digit looks held, not measured.
        self.tracker = ScanTracker(self.tracker.pose + 1e-6)
        self.piece += 1

    def _match(self) -> Iterator[_Seen]:
        seen = self._seen[self._done]
        course = _course(self._seen, self._done)
        points = deskewed(seen.sweep, course)
        motion, duration = np.zeros(3), USUAL
        if self._done:
            last = self._seen[self._done - 1]
            motion, duration = motion_between(last.pose, seen.pose), seen.clock - last.clock
        self._done += 1
        self.turning = course.linear[2]
        flag = self.tracker.take(points, seen.sweep.reach, motion, duration)
        if flag:
            self._flags[flag] += 1
            # What was missed is in the guess: the pose goes on as in the pass before.
            self.tracker.pose = moved(self.tracker.pose, motion)
            if self.tracker.lost:
                self._renew()
            return
        yield seen._replace(pose=self.tracker.pose)


def _course(seen: deque[_Seen], at: int) -> SweepMotion:
    """How the lidar moved about a scan: a cubic through the poses about it."""
    about = [seen[row] for row in range(max(at - AROUND, 0), min(at + AROUND + 1, len(seen)))]
    t = np.array([each.clock for each in about]) - seen[at].clock
    degree = 3 if t.size > 2 * AROUND else min(2, t.size - 1)
    if degree == 0:
        return SweepMotion()
    motions = np.array([motion_between(seen[at].pose, each.pose) for each in about])
    powers = np.column_stack([t**power for power in range(degree + 1)])
    fitted = np.linalg.lstsq(powers, motions, rcond=None)[0]
    fitted = np.vstack([fitted, np.zeros((2, 3))])  # the cube of half a turn is nothing
    return SweepMotion(tuple(fitted[1].tolist()), tuple(fitted[2].tolist()))
