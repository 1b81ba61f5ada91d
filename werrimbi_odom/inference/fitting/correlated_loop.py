# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Loop of the filter of `correlated_filter`: predict a leg, compute the innovation, correct.

It exists twice, as that of `leg_loop`: vectorised over all stretches, and leg by leg in scalars,
which `compiled` turns into machine code.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference.fitting.leg_loop import turn_into
from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.pose import Floats, wrap_all

GYRO_STATES = 8
"""Pose, error, and a gyro's scale factor and drift, which move the error of the heading."""


class CorrelatedLoop(NamedTuple):
    """What the loop is to be told of m legs, for g sets of variances, and what it fills.

    Legs are in the order of the rounds. States are the pose, its measurement's error, and of a gyro
    the scale factor and the drift: s = 6 or 8.
    """

    bounds: NDArray[np.intp]
    """First row of each round, and the end of the last, (r + 1,)."""
    state: Floats
    """At the start of each of j stretches, (g, j, s)."""
    spread: Floats
    """Its covariance, (g, j, s, s)."""
    relative: Floats
    """Predicted relative poses, (m, 3)."""
    noise: Floats
    """Their covariance, (g, m, 3, 3)."""
    finish: Floats
    """Measured poses, (m, 3), zero where nothing was measured."""
    known: NDArray[np.bool_]
    """Whether it was, (m, 3)."""
    reading: Floats
    """White noise of the measurement, (g, m, 3, 3), with that of what was not measured."""
    lost: Floats
    """Variance added to the pose, (m, 3), and ..."""
    anew: Floats
    """... to its error, (g, m, 3)."""
    moves: Floats
    """Transition of the states over each leg, (g, m, s, s); the loop fills in how a heading moves
    the position."""
    values: Floats
    """Filled: innovations, (g, m, 3), in the axes of the reference, ..."""
    covariances: Floats
    """... `covariances`, (g, m, 3, 3), ..."""
    turns: Floats
    """... rotations from the robot's axes at the leg's start, (g, m, 3, 3), ..."""
    less: Floats
    """... and for the first set what a correction leaves of a change, (m, s, s)."""


def run_loop(of: CorrelatedLoop) -> None:
    """Fill what the loop fills, the faster way."""
    machine = compiled(loop_over_scalars)
    if machine is None:
        loop_over_arrays(of)
    else:
        machine(*map(np.ascontiguousarray, of[:10]), *of[10:])


def loop_over_arrays(of: CorrelatedLoop) -> None:
    """The loop, all stretches and sets in step: `loop_over_scalars` for arrays."""
    state, spread, size = of.state, of.spread, of.state.shape[-1]
    pose, own = np.arange(3), np.arange(3, 6)
    for now in map(slice, of.bounds[:-1], of.bounds[1:]):
        still = now.stop - now.start
        state, spread = state[:, :still], spread[:, :still]
        turn, move, known = of.turns[:, now], of.moves[:, now], of.known[now]
        turn_into(turn, state[..., 2])
        step = (turn @ of.relative[now, :, None])[..., 0]
        move[..., 0, 2], move[..., 1, 2] = -step[..., 1], step[..., 0]
        carried = (move[..., 3:, 3:] @ state[..., 3:, None])[..., 0]
        state = np.concatenate([state[..., :3] + step, carried], -1)
        spread = move @ spread @ move.swapaxes(-1, -2)
        spread[..., :3, :3] += turn @ of.noise[:, now] @ turn.swapaxes(-1, -2)
        spread[..., pose, pose] += of.lost[now]
        spread[..., own, own] += of.anew[:, now]
        seen = spread[..., :3] + spread[..., 3:6]
        total = seen[..., :3, :] + seen[..., 3:6, :] + of.reading[:, now]
        new = np.where(known, of.finish[now] - state[..., :3] - state[..., 3:6], 0.0)
        new[..., 2] = wrap_all(new[..., 2])
        of.values[:, now], of.covariances[:, now] = new, total
        gain = seen @ np.linalg.inv(total)
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ seen.swapaxes(-1, -2)
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        counted = gain[0] * known[:, None, :]
        of.less[now] = np.eye(size)
        of.less[now, :, :3] -= counted
        of.less[now, :, 3:6] -= counted


