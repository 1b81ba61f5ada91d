# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Loop of the Kalman filter: predict a leg, compute the innovation, correct.

It exists twice: vectorised over all stretches, and leg by leg in scalars, which `compiled` turns
into machine code (plain Python would take fifty times as long as the arrays).
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.model.compiled import compiled
from werrimbi_odom.model.pose import Floats, wrap_all

UNMEASURED = 1e6
"""Measurement variance [m², rad²] for a coordinate that was not measured."""


class Loop(NamedTuple):
    """What the loop is to be told of m legs, for g sets of variances, and what it fills."""

    leg: NDArray[np.intp]
    """The legs in the order of the rounds, (m,): the first of all stretches, the second ..."""
    bounds: NDArray[np.intp]
    """First row of each round, and the end of the last, (r + 1,)."""
    state: Floats
    """Start pose of each of j stretches, (j, 3)."""
    spread: Floats
    """Covariance of the start poses, (g, j, 3, 3)."""
    relative: Floats
    """Of the legs in their own order, as in `filtering.FilterInput`: (m, 3) ..."""
    noise: Floats
    """... (g, m, 3, 3) ..."""
    finish: Floats
    """... (m, 3), zero where nothing was measured ..."""
    known: NDArray[np.bool_]
    """... and whether it was, (m, 3)."""
    jumped: NDArray[np.bool_]
    reading: Floats
    """(g, m, 3, 3); (g, 1, 3, 3) if all are alike."""
    values: Floats
    """Filled: innovations, (g, m, 3), in the frame of the robot at each leg's start ..."""
    covariances: Floats
    """... and `covariances`, (g, m, 3, 3)."""
    turns: Floats
    """Filled for the first set, in the order of the rounds: into the state's axes from the robot's
    at the leg's start, (m, 3, 3) ..."""
    carry: Floats
    """... and what becomes at the leg's end of a change at the end of the leg before, (m, 3, 3)."""


def run_loop(of: Loop) -> None:
    """Fill what the loop fills, the faster way."""
    machine = compiled(loop_over_scalars)
    if machine is None:
        loop_over_arrays(of)
        return
    spread = np.broadcast_to(of.spread, (of.noise.shape[0], *of.spread.shape[1:]))
    given = of.state, spread, of.relative, of.noise, of.finish, of.known, of.jumped, of.reading
    filled = of.values, of.covariances, of.turns, of.carry
    machine(of.leg, of.bounds, *map(np.ascontiguousarray, given), UNMEASURED, *filled)


def loop_over_arrays(of: Loop) -> None:
    """The loop, all stretches and sets in step: `loop_over_scalars` for arrays."""
    state = np.repeat(of.state[None], of.noise.shape[0], axis=0)
    spread = of.spread
    reading = np.broadcast_to(of.reading, of.noise.shape)
    identity = np.eye(3)
    kept = np.broadcast_to(identity, (of.state.shape[0], 3, 3))
    for now in map(slice, of.bounds[:-1], of.bounds[1:]):
        own, still = of.leg[now], now.stop - now.start
        seen, leapt = of.known[own], of.jumped[own]
        state, spread = state[:, :still], spread[:, :still]
        turn = np.empty((*state.shape, 3))
        turn_into(turn, state[..., 2])
        back = turn.swapaxes(-1, -2)
        move = (turn @ of.relative[own, :, None])[..., 0]
        lever = lever_of(move)
        of.turns[now], of.carry[now] = turn[0], lever[0] @ kept[:still]
        state = state + move
        spread = lever @ spread @ lever.swapaxes(-1, -2)
        spread += turn @ of.noise[:, own] @ back
        total = spread + reading[:, own] + UNMEASURED * diagonal_of(~seen)
        new = of.finish[own] - state
        new[:, ~seen] = 0.0
        new[..., 2] = wrap_all(new[..., 2])
        gain = spread @ np.linalg.inv(total)
        before = state, spread
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ spread
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        kept = identity - gain[0] * seen[:, None, :]
        if leapt.any():
            # After a jump, the measured coordinates restart from the measurement alone. The others
            # (the heading, where only positions are measured) keep their predicted value and
            # variance.
            both, apart = both_of(seen), both_of(~seen)
            anew = np.where(apart, before[1], np.where(both, reading[:, own], 0.0))
            new[:, leapt] = 0.0
            state = np.where(leapt[:, None], np.where(seen, of.finish[own], before[0]), state)
            spread = np.where(leapt[:, None, None], anew, spread)
            kept[leapt] = diagonal_of(~seen[leapt])
        of.values[:, own] = (back @ new[..., None])[..., 0]
        of.covariances[:, own] = back @ total @ turn


