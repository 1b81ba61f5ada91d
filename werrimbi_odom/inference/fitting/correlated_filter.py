# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""The filter of `filtering` for a reference with a time-correlated error: a localiser, a local map.

The measurement is the pose, plus a slowly varying error, plus white noise. The error is a
first-order Gauss-Markov process (Ornstein-Uhlenbeck): a random walk with reversion to zero, so it
is bounded, as is the error of a sensor that sees walls. It adds three states to the pose, in the
frame of the reference.

Where headings come from a gyro aligned to a localiser, their error is different: an offset, a drift
and a scale factor, none well known, are constant over a drive. Offset and random walk are the
heading error itself; drift and scale factor are two more states.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.fitting.correlated_loop import CorrelatedLoop, run_loop
from werrimbi_odom.inference.fitting.filtering import (
    FilterInput,
    FilterResult,
    Ways,
    in_rounds,
    rows_before,
)
from werrimbi_odom.inference.fitting.leg_loop import UNMEASURED
from werrimbi_odom.model.pose import Floats

ANEW = 1e2
"""Variance [m², rad²] of an unknown quantity: the error after a jump, the pose after a gap."""

_LOST = np.square([rules.LOST_XY, rules.LOST_XY, rules.LOST_YAW])


class GyroHeading(NamedTuple):
    """Headings from a gyro in place of a localiser's, for m legs and g sets of variances."""

    turn: Floats
    """Predicted turn of each leg, (m,) [rad]."""
    duration: Floats
    """Duration of each leg, (m,) [s]."""
    walk: Floats
    """Random walk of the gyro, variance per second, (g,) [rad²/s]."""
    by_course: bool = False
    """Whether they were aligned with the direction of the positions, which tell it here too."""

    @property
    def known(self) -> Floats:
        """Initial variances of the error of their angle, their scale and their drift."""
        scale = rules.LAID_SCALE**2
        if self.by_course:
            return np.array([rules.UNKNOWN_HEADING, scale, rules.COURSE_DRIFT**2])
        return np.array([rules.LAID_YAW**2, scale, rules.LAID_DRIFT**2])


class GaussMarkovError(NamedTuple):
    """Gauss-Markov error of the reference, for g sets of variances."""

    variance: Floats
    """Stationary variance in x, y, yaw, (g, 3) [m², rad²]."""
    kept: Floats
    """Autocorrelation over each leg, (g, m)."""
    gap: NDArray[np.bool_]
    """Legs after which the pose is unknown, (m,). On other skipped legs the reference jumped: its
    error is unknown, while the robot drove on."""
    lost: NDArray[np.bool_]
    """Those of them in which the reference partly lost the robot too, (m,)."""
    heading: float
    """Variance of a start heading that was not measured; zero where it is fitted [rad²]."""
    laid: GyroHeading | None = None
    """Headings from a gyro; their error does not revert to zero."""

    def kept_of_each(self) -> Floats:
        """Autocorrelation of the error in x, y, yaw over each leg, (g, m, 3)."""
        kept = np.repeat(self.kept[..., None], 3, axis=-1)
        if self.laid is not None:
            kept[..., 2] = 1.0
        return kept

    def added(self) -> Floats:
        """Process noise variance of the error over each leg, (g, m, 3)."""
        new = (1.0 - np.square(self.kept_of_each())) * self.variance[:, None]
        if self.laid is not None:
            new[..., 2] = self.laid.walk[:, None] * self.laid.duration
        return new

    def begun(self) -> Floats:
        """Initial variance of all states other than the pose, (g, 3 or 5)."""
        if self.laid is None:
            return self.variance
        known = np.tile(self.laid.known, (len(self.variance), 1))
        return np.column_stack([self.variance[:, :2], known])


def filtered_with_correlated_error(legs: FilterInput, wander: GaussMarkovError) -> FilterResult:
    """Run the filter over all stretches at once; innovations are of the measurements."""
    sets, count = legs.noise.shape[0], legs.relative.shape[0]
    first, leg, bounds = in_rounds(legs)
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
    lost = np.where(known & wander.gap[leg, None], ANEW, 0.0)
    over = wander.lost & ~np.append(wander.lost[1:], False)  # a gap is one leg per pose in it
    throws = np.array([True, True, laid is None])  # a gyro does not jump
    anew = ANEW * (jumped[:, None] & known & throws) + _LOST * over[leg, None]
    kept, added = wander.kept_of_each()[:, leg], wander.added()[:, leg]

    values, covariances = np.empty((sets, count, 3)), np.empty((sets, count, 3, 3))
    turns, less = np.empty((sets, count, 3, 3)), np.empty((count, size, size))
    moves = np.tile(np.eye(size), (sets, count, 1, 1))
    moves[..., np.arange(3, 6), np.arange(3, 6)] = kept
    if laid is not None:
        moves[..., 5, 6], moves[..., 5, 7] = laid.turn[leg], laid.duration[leg]
    run_loop(
        CorrelatedLoop(
            *(bounds, state, spread),
            relative=relative,
            noise=noise,
            finish=finish,
            known=known,
            reading=doubted,
            lost=lost,
            anew=added + anew,
            moves=moves,
            values=values,
            covariances=covariances,
            turns=turns,
            less=less,
        )
    )
    skipped = legs.skip[leg]
    values[:, skipped] = 0.0
    place = np.empty(count, dtype=np.intp)
    place[leg] = np.arange(count)
    back = turns.swapaxes(-1, -2)
    leave = -back[0] * (known & ~skipped[:, None])[:, None]
    carry = moves[0].copy()
    for last, now in rows_before(bounds):
        carry[now] = moves[0, now] @ less[last]
    enter = np.concatenate([turns[0], np.zeros((count, size - 3, 3))], axis=1)
    away = np.zeros((count, 3, size - 6))
    return FilterResult(
        (back @ values[..., None])[..., 0][:, place],
        (back @ covariances @ turns)[:, place],
        Ways(leg, enter, carry, np.concatenate([leave, leave, away], axis=-1), free, bounds),
    )


def _begun(reading: Floats, finite: NDArray[np.bool_], begun: Floats, heading: float) -> Floats:
    """Initial covariance of the stretches, (g, s, n, n): the pose is measurement less error."""
    size = 3 + begun.shape[1]
    spread = np.zeros((*reading.shape[:2], size, size))
    own = np.einsum("gi,ij->gij", begun[:, :3], np.eye(3))[:, None]
    both = finite[:, :, None] & finite[:, None, :]
    spread[..., :3, :3] = (reading + own) * both
    spread[..., 3:, 3:] = np.einsum("gi,ij->gij", begun, np.eye(size - 3))[:, None]
    spread[..., :3, 3:6] = spread[..., 3:6, :3] = -own * both
    spread[..., 2, 2] += heading * ~finite[:, 2]
    return spread
