# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Test whether wheels and reference recorded the same drive at all."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache

import numpy as np

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.comparison.judged_legs import Legs, judged_legs
from werrimbi_odom.inference.comparison.prepared_runs import PreparedRuns
from werrimbi_odom.inference.fitting.free_parameters import Model
from werrimbi_odom.model.pose import Floats, wrap_all

Driven = Callable[[Legs], tuple[slice, Floats, Floats]]
"""For some legs: columns of the errors, and the motion by wheels and by reference, (m,) each."""


def of_another_drive(prepared: PreparedRuns, model: Model) -> bool:
    """Whether a calibrated model explains next to nothing of the reference.

    At every leg length its errors are as large as the motion, by position or by heading (for drives
    that turn), and larger than noise. Then the reference is of another robot, drive or hour, or its
    topic is no pose. A poor reference still passes by its long legs, a poor model by its short
    ones.
    """

    @cache
    def legs_of(length: float) -> Legs:
        return judged_legs(prepared, model, length)

    def all_untold(driven: Driven, least: float) -> bool | None:
        return _untold((legs_of(length) for length in prepared.cuts), driven, least)

    return bool(all_untold(_by_position, 0.0) or all_untold(_by_heading, rules.OTHER_DRIVE_TURN))


def turns_alike(prepared: PreparedRuns, model: Model) -> bool:
    """Whether the headings of a reference follow the wheels, whatever its places are of.

    Then it is of this robot and this drive. Straight lines show nothing of it.
    """
    every = (judged_legs(prepared, model, length) for length in prepared.cuts)
    return _untold(every, _by_heading, rules.OTHER_DRIVE_TURN) is False


def unturned(prepared: PreparedRuns, model: Model) -> tuple[float, float] | None:
    """Turn by a reference of headings alone and by the wheels [rad], where it is next to none.

    Sums over the legs of all runs of each leg's turn by size. A steady drift of the headings is no
    turn.
    """
    if any(run.reference is not None and run.reference.has_position.any() for run in prepared.runs):
        return None
    legs = judged_legs(prepared, model, min(prepared.cuts))
    turn, duration = legs.errors.turn + legs.errors.error[:, 2], legs.end_time - legs.start_time
    shown = 0.0
    for number in np.unique(legs.run):
        mine = legs.run == number
        drift = np.median(turn[mine] / duration[mine])
        shown += float(np.sum(np.abs(turn[mine] - drift * duration[mine])))
    turned = float(np.sum(np.abs(legs.errors.turn)))
    return (shown, turned) if shown < rules.NO_TURN * turned else None


def _by_position(legs: Legs) -> tuple[slice, Floats, Floats]:
    return slice(0, 2), legs.errors.along, np.hypot(legs.end_x - legs.x, legs.end_y - legs.y)


def _by_heading(legs: Legs) -> tuple[slice, Floats, Floats]:
    turn = legs.errors.turn
    return slice(2, 3), turn, wrap_all(turn + legs.errors.error[:, 2])


def _untold(every: Iterable[Legs], driven: Driven, least: float) -> bool | None:
    """Whether errors are as large as the motion, at every length with motion above `least`.

    None if no length has so much motion.
    """
    looked_at = False
    for legs in every:
        places, rolled, measured = driven(legs)
        square = np.sum(legs.errors.error[:, places] ** 2, axis=1)
        known = np.isfinite(square) & np.isfinite(measured)
        if np.sum(known) < rules.OTHER_DRIVE_LEGS:
            continue
        promised = np.trace(legs.errors.covariance[known, places, places], axis1=1, axis2=2)
        way = max(float(np.median(each[known] ** 2)) for each in (rolled, measured))
        noise = rules.FAR_ABOVE_NOISE**2 * float(np.median(promised))
        if way < least**2:
            continue
        if np.median(square[known]) < max(rules.OTHER_DRIVE * way, noise):
            return False
        looked_at = True
    return looked_at or None
