# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Laws for effects on the wheels and on the body."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from werrimbi_odom.effects.contract.demands import (
    Values,
    corners,
    demand,
    in_words,
    settings,
    typical,
)
from werrimbi_odom.effects.contract.live_recorded_predicted import drives_alike
from werrimbi_odom.effects.contract.sample_drive import TRACK, Rehearsal, rows, seal, sealed
from werrimbi_odom.model.effect import Effect
from werrimbi_odom.model.effects_over_run import PLACE, watched
from werrimbi_odom.model.motion import BodyMotion, WheelTravel, displacement
from werrimbi_odom.model.pose import Floats

Moved = WheelTravel[Floats] | BodyMotion[Floats]

_PARTS = (0.2, 0.5, 0.3)
_SMALL, _LARGER = 2e-3, 2e-2  # of a parameter's scale
_ROUNDING = 1e-10
_GENTLY = 0.1  # largest share of a change of heading that may act on the turn of one step


def _null_is_identity(effect: Effect, rehearsal: Rehearsal) -> None:
    free = [name for name, item in effect.parameters.items() if item.tries]
    if effect.quadrature is not None:
        free.append(effect.quadrature[1])
    typical = {name: effect.parameters[name].typical for name in free}
    before = _before(effect, rehearsal)
    for values in (effect.nulls, {**effect.nulls, **typical}):
        after = _applied(effect, rehearsal, values)
        demand(
            all(np.array_equal(a, b) for a, b in zip(after, before, strict=True)),
            effect,
            "at its null values it is the exact identity",
            f"with {in_words(values)} something changes by {_distance(after, before):g}",
        )


def _is_pure(effect: Effect, rehearsal: Rehearsal) -> None:
    law = "it changes none of its arguments and remembers nothing"
    before, drive = _before(effect, rehearsal), sealed(rehearsal.drive)
    still = type(before)(*(seal(part) for part in before))
    try:
        first = effect.apply(still, drive, **typical(effect))
        second = effect.apply(still, drive, **typical(effect))
    except ValueError as error:
        if "read-only" not in str(error):
            raise
        demand(False, effect, law, "it writes into an array that it was given; make a new one")
    same = all(np.array_equal(a, b, equal_nan=True) for a, b in zip(first, second, strict=True))
    demand(same, effect, law, "twice the same, and two results")


def _is_row_local(effect: Effect, rehearsal: Rehearsal) -> None:
    drive, before = rehearsal.drive, _before(effect, rehearsal)
    some = np.arange(drive.duration.size)[::-3]
    for values in settings(effect):
        whole = effect.apply(before, drive, **values)
        picked = effect.apply(type(before)(*(p[some] for p in before)), rows(drive, some), **values)
        apart = _distance(type(before)(*(part[some] for part in whole)), picked)
        demand(
            apart <= _ROUNDING,
            effect,
            "the result of a step depends on that step's row alone",
            f"taken alone, steps come out differently by {apart:g}; no cumsum, no neighbours: "
            "what went before stands in Drive (distance, since_reversal, angles ...)",
        )


def _is_finite(effect: Effect, rehearsal: Rehearsal) -> None:
    law = "it is finite at the bounds"
    moments = rehearsal.steps[::7]
    for values in corners(effect):
        after = _applied(effect, rehearsal, values)
        demand(
            all(bool(np.isfinite(part).all()) for part in after),
            effect,
            law,
            f"with {in_words(values)} there are steps without a finite result",
        )
        for moment in moments:
            given = moment.travel if effect.stage == "wheels" else moment.motion
            try:
                effect.apply(given, moment.drive, **values)
            except (ArithmeticError, ValueError) as error:  # of `math`, for a logarithm of zero
                words = (
                    f"with {in_words(values)} a single step fails ({error}); `share` divides safely"
                )
                demand(False, effect, law, words)


def _does_not_mind_splitting(effect: Effect, rehearsal: Rehearsal) -> None:
    parts = rehearsal.split(_PARTS)
    shape = (-1, len(_PARTS))
    for values in settings(effect):
        whole, pieces = _applied(effect, rehearsal, values), _applied(effect, parts, values)
        seen = watched(rehearsal.drive)
        effect.apply(_before(effect, rehearsal), seen, **values)
        if isinstance(whole, WheelTravel):
            apart = [abs(p.reshape(shape).sum(1) - w) for p, w in zip(pieces, whole, strict=True)]
            if seen.asked & PLACE:  # places lie on chords, which differ from those of an arc
                turn = abs(rehearsal.motion.turn)
                sides = zip(apart, rehearsal.travel, strict=True)
                apart = [np.maximum(a - abs(side) * turn, 0.0) for a, side in sides]
        else:
            apart = _apart_when_split(rehearsal, whole, pieces, shape)
        worst = float(np.max(apart))
        demand(
            worst <= _ROUNDING,
            effect,
            "splitting a step changes nothing",
            f"with {in_words(values)} the sum of a step's parts differs from the step by "
            f"{worst:g}, so results depend on how often the counters are read; take a "
            "step's mean speed as speed.end, and integrals as the change of a function from .start "
            "to .end",
        )


