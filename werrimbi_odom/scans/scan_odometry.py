# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""One pass over scans: each is matched with the local map, and accepted or rejected."""

from __future__ import annotations

from typing import Literal

import numpy as np

from werrimbi_odom.model.pose import Floats, Pose, between, compose, wrap
from werrimbi_odom.scans.limits import (
    ALONE,
    FASTEST,
    FASTEST_TURN,
    FEIGNED,
    FEWEST_POINTS,
    FLOOR,
    LARGEST_SIGMA,
    LEAP,
    LEAST_AGREED,
    LEAST_MATCHED,
    LEAST_SHARE,
    LOST_AFTER,
    LOST_AFTER_ALONE,
)
from werrimbi_odom.scans.local_map import LocalMap
from werrimbi_odom.scans.matching import Match, match

Flag = Literal["", "few", "disagree", "weak", "unsettled", "fast"]
"""Reason for a rejection: few echoes on lines; echoes that disagree with the map; a direction that
is undetermined, as along a bare corridor; no convergence; an impossible speed. "" if accepted."""


class ScanTracker:
    """Pose of the lidar, scan after scan, on one unbroken map."""

    def __init__(self, start: Floats) -> None:
        """Begin at a pose (3,), with an empty map."""
        self.pose = start
        self._map = LocalMap()
        self.covariance = FLOOR**2 * np.eye(3)
        """Covariance of the last pose in the map, world axes, shape (3, 3)."""
        self.walk = np.zeros(2)
        """Variances of position, an axis, and heading that the map has walked so far [m², rad²].

        A key scan joins the map with its own error, which stays for good in the mean of those that
        are matched with it: by one over their mean age, counted in key scans, as in a moving
        average of itself.
        """
        self.scatter = 0.0
        """Scatter of the echoes of the last scan about the lines of the map [m]."""
        self._alone = False  # one place was all that told one direction of the last position
        self.failed = 0
        """Number of matches that failed since the last pose."""

    @property
    def lost(self) -> bool:
        """Whether so many matches failed in a row that the next has nothing to begin with."""
        return self.failed >= (LOST_AFTER_ALONE if self._alone else LOST_AFTER)

    def take(self, points: Floats, reach: Floats, motion: Floats, duration: float) -> Flag:
        """Match deskewed echoes (k, 2), starting from the last pose moved by `motion` (3,).

        If the match is rejected, the pose stays as it was.
        """
        flag = self._take(points, reach, motion, duration)
        self.failed = self.failed + 1 if flag else 0
        return flag

    def _take(self, points: Floats, reach: Floats, motion: Floats, duration: float) -> Flag:
        if self._map.elements is None:
            if len(points) < FEWEST_POINTS:
                return "few"
            self._map.take(self.pose, points, reach)
            return "" if self._map.elements is not None else "few"
        guess = moved(self.pose, motion)
        found = match(points, self._map.elements, guess)
        flag = _flag(found, len(points), motion_between(self.pose, found.pose), duration)
        if not flag and self._alone and np.hypot(*(found.pose - guess)[:2]) > LEAP:
            flag = "weak"
        self._alone = found.alone > ALONE or (self._alone and bool(flag))
        if not flag:
            self.pose, self.covariance = found.pose, found.covariance.copy()
            self.scatter = found.noise
            least = np.maximum(np.diagonal(found.covariance), FLOOR**2)
            np.fill_diagonal(self.covariance, least)
            if self._map.take(self.pose, points, reach):
                gain = np.linalg.solve(found.aged, found.information)
                step = gain @ self.covariance @ gain.T
                widest = np.linalg.eigvalsh(step[:2, :2])[1]
                self.walk = self.walk + np.array([widest, step[2, 2]])
        return flag


def moved(pose: Floats, motion: Floats) -> Floats:
    """A pose after a motion in its own frame; all of shape (3,)."""
    return np.array(compose(Pose(*pose.tolist()), Pose(*motion.tolist())))


def motion_between(one: Floats, other: Floats) -> Floats:
    """The motion from one pose to another, in the frame of the first; all of shape (3,)."""
    x, y, yaw = between(Pose(*one.tolist()), Pose(*other.tolist()))
    return np.array([x, y, wrap(yaw)])


def _flag(found: Match, echoes: int, motion: Floats, duration: float) -> Flag:
    if found.points < max(FEWEST_POINTS, LEAST_MATCHED * echoes):
        return "few"
    if np.linalg.det(found.information) < 1e-9 or not np.isfinite(found.covariance).all():
        return "weak"
    # From the geometry of the lines alone: the scatter of few echoes says little of a direction.
    covariance = found.noise**2 * np.linalg.inv(found.information)
    variance, axes = np.linalg.eigh(covariance[:2, :2])
    weakest = axes[:, 1]
    feigned = float(weakest @ found.feigned @ weakest)
    if variance[1] * FEIGNED * feigned > found.noise**2:
        return "weak"
    if np.sqrt(max(variance[1], covariance[2, 2])) > LARGEST_SIGMA:
        return "weak"
    if found.share < LEAST_SHARE or found.agreed < LEAST_AGREED:
        return "disagree"
    if not found.converged:
        return "unsettled"
    if np.hypot(*motion[:2]) > FASTEST * duration or abs(motion[2]) > FASTEST_TURN * duration:
        return "fast"
    return ""
