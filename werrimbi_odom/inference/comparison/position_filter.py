# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Errors of legs for a reference of positions only, with headings estimated from earlier positions.

A Kalman filter carries position and heading from leg to leg; the error of a leg is the innovation
of the position at its end. A wrong model would trust its own heading too much and carry one bad
spin into all later legs. So the gain is computed with process noise inflated until innovations are
consistent, while the covariance is the true one of that gain under the stated noise.

The filter begins with the heading that aligns the whole drive, and holds it for as uncertain as the
alignment shows: after a spin on the spot a position tells hardly a heading, and by it alone a leg
of 1 m ended 33 cm aside.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.residuals import chained
from werrimbi_odom.model.pose import Floats

_MEDIAN_CHI2_2 = 1.386
_MOST_DOUBT = 1e6
_ROUNDS = 4


class PositionErrors(NamedTuple):
    """Errors of all legs, in the frame of the robot at each leg's start."""

    error: Floats
    """(x, y, NaN), shape (m, 3) [m]."""
    wheels: Floats
    """Their covariance from the wheel noise, shape (m, 3, 3)."""
    reference: Floats
    """Their covariance from the reference noise, shape (m, 3, 3)."""
    heading: Floats
    """Heading at the leg's start, estimated from earlier positions, shape (m,) [rad]."""


def position_errors(
    relative: Floats,
    wheels: Floats,
    alike: Floats,
    start: Floats,
    finish: Floats,
    variance: Floats | float,
    first: NDArray[np.intp],
    headings: Floats,
    gap: NDArray[np.bool_],
    jumped: NDArray[np.bool_] | None = None,
) -> PositionErrors:
    """Filter the legs of all runs.

    `relative`, `wheels`: predicted relative pose of each leg, and its covariance from the wheel
    noise. `alike` (m, 3, 3): the same covariance for equal noise of both wheels. Inflated noise has
    this shape: model errors are not those of a single wheel, and an error along the path is none of
    the heading. `start`, `finish` (m, 2): measured positions [m]. `variance` (m,): variance of each
    measured coordinate [m²]. `first` (runs + 1,): first leg of each run, and the number of legs.
    `headings` (runs,): approximate heading at the first pose of each run [rad]. `gap` (m,): gaps:
    the heading is propagated, the position restarts. `jumped` (m,): legs on which the reference
    jumped: after them it is the same, and what they err by tells nothing else.
    """
    variances = np.zeros(relative.shape[0]) + variance
    jumped = np.zeros_like(gap) if jumped is None else jumped
    uncertain = _heading_variances(relative, start, finish, variances, first, headings, jumped)
    anew, counted = (gap, jumped), ~(gap | jumped)
    doubt = 1.0
    for _ in range(_ROUNDS):
        doubted = wheels if doubt == 1.0 else doubt * alike
        found, deviation = _filtered(
            relative, wheels, doubted, start, finish, variances, first, headings, uncertain, anew
        )
        usual = float(np.median(deviation[counted])) / _MEDIAN_CHI2_2 if counted.any() else 0.0
        if usual <= rules.HONEST_WITHIN or doubt >= _MOST_DOUBT:
            break
        doubt = min(doubt * usual, _MOST_DOUBT)
    return found


def _filtered(
    relative: Floats,
    wheels: Floats,
    doubted: Floats,
    start: Floats,
    finish: Floats,
    variances: Floats,
    first: NDArray[np.intp],
    headings: Floats,
    uncertain: Floats,
    anew: tuple[NDArray[np.bool_], NDArray[np.bool_]],
) -> tuple[PositionErrors, Floats]:
    """Filter once with an inflated covariance; also return squared Mahalanobis distances.

    `anew`: gaps and legs on which the reference jumped, after which the position restarts.
    """
    gap, jumped = anew
    count = relative.shape[0]
    found = PositionErrors(
        np.full((count, 3), np.nan),
        np.zeros((count, 3, 3)),
        np.zeros((count, 3, 3)),
        np.zeros(count),
    )
    deviation = np.zeros(count)
    begins = {int(leg): index for index, leg in enumerate(first[:-1])}
    identity = np.eye(3)
    state = np.zeros(3)
    # Three covariances of one state: the inflated one for the gain, and the true one in two parts.
    parts = np.zeros((3, 3, 3))
    for leg in range(count):
        if leg in begins:
            run = begins[leg]
            state[:2], state[2] = start[leg], headings[run]
            known = np.diag([variances[leg], variances[leg], uncertain[run]])
            parts = np.stack([known, np.zeros((3, 3)), known])
        cos, sin = np.cos(state[2]), np.sin(state[2])
        turn = np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
        move = turn @ relative[leg]
        lever = identity.copy()
        lever[0, 2], lever[1, 2] = -move[1], move[0]
        found.heading[leg] = state[2]
        state = state + move
        parts = lever @ parts @ lever.T
        parts[0] += turn @ doubted[leg] @ turn.T
        parts[1] += turn @ wheels[leg] @ turn.T
        noise = variances[leg] * np.eye(2)
        unexpected = finish[leg] - state[:2]
        if not gap[leg]:
            back = turn[:2, :2].T
            found.error[leg, :2] = back @ unexpected
            found.wheels[leg, :2, :2] = back @ parts[1, :2, :2] @ back.T
            found.reference[leg, :2, :2] = back @ (parts[2, :2, :2] + noise) @ back.T
        if gap[leg] or jumped[leg]:
            state[:2] = finish[leg]
            parts[:, :2, :], parts[:, :, :2] = 0.0, 0.0
            parts[[[0], [2]], [0, 1], [0, 1]] = variances[leg]
            continue
        total = parts[0, :2, :2] + noise
        inverse = np.linalg.inv(total)
        deviation[leg] = unexpected @ inverse @ unexpected
        gain = parts[0, :, :2] @ inverse
        state = state + gain @ unexpected
        less = identity.copy()
        less[:, :2] -= gain
        parts = less @ parts @ less.T
        added = gain @ noise @ gain.T
        parts[0] += added
        parts[2] += added
    return found, deviation


def _heading_variances(
    relative: Floats,
    start: Floats,
    finish: Floats,
    variances: Floats,
    first: NDArray[np.intp],
    headings: Floats,
    jumped: NDArray[np.bool_],
) -> Floats:
    """Variance of the heading at the first pose of each run, shape (runs,) [rad²].

    Mean square of what the aligned path is off, and of the positions' noise, over that of its
    distance from the start: as if one position told it, since errors of a path are of a kind.
    After a jump of the reference the path starts anew.
    """
    found = np.full(headings.size, rules.UNKNOWN_HEADING)
    for run, heading in enumerate(headings.tolist()):
        own = slice(first[run], first[run + 1])
        if own.start == own.stop:
            continue
        path = np.exp(1j * heading) * chained(relative[own])[0]
        leg = np.arange(path.size - 1)
        begun = np.maximum.accumulate(np.where(jumped[own], leg + 1, 0))
        begun = np.minimum(begun, leg)
        path = path[1:] - path[begun]
        measured = (finish[own] - start[own][begun]) @ np.array([1.0, 1j])
        off = np.abs(measured - path) ** 2 + 2.0 * variances[own]
        known = np.isfinite(off) & ~jumped[own]
        lever = float(np.sum(np.abs(path[known]) ** 2))
        if lever > 0.0:
            found[run] = min(float(np.sum(off[known])) / lever, rules.UNKNOWN_HEADING)
    return found