def _apart_when_split(
    rehearsal: Rehearsal, whole: Moved, pieces: Moved, shape: tuple[int, int]
) -> list[Floats]:
    """Distances between each step and the sequence of its parts, shape (n,).

    A step is one arc at constant rate. If the effect varies within a step, one arc is only an
    approximation. Its error is tolerated: the added turn times the distance, and the variation of
    the shift times the turn.
    """
    assert isinstance(whole, BodyMotion)
    heading, x, y = (np.zeros_like(whole.turn) for _ in range(3))
    along, sideways, turn = (part.reshape(shape) for part in pieces)
    for i in range(shape[1]):
        dx, dy = displacement(BodyMotion(along[:, i], sideways[:, i], turn[:, i]), heading)
        x, y, heading = x + dx, y + dy, heading + turn[:, i]
    dx, dy = displacement(whole, np.zeros_like(whole.turn))
    bent = abs(whole.turn - rehearsal.motion.turn)
    uneven = sum(
        np.abs(part - part.sum(1, keepdims=True) * _PARTS).sum(1) for part in (along, sideways)
    )
    forgiven = bent * (abs(whole.along) + abs(whole.sideways)) + uneven * abs(whole.turn)
    return [np.maximum(np.hypot(x - dx, y - dy) - forgiven, 0.0), abs(heading - whole.turn)]


def _turns_gently_with_heading(effect: Effect, rehearsal: Rehearsal) -> None:
    drive, before = rehearsal.drive, _before(effect, rehearsal)
    swing = 1e-3
    swung = drive.with_heading(drive.heading.start + swing, drive.heading.change)
    for values in settings(effect):
        one, other = (effect.apply(before, seen, **values) for seen in (drive, swung))
        turns = [
            (after.right - after.left) / TRACK if isinstance(after, WheelTravel) else after.turn
            for after in (one, other)
        ]
        demand(
            float(np.max(np.abs(turns[1] - turns[0]))) <= _GENTLY * swing,
            effect,
            "a turn that depends on the heading does so gently",
            "with a slightly different heading a step turns quite otherwise; the heading is the "
            "sum of such turns, so nothing would be left of it",
        )


def _live_equals_recorded(effect: Effect, rehearsal: Rehearsal) -> None:
    law = "step by step in floats is the same as all at once in arrays"
    moments = rehearsal.steps
    for values in settings(effect):
        recorded = np.array(_applied(effect, rehearsal, values)).T
        for i, moment in enumerate(moments):
            given = moment.travel if effect.stage == "wheels" else moment.motion
            live = effect.apply(given, moment.drive, **values)
            apart = float(np.max(np.abs(np.array(live) - recorded[i])))
            demand(apart <= 1e-9, effect, law, f"step {i} comes out differently by {apart:g}")
            demand(
                all(type(part) is float for part in live),
                effect,
                law,
                "floats must stay floats, numpy on single numbers is slow; use the functions of "
                "werrimbi_odom.effects.functions",
            )


def _is_differentiable(effect: Effect, rehearsal: Rehearsal) -> None:
    law = "its parameters have derivatives"

    def summed(coordinates: Values) -> Floats:
        after = _applied(effect, rehearsal, effect.from_fit(coordinates))
        return np.cumsum(np.array(after), axis=1)

    for name, point, scale, sides in _coordinates(effect):
        here = summed(point)
        slopes = [
            (summed({**point, name: point[name] + side * size * scale}) - here) / (side * size)
            for side in sides
            for size in (_SMALL, _LARGER)
        ]
        length = float(np.linalg.norm(slopes[0]))
        demand(
            length > 0.0,
            effect,
            law,
            f"{name} does nothing, on a drive with everything in it; a shape, which does nothing "
            "while the others are null, must be declared with tries=(...)",
        )
        worst = max(float(np.linalg.norm(slope - slopes[0])) for slope in slopes)
        is_shape = name in effect.parameters and bool(effect.parameters[name].tries)
        demand(
            worst <= 0.25 * length or is_shape,
            effect,
            law,
            f"the slope in {name} changes by {worst / length:.0%} from small changes to larger "
            "ones, or from one side to the other: no fit can follow a jump or a kink",
        )


def _coordinates(effect: Effect) -> Iterator[tuple[str, Values, float, tuple[float, ...]]]:
    """Fitted coordinates: name, point, scale, and sides on which values are possible."""
    shapes = {name for name, item in effect.parameters.items() if item.tries}
    at_null = {**effect.nulls, **{name: effect.parameters[name].typical for name in shapes}}
    start = effect.to_fit(at_null)
    for name in start:
        if name not in effect.parameters:
            assert effect.quadrature is not None
            yield name, start, effect.parameters[effect.quadrature[0]].scale, (1.0, -1.0)
            continue
        item = effect.parameters[name]
        point = typical(effect) if name in shapes else start
        low, high = item.bounds
        sides = (1.0,) * (point[name] < high) + (-1.0,) * (point[name] > low)
        yield name, point, item.scale, sides


LAWS: tuple[Callable[[Effect, Rehearsal], None], ...] = (
    _null_is_identity,
    _is_pure,
    _is_finite,
    _is_row_local,
    _does_not_mind_splitting,
    _turns_gently_with_heading,
    _live_equals_recorded,
    drives_alike,
    _is_differentiable,
)


def _before(effect: Effect, rehearsal: Rehearsal) -> Moved:
    return rehearsal.travel if effect.stage == "wheels" else rehearsal.motion


def _applied(effect: Effect, rehearsal: Rehearsal, values: Values) -> Moved:
    before = _before(effect, rehearsal)
    after: Moved = effect.apply(before, rehearsal.drive, **values)
    demand(
        type(after) is type(before) and all(np.shape(part) == before[0].shape for part in after),
        effect,
        f"an effect on the {effect.stage} gives back a {type(before).__name__}",
        f"it gives a {type(after).__name__}, or arrays of another shape",
    )
    return after


def _distance(one: Any, other: Any) -> float:
    return float(np.max([np.max(np.abs(a - b)) for a, b in zip(one, other, strict=True)]))
