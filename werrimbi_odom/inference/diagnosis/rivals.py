# SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
# SPDX-License-Identifier: Apache-2.0
"""Rivals: effects that the drives cannot tell from the one that was found.

Innovations of a filter are independent from leg to leg, so the log-likelihood of a model is a sum
over legs, and any half of them can be evaluated by itself. Every fitted effect is compared in every
half. One that beats the chosen effect in a half by the margin for rivals is a rival.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from werrimbi_odom.effects.lookup import find
from werrimbi_odom.inference import rules
from werrimbi_odom.inference.calibration_parametrisation import name_of_base, sizes_of
from werrimbi_odom.inference.diagnosis.forward_selection import Round, near_to
from werrimbi_odom.inference.diagnosis.instead_of_calibration import Instead
from werrimbi_odom.inference.diagnosis.penalised_likelihood import Fitted
from werrimbi_odom.inference.fitting.concatenated_runs import Concatenated
from werrimbi_odom.inference.fitting.identifiable import CALIBRATED
from werrimbi_odom.inference.fitting.whitened_innovations import unexpected
from werrimbi_odom.inference.set_up.findings import SetUpFinding
from werrimbi_odom.model.pose import Floats
from werrimbi_odom.model.robot import Robot


def possible_twins(finding: SetUpFinding) -> tuple[str, ...]:
    """Observational equivalents of a finding that lie within physical bounds.

    No axle is askew by a quarter turn.
    """
    impossible = {
        twin.name
        for twin in find(finding.effect).indistinguishable_from
        if not find(twin.name).allows(twin.same_as(finding.values))
    }
    return tuple(name for name in finding.twins if name not in impossible)


def rivals_of(
    first: str, rounds: tuple[Round, ...], final: Fitted, instead: tuple[Instead, ...]
) -> tuple[str, ...]:
    """The first effect and its rivals, which the runs cannot tell from it; empty if it has none."""
    size = _size(first, final)
    if size in CALIBRATED:
        named = [first, *_told(_but_certain(_sizes_in_place_of(size, final), final), final)]
        limit = final.total + rules.RIVAL * final.scatter
        named += [item.effect for item in instead if item.total < limit]
        named = list(dict.fromkeys((*named, *_in_place_of_a_size(size, rounds, final))))
        return tuple(named) if len(named) > 1 else ()
    this = round_of(first, rounds, final)
    # What was found beside it explains something else, however alike the gains are.
    near = () if this is None else _near(first, this)
    near = tuple(other for other in near if other not in final.names)
    return (first, *near) if near else ()


def round_of(name: str, rounds: Sequence[Round], final: Fitted) -> Round | None:
    """The round that accepted an effect; of what was not accepted, the first that tried it."""
    since = final.names.index(name) if name in final.names else 0
    tried = (
        this
        for this in rounds[since:]
        if any(fit.names[-1] == name and not fit.at_bound for fit in this.tried)
    )
    return next(tried, None)


def rivals_of_others(
    found: Sequence[str],
    rivals: Sequence[str],
    rounds: tuple[Round, ...],
    final: Fitted,
    given: Robot,
    laid: Concatenated,
) -> dict[str, tuple[str, ...]]:
    """Rivals of each further effect, in the round that accepted it; without those found as well.

    Effects of the reference that do the same as a size of the robot are among them.
    """
    others = {}
    for name in found[1:]:
        if name in rivals:
            continue
        near: tuple[str, ...] = ()
        if name in final.names:
            near = _near(name, rounds[final.names.index(name)])
        elif (size := _size(name, final)) in CALIBRATED:
            near = _told(_sizes_in_place_of(size, final), final)
            near = (*near, *own_scale_instead(name, final, given, laid))
        others[name] = tuple(other for other in near if other not in (*found, *rivals))
    return {name: near for name, near in others.items() if near}


def _size(name: str, final: Fitted) -> str:
    """The calibration effect that a name stands for: the base of a robot that skids has its own."""
    return "track_width" if name not in final.names and name == _base(final) else name


def _told(sizes: Iterable[str], final: Fitted) -> tuple[str, ...]:
    """Calibration effects by the names that they are told by."""
    base = _base(final)
    own = "track_width" if base in final.names else base
    return tuple(own if name == "track_width" else name for name in sizes)


def _base(final: Fitted) -> str:
    return name_of_base(final.point.model.robot)


def _sizes_in_place_of(name: str, final: Fitted) -> tuple[str, ...]:
    """Calibration effects that explain as much in place of `name`."""
    others = {other for subset in final.alternatives for other in subset if name not in subset}
    return tuple(other for other in CALIBRATED if other in others)


def _but_certain(others: tuple[str, ...], final: Fitted) -> tuple[str, ...]:
    """Sizes that explain as much in place of another, without those that are wrong in any case."""
    certain = set(final.calibrated).intersection(*final.alternatives)
    return tuple(other for other in others if other not in certain)


def _in_place_of_a_size(name: str, rounds: tuple[Round, ...], final: Fitted) -> Iterator[str]:
    """Effects that make a size unnecessary, in a model about as likely, in any round."""
    limit = final.total + rules.RIVAL * final.scatter
    for fit in (fit for this in rounds for fit in this.tried if not fit.at_bound):
        fewer = len(fit.calibrated) < len(final.calibrated) and name not in fit.calibrated
        if fewer and fit.names[-1] not in final.names and fit.total < limit:
            yield fit.names[-1]


def _near(name: str, this: Round) -> tuple[str, ...]:
    """Rivals of an effect in the round that tried it."""
    fits = [fit for fit in this.tried if not fit.at_bound]
    best = next(fit for fit in fits if fit.names[-1] == name)
    near = (fit.names[-1] for fit in fits if near_to(best, fit))
    return tuple(other for other in dict.fromkeys(near) if other != name)


def own_scale_instead(
    name: str, final: Fitted, given: Robot, laid: Concatenated
) -> tuple[str, ...]:
    """Effects of the reference that are equivalent to a size of the robot, for headings alone.

    Positions are measured by tape or by satellites, whose metric scale is right. The scale of a
    gyro is unknown, and no tape measures it.
    """
    name = _size(name, final)
    if not laid.headings_alone or name not in CALIBRATED:
        return ()
    size = sizes_of(final.point.model.robot).over(sizes_of(given)).as_effects[name]
    (own,) = find(name).parameters
    twins = [
        (find(twin.name), twin.same_as({own: size}))
        for twin in find(name).indistinguishable_from
        if twin.of_headings
    ]
    return tuple(
        effect.name
        for effect, values in twins
        if effect.stage == "reference" and effect.allows(values)
    )


def torn_by_halves(
    first: str, rounds: tuple[Round, ...], final: Fitted, laid: Concatenated
) -> tuple[str, ...]:
    """Effects that halves of the data prefer to the one that was found.

    Empty where several effects were found: a half that excites one of them more rightly prefers it.
    """
    if final.names != (first,):
        return ()
    fits = [fit for fit in rounds[0].tried if not fit.at_bound]
    best = next((fit for fit in fits if fit.names[-1] == first), None)
    return () if best is None else rivals_in_halves(laid, rounds[0], best)


def rivals_in_halves(runs: Concatenated, this: Round, best: Fitted) -> tuple[str, ...]:
    """Effects of a round that explain some half of the legs better than the overall best."""
    others = [fit for fit in this.tried if fit is not best and not fit.at_bound]
    if not others:
        return ()
    chosen = _cost_of_legs(runs, best)
    found: dict[str, None] = {}
    costs = [_cost_of_legs(runs, fit) for fit in others]
    for half in halves(runs):
        for fit, cost in zip(others, costs, strict=True):
            dearer = (best.penalty - fit.penalty) * best.scatter
            ahead = float(np.sum((chosen - cost)[half])) + 0.5 * dearer
            if ahead > rules.RIVAL * best.scatter:
                found[fit.names[-1]] = None
    return tuple(found)


def _cost_of_legs(runs: Concatenated, fit: Fitted) -> Floats:
    return np.asarray(unexpected(runs, fit.point).cost_of_legs()[0])


def halves(runs: Concatenated) -> Iterator[NDArray[np.bool_]]:
    """Odd and even parts of every drive, and each drive's first and second half; masks (m,)."""
    first = runs.legs[runs.run_of_leg]
    count = np.diff(runs.legs)[runs.run_of_leg]
    number = np.arange(runs.count) - first
    for half in ((number * rules.HALF_PARTS // count) % 2 == 0, 2 * number < count):
        yield half
        yield ~half
