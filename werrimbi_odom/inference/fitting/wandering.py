# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The same filter for a reference whose own error wanders: a localiser, a matcher on a local map.

What is measured is the pose, and an error that was nearly the same a moment ago, and noise of the
moment. The error that wanders is a first-order Gauss-Markov process (Ornstein and Uhlenbeck): a
random walk that is drawn back to nothing, so that it is bounded, as the error of whoever looks at
walls is. It is three more states beside the pose, in the frame of the reference.
"""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.filtering import (
    UNMEASURED,
    Legs,
    Unexpected,
    Ways,
    in_rounds,
    turn_into,
)
from werrimbi_odom.inference.rules import LOST_XY, LOST_YAW
from werrimbi_odom.model.pose import Floats, wrap_all

ANEW = 1e2
"""Variance [m², rad²] of what may be anything: the error after a jump, the pose after a gap."""

_LOST = np.square([LOST_XY, LOST_XY, LOST_YAW])


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


def filtered_wandering(legs: Legs, wander: Wander) -> Unexpected:
    """Filter all stretches at once; innovations are of what is measured."""
    sets, count = legs.noise.shape[0], legs.relative.shape[0]
    first, leg, rounds = in_rounds(legs)
    reading = np.broadcast_to(legs.reading, legs.noise.shape)
    finite = np.isfinite(legs.start[first])
    free = ~finite[:, 2]
    state = np.zeros((sets, first.size, 6))
    state[..., :3] = np.where(finite, legs.start[first], 0.0)
    state[..., 2] = np.where(free, np.nan_to_num(legs.heading[first]), state[..., 2])
    spread = _begun(reading[:, first], finite, wander)

    relative, noise, finish = legs.relative[leg], legs.noise[:, leg], legs.finish[leg]
    known, jumped = np.isfinite(finish), (legs.skip & ~wander.gap)[leg]
    finish = np.where(known, finish, 0.0)
    doubted = reading[:, leg] + UNMEASURED * (~known[:, None, :] * np.eye(3))
    lost = ANEW * (known & wander.gap[leg, None])
    over = wander.gap & ~np.append(wander.gap[1:], False)  # a gap is a leg for each pose in it
    anew = ANEW * (jumped[:, None] & known) + _LOST * over[leg, None]
    kept = wander.kept[:, leg]
    added = (1.0 - np.square(kept))[..., None] * wander.variance[:, None]

    values, covariances = np.zeros((sets, count, 3)), np.empty((sets, count, 3, 3))
    turns, moves = np.empty((sets, count, 3, 3)), np.zeros((sets, count, 6, 6))
    moves[:] = np.eye(6)
    less = np.empty((count, 6, 6))
    pose, own = np.arange(3), np.arange(3, 6)
    for now in rounds:
        still = now.stop - now.start
        state, spread = state[:, :still], spread[:, :still]
        turn, move = turns[:, now], moves[:, now]
        turn_into(turn, state[..., 2])
        step = (turn @ relative[now, :, None])[..., 0]
        move[..., 0, 2], move[..., 1, 2] = -step[..., 1], step[..., 0]
        move[..., own, own] = kept[:, now, None]
        state = np.concatenate([state[..., :3] + step, kept[:, now, None] * state[..., 3:]], -1)
        spread = move @ spread @ move.swapaxes(-1, -2)
        spread[..., :3, :3] += turn @ noise[:, now] @ turn.swapaxes(-1, -2)
        spread[..., pose, pose] += lost[now]
        spread[..., own, own] += added[:, now] + anew[now]
        seen = spread[..., :3] + spread[..., 3:]
        total = seen[..., :3, :] + seen[..., 3:, :] + doubted[:, now]
        new = np.where(known[now], finish[now] - state[..., :3] - state[..., 3:], 0.0)
        new[..., 2] = wrap_all(new[..., 2])
        values[:, now], covariances[:, now] = new, total
        gain = seen @ np.linalg.inv(total)
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ seen.swapaxes(-1, -2)
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        counted = gain[0] * known[now, None, :]
        less[now] = np.eye(6) - np.concatenate([counted, counted], axis=-1)
    skipped = legs.skip[leg]
    values[:, skipped] = 0.0
    place = np.empty(count, dtype=np.intp)
    place[leg] = np.arange(count)
    back = turns.swapaxes(-1, -2)
    leave = -back[0] * (known & ~skipped[:, None])[:, None]
    carry = moves[0].copy()
    for last, now in itertools.pairwise(rounds):
        carry[now] = moves[0, now] @ less[last.start : last.start + now.stop - now.start]
    enter = np.concatenate([turns[0], np.zeros((count, 3, 3))], axis=1)
    return Unexpected(
        (back @ values[..., None])[..., 0][:, place],
        (back @ covariances @ turns)[:, place],
        Ways(leg, enter, carry, np.concatenate([leave, leave], axis=-1), free, rounds),
    )


def _begun(reading: Floats, finite: NDArray[np.bool_], wander: Wander) -> Floats:
    """Covariance at the first poses of the stretches, (g, s, 6, 6): pose is measured less error."""
    spread = np.zeros((*reading.shape[:2], 6, 6))
    own = np.einsum("gi,ij->gij", wander.variance, np.eye(3))[:, None]
    both = finite[:, :, None] & finite[:, None, :]
    spread[..., :3, :3] = (reading + own) * both
    spread[..., 3:, 3:] = own
    spread[..., :3, 3:] = spread[..., 3:, :3] = -own * both
    spread[..., 2, 2] += wander.heading * ~finite[:, 2]
    return spread
