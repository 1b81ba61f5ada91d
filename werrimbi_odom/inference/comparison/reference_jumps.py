# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Jumps of a reference: a tracker that lost its markers, a scan match that failed."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.files.run import ReferenceKind
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.residuals import Residual
from werrimbi_odom.inference.distributions import MEDIAN_TO_SIGMA
from werrimbi_odom.model.pose import Floats, wrap_all
from werrimbi_odom.model.robot import Robot


def jumps_of(item: Residual, gap: NDArray[np.bool_], robot: Robot) -> Floats:
    """Jump of the reference in each interval, (x, y, yaw); zero where there is none; (n - 1, 3).

    A jump is an error of one interval that exceeds the dispersion of all errors, the errors of its
    neighbours, and a share of the motion around it (over `JUMP_SPAN` at least) by more than a count
    of both wheels of `robot`, and a step of a heading that is given in steps. No wrong model causes
    such errors. Intervals in a `gap` (n - 1,) are not tested. A spike is recorded with its
    neighbours: the poses before and after it err as well, so it comes and goes in several steps.
    """
    tested = ~gap & np.isfinite(item.intervals).any(axis=1)
    errors = np.where(np.isfinite(item.intervals) & tested[:, None], item.intervals, 0.0)
    if errors.shape[0] < rules.JUMP_FEWEST or not tested.any():
        return np.zeros_like(errors)
    interval = max(float(np.median(np.diff(item.time))), 1e-9)
    usual = np.median(_windows(errors, rules.JUMP_NEIGHBOURS), axis=-1)
    left = errors - usual
    late = int(min(rules.JUMP_LATE / interval, item.time.size // 4))
    around = max(rules.JUMP_NEIGHBOURS, late)
    driven = _windows(np.abs(item.relative), around).max(axis=-1)
    # In a turn, what is measured may go as far as a wheel that turns about the other.
    driven[:, :2] = np.maximum(driven[:, :2].max(axis=1), robot.track * driven[:, 2])[:, None]
    # A pose may be noisier under way than at rest (an antenna that shakes), hardly the reverse.
    # What is left out of a drive, and may be most of it, tells no scatter.
    moves = tested & driven.any(axis=1)
    under_way = moves if moves.any() else tested
    scatter = MEDIAN_TO_SIGMA * np.median(np.abs(left[under_way]), axis=0)
    share = np.full(3, rules.JUMP_SHARE)
    if not np.isfinite(item.measured).any():
        # A gyro does not jump. A delay of more than one interval causes an error of all that the
        # robot turns in it, so a start looks like a jump until base and delay are right.
        share[2] = rules.JUMP_SHARE_OF_A_GYRO
    # The noise of a pose does not fall with the interval; the motion does.
    share = share * max(1.0, rules.JUMP_SPAN / interval)
    least = share * (driven + np.abs(usual))
    if not np.isfinite(item.measured).any():
        least[:, 2] = np.maximum(least[:, 2], rules.JUMP_LEAST_OF_A_GYRO)
    least = np.maximum(least, 1e-9)
    # Where most intervals err by nothing, as the headings of a robot that goes straight, the median
    # is no scatter: everything else is beyond it. What many of them do is no jump.
    beyond = np.abs(left) > np.maximum(rules.JUMP_SCATTER * scatter, least)
    often = beyond[tested].mean(axis=0) > rules.JUMP_RARE
    many = np.quantile(np.abs(left[tested]), 1.0 - rules.JUMP_RARE, axis=0) / rules.JUMP_RARE_SIGMAS
    scatter = np.where(often, np.maximum(many, scatter), scatter)
    # A reference's noise has the axes of its room, the robot's turn: of two, the larger is of both.
    scatter[:2] = scatter[:2].max()
    count = np.array([0.5, 0.5, 1.0 / robot.track]) * (robot.left_tick + robot.right_tick)
    count[2] += _step_of(item.measured_yaw)
    wrong = np.abs(left) > np.maximum(rules.JUMP_SCATTER * scatter, least) + count
    total = _windows(left, rules.JUMP_NEIGHBOURS, "constant").sum(axis=-1)
    stays = np.abs(total) > rules.JUMP_LASTS * np.abs(left)
    returns = _windows(wrong & ~stays, rules.JUMP_NEIGHBOURS).any(axis=-1)
    return np.where(wrong | returns, left, 0.0)


def _step_of(yaw: Floats) -> float:
    """Step in which a heading is given [rad]; 0 where it is not seen to be."""
    changes = np.abs(wrap_all(np.diff(yaw)))
    changes = changes[changes > 1e-9]  # NaN and the rounding of a whole turn are left out
    if not changes.size:
        return 0.0
    step = float(changes.min())
    alike = np.count_nonzero(changes < rules.JUMP_STEPS_ALIKE * step)
    return step if alike >= rules.JUMP_STEPS else 0.0


def _windows(
    values: NDArray[Any], reach: int, mode: Literal["edge", "constant"] = "edge"
) -> NDArray[Any]:
    """Each row and its neighbours, along a new last axis; beyond the ends, as `numpy.pad` says."""
    padded = np.pad(values, ((reach, reach), (0, 0)), mode=mode)
    return np.lib.stride_tricks.sliding_window_view(padded, 2 * reach + 1, axis=0)


def jumped_legs(jumps: Floats, chosen: NDArray[np.intp], kind: ReferenceKind) -> NDArray[np.bool_]:
    """Legs that a jump invalidates, shape (m,).

    Where poses are absolute, a spike that is over at the leg's end does no harm. `jumps` (n - 1,
    3): jumps of the reference. `chosen` (m + 1,): reference pose at which each leg begins and ends.
    `kind`: error model of the reference.
    """
    happened = np.any(jumps != 0.0, axis=1).astype(np.float64)
    sums = np.concatenate([np.zeros((1, 3)), np.cumsum(jumps, axis=0)])
    number = np.concatenate([[0.0], np.cumsum(happened)])
    lasting = np.abs(np.diff(sums[chosen], axis=0))
    legs = [np.abs(jumps[a:b]).max(axis=0, initial=0.0) for a, b in pairwise(chosen)]
    of_leg = np.reshape(legs, (-1, 3))
    least = np.maximum(
        rules.JUMP_LASTS * of_leg, rules.JUMP_SMALL * np.abs(jumps).max(axis=0, initial=0.0)
    )
    count = np.diff(number[chosen])
    if kind == "incremental":
        return np.asarray(count > 0.0)
    return np.asarray(np.any(lasting > np.maximum(least, 1e-12), axis=1))


def pieces_between(jumps: Floats) -> NDArray[np.intp]:
    """Number of the piece of a drive between lasting jumps that each pose is of, shape (n,).

    It is -1 within a jump or a spike of several intervals. `jumps` (n - 1, 3): of the reference.
    """
    happened = np.concatenate([[False], np.any(jumps != 0.0, axis=1), [False]])
    edges = np.flatnonzero(happened[1:] != happened[:-1])
    begun = np.zeros(jumps.shape[0] + 1, dtype=np.intp)
    if edges.size:
        begun[edges[1::2]] = jumped_legs(jumps, edges, "absolute")[::2]
    return np.where(happened[1:] & happened[:-1], -1, np.cumsum(begun))
