# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Common cause of events: a reversal, a start or stop, a place on the floor, or none.

Events with a common cause are no accidents: reversals suggest an effect, a place suggests the
floor, or what the reference sees there. The count of events at each possible cause is compared with
its share of the driving (binomial test).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.inference import rules
from werrimbi_odom.inference.distributions import binomial_survival, bonferroni
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.prediction import Prediction
from werrimbi_odom.model.pose import Floats

Common = Literal["reversal", "start or stop", "x", "y", "place"]

PLACES: tuple[Common, ...] = ("x", "y", "place")

MOVES = 1e-3
"""Travel in an interval [m] from which its direction counts, and turn [rad] from which it is no
standing: the noise of standing counters is less."""


@dataclass(frozen=True, slots=True)
class Alike:
    """What most of the events have in common."""

    what: Common
    count: int
    """Number of events that have it."""
    of: int
    """Number of all events."""
    at: tuple[float, float]
    """Position on the floor [m]; NaN where the cause is no place."""
    p_value: float
    """P-value, corrected for all causes tested (Bonferroni)."""
    of_reference: bool
    """Whether it is a place, and most of the events there are jumps of the reference."""


class _Tried(NamedTuple):
    """A possible common cause, on each of the sides."""

    what: Common
    at: tuple[float, float]
    near: list[NDArray[np.bool_]]
    """Mask of the intervals that have it."""
    weight: list[Floats]
    """Weight of each interval in the driving."""


def alike(
    legs: Sequence[NDArray[np.intp]],
    sides: Sequence[tuple[Concatenated, Prediction]],
    jumped: Sequence[NDArray[np.bool_]],
    *,
    places: bool = True,
) -> Alike | None:
    """The most significant common cause of the events, if any.

    `legs`: intervals of the events, for each side. `sides`: sets of drives divided into intervals,
    each with a model's prediction. `jumped`: which of the events are jumps of the reference, for
    each side. `places`: whether measured positions are places on the floor; those of an incremental
    reference are not, after a jump.
    """
    of = sum(own.size for own in legs)
    if of < rules.EVENTS_ALIKE:
        return None
    found: list[Alike] = []
    nan = float("nan")
    tried: list[_Tried] = []
    time = [runs.duration * ~runs.gap for runs, _ in sides]
    way = [told.length * ~runs.gap for runs, told in sides]
    for what in ("reversal", "start or stop"):
        near = [_after(runs, told, stops=what != "reversal") for runs, told in sides]
        tried.append(_Tried(what, (nan, nan), near, time))
    if places and not any(runs.own_axes or runs.headings_alone for runs, _ in sides):
        seen = [runs.finish[:, :2] for runs, _ in sides]
        for own, here in zip(legs, seen, strict=True):
            for leg in own.tolist():
                x, y = here[leg].tolist()
                if not np.isfinite(x + y):
                    continue
                across = [abs(p[:, 0] - x) < rules.NEAR_BAND for p in seen]
                along = [abs(p[:, 1] - y) < rules.NEAR_BAND for p in seen]
                about = [np.hypot(*(p - (x, y)).T) < rules.NEAR_PLACE for p in seen]
                tried.append(_Tried("x", (x, nan), across, way))
                tried.append(_Tried("y", (nan, y), along, way))
                tried.append(_Tried("place", (x, y), about, way))
    for what, at, near, weight in tried:
        there = [here[own] for own, here in zip(legs, near, strict=True)]
        count = sum(int(each.sum()) for each in there)
        strayed = sum(int((a & b).sum()) for a, b in zip(there, jumped, strict=True))
        whole = sum(float(part.sum()) for part in weight)
        share = sum(float(p @ here) for p, here in zip(weight, near, strict=True)) / whole
        # The event that gave the place is no evidence for it.
        told_by = 0 if np.isnan(at).all() else 1
        chance = binomial_survival(count - told_by, of - told_by, share)
        seen_badly = what in PLACES and 2 * strayed > count
        found.append(Alike(what, count, of, at, bonferroni(len(tried), chance), seen_badly))
    common = [
        each
        for each in found
        if each.count >= max(rules.EVENTS_ALIKE, rules.ALIKE_SHARE * of)
        and each.p_value < rules.SURE
    ]
    # A drive to and fro has all its stops at one place: the manoeuvre explains that, not the floor.
    return min(common, key=lambda each: (each.what in PLACES, each.p_value), default=None)


def _after(runs: Concatenated, told: Prediction, *, stops: bool) -> NDArray[np.bool_]:
    """Intervals about a reversal, or about a start or a stop; (m,)."""
    found = np.zeros(runs.count, dtype=np.bool_)
    end = runs.ends_at
    for first, last in zip(runs.legs[:-1], runs.legs[1:], strict=True):
        along, turn = told.along[first:last], told.turn[first:last]
        if stops:
            moves = (np.abs(along) > MOVES) | (np.abs(turn) > MOVES)
            turned = np.flatnonzero(np.diff(moves.astype(np.int8))) + 1
        else:
            going = np.flatnonzero(np.abs(along) > MOVES)
            turned = going[1:][np.diff(np.sign(along[going])) != 0.0]
        for leg in turned.tolist():
            since = end[first:last] - end[first + leg]
            found[first:last] |= (since > rules.AT_REVERSAL[0]) & (since < rules.AT_REVERSAL[1])
    return found
