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


class InOrder(NamedTuple):
    """Inputs and outputs of the loop, for m legs in loop order."""

    rounds: list[slice]
    state: Floats
    """Start pose of each of j stretches, (j, 3)."""
    spread: Floats
    """Covariance of the start poses, (g, j, 3, 3)."""
    relative: Floats
    noise: Floats
    finish: Floats
    """Zero where nothing was measured."""
    known: NDArray[np.bool_]
    jumped: NDArray[np.bool_]
    reading: Floats
    values: Floats
    """Innovations, (g, m, 3), and `covariances` (g, m, 3, 3), in the axes of the state."""
    covariances: Floats
    turns: Floats
    """Rotation to the state's axes from the robot's at the leg's start, (g, m, 3, 3)."""
    levers: Floats
    """State transition Jacobian: effect of a heading change over the leg, (g, m, 3, 3)."""
    kept: Floats
    """I - K H: part of a perturbation that remains after the correction, for the first set, (m, 3,
    3)."""


def go_along(of: InOrder) -> None:
    """Fill the outputs, by the compiled loop if there is a compiler."""
    machine = compiled(leg_by_leg)
    if machine is None:
        side_by_side(of)
        return
    starts = np.array([0, *(now.stop for now in of.rounds)])
    spread = np.broadcast_to(of.spread, (of.noise.shape[0], *of.spread.shape[1:]))
    given = of.state, spread, of.relative, of.noise, of.finish, of.known, of.jumped, of.reading
    filled = of.values, of.covariances, of.turns, of.levers, of.kept
    machine(starts, *map(np.ascontiguousarray, given), UNMEASURED, *filled)


def side_by_side(of: InOrder) -> None:
    """The loop vectorised over stretches and sets; the same as `leg_by_leg`."""
    state = np.repeat(of.state[None], of.noise.shape[0], axis=0)
    spread = of.spread
    doubted = of.reading + UNMEASURED * diagonal_of(~of.known)
    identity = np.eye(3)
    of.levers[:] = identity
    for now in of.rounds:
        still = now.stop - now.start
        seen, leapt = of.known[now], of.jumped[now]
        state, spread = state[:, :still], spread[:, :still]
        turn, lever = of.turns[:, now], of.levers[:, now]
        turn_into(turn, state[..., 2])
        move = (turn @ of.relative[now, :, None])[..., 0]
        lever[..., 0, 2], lever[..., 1, 2] = -move[..., 1], move[..., 0]
        state = state + move
        spread = lever @ spread @ lever.swapaxes(-1, -2)
        spread += turn @ of.noise[:, now] @ turn.swapaxes(-1, -2)
        total = np.add(spread, doubted[:, now], out=of.covariances[:, now])
        new = np.subtract(of.finish[now], state, out=of.values[:, now])
        new[:, ~seen] = 0.0
        new[..., 2] = wrap_all(new[..., 2])
        gain = spread @ np.linalg.inv(total)
        before = state, spread
        state = state + (gain @ new[..., None])[..., 0]
        spread = spread - gain @ spread
        spread = 0.5 * (spread + spread.swapaxes(-1, -2))
        of.kept[now] = identity - gain[0] * seen[:, None, :]
        if leapt.any():
            # After a jump, the measured coordinates restart from the measurement alone. The others
            # (the heading, where only positions are measured) keep their predicted value and
            # variance.
            both, apart = both_of(seen), both_of(~seen)
            anew = np.where(apart, before[1], np.where(both, of.reading[:, now], 0.0))
            of.values[:, now][:, leapt] = 0.0
            state = np.where(leapt[:, None], np.where(seen, of.finish[now], before[0]), state)
            spread = np.where(leapt[:, None, None], anew, spread)
            of.kept[now][leapt] = diagonal_of(~seen[leapt])


