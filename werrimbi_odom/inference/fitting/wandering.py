# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The filter of `filtering` for a reference whose own error wanders: a localiser, a local map.

What is measured is the pose, and an error that was nearly the same a moment ago, and noise of the
moment. The error that wanders is a first-order Gauss-Markov process (Ornstein and Uhlenbeck): a
random walk that is drawn back to nothing, so that it is bounded, as the error of whoever looks at
walls is. It is three more states beside the pose, in the frame of the reference.

Where headings are a gyro's that were laid upon a localiser's, they do not wander so: an angle, a
drift and the gyro's scale, none of them known well, stay as they are for all of a drive. Angle and
random walk are the error of the heading itself; drift and scale are two states more.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.filtering import Legs, Unexpected, Ways, in_rounds
from werrimbi_odom.inference.fitting.leg_loop import UNMEASURED, turn_into
from werrimbi_odom.inference.rules import LAID_DRIFT, LAID_SCALE, LAID_YAW, LOST_XY, LOST_YAW
from werrimbi_odom.model.pose import Floats, wrap_all

ANEW = 1e2
"""Variance [m², rad²] of what may be anything: the error after a jump, the pose after a gap."""

_LOST = np.square([LOST_XY, LOST_XY, LOST_YAW])


class LaidHeading(NamedTuple):
    """Headings of a gyro in place of a localiser's, for m legs and g sets of variances."""

    turn: Floats
    """What the robot turned in each leg, by the model, (m,) [rad]."""
    duration: Floats
    """Of each leg, (m,) [s]."""
    walk: Floats
    """Variance of the gyro's random walk in a second, (g,) [rad²/s]."""


class Wander(NamedTuple):
    """The error that wanders, for g sets of variances."""

    variance: Floats
    """Of it in x, y, yaw, however long one waits, (g, 3) [m², rad²]."""
    kept: Floats
    """Share of it that is left at each leg's end, (g, m)."""
    gap: NDArray[np.bool_]
    """Legs after which the robot may be anywhere, and the reference is lost somewhat; (m,). On
    others to be skipped it jumped: its error may be anything, and the robot drove on."""
    heading: float
    """Variance of a start heading that was not measured: none where it is fitted [rad²]."""
    laid: LaidHeading | None = None
    """Where headings are a gyro's; their error is then no process that is drawn back."""

    def kept_of_each(self) -> Floats:
        """Share of the error in x, y, yaw that is left at each leg's end, (g, m, 3)."""
        kept = np.repeat(self.kept[..., None], 3, axis=-1)
        if self.laid is not None:
            kept[..., 2] = 1.0
        return kept

    def added(self) -> Floats:
        """Variance of the error that is new at each leg's end, (g, m, 3)."""
        new = (1.0 - np.square(self.kept_of_each())) * self.variance[:, None]
        if self.laid is not None:
            new[..., 2] = self.laid.walk[:, None] * self.laid.duration
        return new

    def begun(self) -> Floats:
        """Variance of all states that are no pose where a stretch begins, (g, 3 or 5)."""
        if self.laid is None:
            return self.variance
        known = np.square([LAID_YAW, LAID_SCALE, LAID_DRIFT])
        return np.column_stack([self.variance[:, :2], np.tile(known, (len(self.variance), 1))])


