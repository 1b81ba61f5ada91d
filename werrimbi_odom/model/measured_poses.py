# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Poses of steps that are followed from measured ones, so that errors do not accumulate."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.motion import BodyMotion, displacement
from werrimbi_odom.model.pose import Floats

Mask = NDArray[np.bool_]


@dataclass(frozen=True, slots=True)
class MeasuredPoses:
    """What was measured of the poses of n steps; arrays of shape (n,).

    Heading and position may have been measured at different steps.
    """

    yaw: Floats
    """Heading measured at the step from which each step's is followed [rad]."""
    yaw_from: NDArray[np.intp]
    """Index of that step."""
    place: NDArray[np.complex128]
    """Position measured at the step from which each step's is followed [m]."""
    place_from: NDArray[np.intp]
    """Index of that step."""
    arm: complex = 0j
    """Point whose position was measured, ahead and left of the axle's midpoint [m]."""

    def headings(self, turn: Floats) -> Floats:
        """Heading at the start of each step, which turns by `turn` [rad]."""
        turned = np.cumsum(turn) - turn
        return np.asarray(self.yaw + turned - turned[self.yaw_from])

    def places(self, motion: BodyMotion[Floats], heading: Floats) -> tuple[Floats, Floats]:
        """Position at the start of each step, from its motion and heading."""
        x, y = (np.cumsum(part) - part for part in displacement(motion, heading))
        first = self.place
        if self.arm:
            first = first - self.arm * np.exp(1j * heading[self.place_from])
        return first.real + x - x[self.place_from], first.imag + y - y[self.place_from]

    def reached_from(self, moved: Mask, placed: bool) -> Mask:
        """Steps whose poses may move where the motion of some steps does.

        `placed`: whether their positions matter, too.
        """
        index = np.arange(moved.size)
        sources = [self.yaw_from, self.place_from] if placed else [self.yaw_from]
        # A stretch ends where no later step is followed from before, and none from beyond.
        behind = np.minimum.accumulate(np.minimum.reduce([index, *sources])[::-1])[::-1]
        beyond = np.maximum.accumulate(np.maximum.reduce([index, *sources]))
        begins = behind == index
        begins[1:] &= beyond[:-1] < index[1:]
        stretch = np.cumsum(begins) - 1
        return np.asarray((np.bincount(stretch, moved) > 0.0)[stretch])

    def of(self, steps: Mask) -> MeasuredPoses:
        """Those of some steps, whole stretches of `reached_from`."""
        number = np.cumsum(steps) - 1
        return replace(
            self,
            yaw=self.yaw[steps],
            yaw_from=number[self.yaw_from[steps]],
            place=self.place[steps],
            place_from=number[self.place_from[steps]],
        )
