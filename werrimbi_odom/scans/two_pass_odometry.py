# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Scans in, poses out: two passes side by side, and cuts where the lidar was lost.

The first pass deskews a scan by the lidar's own last motion, and so may lean a little to it. The
second deskews it by the smoothed path of the first, some scans before and after it, on a map of its
own: what is left of any guess is then gone. It follows the first by some scans, so that neither
scans nor maps are kept: memory does not grow with the drive.
"""

from __future__ import annotations

from array import array
from collections import deque
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import uniform_filter1d

from werrimbi_odom.model.pose import Floats
from werrimbi_odom.scans.limits import (
    CALM,
    COMMON,
    COMMON_SURE,
    FEWEST_POSES,
    LONGEST_HOLE,
    LOST_AFTER,
    MOVING,
    ORDER_MOST,
    ORDER_TURNING,
)
from werrimbi_odom.scans.matching import MAD
from werrimbi_odom.scans.scan_odometry import Flag, ScanTracker, motion_between, moved
from werrimbi_odom.scans.sweep import Sweep, SweepMotion, deskewed, own_course

AROUND = 2
"""Scans before and after one, that its course in the second pass is fitted to: five poses, which a
cubic fits with one to spare. A parabola is too smooth where turning begins or ends (4 rad/s^2: NEES
of steps 2.1 in place of 1.2, in a simulated drive); by three poses alone the noise of the two
neighbours is felt (of a calm drive 1.1 in place of 1.0)."""
USUAL = 0.1
"""Time of a turn until two scans are known [s]."""
INTERVALS = 15
"""Scans whose median tells how long a turn takes."""


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
    """A scan as the first pass has it."""

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
        self._second = ScanTracker(np.zeros(3))
        self._motion, self._clock, self._failed = np.zeros(3), 0.0, 0
        self._seen: deque[_Seen] = deque(maxlen=2 * AROUND + 1)
        self._done = 0  # scans at the front of `_seen` that the second pass has
        self._failed_again, self._piece, self._scans = 0, 0, 0
        self._flags: dict[Flag, int] = {}
        self._found = array("d")  # of each pose: time, pose, covariance, walk, piece
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
        if self._seen or self._failed:
            turns += self._failed
        before = self._first.pose
        points = deskewed(sweep, own_course(self._motion, usual))
        motion = turns * self._motion
        flag = self._first.take(points, sweep.spacing, motion, turns * usual)
        if flag:
            self._flags[flag] = self._flags.get(flag, 0) + 1
            self._failed += 1
            if self._failed >= LOST_AFTER:
                self._cut()
            return
        if self._seen:
            self._motion = motion_between(before, self._first.pose) / turns
        self._failed = 0
        self._append(_Seen(sweep, self._first.pose, self._clock))

    def path(self) -> ScanPath:
        """The path of all scans that were taken; the last call of all."""
        self._cut()
        table = np.array(self._found).reshape(-1, 16)
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
        while self._done < len(self._seen):
            self._again()
        self._seen.clear()
        self._done = 0
        self._first = ScanTracker(self._first.pose)
        self._motion, self._failed = np.zeros(3), 0
        self._renew()

    def _renew(self) -> None:
        # Beside the last pose: one that is the same to the last digit looks held, not measured.
        self._second = ScanTracker(self._second.pose + 1e-6)
        self._failed_again = 0
        self._piece += 1

    def _append(self, seen: _Seen) -> None:
        if len(self._seen) == self._seen.maxlen:
            self._done -= 1
        self._seen.append(seen)
        if len(self._seen) - self._done > AROUND:
            self._again()

    def _again(self) -> None:
        """The second pass over the next scan."""
        seen = self._seen[self._done]
        course = _course(self._seen, self._done)
        points = deskewed(seen.sweep, course)
        motion, duration = np.zeros(3), USUAL
        if self._done:
            last = self._seen[self._done - 1]
            motion, duration = motion_between(last.pose, seen.pose), seen.clock - last.clock
        self._done += 1
        flag = self._second.take(points, seen.sweep.spacing, motion, duration)
        if flag:
            self._flags[flag] = self._flags.get(flag, 0) + 1
            self._failed_again += 1
            # What was missed is in the guess: the pose goes on as in the first pass.
            self._second.pose = moved(self._second.pose, motion)
            if self._failed_again >= LOST_AFTER:
                self._renew()
            return
        self._failed_again = 0
        if abs(course.linear[2]) > ORDER_TURNING and len(self.scatter) < ORDER_MOST:
            self.scatter[seen.sweep.time] = self._second.scatter
        self._found.append(seen.sweep.time)
        self._found.extend(self._second.pose)
        self._found.extend(self._second.covariance.ravel())
        self._found.extend(self._second.walk)
        self._found.append(self._piece)


def usual_about(covariances: Floats, piece: NDArray[np.intp]) -> Floats:
    """Covariances (n, 3, 3), each as the mean of those of scans about it, in axes of the piece.

    The residuals of one scan tell its variance to a factor of two only, and who believes the small
    ones weighs poses by chance. What a lidar sees hardly changes in half a second.
    """
    found = np.empty_like(covariances)
    for each in np.unique(piece):
        rows = piece == each
        found[rows] = uniform_filter1d(covariances[rows], 2 * _BESIDE + 1, axis=0, mode="nearest")
    return found


def common_noise(
    poses: Floats, covariances: Floats, piece: NDArray[np.intp]
) -> tuple[float, float]:
    """What poses err beyond the covariances of their matches; see `ScanPath.common`.

    A lidar whose turns begin at an angle that jitters: no match can see it. It turns the heading
    alone. What positions err beyond their matches has the directions of those: along a corridor it
    is not what it is across. Both are read off the fourth differences of five poses, which no
    smooth course has, one by one, of a lidar that moves: at rest, what a driver does to the beams
    is the same in each scan. Starts and stops have such differences too: only the calmest part
    counts, by the poses before and after the five.
    """
    middle = np.arange(_BESIDE, len(poses) - _BESIDE)
    middle = middle[piece[middle - _BESIDE] == piece[middle + _BESIDE]]

    def step(first: int, last: int) -> Floats:
        return np.asarray(poses[middle + last] - poses[middle + first])

    moved = np.abs(step(-_BESIDE, 0)) + np.abs(step(0, _BESIDE))
    moving = (np.hypot(*moved[:, :2].T) > MOVING) | (moved[:, 2] > MOVING)
    if np.count_nonzero(moving) >= FEWEST_POSES:
        middle = middle[moving]
    if len(middle) < FEWEST_POSES:
        return 1.0, 0.0
    changes = step(3, _BESIDE) - step(-_BESIDE, -3)
    of_both = np.column_stack([np.hypot(*changes[:, :2].T), np.abs(changes[:, 2])])
    still, steady = (of_both <= np.quantile(of_both, CALM, axis=0)).T
    rough = step(1, 2) - 3.0 * step(0, 1) + 3.0 * step(-1, 0) - step(-2, -1)
    stated = 70.0 * covariances[middle]  # 1, -4, 6, -4, 1
    place = rough[still, :2]
    solved = np.linalg.solve(stated[still, :2, :2], place[..., None])[..., 0]
    ratios = (
        float(np.median((place * solved).sum(axis=1))) / _MEDIAN_OF_TWO,
        (MAD * float(np.median(np.abs(rough[steady, 2])))) ** 2
        / float(np.median(stated[steady, 2, 2])),
    )
    # A standard deviation by the median of n has a relative error of 1.17 / root n.
    least = [
        max(COMMON, 1.0 + 2.0 * 1.17 * COMMON_SURE / np.sqrt(np.count_nonzero(rows)))
        for rows in (still, steady)
    ]
    wider, more = (
        ratio if ratio > bound else 1.0 for ratio, bound in zip(ratios, least, strict=True)
    )
    return wider, float(np.sqrt((more - 1.0) * np.median(covariances[middle, 2, 2])))


_BESIDE = 5
"""Scans before and after one that tell its covariance, and how calmly the lidar moves."""
_MEDIAN_OF_TWO = 2.0 * np.log(2.0)
"""Median of chi squared with two degrees of freedom."""


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