def filtered_wandering(legs: Legs, wander: Wander) -> Unexpected:
    """Filter all stretches at once; innovations are of what is measured."""
    sets, count = legs.noise.shape[0], legs.relative.shape[0]
    first, leg, rounds = in_rounds(legs)
    reading = np.broadcast_to(legs.reading, legs.noise.shape)
    finite = np.isfinite(legs.start[first])
    free = ~finite[:, 2]
    laid, begun = wander.laid, wander.begun()
    size = 3 + begun.shape[1]
    state = np.zeros((sets, first.size, size))
    state[..., :3] = np.where(finite, legs.start[first], 0.0)
    state[..., 2] = np.where(free, np.nan_to_num(legs.heading[first]), state[..., 2])
    spread = _begun(reading[:, first], finite, begun, wander.heading)

    relative, noise, finish = legs.relative[leg], legs.noise[:, leg], legs.finish[leg]
    known, jumped = np.isfinite(finish), (legs.skip & ~wander.gap)[leg]
    finish = np.where(known, finish, 0.0)
    doubted = reading[:, leg] + UNMEASURED * (~known[:, None, :] * np.eye(3))
    lost = ANEW * (known & wander.gap[leg, None])
    over = wander.gap & ~np.append(wander.gap[1:], False)  # a gap is a leg for each pose in it
    throws = np.array([True, True, laid is None])  # a gyro does not lose its place
    anew = ANEW * (jumped[:, None] & known & throws) + _LOST * over[leg, None]
    kept, added = wander.kept_of_each()[:, leg], wander.added()[:, leg]

    values, covariances = np.zeros((sets, count, 3)), np.empty((sets, count, 3, 3))
    turns, moves = np.empty((sets, count, 3, 3)), np.zeros((sets, count, size, size))
    moves[:] = np.eye(size)
    moves[..., np.arange(3, 6), np.arange(3, 6)] = kept
    if laid is not None:
        moves[..., 5, 6], moves[..., 5, 7] = laid.turn[leg], laid.duration[leg]
    less = np.empty((count, size, size))
    pose, own = np.arange(3), np.arange(3, 6)
    for now in rounds:
        still = now.stop - now.start
        state, spread = state[:, :still], spread[:, :still]
        turn, move = turns[:, now], moves[:, now]
        turn_into(turn, state[..., 2])
        step = (turn @ relative[now, :, None])[..., 0]
        move[..., 0, 2], move[..., 1, 2] = -step[..., 1], step[..., 0]
        carried = (move[..., 3:, 3:] @ state[..., 3:, None])[..., 0]
        state = np.concatenate([state[..., :3] + step, carried], -1)
        spread = move @ spread @ move.swapaxes(-1, -2)
        spread[..., :3, :3] += turn @ noise[:, now] @ turn.swapaxes(-1, -2)
        spread[..., pose, pose] += lost[now]
        spread[..., own, own] += added[:, now] + anew[now]
        seen = spread[..., :3] + spread[..., 3:6]
        total = seen[..., :3, :] + seen[..., 3:6, :] + doubted[:, now]
        new = np.where(known[now], finish[now] - state[..., :3] - state[..., 3:6], 0.0)
        new[..., 2] = wrap_all(new[..., 2])
        values[:, now], covariances[:, now] = new, total
        gain = seen @ np.linalg.inv(total)
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ seen.swapaxes(-1, -2)
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        counted = gain[0] * known[now, None, :]
        less[now] = np.eye(size)
        less[now, :, :3] -= counted
        less[now, :, 3:6] -= counted
    skipped = legs.skip[leg]
    values[:, skipped] = 0.0
    place = np.empty(count, dtype=np.intp)
    place[leg] = np.arange(count)
    back = turns.swapaxes(-1, -2)
    leave = -back[0] * (known & ~skipped[:, None])[:, None]
    carry = moves[0].copy()
    for last, now in itertools.pairwise(rounds):
        carry[now] = moves[0, now] @ less[last.start : last.start + now.stop - now.start]
    enter = np.concatenate([turns[0], np.zeros((count, size - 3, 3))], axis=1)
    away = np.zeros((count, 3, size - 6))
    return Unexpected(
        (back @ values[..., None])[..., 0][:, place],
        (back @ covariances @ turns)[:, place],
        Ways(leg, enter, carry, np.concatenate([leave, leave, away], axis=-1), free, rounds),
    )


def _begun(reading: Floats, finite: NDArray[np.bool_], begun: Floats, heading: float) -> Floats:
    """Covariance at the first poses of the stretches, (g, s, n, n): pose is measured less error."""
    size = 3 + begun.shape[1]
    spread = np.zeros((*reading.shape[:2], size, size))
    own = np.einsum("gi,ij->gij", begun[:, :3], np.eye(3))[:, None]
    both = finite[:, :, None] & finite[:, None, :]
    spread[..., :3, :3] = (reading + own) * both
    spread[..., 3:, 3:] = np.einsum("gi,ij->gij", begun, np.eye(size - 3))[:, None]
    spread[..., :3, 3:6] = spread[..., 3:6, :3] = -own * both
    spread[..., 2, 2] += heading * ~finite[:, 2]
    return spread