def leg_by_leg(
    starts: NDArray[np.intp],
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
    levers: Floats,
    kept: Floats,
) -> None:
    """The loop in scalars, one stretch after the other, for g sets of variances.

    Parameters
    ----------
    starts : ndarray, shape (r + 1,)
        First row of each iteration; leg k of stretch j is row ``starts[k] + j``.
    state, spread : ndarray, shape (j, 3) and (g, j, 3, 3)
        Start poses of the stretches, and their covariances.
    relative, noise, finish, known, jumped, reading
        Inputs of the m legs in loop order: (m, 3), (g, m, 3, 3), (m, 3), (m, 3), (m,) and (g, m, 3,
        3); see `filtering.Legs`.
    unmeasured : float
        Variance for a coordinate that was not measured.
    values, covariances, turns, levers, kept : ndarray
        Outputs: innovations (g, m, 3); their covariance, the rotation into the state's axes and the
        transition Jacobian, (g, m, 3, 3) each; I - K H for the first set, (m, 3, 3).
    """
    for group in range(noise.shape[0]):
        for stretch in range(state.shape[0]):
            x, y, yaw = state[stretch, 0], state[stretch, 1], state[stretch, 2]
            first = spread[group, stretch]
            xx, xy, xt = first[0, 0], first[0, 1], first[0, 2]
            yy, yt, tt = first[1, 1], first[1, 2], first[2, 2]
            for step in range(starts.size - 1):
                row = starts[step] + stretch
                if row >= starts[step + 1]:
                    break
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

                turn, lever = turns[group, row], levers[group, row]
                turn[0, 0], turn[0, 1], turn[0, 2] = cos, -sin, 0.0
                turn[1, 0], turn[1, 1], turn[1, 2] = sin, cos, 0.0
                turn[2, 0], turn[2, 1], turn[2, 2] = 0.0, 0.0, 1.0
                lever[0, 0], lever[0, 1], lever[0, 2] = 1.0, 0.0, -dy
                lever[1, 0], lever[1, 1], lever[1, 2] = 0.0, 1.0, dx
                lever[2, 0], lever[2, 1], lever[2, 2] = 0.0, 0.0, 1.0

                # Innovation and its covariance, inverted by cofactors.
                seen_x, seen_y, seen_t = known[row, 0], known[row, 1], known[row, 2]
                off_x = finish[row, 0] - x if seen_x else 0.0
                off_y = finish[row, 1] - y if seen_y else 0.0
                off_t = finish[row, 2] - yaw if seen_t else 0.0
                off_t -= 2.0 * math.pi * np.rint(off_t / (2.0 * math.pi))  # as `wrap_all` does
                of = reading[group, row]
                a = xx + of[0, 0] + (0.0 if seen_x else unmeasured)
                b, c = xy + of[0, 1], xt + of[0, 2]
                d = yy + of[1, 1] + (0.0 if seen_y else unmeasured)
                e = yt + of[1, 2]
                f = tt + of[2, 2] + (0.0 if seen_t else unmeasured)
                total = covariances[group, row]
                total[0, 0], total[0, 1], total[0, 2] = a, b, c
                total[1, 0], total[1, 1], total[1, 2] = b, d, e
                total[2, 0], total[2, 1], total[2, 2] = c, e, f
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
                    if group == 0:
                        kept[row, :, :] = 0.0
                        kept[row, 0, 0] = 0.0 if seen_x else 1.0
                        kept[row, 1, 1] = 0.0 if seen_y else 1.0
                        kept[row, 2, 2] = 0.0 if seen_t else 1.0
                    continue

                values[group, row, 0] = off_x
                values[group, row, 1] = off_y
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
                if group == 0:
                    left = kept[row]
                    left[0, 0] = 1.0 - gxx if seen_x else 1.0
                    left[1, 0] = -gyx if seen_x else 0.0
                    left[2, 0] = -gtx if seen_x else 0.0
                    left[0, 1] = -gxy if seen_y else 0.0
                    left[1, 1] = 1.0 - gyy if seen_y else 1.0
                    left[2, 1] = -gty if seen_y else 0.0
                    left[0, 2] = -gxt if seen_t else 0.0
                    left[1, 2] = -gyt if seen_t else 0.0
                    left[2, 2] = 1.0 - gtt if seen_t else 1.0
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
    """Write rotation matrices of (x, y, yaw) for angles of shape (g, s)."""
    cos, sin = np.cos(yaw), np.sin(yaw)
    turn[:] = 0.0
    turn[..., 0, 0] = turn[..., 1, 1] = cos
    turn[..., 0, 1], turn[..., 1, 0] = -sin, sin
    turn[..., 2, 2] = 1.0


def diagonal_of(rows: NDArray[np.bool_]) -> Floats:
    """Diagonal matrices (m, 3, 3) with ones where rows (m, 3) are true."""
    return np.asarray(rows[..., None] * np.eye(3))


def both_of(known: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Mask of the covariance entries whose two coordinates are known."""
    return known[..., :, None] & known[..., None, :]