def loop_over_scalars(
    leg: NDArray[np.intp],
    bounds: NDArray[np.intp],
    state: Floats,
    spread: Floats,
    relative: Floats,
    noise: Floats,
    finish: Floats,
    known: NDArray[np.bool_],
    jumped: NDArray[np.bool_],
    reading: Floats,
    unmeasured: float,
    values: Floats,
    covariances: Floats,
    turns: Floats,
    carry: Floats,
) -> None:
    """The loop in scalars, one stretch after the other, for g sets of variances.

    `bounds` (r + 1,): leg k of stretch j is ``leg[bounds[k] + j]``. `unmeasured`: variance of what
    was not measured. All else is as in `Loop`.
    """
    alike = reading.shape[1] == 1
    for group in range(noise.shape[0]):
        for stretch in range(state.shape[0]):
            x, y, yaw = state[stretch, 0], state[stretch, 1], state[stretch, 2]
            kept = np.eye(3)  # what is left of a change once it was corrected
            first = spread[group, stretch]
            xx, xy, xt = first[0, 0], first[0, 1], first[0, 2]
            yy, yt, tt = first[1, 1], first[1, 2], first[2, 2]
            for step in range(bounds.size - 1):
                place = bounds[step] + stretch
                if place >= bounds[step + 1]:
                    break
                row = leg[place]
                cos, sin = math.cos(yaw), math.sin(yaw)
                ahead, aside, turned = relative[row, 0], relative[row, 1], relative[row, 2]
                dx, dy = cos * ahead - sin * aside, sin * ahead + cos * aside
                # Propagate the covariance with the transition Jacobian and add the process noise.
                n = noise[group, row]
                xx, xy, yy = (
                    xx - 2.0 * dy * xt + dy * dy * tt,
                    xy + dx * xt - dy * yt - dx * dy * tt,
                    yy + 2.0 * dx * yt + dx * dx * tt,
                )
                xt, yt = xt - dy * tt, yt + dx * tt
                xx += cos * cos * n[0, 0] - 2.0 * cos * sin * n[0, 1] + sin * sin * n[1, 1]
                xy += cos * sin * (n[0, 0] - n[1, 1]) + (cos * cos - sin * sin) * n[0, 1]
                yy += sin * sin * n[0, 0] + 2.0 * cos * sin * n[0, 1] + cos * cos * n[1, 1]
                xt += cos * n[0, 2] - sin * n[1, 2]
                yt += sin * n[0, 2] + cos * n[1, 2]
                tt += n[2, 2]
                x, y, yaw = x + dx, y + dy, yaw + turned

                if group == 0:
                    turn, passed = turns[place], carry[place]
                    turn[0, 0], turn[0, 1], turn[0, 2] = cos, -sin, 0.0
                    turn[1, 0], turn[1, 1], turn[1, 2] = sin, cos, 0.0
                    turn[2, 0], turn[2, 1], turn[2, 2] = 0.0, 0.0, 1.0
                    for column in range(3):
                        passed[0, column] = kept[0, column] - dy * kept[2, column]
                        passed[1, column] = kept[1, column] + dx * kept[2, column]
                        passed[2, column] = kept[2, column]

                # Innovation and its covariance, inverted by cofactors.
                seen_x, seen_y, seen_t = known[row, 0], known[row, 1], known[row, 2]
                off_x = finish[row, 0] - x if seen_x else 0.0
                off_y = finish[row, 1] - y if seen_y else 0.0
                off_t = finish[row, 2] - yaw if seen_t else 0.0
                off_t -= 2.0 * math.pi * np.rint(off_t / (2.0 * math.pi))  # as `wrap_all` does
                of = reading[group, 0 if alike else row]
                a = xx + of[0, 0] + (0.0 if seen_x else unmeasured)
                b, c = xy + of[0, 1], xt + of[0, 2]
                d = yy + of[1, 1] + (0.0 if seen_y else unmeasured)
                e = yt + of[1, 2]
                f = tt + of[2, 2] + (0.0 if seen_t else unmeasured)
                total = covariances[group, row]
                total[0, 0] = cos * cos * a + 2.0 * cos * sin * b + sin * sin * d
                total[1, 1] = sin * sin * a - 2.0 * cos * sin * b + cos * cos * d
                total[0, 1] = cos * sin * (d - a) + (cos * cos - sin * sin) * b
                total[0, 2], total[1, 2] = cos * c + sin * e, cos * e - sin * c
                total[1, 0], total[2, 0], total[2, 1] = total[0, 1], total[0, 2], total[1, 2]
                total[2, 2] = f
                co_a, co_b, co_c = d * f - e * e, c * e - b * f, b * e - c * d
                co_d, co_e, co_f = a * f - c * c, b * c - a * e, a * d - b * b
                size = 1.0 / (a * co_a + b * co_b + c * co_c)

                if jumped[row]:
                    # After a jump, the measured coordinates restart from the measurement alone; the
                    # others keep their predicted value and variance.
                    values[group, row, 0] = values[group, row, 1] = values[group, row, 2] = 0.0
                    if seen_x:
                        x, xx = finish[row, 0], of[0, 0]
                    if seen_y:
                        y, yy = finish[row, 1], of[1, 1]
                    if seen_t:
                        yaw, tt = finish[row, 2], of[2, 2]
                    if seen_x or seen_y:
                        xy = of[0, 1] if seen_x and seen_y else 0.0
                    if seen_x or seen_t:
                        xt = of[0, 2] if seen_x and seen_t else 0.0
                    if seen_y or seen_t:
                        yt = of[1, 2] if seen_y and seen_t else 0.0
                    kept[:, :] = 0.0
                    kept[0, 0] = 0.0 if seen_x else 1.0
                    kept[1, 1] = 0.0 if seen_y else 1.0
                    kept[2, 2] = 0.0 if seen_t else 1.0
                    continue

                values[group, row, 0] = cos * off_x + sin * off_y
                values[group, row, 1] = cos * off_y - sin * off_x
                values[group, row, 2] = off_t
                gxx = size * (xx * co_a + xy * co_b + xt * co_c)
                gxy = size * (xx * co_b + xy * co_d + xt * co_e)
                gxt = size * (xx * co_c + xy * co_e + xt * co_f)
                gyx = size * (xy * co_a + yy * co_b + yt * co_c)
                gyy = size * (xy * co_b + yy * co_d + yt * co_e)
                gyt = size * (xy * co_c + yy * co_e + yt * co_f)
                gtx = size * (xt * co_a + yt * co_b + tt * co_c)
                gty = size * (xt * co_b + yt * co_d + tt * co_e)
                gtt = size * (xt * co_c + yt * co_e + tt * co_f)
                kept[0, 0] = 1.0 - gxx if seen_x else 1.0
                kept[1, 0] = -gyx if seen_x else 0.0
                kept[2, 0] = -gtx if seen_x else 0.0
                kept[0, 1] = -gxy if seen_y else 0.0
                kept[1, 1] = 1.0 - gyy if seen_y else 1.0
                kept[2, 1] = -gty if seen_y else 0.0
                kept[0, 2] = -gxt if seen_t else 0.0
                kept[1, 2] = -gyt if seen_t else 0.0
                kept[2, 2] = 1.0 - gtt if seen_t else 1.0
                x += gxx * off_x + gxy * off_y + gxt * off_t
                y += gyx * off_x + gyy * off_y + gyt * off_t
                yaw += gtx * off_x + gty * off_y + gtt * off_t
                xx, xy, xt, yy, yt, tt = (
                    xx - gxx * xx - gxy * xy - gxt * xt,
                    xy - 0.5 * (gxx * xy + gxy * yy + gxt * yt + gyx * xx + gyy * xy + gyt * xt),
                    xt - 0.5 * (gxx * xt + gxy * yt + gxt * tt + gtx * xx + gty * xy + gtt * xt),
                    yy - gyx * xy - gyy * yy - gyt * yt,
                    yt - 0.5 * (gyx * xt + gyy * yt + gyt * tt + gtx * xy + gty * yy + gtt * yt),
                    tt - gtx * xt - gty * yt - gtt * tt,
                )


def turn_into(turn: Floats, yaw: Floats) -> None:
    """Write rotation matrices of (x, y, yaw) for angles of any shape."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn[:] = 0.0
    turn[..., 0, 0] = turn[..., 1, 1] = cos
    turn[..., 0, 1], turn[..., 1, 0] = -sin, sin
    turn[..., 2, 2] = 1.0


def lever_of(move: Floats) -> Floats:
    """What becomes of an error of the pose as the robot moves on by (x, y, yaw), (..., 3, 3)."""
    lever = np.zeros((*move.shape, 3)) + np.eye(3)
    lever[..., 0, 2], lever[..., 1, 2] = -move[..., 1], move[..., 0]
    return lever


def diagonal_of(rows: NDArray[np.bool_]) -> Floats:
    """Diagonal matrices (m, 3, 3) with ones where rows (m, 3) are true."""
    return np.asarray(rows[..., None] * np.eye(3))


def both_of(known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mask of the covariance entries whose two coordinates are known."""
    return known[..., :, None] & known[..., None, :]
