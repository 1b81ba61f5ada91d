# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Derivatives of all legs in an error of each step: of a wheel, or of the body along its axes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.leg_noise import DrivenPath
from werrimbi_odom.inference.fitting.whitened_innovations import Point
from werrimbi_odom.model.effect import view_of
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.reference_view import View

StepJacobian = Callable[[NDArray[np.intp]], Floats]
"""Function of step numbers (...): change of the legs' relative poses for unit errors of these
steps, (..., p). It is evaluated on demand, as the array for all steps is large."""

Side = Literal["left", "right"]
_OTHER: dict[Side, Side] = {"left": "right", "right": "left"}

CHANNELS = ("left", "right", "along", "sideways", "heading")
OF_WHEELS = CHANNELS[:3]


@dataclass(frozen=True, slots=True)
class Amount:
    """Error channel, and the quantity that the error is proportional to."""

    channel: str
    """left, right, along (both wheels alike), sideways or heading."""
    per: str
    """travel (signed), path (unsigned), turn or duration."""

    @property
    def of_wheels(self) -> bool:
        """Whether the error is a separate one of each wheel."""
        return self.channel in OF_WHEELS and self.per != "turn"

    @property
    def even(self) -> bool:
        """Whether a robot seen in a mirror has the same error; not one of one wheel."""
        aside = self.channel in ("sideways", "heading")
        return self.channel not in ("left", "right") and aside == (self.per == "turn")

    @property
    def most(self) -> float:
        """Largest error per unit of the quantity that a robot can have."""
        per_metre = self.channel == "heading" and self.per in ("travel", "path")
        return rules.MOST_TURN if per_metre else rules.MOST_ERROR


AMOUNTS = (
    Amount("left", "travel"),
    Amount("right", "travel"),
    Amount("along", "travel"),
    Amount("along", "path"),
    Amount("along", "turn"),
    Amount("sideways", "travel"),
    Amount("sideways", "path"),
    Amount("sideways", "turn"),
    Amount("heading", "turn"),
    Amount("heading", "travel"),
    Amount("heading", "path"),
    Amount("heading", "duration"),
)

BLOCK = 4096
"""Steps in a block, so that their arrays fit into the processor's cache."""


def step_jacobians(
    runs: Concatenated, path: DrivenPath, amounts: Sequence[Amount], point: Point
) -> tuple[StepJacobian, StepJacobian]:
    """Change of the legs' relative poses for unit errors of steps: of left wheel, of right wheel.

    Three coordinates for each of the amounts, one amount after the other, (..., 3 a). For an amount
    of the robot as a whole, the second is zero.
    """
    robot = point.model.robot
    levers = runs.cache.of_steps(
        point.model, "levers", lambda: _levers(runs, path, view_of(robot.effects))
    )
    bases = _bases(path, runs.drive(robot).duration)

    def pushed(own: _Levers, amount: Amount, at: NDArray[np.intp], side: Side) -> Floats:
        if amount.channel == _OTHER[side] or (side == "right" and not amount.of_wheels):
            return np.zeros((*at.shape, 3))
        base = bases[_base_of(amount, side)][at]
        base = np.abs(base) if amount.per == "path" else base
        if amount.of_wheels:
            return own.seen(0.5 * base, (-base if side == "left" else base) / robot.track)
        if amount.channel == "along":
            return own.seen(base, None)
        if amount.channel == "sideways":
            return own.seen(np.asarray(1j * base), None)
        return own.seen(None, base)

    def of_side(side: Side, at: NDArray[np.intp]) -> Floats:
        own = _Levers(levers.along[at], levers.turn[at])
        return np.concatenate([pushed(own, amount, at, side) for amount in amounts], axis=-1)

    return partial(of_side, "left"), partial(of_side, "right")


def _bases(path: DrivenPath, duration: Floats) -> dict[str, Floats]:
    """What errors are proportional to, in each step, (n,); a path is the size of a travel."""
    (left, right), (along, _, turn) = path.travel, path.motion
    return {"left": left, "right": right, "along": along, "turn": turn, "duration": duration}


def _base_of(amount: Amount, side: Side) -> str:
    """Name of the quantity for one wheel."""
    if amount.of_wheels:
        return side
    return "along" if amount.per in ("travel", "path") else amount.per


def shares_of_steps(path: DrivenPath, duration: Floats) -> dict[Amount, tuple[Floats, Floats]]:
    """`Dependence.shares` of all amounts."""
    sizes = {name: np.abs(base) for name, base in _bases(path, duration).items()}

    def of_side(amount: Amount, side: Side) -> Floats:
        return np.zeros(0) if amount.channel == _OTHER[side] else sizes[_base_of(amount, side)]

    return {amount: (of_side(amount, "left"), of_side(amount, "right")) for amount in AMOUNTS}


class _Levers(NamedTuple):
    """Lever arms: how errors of steps move the end of their leg, in the frame of its start."""

    along: NDArray[np.complex128]
    """For a metre along."""
    turn: NDArray[np.complex128]
    """For a radian [m]."""

    def seen(self, moved: Floats | NDArray[np.complex128] | None, turn: Floats | None) -> Floats:
        """Relative pose for errors along (sideways imaginary) and in heading, (..., 3)."""
        found = np.zeros((*self.along.shape, 3))
        for part, lever in ((moved, self.along), (turn, self.turn)):
            if part is not None:
                place = lever * part
                found[..., 0] += place.real
                found[..., 1] += place.imag
        if turn is not None:
            found[..., 2] = turn
        return found


def _levers(runs: Concatenated, path: DrivenPath, view: View) -> _Levers:
    leg = np.searchsorted(runs.begin, np.arange(path.motion.turn.size), side="right") - 1
    leg = np.clip(leg, 0, None)
    facing = np.exp(-1j * (path.yaw[runs.begin] + view.yaw))[leg]
    middle = np.exp(1j * (path.yaw[:-1] + 0.5 * path.motion.turn))
    marker = path.position + complex(view.ahead, view.left) * np.exp(1j * path.yaw)
    arm = marker[runs.end][leg] - 0.5 * (path.position[:-1] + path.position[1:])
    return _Levers(facing * middle, 1j * facing * arm)