def loop_over_scalars(
    bounds: NDArray[np.intp],
    states: Floats,
    spreads: Floats,
    relative: Floats,
    noise: Floats,
    finish: Floats,
    known: NDArray[np.bool_],
    reading: Floats,
    lost: Floats,
    anew: Floats,
    moves: Floats,
    values: Floats,
    covariances: Floats,
    turns: Floats,
    less: Floats,
) -> None:
    """The loop in scalars, one stretch after the other; see `CorrelatedLoop`."""
    size = states.shape[2]
    seen, gain = np.empty((size, 3)), np.empty((size, 3))
    for group in range(states.shape[0]):
        for stretch in range(states.shape[1]):
            state, spread = states[group, stretch].copy(), spreads[group, stretch].copy()
            for step in range(bounds.size - 1):
                row = bounds[step] + stretch
                if row >= bounds[step + 1]:
                    break
                cos, sin = math.cos(state[2]), math.sin(state[2])
                turn, move, n = turns[group, row], moves[group, row], noise[group, row]
                turn[0, 0], turn[0, 1], turn[0, 2] = cos, -sin, 0.0
                turn[1, 0], turn[1, 1], turn[1, 2] = sin, cos, 0.0
                turn[2, 0], turn[2, 1], turn[2, 2] = 0.0, 0.0, 1.0
                ahead, aside = relative[row, 0], relative[row, 1]
                dx, dy = cos * ahead - sin * aside, sin * ahead + cos * aside
                move[0, 2], move[1, 2] = -dy, dx

                state[0] += dx
                state[1] += dy
                state[2] += relative[row, 2]
                for axis in range(3, 6):
                    state[axis] *= move[axis, axis]
                if size == GYRO_STATES:
                    state[5] += move[5, 6] * state[6] + move[5, 7] * state[7]
                # The transition from the left, then its transpose from the right.
                for column in range(size):
                    spread[0, column] -= dy * spread[2, column]
                    spread[1, column] += dx * spread[2, column]
                    for axis in range(3, 6):
                        spread[axis, column] *= move[axis, axis]
                    if size == GYRO_STATES:
                        spread[5, column] += move[5, 6] * spread[6, column]
                        spread[5, column] += move[5, 7] * spread[7, column]
                for line in range(size):
                    spread[line, 0] -= dy * spread[line, 2]
                    spread[line, 1] += dx * spread[line, 2]
                    for axis in range(3, 6):
                        spread[line, axis] *= move[axis, axis]
                    if size == GYRO_STATES:
                        spread[line, 5] += move[5, 6] * spread[line, 6]
                        spread[line, 5] += move[5, 7] * spread[line, 7]
                across = cos * sin * (n[0, 0] - n[1, 1]) + (cos * cos - sin * sin) * n[0, 1]
                with_x, with_y = cos * n[0, 2] - sin * n[1, 2], sin * n[0, 2] + cos * n[1, 2]
                twice = 2.0 * cos * sin * n[0, 1]
                spread[0, 0] += cos * cos * n[0, 0] - twice + sin * sin * n[1, 1]
                spread[1, 1] += sin * sin * n[0, 0] + twice + cos * cos * n[1, 1]
                spread[2, 2] += n[2, 2]
                spread[0, 1] += across
                spread[1, 0] += across
                spread[0, 2] += with_x
                spread[2, 0] += with_x
                spread[1, 2] += with_y
                spread[2, 1] += with_y
                for axis in range(3):
                    spread[axis, axis] += lost[row, axis]
                    spread[3 + axis, 3 + axis] += anew[group, row, axis]

                # Innovation and its covariance, inverted by cofactors.
                new, total = values[group, row], covariances[group, row]
                for axis in range(3):
                    for line in range(size):
                        seen[line, axis] = spread[line, axis] + spread[line, 3 + axis]
                    off = finish[row, axis] - state[axis] - state[3 + axis]
                    new[axis] = off if known[row, axis] else 0.0
                new[2] -= 2.0 * math.pi * np.rint(new[2] / (2.0 * math.pi))  # as `wrap_all` does
                doubted = reading[group, row]
                for line in range(3):
                    for axis in range(3):
                        both = seen[line, axis] + seen[3 + line, axis]
                        total[line, axis] = both + doubted[line, axis]
                a, b, c = total[0, 0], total[0, 1], total[0, 2]
                d, e, f = total[1, 1], total[1, 2], total[2, 2]
                co_a, co_b, co_c = d * f - e * e, c * e - b * f, b * e - c * d
                co_d, co_e, co_f = a * f - c * c, b * c - a * e, a * d - b * b
                share = 1.0 / (a * co_a + b * co_b + c * co_c)
                for line in range(size):
                    x, y, t = seen[line, 0], seen[line, 1], seen[line, 2]
                    gain[line, 0] = share * (x * co_a + y * co_b + t * co_c)
                    gain[line, 1] = share * (x * co_b + y * co_d + t * co_e)
                    gain[line, 2] = share * (x * co_c + y * co_e + t * co_f)
                    state[line] += (
                        gain[line, 0] * new[0] + gain[line, 1] * new[1] + gain[line, 2] * new[2]
                    )
                for line in range(size):
                    for column in range(line + 1):
                        known_so = 0.0
                        for axis in range(3):
                            known_so += gain[line, axis] * seen[column, axis]
                            known_so += gain[column, axis] * seen[line, axis]
                        left = 0.5 * (spread[line, column] + spread[column, line] - known_so)
                        spread[line, column] = spread[column, line] = left
                if group == 0:
                    for line in range(size):
                        for column in range(size):
                            less[row, line, column] = 1.0 if line == column else 0.0
                        for axis in range(3):
                            if known[row, axis]:
                                less[row, line, axis] -= gain[line, axis]
                                less[row, line, 3 + axis] -= gain[line, axis]
